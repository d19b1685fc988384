"""The closed loop of a policy as a model for NuSMV and nuXmv, with what is claimed of it as CTL."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from string import Template
from textwrap import indent
from typing import Final

from tumato_symbolic.export.model import Claims, Language, Model, infix
from tumato_symbolic.export.request import Request, commented
from tumato_symbolic.spec import Assignment

_MODEL = Template("""\
-- The closed loop of a policy, and what is claimed of it. Written by `tumato-sym export nusmv`.
--
$promise
--
$about
--
--   NuSMV $name.smv

MODULE main

FROZENVAR
  nominal : boolean;
$frozen
VAR
  acting : boolean; -- whether effects may occur; else the next decision is taken
  acted : boolean; -- whether an effect has occurred since the decision, or none can
$variables
DEFINE
  rule := case
$rules  esac;
  decided := $decided;
$executed  quiet := $quiet;
  valid := $valid;
  safe := $safe;
  allowed := $allowed;
  as_required := $required;
$lasting  met := $met;
  stays := $stays;
$remembers  nothing_waits := $nothing_waits;

INIT $begins & !acting & !acted$init

TRANS
  ( nominal & !next(acting) & !next(acted)$remembered & next(nothing_waits)
$nominal  )
| ( !nominal & !acting & next(acting) & (next(acted) <-> quiet) & stays
$decide  )
| ( !nominal & acting & acted & !next(acting) & next(acted) & next(nothing_waits)$remembered & stays )
$effects
CTLSPEC NAME total := $complete
CTLSPEC NAME allowed_at_decisions := AG (!acting & valid & decided -> allowed)
CTLSPEC NAME safe_after_effects := AG (acted -> as_required)
$more""")

_ABOUT: Final = (
    "From {begins}: the policy decides; then effects of the set occur, in any order, until the robot halts what is "
    "left, after any of them. Where `nominal` is chosen, a step is all nominal effects of a set at once. Whether a "
    "cheaper set would restore safety as well is not asked. To check all of it:"
)

_WORDS: Final = """
MODULE DEFINE MDEFINE CONSTANTS VAR IVAR FROZENVAR INIT TRANS INVAR SPEC CTLSPEC LTLSPEC PSLSPEC COMPUTE NAME INVARSPEC
FAIRNESS JUSTICE COMPASSION ISA ASSIGN CONSTRAINT SIMPWFF CTLWFF LTLWFF PSLWFF COMPWFF IN MIN MAX MIRROR PRED PREDICATES
process array of boolean integer real word word1 bool signed unsigned extend resize sizeof uwconst swconst EX AX EF AF
EG AG E F O G H X Y Z A U S V T BU EBF ABF EBG ABG case esac mod next init union in xor xnor self TRUE FALSE count abs
max min pi exp sin cos tan ln pow asin acos atan floor itype clock time INVARSPEC READ WRITE CONSTARRAY typeof FUN
nominal acting acted rule decided quiet valid safe allowed as_required still_possible met stays remembers nothing_waits
total allowed_at_decisions safe_after_effects preconditions_last goals_reached safety_restored main
"""
"""Words of the language, and names of ours."""

_OURS: Final = ("executed_", "waiting_", "first_", "active_", "kept_")

_LANGUAGE = Language(
    infix(true="TRUE", false="FALSE", negation="!", conjunction="&", disjunction="|", equivalence="<->"),
    "=",
    lambda rules: f"(rule in {{{', '.join(map(str, rules))}}})",
    "\n    & ",
    "safe",
)


def files(request: Request) -> tuple[str]:
    """The text of the model. Raises `UserError` (TUM508) where the policy has no short list of rules."""
    return (_Printer(model_of(request), request).text(),)


def model_of(request: Request) -> Model:
    """The model of a policy, with the names that it has in NuSMV."""
    return Model.of(request, _WORDS.split(), _OURS)


class _Printer:
    def __init__(self, model: Model, request: Request) -> None:
        self._model, self._loop = model, model.loop
        self._name, self._promise = request.name, commented(request.promise, "-- ")
        self._claims = Claims(model, _LANGUAGE)

    def text(self) -> str:
        model, claims = self._model, self._claims
        places = claims.placeholders()
        lasting = f"  still_possible := {places['possible']};\n" if self._loop.preconditions_last else ""
        return _MODEL.substitute(
            places,
            name=self._name,
            promise=self._promise,
            about=commented(_ABOUT.format(begins=self._loop.begins), "-- "),
            frozen="".join(f"  {name} : boolean;\n" for name in self._frozen()),
            variables="".join(self._variables()),
            rules="".join(self._rules()),
            executed="".join(f"  executed_{name} := {claims.executed(n)};\n" for n, name in enumerate(model.actions)),
            lasting=lasting,
            stays=self._all(f"next({name}) = {name}" for name in model.variables),
            remembers="".join(self._remembers()),
            remembered=self._remembered,
            nothing_waits=self._all(f"!waiting_{name}" for name in model.actions),
            init="".join(f"\n  & {each}" for each in self._init()),
            nominal="".join(f"    & {each}\n" for each in self._nominal("executed")),
            decide="".join(f"    & {each}\n" for each in self._decide()),
            effects="".join(self._effects()),
            more="".join(f"CTLSPEC NAME {each}\n" for each in self._more()),
        )

    @property
    def _remembered(self) -> str:
        return " & remembers" if self._claims.kept else ""

    def _remembers(self) -> Iterator[str]:
        if self._claims.kept:
            yield f"  remembers := {self._all(f'(next(kept_{n}) <-> kept_{n})' for n in self._claims.kept)};\n"

    @staticmethod
    def _all(parts: Iterator[str] | Sequence[str]) -> str:
        return " & ".join(parts) or "TRUE"

    def _frozen(self) -> Iterator[str]:
        """What is remembered of the first decision: which goals are active, and which of the actions they name run."""
        yield from (f"active_{number}" for number in range(len(self._loop.goals)))
        yield from (f"first_{self._model.actions[entry]}" for entry in self._model.named_by_goals)

    def _variables(self) -> Iterator[str]:
        for name, values in zip(self._model.variables, self._model.values, strict=True):
            yield f"  {name} : {{{', '.join(values)}}};\n"
        yield from (f"  waiting_{name} : boolean;\n" for name in self._model.actions)
        yield from (f"  kept_{number} : boolean;\n" for number in self._claims.kept)

    def _rules(self) -> Iterator[str]:
        """The rules in their order; the last matches always."""
        model = self._model
        for number, rule in enumerate(model.rules):
            tests = []
            for variable, values in model.condition(rule):
                listed = ", ".join(model.values[variable][value] for value in values)
                tests.append(f"{model.variables[variable]} in {{{listed}}}")
            shown = "undecided" if rule.actions is None else ", ".join(rule.actions) or "nothing"
            yield f"    {self._all(tests)} : {number}; -- {shown}\n"

    def _init(self) -> Iterator[str]:
        yield "nothing_waits"
        claims = self._claims
        yield from (claims.same(f"active_{n}", claims.now(goal.when)) for n, goal in enumerate(self._loop.goals))
        for entry in self._model.named_by_goals:
            name = self._model.actions[entry]
            yield f"(first_{name} <-> executed_{name})"
        yield from (f"!kept_{number}" for number in self._claims.kept)

    def _nominal(self, which: str) -> Iterator[str]:
        """All nominal effects of the actions of a set at once."""
        for number, (name, values) in enumerate(zip(self._model.variables, self._model.values, strict=True)):
            writes = [
                f"{which}_{action} : {values[value]};"
                for action, entry in zip(self._model.actions, self._loop.actions, strict=True)
                for variable, value in entry.nominal
                if variable == number
            ]
            changed = f"case {' '.join([*writes, f'TRUE : {name};'])} esac" if writes else name
            yield f"next({name}) = {changed}"

    def _decide(self) -> Iterator[str]:
        yield from (f"(next(waiting_{name}) <-> executed_{name})" for name in self._model.actions)
        claims, required = self._claims, self._loop.required
        yield from (claims.same(f"next(kept_{n})", claims.now(required[n].when)) for n in claims.kept)

    def _effects(self) -> Iterator[str]:
        before = f"!nominal & acting & next(acting) & next(acted){self._remembered}"
        if self._loop.ordering == "first":
            before += " & !acted"
        for entry, effect in self._model.effects:
            name = self._model.actions[entry]
            parts = [f"waiting_{name} & !next(waiting_{name})", *self._others_wait(entry), *self._writes(effect)]
            yield f"| ( {before}\n{indent(''.join(f'& {part}{chr(10)}' for part in parts), '    ')}  )\n"
        if self._loop.ordering == "first":
            parts = ["!quiet & next(nothing_waits)", *self._nominal("waiting")]
            yield f"| ( {before}\n{indent(''.join(f'& {part}{chr(10)}' for part in parts), '    ')}  )\n"

    def _others_wait(self, entry: int) -> Iterator[str]:
        for number, name in enumerate(self._model.actions):
            if number != entry:
                yield f"(next(waiting_{name}) <-> waiting_{name})"

    def _writes(self, effect: Assignment) -> Iterator[str]:
        written = dict(effect)
        for number, name in enumerate(self._model.variables):
            value = self._model.values[number][written[number]] if number in written else name
            yield f"next({name}) = {value}"

    def _more(self) -> Iterator[str]:
        """Claims that not every specification makes."""
        loop = self._loop
        if loop.preconditions_last:
            yield "preconditions_last := AG (acting & acted -> still_possible)"
        bound = f"ABF 1..{loop.bound} met" if loop.bound else "AX AF met"
        if self._claims.has_goals():
            yield f"goals_reached := nominal -> {bound}"
        if loop.several_steps:
            restored = "nominal -> AF safe" if loop.restoration == "fair" else "!nominal -> AF (!acting & safe)"
            yield f"safety_restored := {restored}"
