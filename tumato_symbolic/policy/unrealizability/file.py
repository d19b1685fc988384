"""A certificate of unrealizability as a file (`docs/certificate.md`)."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

from tumato_symbolic.diagnostics import Code, Source, UserError
from tumato_symbolic.policy.formats import header, kinds
from tumato_symbolic.policy.formats.diagrams import DiagramPart, section
from tumato_symbolic.policy.formats.kinds import Names
from tumato_symbolic.policy.formats.policies import UNREALIZABLE
from tumato_symbolic.policy.formats.tables import Entries, Field, Record, Tagged, dotted, plain, text_of, within
from tumato_symbolic.policy.records import RankedGoal, Vocabulary
from tumato_symbolic.policy.text import MAX_BYTES, as_object, fault, parse_json, read_text, save_text, too_large
from tumato_symbolic.policy.unrealizability.records import (
    Case,
    Choice,
    Conflict,
    Cube,
    Cut,
    Divided,
    Layers,
    NoAllowedSet,
    NoPart,
    NoPlan,
    NoRestoration,
    Reason,
    Removal,
    StartRemoved,
    Unrealizability,
    Violation,
)
from tumato_symbolic.semantics import State
from tumato_symbolic.spec import Assignment

# Violations: the condition that no set of a cube meets.


class _Effect(NamedTuple):
    """An action taking one of its effects."""

    action: int
    effect: Assignment


_EFFECT = Record[_Effect](
    _Effect, (Field("Action", kinds.ACTION), Field("Effect", kinds.ASSIGNMENT)), view=_Effect._make
)
_OUTCOME = Entries("Outcome", _EFFECT, "effect", "Effects in the order in which they happen.")
_ONE, _TWO = (Field("Actions", kinds.actions(number)) for number in (1, 2))
_RULE = Field("Rule", kinds.TEXT, "The rule in canonical text.")

VIOLATION = Tagged[Violation](
    {
        words: Record(Violation, parts, style=within)
        for words, parts in (
            (("precondition",), (_ONE,)),
            (("resource", "nominal-conflict"), (_TWO,)),
            (("reaction-rule",), (_RULE,)),
            (("unsafe",), (_OUTCOME,)),
            (("falsified",), (_ONE, _OUTCOME)),
            (("idle", "nominal-unsafe"), ()),
        )
    },
    within,
)

CUBE = Record(
    Cube,
    (
        Field("Executed", kinds.ACTION_SET),
        Field("Idle", kinds.ACTION_SET),
        Field("Violation", VIOLATION),
    ),
    "All sets that contain the executed actions and none of the idle ones.",
)

# Conflicts: what can be done, and the runs that fail.


class _Option(NamedTuple):
    """Where an allowed set leads, and its residual goal."""

    successor: State
    goal: int


_GOAL = Field("Goal", kinds.whole("goal"))
_OPTION = Record[_Option](_Option, (Field("Successor", kinds.STATE), _GOAL), view=_Option._make)
_STATES = kinds.listed(kinds.listed(kinds.STATE))


def _for_every_option(value: object, where: str, names: Names) -> tuple[tuple[State, ...], ...]:
    found = _STATES.read(value, where, names)
    if len(found) != names.counts["option"]:
        raise fault(Code.TUM502, f"{where} does not have one entry for every option")
    return found


_CHOICE = Record(
    Choice,
    (
        Field("State", kinds.STATE),
        Entries("Options", _OPTION, "option"),
        Field(
            "Outcomes",
            kinds.Kind(_for_every_option, _STATES.write, _STATES.schema),
            "For every option, states to which its sets may lead as well.",
            default=(),
        ),
    ),
    "A state, and for every set allowed in it where it leads and its residual goal (by number).",
)
_ALONG = Field("States", kinds.listed(kinds.whole("choice"), filled=True), "Numbers of choices.")
_RUN = (_GOAL, _ALONG)
_CUT = Tagged[Cut](
    {
        ("path",): Record(Cut, (*_RUN, Field("End", kinds.STATE))),
        ("loop",): Record(partial(Cut, end=None), _RUN, without=("End",)),
        ("outcomes",): Record(
            partial(Cut, goal=0, end=None),
            (_ALONG, Field("Back", kinds.whole(), "The place to which outcomes of the last state lead.")),
            without=("Goal", "End"),
        ),
    },
)

# Reasons.

_NAMED = (Field("Bodies", kinds.TEXTS), Field("Executed", kinds.ACTION_NAMES))
_LAYERS = Record(Layers, (*_NAMED, Field("Layers", kinds.listed(kinds.REFERENCE, filled=True), name="roots")))
_STATE = Field("State", kinds.STATE)
_STARTS = Field("Starts", kinds.listed(kinds.whole("choice")), "Numbers of choices.")
_CHOICES = Entries("Choices", _CHOICE, "choice")
_CUTS = Entries("Cuts", _CUT, "cut")
_DISTANCES = DiagramPart("distances", kinds.RANKS, "Numbers of steps; null is never, or not within the plan bound.")
_GOALS = Entries("Goals", Record(RankedGoal, (*_NAMED, Field("Root", kinds.REFERENCE))), "goal")

_CONFLICT = section(
    Conflict,
    (_STARTS, _CHOICES, _CUTS, _DISTANCES, _GOALS),
    "No policy serves the starts together: every choice of options breaks a cut.",
    first=(_DISTANCES, _GOALS, _CHOICES, _CUTS),
)
_KIND = Field("Kind", kinds.one_of("no-restoration", "no-plan"))
_REMOVED = DiagramPart("diagram", kinds.RANKS, "Numbers of steps; null is never, and outside of what is removed.")
_REMOVALS = Entries(
    "Removals",
    section(Removal, (_KIND, _REMOVED, Field("Root", kinds.REFERENCE), _GOALS)),
    "removal",
    "States that no policy decides which decides none that was removed before: where the root leads to a number.",
)
_CASE = Record(Case, (Field("Without", kinds.STATE, name="state"), Field("Part", kinds.whole())))
_PART = Tagged[StartRemoved | Divided](
    {
        ("start",): Record(StartRemoved, (_REMOVALS, _STATE), "A start is removed."),
        ("conflict",): Record(
            Divided,
            (_REMOVALS, Field("Conflict", _CONFLICT), Entries("Cases", _CASE, "case")),
            "Goals conflict in what is left; a case for every state of the conflict that is no start.",
        ),
    },
    told=False,
)

REASON = Tagged[Reason](
    {
        ("no-allowed-set",): Record(
            NoAllowedSet,
            (_STATE, Entries("Cubes", CUBE, "cube", or_null=True)),
            "No set of actions is allowed in a state: disjoint cubes hold all sets. Null leaves the claim to a prover.",
            dotted,
        ),
        ("no-restoration",): section(
            NoRestoration,
            (_STATE, DiagramPart("diagram", kinds.TRUTH), Field("Root", kinds.REFERENCE)),
            "From a state safety is never surely restored: nothing surely leads out of a set of states that it is in.",
        ),
        ("no-plan",): section(
            NoPlan,
            (_STATE, DiagramPart("diagram", kinds.TRUTH), Entries("Goals", _LAYERS, "goal")),
            "No run from a state meets its residual goal: for each that it can have, layers of states that hold all "
            "runs.",
        ),
        ("conflict",): _CONFLICT,
        ("no-part",): Record(
            NoPart,
            (Entries("Parts", _PART, "part"),),
            "No part of the valid states that has all starts has a policy.",
            dotted,
        ),
    },
    dotted,
    told=False,
)

FILE = Record(
    Unrealizability,
    (
        header.type_of_file(UNREALIZABLE),
        header.version(),
        header.digest("Identifies the meaning of the specification that has no policy."),
        header.ordering("The ordering of effects under which there is no policy."),
        header.restoration("How safety was to be restored; one_step where it is missing."),
        header.VocabularyPart(
            "All actions, in the order of declaration.",
            "The variables; for each, its values and their indices 0, 1, ….",
        ),
        Field("Reason", REASON),
    ),
    style=plain,
)
"""The fields of a certificate."""


def unrealizability_of(document: dict[str, Any]) -> Unrealizability:
    """The certificate that a JSON object describes. Raises `UserError` (TUM502 to TUM505) where it describes none."""
    return FILE.read(document, "the certificate", Names(Vocabulary((), ())))


def loads(text: str, name: str = "certificate") -> Unrealizability:
    """The certificate that `text` describes; `name` is what it is called in messages.

    Raises `UserError` (TUM501 to TUM505, TUM508) for text that is no certificate.
    """
    try:
        return unrealizability_of(as_object(parse_json(text, name), "the certificate"))
    except UserError as error:
        raise UserError(error.diagnostics, error.source or Source(name, "")) from None


def load(path: str) -> Unrealizability:
    """The certificate in the file at `path`; `-` is standard input. Raises `UserError` as `loads` does."""
    return loads(*read_text(path))


def save(certificate: Unrealizability, path: Path) -> None:
    """Write the certificate to `path`, all or nothing. Raises `UserError` (TUM508, TUM510)."""
    save_text(dumps(certificate), path, "certificate")


def dumps(certificate: Unrealizability) -> str:
    """The certificate as JSON text in ASCII, always the same for equal ones.

    Raises `UserError` (TUM508) where the text would be larger than `loads` accepts.
    """
    text = text_of(FILE, certificate, Names(certificate.vocabulary))
    if len(text) > MAX_BYTES:
        raise too_large("certificate", "certificate")
    return text
