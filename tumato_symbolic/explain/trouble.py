"""A specification with the states that fail in it, for which something is looked for that could be added."""

from __future__ import annotations

from msgspec import Struct

from tumato_symbolic.explain.cores import Failing, failing_states
from tumato_symbolic.explain.failing_states import FailingStates
from tumato_symbolic.explain.requirements import Requirements
from tumato_symbolic.spec import Spec
from tumato_symbolic.symbolic import Bdd


class Trouble(Struct, frozen=True):
    """A specification and the states that fail in it."""

    requirements: Requirements
    failing: Failing

    @classmethod
    def of(cls, oracle: FailingStates) -> Trouble:
        """What fails in the specification of an oracle; with starts, where these may lead."""
        requirements, found = oracle.requirements, failing_states(oracle)
        return cls(requirements, found.among(_following(requirements)) if requirements.spec.starts else found)

    @property
    def spec(self) -> Spec:
        """The specification."""
        return self.requirements.spec

    @property
    def unrestored(self) -> Bdd:
        """The states that fail already because nothing is allowed, or leads back to safety."""
        return self.failing.no_allowed_set | self.failing.no_restoration

    @property
    def states(self) -> Bdd:
        """All states that fail."""
        return self.unrestored | self.failing.no_plan


def _following(requirements: Requirements) -> Bdd:
    """The starts, and states to which single effects of what is allowed lead from there on."""
    encoding, manager = requirements.encoding, requirements.manager
    steps = requirements.steps(requirements.everything)
    acting = [
        (encoding.assignment_bits(effect), steps.states_of(steps.allowed & encoding.executing(number)))
        for number, action in enumerate(requirements.spec.actions)
        for effect in action.effects
    ]
    found = new = requirements.starts
    while new != requirements.false:
        manager.context.check()
        led = (manager.exists([*bits], new & states) & manager.cube(bits) for bits, states in acting)
        new = manager.union(led) & steps.valid & ~found
        found = found | new
    return found
