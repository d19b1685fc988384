"""Questions in words. Each is asked of all states or sets, so that an answer says what holds and what does not."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from tests.conformance.roles import Decider, Guarantor, Judge, Restorer, Stepper
from tests.conformance.world import BOTH, Decisions, world
from tumato_symbolic.semantics import ActionSet, Effort, State, all_states
from tumato_symbolic.spec import Ordering


class Asked:
    """The states and steps of a specification as one engine has them."""

    def __init__(self, engine: Stepper, text: str, ordering: Ordering = "any") -> None:
        self.engine, self.world = engine, world(text, ordering)

    def valid(self) -> str:
        """All valid states."""
        return self._states(lambda state: self.engine.valid(self.world, state))

    def safe(self) -> str:
        """All safe states."""
        return self._states(lambda state: self.engine.safe(self.world, state))

    def allowed(self, state: str) -> list[str]:
        """All allowed sets in a state, the small ones first, then as declared."""
        here = self.world.state(state)
        allowed = (self.world.cases(here, chosen) for chosen in self.world.sets() if self._is_allowed(state, chosen))
        return list(map(self.world.names, allowed))

    def allows(self, state: str, actions: str) -> bool:
        """Whether one set is allowed."""
        return self._is_allowed(state, self.world.actions(actions))

    def leads(self, state: str, actions: str) -> str:
        """The nominal successor."""
        here = self.world.state(state)
        return self.world.words(self.engine.successor(self.world, here, self._cases(here, actions)))

    def meets(self, state: str, actions: str = "") -> str:
        """All states that satisfy the residual goal of a state with its first set."""
        here = self.world.state(state)
        return self._states(lambda there: self.engine.meets(self.world, here, self._cases(here, actions), there))

    def _cases(self, state: State, actions: str) -> ActionSet:
        return self.world.cases(state, self.world.actions(actions))

    def _is_allowed(self, state: str, chosen: ActionSet) -> bool:
        here = self.world.state(state)
        return self.engine.allowed(self.world, here, self.world.cases(here, chosen))

    def _states(self, test: Callable[[State], bool]) -> str:
        return " ".join(self.world.words(state) for state in all_states(self.world.spec) if test(state))


def under_both(engine: Stepper, text: str) -> Iterator[Asked]:
    """A specification under either effect ordering."""
    return (Asked(engine, text, ordering) for ordering in BOTH)


def faults(judge: Judge, text: str, decisions: Decisions, ordering: Ordering = "any") -> set[str]:
    """The properties that a policy in words does not have."""
    asked = world(text, ordering)
    return judge.faults(asked, asked.rows(decisions))


def following(restorer: Restorer, text: str, state: str, actions: str, ordering: Ordering = "any") -> str:
    """All states that a step leads to."""
    asked = world(text, ordering)
    here = asked.state(state)
    found = restorer.following(asked, here, asked.cases(here, asked.actions(actions)))
    return " ".join(map(asked.words, sorted(found)))


def efforts(restorer: Restorer, text: str, decisions: Decisions, ordering: Ordering = "any") -> dict[str, Effort]:
    """The worst efforts of a policy in words."""
    asked = world(text, ordering)
    found = restorer.efforts(asked, asked.rows(decisions))
    return {asked.words(state): effort for state, effort in sorted(found.items())}


def guaranteed(guarantor: Guarantor, text: str, decisions: Decisions, ordering: Ordering = "any") -> dict[str, str]:
    """What a policy in words guarantees: `guaranteed 2` (steps), `fair`, `survives 1`, `nominal` or `nothing`."""
    asked = world(text, ordering)
    found = guarantor.guarantees(asked, asked.rows(decisions))
    numbered = {
        state: each and (each.kind, *(number for number in (each.steps, each.deviations) if number is not None))
        for state, each in sorted(found.items())
    }
    return {asked.words(state): " ".join(map(str, each or ("nothing",))) for state, each in numbered.items()}


def policy(decider: Decider, text: str, ordering: Ordering = "any") -> dict[str, str]:
    """The policy of a realizable specification in words."""
    asked = world(text, ordering)
    answer = decider.answer(asked)
    assert answer.policy is not None, answer.failures
    return asked.decisions(answer.policy)


def failures(decider: Decider, text: str, ordering: Ordering = "any") -> dict[str, str]:
    """The failing states by kind; nothing where there is a policy."""
    asked = world(text, ordering)
    answer = decider.answer(asked)
    assert (answer.policy is None) == bool(answer.failures)
    return {kind: " ".join(map(asked.words, sorted(states))) for kind, states in answer.failures.items()}
