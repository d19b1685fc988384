"""The closed loop of a policy as a module of TLA+, with what is claimed of it as invariants and properties."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from typing import Final

from msgspec.structs import replace

from tumato_symbolic.diagnostics import Code, Diagnostic, UserError
from tumato_symbolic.diagnostics.wording import quoted
from tumato_symbolic.export.model import Claims, Language, Model, infix
from tumato_symbolic.export.request import Request, commented
from tumato_symbolic.export.tlaplus_module import ABOUT, AT_ONCE, LASTING, MODULE

_WORDS: Final = """
ACTION ASSERT ASSUME ASSUMPTION AXIOM BOOLEAN BY CASE CHOOSE CONSTANT CONSTANTS COROLLARY DEF DEFINE DEFS DOMAIN ELSE
ENABLED EXCEPT EXTENDS FALSE HAVE HIDE IF IN INSTANCE LAMBDA LEMMA LET LOCAL MODULE NEW OBVIOUS OMITTED ONLY OTHER PICK
PROOF PROPOSITION PROVE QED RECURSIVE STATE STRING SUBSET SUFFICES TAKE TEMPORAL THEN THEOREM TRUE UNCHANGED UNION USE
VARIABLE VARIABLES WITH WITNESS
"""
"""Words of the language, which no field of a record may be."""

_OURS: Final = ("WF_", "SF_")
"""How identifiers must not begin."""

_LANGUAGE = Language(
    infix(true="TRUE", false="FALSE", negation="~", conjunction="/\\", disjunction="\\/", equivalence="<=>"),
    "=",
    lambda _: "~Decided",  # decisions have no numbers: see `_Claims.decides`
    "\n  /\\ ",
    "Safe",
    "Valid",
    "Decided",
)


def files(request: Request) -> tuple[str, str]:
    """The texts of the module, and of the configuration of TLC that names its claims.

    Raises `UserError` (TUM508) where the policy has no short list of rules, and (TUM510) where the file has a name that
    no module can have.
    """
    if not re.fullmatch(r"[A-Za-z0-9_]*[A-Za-z][A-Za-z0-9_]*", request.name) or request.name in _WORDS.split():
        message = f"a module of TLA+ is called like its file, and {quoted(request.name)} is no name of one"
        raise UserError((Diagnostic(Code.TUM510, message, help="take letters, digits and `_`, as in -o amr.tla"),))
    model = model_of(request)
    fields = tuple(f"state.{name}" for name in model.variables)
    texts = tuple(tuple(f'"{value}"' for value in variable.values) for variable in model.loop.variables)
    return _Printer(replace(model, variables=fields, values=texts), model.variables, request).texts()


def model_of(request: Request) -> Model:
    """The model of a policy, with the names that it has in TLA+."""
    return Model.of(request, _WORDS.split(), _OURS)


class _Claims(Claims):
    """What is claimed, as it is said in TLA+: implications are written so, and decisions are sets of names."""

    def decides(self, entry: int) -> str:
        """Where the policy decides the action of an entry."""
        return f'"{self.model.loop.actions[entry].name}" \\in decision'

    def implied(self, condition: str, then: str) -> str:
        """A condition and what follows from it."""
        true = self.language.by.constant(True)
        return true if then == true else f"{condition} => {then}"


class _Printer:
    """Writes a model of which variables are fields of a record, `fields`, and values are strings."""

    def __init__(self, model: Model, fields: Sequence[str], request: Request) -> None:
        self._model, self._loop, self._fields = model, model.loop, fields
        self._module, self._promise = request.name, commented(request.promise, "\\* ")
        self._claims = _Claims(model, _LANGUAGE)

    def texts(self) -> tuple[str, str]:
        """The module and its configuration."""
        claims = list(self._claimed())
        configuration = "".join(f"{kind} {name}\n" for kind, name, _ in claims)
        return self._text([f"{name} == {formula}\n\n" for _, name, formula in claims]), (
            f"\\* What is claimed in {self._module}.tla. Written by `tumato-sym export tlaplus`.\n"
            f"SPECIFICATION Spec\nCHECK_DEADLOCK FALSE\n{configuration}"
        )

    def _text(self, claims: Iterable[str]) -> str:
        model, loop = self._model, self._loop
        listed = self._variables()
        places = self._claims.placeholders()
        for name in ("allowed", "required", "possible", "met"):
            places[name] = " TRUE" if places[name] == "TRUE" else f"\n  /\\ {places[name]}"
        return MODULE.substitute(
            places,
            module=self._module,
            promise=self._promise,
            about=commented(ABOUT.format(begins=loop.begins), "\\* "),
            variables="".join(self._declared()),
            names=", ".join(listed),
            bound=loop.bound or 1,
            uncounted="" if loop.bound else ", where there is one: here, more than one are not counted",
            states=",\n".join(
                f"  {field} : {{{', '.join(values)}}}" for field, values in zip(self._fields, model.values, strict=True)
            ),
            rules="".join(self._rules()),
            executed="".join(self._defined()),
            executed_set=self._executed(),
            lasting=LASTING.substitute(places) if loop.preconditions_last else "",
            nominal=self._nominal(),
            init="".join(f"  /\\ {each}\n" for each in self._init()),
            decide=self._rest("acting", "acted", "waiting", kept=self._kept()),
            once=" /\\ ~acted" if loop.ordering == "first" else "",
            takes=self._rest("state", "decision", "acted", "waiting"),
            effects="".join(self._effects()),
            halt=self._rest("acting", "acted", "waiting", kept="{}"),
            step=self._rest("state", "decision", "steps"),
            claims="".join(claims),
        )

    def _declared(self) -> Iterator[str]:
        about = self._variables()
        for place, (name, meaning) in enumerate(about.items(), 1):
            yield f"  {f'{name},' if place < len(about) else name:<9} \\* {meaning}\n"

    def _variables(self) -> dict[str, str]:
        """What changes, and what it means."""
        listed = {
            "state": "the value of every variable of the specification",
            "decision": "the actions that the policy executes there, together",
            "mode": "`effects` or `nominal`",
            "acting": "whether effects may occur; else the next decision is taken",
            "acted": "whether an effect has occurred since the decision, or none can",
            "waiting": "the actions that may still take effect",
            "steps": "how many steps a nominal run has taken, up to Bound",
        }
        if self._claims.kept:
            listed["kept"] = "which of the rules that some decisions need not keep this one has to"
        if self._loop.goals:
            listed["active"] = "which goals a nominal run has to reach"
        if self._model.named_by_goals:
            listed["first"] = "which of the actions that goals name a nominal run executes first"
        return listed

    def _rest(self, *changed: str, kept: str | None = None) -> str:
        """What happens to all variables but those that have changed."""
        line = ""
        if kept is not None and self._claims.kept:
            line, changed = f"  /\\ kept' = {kept}\n", (*changed, "kept")
        return f"{line}  /\\ UNCHANGED <<{', '.join(name for name in self._variables() if name not in changed)}>>\n"

    def _rules(self) -> Iterator[str]:
        """The rules in their order; the last matches always."""
        for number, rule in enumerate(self._model.rules):
            tests = []
            for variable, values in self._model.condition(rule):
                listed = [self._model.values[variable][value] for value in values]
                is_one = f"= {listed[0]}" if len(listed) == 1 else f"\\in {{{', '.join(listed)}}}"
                tests.append(f"s.{self._fields[variable]} {is_one}")
            begin = "  ELSE " if number else "  "
            condition = " /\\ ".join(tests)
            decision = "Undecided" if rule.actions is None else _set_of(rule.actions)
            yield f"{begin}{f'IF {condition} THEN ' if tests else ''}{decision}\n"

    def _executed(self) -> str:
        """The entries that are executed: where no action has cases, just what is decided."""
        names = self._model.actions
        if names == tuple(action.name for action in self._loop.actions):
            return "decision"
        return _collected((f"executed_{name}", f'"{name}"') for name in names)

    def _defined(self) -> Iterator[str]:
        """Names for what is executed, waits and so on, as far as the claims use them."""
        model, claims = self._model, self._claims
        yield from (f"executed_{name} == {claims.executed(entry)}\n" for entry, name in enumerate(model.actions))
        if self._loop.preconditions_last:
            yield from (f'waiting_{name} == "{name}" \\in waiting\n' for name in model.actions)
        yield from (f"kept_{number} == {number} \\in kept\n" for number in claims.kept)
        yield from (f"active_{number} == {number} \\in active\n" for number in range(len(self._loop.goals)))
        yield from (f'first_{name} == "{name}" \\in first\n' for name in self._named_by_goals())

    def _named_by_goals(self) -> Iterator[str]:
        yield from (self._model.actions[entry] for entry in self._model.named_by_goals)

    def _init(self) -> Iterator[str]:
        if self._claims.kept:
            yield "kept = {}"
        goals = ((self._claims.now(goal.when), str(number)) for number, goal in enumerate(self._loop.goals))
        named = ((f"executed_{name}", f'"{name}"') for name in self._named_by_goals())
        if self._loop.goals:
            yield f'active = IF mode = "nominal" THEN {_collected(goals)} ELSE {{}}'
        if self._model.named_by_goals:
            yield f'first = IF mode = "nominal" THEN {_collected(named)} ELSE {{}}'

    def _kept(self) -> str:
        return _collected((self._claims.now(self._loop.required[each].when), str(each)) for each in self._claims.kept)

    def _nominal(self) -> str:
        """The state after the nominal effects of `actions`."""
        written: dict[int, list[str]] = {}
        for name, action in zip(self._model.actions, self._loop.actions, strict=True):
            for variable, value in action.nominal:
                case = f'IF "{name}" \\in actions THEN {self._model.values[variable][value]} ELSE '
                written.setdefault(variable, []).append(case)
        if not written:
            return "state"
        changes = (f"  !.{self._fields[each]} = {''.join(cases)}@" for each, cases in sorted(written.items()))
        return "[state EXCEPT\n" + ",\n".join(changes) + "]"

    def _effects(self) -> Iterator[str]:
        for entry, effect in self._model.effects:
            changes = (f"!.{self._fields[each]} = {self._model.values[each][value]}" for each, value in effect)
            after = f"[state EXCEPT {', '.join(changes)}]" if effect else "state"
            yield f'  \\/ Takes("{self._model.actions[entry]}", {after})\n'
        if not self._model.effects:
            yield "  FALSE\n"
        elif self._loop.ordering == "first":
            yield f"{AT_ONCE}   {self._rest('state', 'decision', 'acted', 'waiting')}"

    def _claimed(self) -> Iterator[tuple[str, str, str]]:
        """Kinds, names and formulas of the claims."""
        loop = self._loop
        yield "INVARIANT", "Total", f'(mode = "nominal" /\\ steps = 0) => {self._claims.complete()}'
        yield "INVARIANT", "AllowedAtDecisions", "(~acting /\\ Valid /\\ Decided) => Allowed"
        yield "INVARIANT", "SafeAfterEffects", "acted => AsRequired"
        if loop.preconditions_last:
            yield "INVARIANT", "PreconditionsLast", "(acting /\\ acted) => StillPossible"
        if self._claims.has_goals() and loop.bound:
            yield "INVARIANT", "GoalsReached", '(mode = "nominal" /\\ steps = Bound) => Met'
        elif self._claims.has_goals():
            yield "PROPERTY", "GoalsReached", '(mode = "nominal") => <>(steps > 0 /\\ Met)'
        if loop.several_steps and loop.restoration == "fair":
            yield "PROPERTY", "SafetyRestored", '(mode = "nominal") => <>Safe'
        elif loop.several_steps:
            yield "PROPERTY", "SafetyRestored", '(mode = "effects") => <>(~acting /\\ Safe)'


def _set_of(names: Iterable[str]) -> str:
    return f"{{{', '.join(f'{chr(34)}{name}{chr(34)}' for name in names)}}}"


def _collected(parts: Iterable[tuple[str, str]]) -> str:
    """The set of some things, each under a condition."""
    listed = [f"IF {condition} THEN {{{each}}} ELSE {{}}" for condition, each in parts]
    return f"UNION {{\n    {f',{chr(10)}    '.join(listed)}}}" if listed else "{}"
