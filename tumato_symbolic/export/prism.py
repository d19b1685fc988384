"""The closed loop of a policy as a model for PRISM and Storm, with what is claimed of it as properties.

Which effect occurs is a choice of the environment, and no probability: there are none in a specification.
"""

from __future__ import annotations

from collections.abc import Iterator
from string import Template
from typing import Final

from tumato_symbolic.export.model import Claims, Language, Model, infix
from tumato_symbolic.export.request import Request, commented
from tumato_symbolic.spec import Assignment

_MODEL = Template("""\
// The closed loop of a policy. What is claimed of it is in $name.props. Written by `tumato-sym export prism`.
//
$promise
//
$about
//
//   storm --prism $name.prism --prop $name.props --engine dd

mdp

$constants
formula rule = $rule;
formula decided = $decided;
$executed
formula quiet = $quiet;
formula valid = $valid;
formula safe = $safe;
formula allowed = $allowed;
formula as_required = $required;
${lasting}formula met = $met;

module robot
  nominal : bool;
  acting : bool; // whether effects may occur; else the next decision is taken
  acted : bool; // whether an effect has occurred since the decision, or none can
  stepped : bool; // whether a nominal step has been taken
$variables
  [step] nominal -> (stepped'=true)$step;
  [decide] !nominal & !acting -> (acting'=true)&(acted'=quiet)$decide;
  [halt] !nominal & acting & acted -> (acting'=false)$halt;
$effects
endmodule

init
  $begins & !acting & !acted & !stepped$init
endinit
""")

_CLAIMS = Template("""\
// What is claimed of the model in $name.prism. Written by `tumato-sym export prism`.

"total": P>=1 [ G (acting | acted | stepped | $complete) ];
"allowed_at_decisions": P>=1 [ G (acting | !valid | !decided | allowed) ];
"safe_after_effects": P>=1 [ G (!acted | as_required) ];
$more""")

_ABOUT: Final = (
    "From {begins}: the policy decides; then effects of the set occur, in any order, until the robot halts what is "
    "left, after any of them. Where `nominal` is chosen, a step is all nominal effects of a set at once. No "
    "probability is assumed: what occurs is a choice that may be made for ever. Whether a cheaper set would restore "
    "safety as well is not asked. To check all of it (by diagrams: listing the states takes Storm long where they are "
    "more than some hundred):"
)

_WORDS: Final = """
A bool clock const ctmc C double dtmc E endinit endinvariant endmodule endobservables endrewards endsystem false formula
filter func F global G init invariant I int label max mdp min module X nondeterministic observable observables of Pmax
Pmin P pomdp popta probabilistic prob pta rate rewards Rmax Rmin R S smg stochastic system true U W ceil floor pow mod
log player endplayer rule decided quiet valid safe allowed as_required still_possible met robot nominal acting acted
stepped step decide halt at_once
"""
"""Words of the language, and names of ours."""

_OURS: Final = ("executed_", "waiting_", "first_", "active_", "kept_")

_LANGUAGE = Language(
    infix(true="true", false="false", negation="!", conjunction="&", disjunction="|", equivalence="="),
    "=",
    lambda rules: f"({' | '.join(f'rule = {number}' for number in rules)})",
    "\n    & ",
    "safe",
)


def files(request: Request) -> tuple[str, str]:
    """The texts of the model and of its properties.

    Raises `UserError` (TUM508) where the policy has no short list of rules.
    """
    printer = _Printer(model_of(request), request)
    return printer.model(), printer.claims()


def model_of(request: Request) -> Model:
    """The model of a policy, with the names that it has in PRISM."""
    return Model.of(request, _WORDS.split(), _OURS)


class _Printer:
    def __init__(self, model: Model, request: Request) -> None:
        self._model, self._loop = model, model.loop
        self._name, self._promise = request.name, commented(request.promise, "// ")
        self._claims = Claims(model, _LANGUAGE)

    def model(self) -> str:
        """The closed loop."""
        model, claims = self._model, self._claims
        places = claims.placeholders()
        lasting = f"formula still_possible = {places['possible']};\n" if self._loop.preconditions_last else ""
        executed = (f"formula executed_{name} = {claims.executed(n)};" for n, name in enumerate(model.actions))
        return _MODEL.substitute(
            places,
            name=self._name,
            promise=self._promise,
            about=commented(_ABOUT.format(begins=self._loop.begins), "// "),
            constants="".join(self._constants()),
            rule=self._rule(),
            executed="\n".join(executed),
            lasting=lasting,
            variables="".join(self._variables()),
            step="".join(self._nominal("executed")),
            decide="".join(self._decide()),
            halt=self._halted(),
            effects="\n".join(self._effects()),
            init="".join(f"\n  & {each}" for each in self._init()),
        )

    def claims(self) -> str:
        """The properties."""
        more = "".join(f"{each};\n" for each in self._more())
        return _CLAIMS.substitute(name=self._name, complete=self._claims.complete(), more=more)

    def _constants(self) -> Iterator[str]:
        for values in self._model.values:
            yield from (f"const int {value} = {number};\n" for number, value in enumerate(values))

    def _rule(self) -> str:
        """The first rule that matches; the last matches always."""
        *rules, _ = enumerate(self._model.rules)
        conditions = "".join(f"\n    {self._claims.matches(rule)} ? {number} : (" for number, rule in rules)
        return f"{conditions}{len(rules)}{')' * len(rules)}"

    def _variables(self) -> Iterator[str]:
        for name, values in zip(self._model.variables, self._model.values, strict=True):
            yield f"  {name} : [0..{len(values) - 1}];\n"
        flags = [f"waiting_{name}" for name in self._model.actions]
        flags += [f"kept_{number}" for number in self._claims.kept]
        flags += [f"active_{number}" for number in range(len(self._loop.goals))]
        flags += [f"first_{self._model.actions[entry]}" for entry in self._model.named_by_goals]
        yield from (f"  {flag} : bool;\n" for flag in flags)

    def _init(self) -> Iterator[str]:
        yield from (f"!waiting_{name}" for name in self._model.actions)
        yield from (f"!kept_{number}" for number in self._claims.kept)
        claims = self._claims
        yield from (claims.same(f"active_{n}", claims.now(goal.when)) for n, goal in enumerate(self._loop.goals))
        for entry in self._model.named_by_goals:
            name = self._model.actions[entry]
            yield f"(first_{name} = executed_{name})"

    def _decide(self) -> Iterator[str]:
        yield from (f"&(waiting_{name}'=executed_{name})" for name in self._model.actions)
        for number in self._claims.kept:
            yield f"&(kept_{number}'={self._claims.now(self._loop.required[number].when)})"

    def _nominal(self, which: str) -> Iterator[str]:
        """All nominal effects of the actions of a set at once."""
        for number, (variable, values) in enumerate(zip(self._model.variables, self._model.values, strict=True)):
            writes = [
                f"{which}_{name} ? {values[value]} : ("
                for name, action in zip(self._model.actions, self._loop.actions, strict=True)
                for written, value in action.nominal
                if written == number
            ]
            if writes:
                yield f"&({variable}'={''.join(writes)}{variable}{')' * len(writes)})"

    def _effects(self) -> Iterator[str]:
        once = " & !acted" if self._loop.ordering == "first" else ""
        for entry, effect in self._model.effects:
            name = self._model.actions[entry]
            guard = f"!nominal & acting{once} & waiting_{name}"
            yield f"  [{name}] {guard} -> (waiting_{name}'=false)&(acted'=true){self._writes(effect)};"
        if once:
            guard = f"!nominal & acting{once}"
            yield f"  [at_once] {guard} -> (acted'=true){self._halted()}{''.join(self._nominal('waiting'))};"

    def _halted(self) -> str:
        return "".join(f"&(waiting_{name}'=false)" for name in self._model.actions)

    def _writes(self, effect: Assignment) -> str:
        model = self._model
        return "".join(f"&({model.variables[variable]}'={model.values[variable][value]})" for variable, value in effect)

    def _more(self) -> Iterator[str]:
        """Claims that not every specification makes."""
        loop = self._loop
        if loop.preconditions_last:
            yield '"preconditions_last": P>=1 [ G (!acting | !acted | still_possible) ]'
        if self._claims.has_goals():
            bound = f"<={loop.bound}" if loop.bound else ""
            yield f'"goals_reached": P>=1 [ F{bound} (!nominal | (stepped & met)) ]'
        if loop.several_steps:
            restored = "!nominal | safe" if loop.restoration == "fair" else "nominal | (!acting & safe)"
            yield f'"safety_restored": P>=1 [ F ({restored}) ]'
