"""What is found of a specification without a policy: plain records, and the order of the stages."""

from __future__ import annotations

from typing import Final, Literal, TypeAlias

from msgspec import Struct
from msgspec.structs import replace

from tumato_symbolic.explain.additions import Addition
from tumato_symbolic.explain.cubes import StateCube
from tumato_symbolic.explain.elements import Element
from tumato_symbolic.explain.environment import Restriction
from tumato_symbolic.explain.near_misses import NearMiss
from tumato_symbolic.explain.summary import Summary
from tumato_symbolic.semantics import State
from tumato_symbolic.spec import Formula, Ordering, Spec
from tumato_symbolic.synthesis.diagnosis import Restorability
from tumato_symbolic.synthesis.result import FailureKind, Statistics


class OwnGoal(Struct, frozen=True):
    """An active goal of a state that has no plan: `body` indexes `Spec.bodies`.

    `never` are those of its parts (conjuncts) that no nominal effects ever make true, whatever is dropped. `clashes`:
    it belongs to a minimal set of the state's goals that nominal effects never make true at once.
    """

    body: int
    never: tuple[Formula, ...]
    clashes: bool = False


class Reason(Struct, frozen=True):
    """States that fail in one way for one reason.

    `count` is the exact number of these states. `cubes` are disjoint and hold exactly these valid states, but for the
    `omitted` ones of which no cube is listed. `cores`: the core that all of them share, then more cores of `example`.
    `later`: they are starts that fail because of what follows them. `goals` are those of the example where it has no
    plan, `shortest_plan` the steps that it would need if only the plan bound were gone. `together` are the states of a
    conflict. `summary` says what a long first core comes to.
    """

    kind: FailureKind
    count: int
    cubes: tuple[StateCube, ...]
    omitted: int
    example: State
    cores: tuple[tuple[Element, ...], ...]
    goals: tuple[OwnGoal, ...] = ()
    near: tuple[NearMiss, ...] = ()
    together: tuple[State, ...] = ()
    shortest_plan: int | None = None
    summary: Summary | None = None
    later: bool = False

    @property
    def core(self) -> tuple[Element, ...]:
        """The first core."""
        return self.cores[0]


class Change(Struct, frozen=True):
    """One line to change: an element, and the text that takes its place (None: it is dropped)."""

    element: Element
    text: str | None


class Repair(Struct, frozen=True):
    """Additions and changes that together make the specification realizable; synthesis has said so."""

    changes: tuple[Change, ...] = ()
    additions: tuple[Addition, ...] = ()

    @property
    def drops(self) -> bool:
        """Whether all that it does is to drop lines."""
        return not self.additions and all(change.text is None for change in self.changes)

    @property
    def gives_up_safety(self) -> bool:
        """Whether a state rule is dropped, or holds less than before."""
        return any(change.element.kind == "state-rule" for change in self.changes)


Wanted: TypeAlias = int | Literal["all"]
"""How many ways to change lines are looked for; `all`: also those that give up safety."""


class RealizablePart(Struct, frozen=True):
    """An assumption that makes the specification realizable, and how many states it keeps and gives up.

    With starts, it is a start condition in the place of those that are there, and starts are counted.
    `unique`: every other such set of states is a part of this one; else goals conflict, and `largest` tells whether
    none has more states. `environment` is what it assumes of variables that no action controls; `steady` a smaller part
    that assumes nothing of them: how many states it keeps, and the assumption.
    """

    states: int
    given_up: int
    formula: Formula
    text: str
    unique: bool
    largest: bool
    environment: tuple[Restriction, ...] = ()
    steady: tuple[int, str] | None = None


Stage: TypeAlias = Literal["states", "part", "reasons", "near", "repairs"]
"""What an explanation consists of after the verdict, in this order."""

STAGES: Final[tuple[Stage, ...]] = ("states", "part", "reasons", "near", "repairs")
"""The stages of an explanation, in the order in which they run."""


class FailingGroup(Struct, frozen=True):
    """The states that fail in one way, all of them; of a conflict, those that no policy serves together.

    `cubes` are disjoint and hold exactly these valid states, but for the `omitted` ones of which no cube is listed;
    until they are known all are omitted. `together` are the states of a conflict.
    """

    kind: FailureKind
    count: int
    cubes: tuple[StateCube, ...]
    omitted: int
    example: State
    together: tuple[State, ...] = ()


class LeftOut(Struct, frozen=True):
    """A stage that was not finished: `found` says how far it came, `why` what ended it."""

    stage: Stage
    found: str
    why: str


class Explanation(Struct, frozen=True):
    """Why there is no policy, and what would change that; what is known of it by now.

    Every stage adds its part: `groups` (`states`), `part`, `reasons` with `omitted` (the failing states whose reason is
    not among them), what comes near (`near`), and `repairs`, of which those come first that keep all state rules.
    `repairs_complete`: there are no other ways to drop, of those that were asked for. `unavoidable` says why there is
    none. `others_untried`: the search for repairs that keep all state rules was cut short. `finished` are the stages
    that have said all they can, `left_out` those that were cut short; while work goes on, some are neither.
    `restorability` tells what would restore the states that cannot be restored as asked.
    """

    spec: Spec
    ordering: Ordering
    statistics: Statistics
    failing_states: int
    groups: tuple[FailingGroup, ...]
    part: RealizablePart | None = None
    reasons: tuple[Reason, ...] = ()
    omitted: int = 0
    repairs: tuple[Repair, ...] = ()
    repairs_complete: bool = False
    unavoidable: str | None = None
    others_untried: bool = False
    finished: tuple[Stage, ...] = ()
    left_out: tuple[LeftOut, ...] = ()
    restorability: Restorability | None = None

    def is_over(self, stage: Stage) -> bool:
        """Whether nothing more comes from a stage."""
        return stage in self.finished or any(each.stage == stage for each in self.left_out)


class NothingToExplain(Struct, frozen=True):
    """There is a policy."""

    statistics: Statistics


class Unexplained(Struct, frozen=True):
    """It is not known whether there is a policy: a limit was met, or (`limit` is None) work goes on."""

    limit: str | None = None
    statistics: Statistics | None = None


Found: TypeAlias = Explanation | NothingToExplain | Unexplained
"""What is known by now."""


def stopped(found: Found, why: str) -> Found:
    """What is known when work is ended, with what is left out because of it."""
    match found:
        case Explanation():
            unfinished = [stage for stage in STAGES if not found.is_over(stage)]
            more = tuple(LeftOut(stage, so_far(found, stage), why) for stage in unfinished)
            return replace(found, left_out=found.left_out + more)
        case Unexplained():
            return replace(found, limit=why)
        case NothingToExplain():
            return found


def so_far(found: Explanation, stage: Stage) -> str:
    """How far a stage has come, in words."""
    match stage:
        case "states":
            return "not all failing states are listed"
        case "part":
            return "none was found"
        case "reasons":
            told = sum(reason.count for reason in found.reasons)
            of = f", for {told:,} of {found.failing_states:,} failing states" if found.failing_states else ""
            return f"the first {len(found.reasons)}{of}" if found.reasons else "none was found"
        case "near":
            return "not all reasons were looked at"
        case "repairs":
            return f"the first {len(found.repairs)}" if found.repairs else "none was found"
