"""A certificate of what a policy guarantees beyond nominal runs, as a file (`docs/certificate.md`)."""

from __future__ import annotations

from msgspec import Struct
from msgspec.structs import replace

from tumato_symbolic.diagrams import Diagram, Reference
from tumato_symbolic.policy.formats import header, kinds
from tumato_symbolic.policy.formats.diagrams import DiagramPart, section
from tumato_symbolic.policy.formats.kinds import Names
from tumato_symbolic.policy.formats.tables import NEEDED, Entries, Field, Record, plain, text_of
from tumato_symbolic.policy.records import Drawing, Vocabulary
from tumato_symbolic.spec import Ordering, Restoration

GUARANTEES = "guarantees"
"""The `Type` of such a file."""


class CertifiedGoal(Struct, frozen=True):
    """A residual goal, as in `RankedGoal`, with the ranks of its fixpoints.

    `surviving` has a root for each of `W_0, W_1, …, W_ω`: the number of nominal steps to the goal, None outside.
    `forced` leads to the worst number of steps in `G`.
    """

    bodies: tuple[str, ...]
    executed: tuple[str, ...]
    surviving: tuple[Reference, ...]
    forced: Reference


class CertifiedLevel(Struct, frozen=True):
    """A level with the number of its states, and cubes of them: for some variables the values that they may have."""

    level: str
    steps: int | None
    deviations: int | None
    states: int
    cubes: tuple[dict[str, tuple[str, ...]], ...] | None


class CertifiedRanks(Struct, frozen=True):
    """The ranks of all goals, in one diagram."""

    diagram: Diagram[int | None]
    goals: tuple[CertifiedGoal, ...]

    @property
    def drawing(self) -> Drawing:
        """See `Drawn`."""
        return self.diagram, tuple(root for goal in self.goals for root in (*goal.surviving, goal.forced))

    def drawn(self, diagram: Diagram[int | None], roots: tuple[Reference, ...]) -> CertifiedRanks:
        """See `Drawn`."""
        left = iter(roots)
        goals = (
            replace(goal, surviving=tuple([next(left) for _ in goal.surviving]), forced=next(left))
            for goal in self.goals
        )
        return CertifiedRanks(diagram, tuple(goals))


class GuaranteesCertificate(Struct, frozen=True):
    """All that is claimed, for one specification, ordering and restoration."""

    vocabulary: Vocabulary
    digest: str
    ordering: Ordering
    restoration: Restoration
    ranks: CertifiedRanks
    levels: tuple[CertifiedLevel, ...]


_GOAL = Record(
    CertifiedGoal,
    (
        Field("Bodies", kinds.TEXTS),
        Field("Executed", kinds.TEXTS),
        Field("Surviving", kinds.listed(kinds.REFERENCE, filled=True), "W_0, W_1, … to W_ω"),
        Field("Forced", kinds.REFERENCE, "G"),
    ),
)

_LEVEL = Record(
    CertifiedLevel,
    (
        Field("Level", kinds.one_of("guaranteed", "fair", "survives", "nominal")),
        Field("Steps", kinds.optional(kinds.whole())),
        Field("Deviations", kinds.optional(kinds.whole())),
        Field("States", kinds.whole(least=1)),
        Field("Cubes", kinds.optional(kinds.listed(kinds.VALUE_SETS))),
    ),
)

_RANKS = section(
    CertifiedRanks,
    (DiagramPart("diagram", kinds.RANKS), Entries("Goals", _GOAL, "goal", first=1)),
    "One diagram with the ranks of all fixpoints: a number of steps, or null outside.",
)

FILE = Record(
    GuaranteesCertificate,
    (
        header.type_of_file(GUARANTEES),
        header.version(default=NEEDED),
        header.digest(),
        header.ordering(),
        header.restoration(default=NEEDED),
        header.VocabularyPart(),
        Field("Ranks", _RANKS),
        Entries("Levels", _LEVEL, "level", first=1),
    ),
    style=plain,
)
"""The fields of the file."""


def dumps(certificate: GuaranteesCertificate) -> str:
    """The certificate as JSON text in ASCII, always the same for equal ones."""
    return text_of(FILE, certificate, Names(certificate.vocabulary))
