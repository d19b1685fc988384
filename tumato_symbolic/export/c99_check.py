"""A program in C99 that runs the closed loop of an exported policy: all states, all effects, in every order."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from string import Template

from tumato_symbolic.diagnostics import Code, Diagnostic, UserError
from tumato_symbolic.export.c99_names import Names
from tumato_symbolic.export.c99_program import PROGRAM
from tumato_symbolic.export.closed_loop import ClosedLoop, guard, lasting
from tumato_symbolic.export.decisions import MOST_QUESTIONS, Answer, questions, tree_of
from tumato_symbolic.export.request import Request, commented
from tumato_symbolic.semantics import count_states
from tumato_symbolic.spec import TRUE, Assignment, Connectives, Executing, Formula, Is, Spec, fold

MOST_STATES = 10_000_000
"""The program holds a byte for every state, valid or not, and goes through all of them."""


def check(request: Request) -> str:
    """The text of the program. Raises `UserError` (TUM508) where there are too many states."""
    count = _few_states(request.spec)
    names, loop = Names.of(request), ClosedLoop.of(request)
    return Template(PROGRAM).substitute(
        name=request.name,
        p=names.prefix,
        u=names.upper,
        state_count=count,
        variable_count=max(1, len(loop.variables)),
        action_count=max(1, len(loop.actions)),
        required_count=max(1, len(loop.required)),
        goal_count=max(1, len(loop.goals)),
        level_count=len(loop.levels),
        bound=loop.bound or 0,
        one_effect=int(loop.ordering == "first"),
        several_steps=int(loop.several_steps),
        fair=int(loop.restoration == "fair"),
        preconditions_last=int(loop.preconditions_last),
        largest=_largest(request, loop),
        sizes=", ".join(str(len(variable.values)) for variable in loop.variables) or "1",
        variable_names=", ".join(f'"{variable.name}"' for variable in loop.variables) or '""',
        value_names="".join(_value_names(loop)),
        tables="".join(_tables(loop)),
        take="".join(_assigning(effect for action in loop.actions for effect in action.effects)),
        take_nominal="".join(_assigning(action.nominal for action in loop.actions)),
        spend="".join(_spending(loop)),
        excluded="".join(f"    if (chosen[{a}] && chosen[{b}]) return 0;\n" for a, b in loop.excluded),
        fields="".join(_fields(names)),
        about=_about(request, loop),
        starts=int(loop.starts is not None),
        preconditions="".join(_preconditions(loop)),
        chosen="".join(_chosen(loop, names)),
        **_conditions(loop),
    )


def _conditions(loop: ClosedLoop) -> dict[str, str]:
    """What is asked of states and decisions, by the places of the program."""
    return {
        "valid": _formula(loop.valid),
        "start": _formula(TRUE if loop.starts is None else loop.starts),
        "levels": "".join(f"    if (!{_formula(each)}) return {n};\n" for n, each in enumerate(loop.levels)),
        "reaction_rules": _formula(loop.reaction_rules),
        "when": _array("when", [_formula(each.when) for each in loop.required]),
        "required": _broken("when", [_formula(each.rule) for each in loop.required]),
        "active": _array("active", [_formula(each.when) for each in loop.goals]),
        "goals": _broken("active", [_formula(goal.body) for goal in loop.goals]),
    }


def _few_states(spec: Spec) -> int:
    """How many states there are, no more than the program can go through."""
    count = count_states(spec)
    if count > MOST_STATES:
        message = f"the specification has {count:,} states; the check in C goes through each, for up to {MOST_STATES:,}"
        help_ = "leave out --check; `tumato-sym verify` proves all states at once"
        raise UserError((Diagnostic(Code.TUM508, message, help=help_),))
    return count


_ABOUT = (
    "Runs the closed loop of the policy in {header}: from {begins}, what it decides, with all effects in every order."
    " Exits with 0 where all decisions are allowed{more}, safety is restored and nominal effects reach the goals. "
    "Whether a cheaper set would restore safety as well is not asked. Written by `tumato-sym export c99 --check`."
)


def _about(request: Request, loop: ClosedLoop) -> str:
    more = "" if loop.starts is None else " and lead to decided states only"
    text = _ABOUT.format(header=f"{request.name}.h", begins=loop.begins, more=more)
    return "/*" + commented(text, "   ")[2:]


def _largest(request: Request, loop: ClosedLoop) -> int:
    """How many actions that have effects are in one decision at most; a proof follows so many of them."""
    having = {n for n, cases in enumerate(loop.cases) if any(loop.actions[case].effects for case in cases)}
    tree = tree_of(request.policy, MOST_QUESTIONS)
    if tree is None:
        return len(having)
    asked = (below for question in questions(tree) for below in question.below)
    answers = [each.actions or () for each in (tree, *asked) if isinstance(each, Answer)]
    return max(len(having.intersection(answer)) for answer in answers)


def _value_names(loop: ClosedLoop) -> Iterator[str]:
    for number, variable in enumerate(loop.variables):
        values = ", ".join(f'"{value}"' for value in variable.values)
        yield f"static const char *const values_of_{number}[] = {{ {values} }};\n"
    named = ", ".join(f"values_of_{number}" for number in range(len(loop.variables))) or "0"
    yield f"static const char *const *const value_names[] = {{ {named} }};\n"


def _tables(loop: ClosedLoop) -> Iterator[str]:
    """Assignments, one after the other; where the nominal ones and the effects of each action are among them."""
    assignments: list[str] = []

    def place(assignment: Assignment) -> tuple[int, int]:
        first = len(assignments)
        assignments.extend(f"{{ {variable}, {value} }}" for variable, value in assignment)
        return first, len(assignments)

    nominal = [place(action.nominal) for action in loop.actions]
    first, effects = 0, []
    ranges = []
    for action in loop.actions:
        effects += [place(effect) for effect in action.effects]
        ranges.append((first, len(effects)))
        first = len(effects)
    yield f"static const int assignments[][2] = {{ {', '.join(assignments) or '{ 0, 0 }'} }};\n"
    for name, entries in (("nominal_of", nominal), ("effects", effects), ("effects_of", ranges)):
        listed = ", ".join(f"{{ {begin}, {end} }}" for begin, end in entries)
        yield f"static const int {name}[][2] = {{ {listed or '{ 0, 0 }'} }};\n"


def _assigning(assignments: Iterable[Assignment]) -> Iterator[str]:
    for number, assignment in enumerate(assignments):
        written = "".join(f" w->values[{variable}] = {value};" for variable, value in assignment)
        yield f"    case {number}:{written} break;\n"


def _spending(loop: ClosedLoop) -> Iterator[str]:
    """For every effect, that its action has to be waiting for it, and no longer does."""
    effects = (number for number, action in enumerate(loop.actions) for _ in action.effects)
    for effect, action in enumerate(effects):
        yield f"        case {effect}: if (!decided.executed[{action}]) return 0;\n"
        yield f"            decided.executed[{action}] = 0; break;\n"


def _fields(names: Names) -> Iterator[str]:
    for number, (type_, field) in enumerate(zip(names.types, names.fields, strict=True)):
        yield f"    state.{field} = ({type_})s[{number}];\n"
    if not names.fields:
        yield "    state.nothing = 0;\n"


def _preconditions(loop: ClosedLoop) -> Iterator[str]:
    for number, action in enumerate(loop.actions):
        meant = guard(action)
        more = "" if meant == TRUE else f" && (started || {_formula(meant)})"
        yield f"    case {number}: return {_formula(lasting(action))}{more};\n"


def _chosen(loop: ClosedLoop, names: Names) -> Iterator[str]:
    """Which entries of the actions are executed; `possible` becomes 0 where an action can start in no case."""
    for action, cases in zip(names.actions, loop.cases, strict=True):
        yield f"    if ({names.prefix}_executes(&actions, {action})) {{\n"
        if len(cases) == 1:
            yield f"        chosen[{cases[0]}] = 1;\n        *possible &= is_possible({cases[0]}, 0, s);\n"
        else:
            yield from (f"        chosen[{case}] = (char){_formula(guard(loop.actions[case]))};\n" for case in cases)
            yield f"        *possible &= {' | '.join(f'is_possible({case}, 0, s)' for case in cases)};\n"
        yield "    }\n"


def _array(name: str, formulas: list[str]) -> str:
    return "".join(f"    {name}[{number}] = (char){formula};\n" for number, formula in enumerate(formulas))


def _broken(name: str, formulas: list[str]) -> str:
    return "".join(f"    if ({name}[{number}] && !{formula}) return 0;\n" for number, formula in enumerate(formulas))


def _formula(formula: Formula) -> str:
    return fold(formula, _atom, _C)


def _atom(atom: Is | Executing) -> str:
    return f"(s[{atom.variable}] == {atom.value})" if isinstance(atom, Is) else f"(chosen[{atom.action}] != 0)"


_C: Connectives[str] = Connectives(
    constant=lambda value: "1" if value else "0",
    negation=lambda text: f"(!{text})",
    conjunction=lambda texts: f"({' && '.join(texts)})" if texts else "1",
    disjunction=lambda texts: f"({' || '.join(texts)})" if texts else "0",
    equivalence=lambda left, right: f"({left} == {right})",
)
