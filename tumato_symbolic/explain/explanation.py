"""What there is to say about a specification without a policy: plain records, without an engine behind them."""

from __future__ import annotations

from dataclasses import dataclass

from tumato_symbolic.explain.cubes import StateCube
from tumato_symbolic.explain.elements import Element
from tumato_symbolic.explain.near import NearMiss
from tumato_symbolic.semantics import State
from tumato_symbolic.spec import Formula, Ordering, Spec
from tumato_symbolic.synthesis.outcome import FailureKind, Statistics


@dataclass(frozen=True, slots=True)
class OwnGoal:
    """An active goal of a state that has no plan: `body` indexes `Spec.bodies`.

    `never` are those of its parts (conjuncts) that no nominal effects ever make true, whatever is dropped. `clashes`:
    it belongs to a minimal set of the state's goals that nominal effects never make true at once.
    """

    body: int
    never: tuple[Formula, ...]
    clashes: bool = False


@dataclass(frozen=True, slots=True)
class Reason:
    """States that fail in one way for one reason.

    `count` is the exact number of these states. `cubes` are disjoint and hold exactly these valid states, but for the
    `omitted` ones of which no cube is listed. `cores`: the core that all of them share, then more cores of `example`.
    `goals` are those of the example where it has no plan, `shortest_plan` the steps that it would need if only the plan
    bound were gone. `together` are the states of a conflict.
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

    @property
    def core(self) -> tuple[Element, ...]:
        """The first core."""
        return self.cores[0]


@dataclass(frozen=True, slots=True)
class Change:
    """One line to change: an element, and the text that takes its place (None: it is dropped)."""

    element: Element
    text: str | None


@dataclass(frozen=True, slots=True)
class Repair:
    """Changes that together make the specification realizable; synthesis has said so."""

    changes: tuple[Change, ...]

    @property
    def drops(self) -> bool:
        """Whether everything in it is dropped."""
        return all(change.text is None for change in self.changes)


@dataclass(frozen=True, slots=True)
class RealizablePart:
    """An assumption that makes the specification realizable, and how many states it keeps and gives up.

    `unique`: every other such set of states is a part of this one; else goals conflict, and `largest` tells whether
    none has more states.
    """

    states: int
    given_up: int
    formula: Formula
    text: str
    unique: bool
    largest: bool


@dataclass(frozen=True, slots=True)
class Explanation:
    """Why there is no policy, and what would change that.

    `reasons` are the largest first; `omitted` counts failing states whose reasons were not looked for, because there
    are too many of them. `repairs_complete`: there are no other ways to drop. `hopeless` says why there is none.
    """

    spec: Spec
    ordering: Ordering
    statistics: Statistics
    failing_states: int
    reasons: tuple[Reason, ...]
    omitted: int
    repairs: tuple[Repair, ...]
    repairs_complete: bool
    hopeless: str | None
    part: RealizablePart | None


@dataclass(frozen=True, slots=True)
class NothingToExplain:
    """There is a policy."""

    statistics: Statistics


@dataclass(frozen=True, slots=True)
class Unexplained:
    """A limit was met before it was known whether there is a policy."""

    limit: str
    statistics: Statistics
