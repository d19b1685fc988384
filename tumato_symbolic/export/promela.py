"""The closed loop of a policy as a model for SPIN, with what is claimed of it as assertions."""

from __future__ import annotations

from collections.abc import Iterator
from string import Template
from typing import Final

from tumato_symbolic.diagnostics import Code, Diagnostic, UserError
from tumato_symbolic.export.c99_names import WORDS as C_WORDS
from tumato_symbolic.export.identifiers import identifier
from tumato_symbolic.export.model import Claims, Language, Model, infix
from tumato_symbolic.export.request import Request, commented
from tumato_symbolic.semantics import count_states
from tumato_symbolic.spec import Assignment

MOST_STATES = 1_000_000_000
"""Steps are counted up to the number of states; SPIN goes through far fewer."""

_MODEL = Template("""\
/* The closed loop of a policy, and what is claimed of it. Written by `tumato-sym export promela`.

$promise

$about

   spin -a $name.pml && cc -O2 -DSAFETY -o pan pan.c && ./pan -m1000000 */

$constants
$variables
bool acted;           /* whether an effect has occurred since the decision, or none can */
int rule;             /* which rule decides */
int steps;            /* how many steps a run has taken; how many decisions in a row were unsafe */

#define DECIDED ($decided)
$executed#define QUIET $quiet
#define VALID ($valid)
#define SAFE ($safe)
#define ALLOWED ($allowed)
#define AS_REQUIRED ($required)
$lasting#define MET ($met)

inline find_rule()
{
$rules}

inline forget()
{
$forget}

inline nominal_effects()
{
$wait$nominal    forget();
}

init
{
    atomic { rule = 0; steps = 0; }
$choices$begin    if
    :: true -> goto closed_loop
    :: true -> goto nominal_run
$restoring_mode    fi;

closed_loop:
    skip;
    do
    :: atomic {
           find_rule();
           assert(DECIDED);
           assert(ALLOWED);
$count$start           acted = QUIET;
           assert(!acted || AS_REQUIRED);
           rule = 0;
       }
       do
$effects       :: acted -> break
       od;
       atomic { forget(); acted = false; }
    od;

nominal_run:
    skip;
    atomic {
        find_rule();
$remember    }
    do
    :: atomic {
           find_rule();
           assert(DECIDED);
           nominal_effects();
           steps++;
       }
       if
       :: MET -> break
       :: else -> assert(steps < $bound)
       fi
    od;
$restoring
done:
    skip
}
""")

_ABOUT: Final = (
    "From {begins}: the policy decides; then effects of the set occur, in any order, until the robot halts what is "
    "left, after any of them. Or a step is all nominal effects of a set at once, and the goals are reached. Whether a"
    " cheaper set would restore safety as well is not asked. To check all of it:"
)

_BEGIN: Final = """\
    if
    :: VALID
    :: else -> goto done
    fi;
"""

_BEGIN_DECIDED = Template("""\
    atomic {
        find_rule();
        if
        :: $begins -> assert($complete)
        :: else -> goto done
        fi;
        rule = 0;
    }
""")

_RESTORING = Template("""\
    goto done;

restoring_run:
    skip;
    do
    :: SAFE -> break
    :: else -> atomic {
           find_rule();
           assert(DECIDED);
           nominal_effects();
           steps++;
           assert(steps <= $states);
       }
    od;
""")

_COUNT = Template("""\
           if
           :: SAFE -> steps = 0
           :: else -> steps++; assert(steps <= $states)
           fi;
""")

_WORDS: Final = """
active assert atomic bit bool break byte chan cond_expr d_proctype d_step do od else empty enabled eval fi for full
get_p goto hidden if inline init int in len local ltl mtype nempty never nfull notrace np_ of pc_value pid printf
printm priority proctype provided release return run select set_p short show skip stronguntil timeout trace true false
typedef unless unsigned xr xs weakuntil until always eventually implies equivalent next acted rule steps find_rule
forget nominal_effects closed_loop nominal_run restoring_run done continue final getframe iam_alive max min mix
onstack_put onstack_zap q_sz rand rot wasnew now uchar uint ulong ushort Trans Svtack State Proctype
"""
"""Words of the language, names of ours, and of the program that SPIN writes."""

_OURS: Final = ("executed_", "waiting_", "first_", "active_", "kept_", "_")

_LANGUAGE = Language(
    infix(true="true", false="false", negation="!", conjunction="&&", disjunction="||", equivalence="=="),
    "==",
    lambda rules: f"({' || '.join(f'rule == {number}' for number in rules)})",
    " \\\n    && ",
    "SAFE",
    "VALID",
    "DECIDED",
)


def files(request: Request) -> tuple[str]:
    """The text of the model.

    Raises `UserError` (TUM508) where the policy has no short list of rules, or the specification too many states.
    """
    states = count_states(request.spec)
    if states > MOST_STATES:
        message = f"the specification has {states:,} states; SPIN can count up to {MOST_STATES:,}"
        raise UserError((Diagnostic(Code.TUM508, message, help="`tumato-sym verify` proves all states at once"),))
    return (_Printer(model_of(request), request, states).text(),)


def model_of(request: Request) -> Model:
    """The model of a policy, with the names that it has in SPIN."""
    spec = request.spec
    names = {*(each.name for each in spec.actions), *(each.name for each in spec.variables)}
    names |= {f"{variable.name}_{value}" for variable in spec.variables for value in variable.values}
    in_capitals = {identifier(name).upper() for name in names}  # macros of the program that SPIN writes
    return Model.of(request, {*_WORDS.split(), *C_WORDS.split(), *in_capitals}, _OURS)


class _Printer:
    def __init__(self, model: Model, request: Request, states: int) -> None:
        self._model, self._loop, self._states = model, model.loop, states
        self._name, self._promise = request.name, commented(request.promise, "   ")
        self._claims = Claims(model, _LANGUAGE)

    def text(self) -> str:
        loop, model, claims = self._loop, self._model, self._claims
        fair = loop.several_steps and loop.restoration == "fair"
        counts = loop.several_steps and not fair
        places = claims.placeholders()
        lasting = f"#define STILL_POSSIBLE ({places['possible']})\n" if loop.preconditions_last else ""
        return _MODEL.substitute(
            places,
            name=self._name,
            promise=self._promise,
            about=commented(_ABOUT.format(begins=loop.begins), "   "),
            begin=_BEGIN if loop.starts is None else _BEGIN_DECIDED.substitute(places),
            constants="".join(self._constants()),
            variables="".join(self._variables()),
            lasting=lasting,
            executed="".join(f"#define executed_{name} {claims.executed(n)}\n" for n, name in enumerate(model.actions)),
            rules="".join(self._rules()),
            forget="".join(f"    {name} = false;\n" for name in self._passing()) or "    skip;\n",
            wait="".join(f"    waiting_{name} = executed_{name};\n" for name in model.actions),
            nominal="".join(self._nominal("    ")),
            choices="".join(
                f"    select ({name} : 0 .. {len(values) - 1});\n"
                for name, values in zip(model.variables, model.values, strict=True)
            ),
            restoring_mode="    :: true -> goto restoring_run\n" if fair else "",
            count=_COUNT.substitute(states=self._states) if counts else "",
            start="".join(f"           {each};\n" for each in self._start()),
            effects="".join(self._effects()),
            remember="".join(f"        {each};\n" for each in self._remember()),
            bound=loop.bound or self._states,
            restoring=_RESTORING.substitute(states=self._states) if fair else "",
        )

    def _constants(self) -> Iterator[str]:
        for values in self._model.values:
            yield from (f"#define {value} {number}\n" for number, value in enumerate(values))

    def _variables(self) -> Iterator[str]:
        for name, values in zip(self._model.variables, self._model.values, strict=True):
            yield f"{'byte' if len(values) <= 256 else 'int'} {name};\n"
        yield from (f"bool {name};\n" for name in self._passing())
        yield from (f"bool active_{number};\n" for number in range(len(self._loop.goals)))
        yield from (f"bool first_{self._model.actions[entry]};\n" for entry in self._model.named_by_goals)

    def _passing(self) -> list[str]:
        """What is forgotten when the next decision is taken."""
        kept = (f"kept_{number}" for number in self._claims.kept)
        return [*(f"waiting_{name}" for name in self._model.actions), *kept]

    def _rules(self) -> Iterator[str]:
        """The last rule first, so that the first that matches is the one that stays."""
        for number, rule in reversed(list(enumerate(self._model.rules))):
            decides = f"rule = {number}"
            condition = self._claims.matches(rule)
            yield f"    if :: {condition} -> {decides} :: else fi;\n" if rule.condition else f"    {decides};\n"

    def _start(self) -> Iterator[str]:
        yield from (f"waiting_{name} = executed_{name}" for name in self._model.actions)
        for number in self._claims.kept:
            yield f"kept_{number} = {self._claims.now(self._loop.required[number].when)}"

    def _remember(self) -> Iterator[str]:
        yield from (f"active_{number} = {self._claims.now(goal.when)}" for number, goal in enumerate(self._loop.goals))
        for entry in self._model.named_by_goals:
            yield f"first_{self._model.actions[entry]} = executed_{self._model.actions[entry]}"

    def _nominal(self, margin: str) -> Iterator[str]:
        for name, action in zip(self._model.actions, self._loop.actions, strict=True):
            if action.nominal:
                yield f"{margin}if :: waiting_{name} -> {self._assigned(action.nominal)} :: else fi;\n"

    def _assigned(self, assignment: Assignment) -> str:
        model = self._model
        written = (f"{model.variables[variable]} = {model.values[variable][value]}" for variable, value in assignment)
        return "; ".join(written) or "skip"

    def _effects(self) -> Iterator[str]:
        once = " && !acted" if self._loop.ordering == "first" else ""
        required = "assert(AS_REQUIRED)"
        if self._loop.starts is not None:
            required = f"find_rule(); {required}; rule = 0"
        lasting = "; assert(STILL_POSSIBLE)" if self._loop.preconditions_last else ""
        after = f"acted = true; {required}{lasting} }}\n"
        for entry, effect in self._model.effects:
            name = self._model.actions[entry]
            yield f"       :: atomic {{ waiting_{name}{once} ->\n"
            yield f"              waiting_{name} = false; {self._assigned(effect)}; {after}"
        if once:
            yield "       :: atomic { !acted ->\n"
            yield from self._nominal("              ")
            yield f"              acted = true; {required} }}\n"
