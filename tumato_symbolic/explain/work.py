"""What the stages of an explanation share: the requirements, what was asked for, and how much time there is."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from functools import cached_property

from msgspec import Struct
from msgspec.structs import replace

from tumato_symbolic.explain.cores import Failing, failing_states, typical_state
from tumato_symbolic.explain.cubes import Cover, StateCube, disjoint_cubes, set_of
from tumato_symbolic.explain.explanation import Wanted
from tumato_symbolic.explain.failing_states import FailingStates
from tumato_symbolic.explain.requirements import Requirements
from tumato_symbolic.limits import Context
from tumato_symbolic.semantics import State
from tumato_symbolic.spec.many_goals import many_told
from tumato_symbolic.symbolic import Bdd
from tumato_symbolic.synthesis import Unrealizable
from tumato_symbolic.synthesis.result import FailureKind


class Work(Struct, dict=True):
    """What is asked about, and what was asked for; `context` is that of the whole explanation."""

    requirements: Requirements
    context: Context
    outcome: Unrealizable
    max_cubes: int
    cores: int
    wanted_repairs: Wanted

    @cached_property
    def failing(self) -> Failing:
        """The valid states that fail; with starts, those of them that do."""
        found, spec = failing_states(self.oracle), self.requirements.spec
        if not spec.starts:
            return found
        found = found.among(self.requirements.starts)
        kinds = (each.kind for each in self.outcome.failures if each.kind != "conflict")
        return replace(found, later={kind: self.states_of(kind) & ~found.at_once for kind in kinds})

    @cached_property
    def oracle(self) -> FailingStates:
        """What is known by now about which states fail when only some elements are kept."""
        return FailingStates(self.requirements)

    def states_of(self, kind: FailureKind) -> Bdd:
        """The states that fail in one way: of a conflict, those not served together; of starts, those listed."""
        if self.requirements.spec.starts:
            states = next(each.states for each in self.outcome.failures if each.kind == kind)
            return self.requirements.manager.union(map(self.requirements.encoding.state_cube, states))
        match kind:
            case "no-allowed-set":
                return self.failing.no_allowed_set
            case "no-restoration":
                return self.failing.no_restoration
            case "no-plan":
                return self.failing.no_plan
            case "conflict":
                states = self.outcome.failures[0].states
                return self.requirements.manager.union(map(self.requirements.encoding.state_cube, states))

    def count(self, states: Bdd) -> int:
        """How many states there are in a set."""
        return self.requirements.encoding.count_states(states)

    def typical(self, states: Bdd) -> State:
        """A state that is like most others of a set."""
        return typical_state(self.requirements, states)

    def cubes(self, states: Bdd, limit: int) -> Cover:
        """Disjoint cubes of valid states, the largest first."""
        encoding = self.requirements.encoding
        cover = disjoint_cubes(encoding, states, encoding.domain() & ~self.requirements.valid, limit)

        def size(cube: StateCube) -> int:
            return encoding.count_states(states & set_of(encoding, cube))

        return Cover(tuple(sorted(cover.cubes, key=lambda cube: -size(cube))), cover.rest)

    @contextmanager
    def within(self, share: float) -> Iterator[None]:
        """Let work take a share of the time that is left to it. Raises `LimitReachedError` when it is used up."""
        manager = self.requirements.manager
        before = manager.context
        left = before.seconds_left()
        manager.context = before.within(None if left is None else share * left)
        try:
            with manager.within_memory():
                yield
        finally:
            manager.context = before

    def share_met(self) -> str:
        """That a stage used up its share of the time limit."""
        many = many_told(self.requirements.spec)
        told = f"; {many}" if many else ""
        return f"its share of the time limit of {self.context.limits.seconds:g} s was used up{told}"
