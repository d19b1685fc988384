"""The provers of `tumato_symbolic.verify`, which are asked about policies."""

from __future__ import annotations

import operator
from collections.abc import Sequence
from functools import cache, cached_property, lru_cache
from typing import TYPE_CHECKING
from unittest.mock import patch

from msgspec.structs import replace

from tests.conformance.roles import PROPERTIES, Rows
from tests.conformance.turned import arriving, as_rival, jumping
from tests.conformance.world import REMEMBERED, World
from tumato_symbolic import parse
from tumato_symbolic.diagnostics import UserError
from tumato_symbolic.limits import Budget
from tumato_symbolic.policy import as_diagram, policy_from_rows
from tumato_symbolic.policy.unrealizability import Unrealizability
from tumato_symbolic.semantics import ActionSet, Effort, Guarantee, State, all_states, takes_effect
from tumato_symbolic.spec import Ordering, Spec
from tumato_symbolic.verify import ProverName, verify, verify_unrealizable
from tumato_symbolic.verify.by_diagrams.closed_loop import ClosedLoop
from tumato_symbolic.verify.by_diagrams.efforts import WalkEfforts
from tumato_symbolic.verify.by_diagrams.goals import WalkGoals
from tumato_symbolic.verify.by_states.efforts import Efforts
from tumato_symbolic.verify.by_states.packed import Packing
from tumato_symbolic.verify.by_states.steps import Steps
from tumato_symbolic.verify.guarantees.prospects import WalkProspects

if TYPE_CHECKING:
    import z3

    from tumato_symbolic.verify.unrealizability.allowed_step import AllowedStep


class Prover:
    """One prover. What a step is, it is asked by policies for one state."""

    def __init__(self, name: str, prover: ProverName) -> None:
        self.name, self._prover = name, prover

    def refuses(self, text: str) -> bool:
        """When it is read, or a policy is judged."""
        try:
            spec = parse(text)
            verify(policy_from_rows(spec, {}), spec, prover=self._prover)
        except UserError:
            return True
        return False

    @cache  # noqa: B019 - there is one engine of each prover
    def valid(self, world: World, state: State) -> bool:
        """Whether a policy for all other states is not *total*."""
        rows = {other: frozenset[int]() for other in all_states(world.spec) if other != state}
        return not self._has("total", world.spec, world.ordering, rows)

    def safe(self, world: World, state: State) -> bool:
        """Whether it is valid, and doing nothing there is *safe*, or restores it; asked without reaction rules."""
        spec, name = replace(world.spec, reaction_rules=()), "restoring" if world.spec.restores_stepwise else "safe"
        return self.valid(world, state) and self._has(name, spec, world.ordering, {state: frozenset()})

    def allowed(self, world: World, state: State, chosen: ActionSet) -> bool:
        """Whether a policy for this state alone is *safe*; what a search for better sets allows has to agree."""
        found = self._has("safe", world.spec, world.ordering, {state: chosen})
        assert self.finds(world, state, chosen) == found, "its search differs"
        return found

    def finds(self, world: World, state: State, chosen: ActionSet) -> bool:
        """Whether the set refuses a longer one to be called *minimal*; one without effects never can."""
        if not takes_effect(world.spec, chosen):
            return self._has("safe", world.spec, world.ordering, {state: chosen})
        spec, here, longer = as_rival(world.spec, state, chosen)
        return not self._has("minimal", spec, world.ordering, {here: longer})

    def successor(self, world: World, state: State, chosen: ActionSet) -> State:
        """The values that a policy for this state alone reaches in one step."""
        found = []
        for variable, declared in enumerate(world.spec.variables):
            (value,) = (
                value
                for value in range(len(declared.values))
                if self._has("goals", arriving(world.spec, variable, value), world.ordering, {state: chosen})
            )
            found.append(value)
        return tuple(found)

    def meets(self, world: World, state: State, chosen: ActionSet, there: State) -> bool:
        """Whether a decision that jumps there reaches its goals at once."""
        spec, jump = jumping(world.spec, chosen, there)
        return self._has("goals", spec, world.ordering, {state: jump})

    def faults(self, world: World, rows: Rows) -> set[str]:
        """What is refuted."""
        return self._refuted(PROPERTIES, world.spec, world.ordering, rows)

    def _has(self, name: str, spec: Spec, ordering: Ordering, rows: Rows) -> bool:
        return not self._refuted((name,), spec, ordering, rows)

    def _refuted(self, names: Sequence[str], spec: Spec, ordering: Ordering, rows: Rows) -> set[str]:
        policy = policy_from_rows(spec, dict(rows))
        answer = verify(policy, spec, ordering=ordering, properties=names, prover=self._prover)
        assert all(result.verdict != "undecided" for result in answer.properties)
        return {result.name for result in answer.properties if result.verdict == "refuted"}


class States(Prover):
    """The prover that looks at each state."""

    def __init__(self) -> None:
        super().__init__("states", "explicit")

    def finds(self, world: World, state: State, chosen: ActionSet) -> bool:
        """As the others; where safety may take several steps to restore, by `Steps.allowed_sets` in unsafe states."""
        if not world.spec.restores_stepwise:
            return super().finds(world, state, chosen)
        packing, steps = self._steps(world)
        code = packing.pack(state)
        if not chosen or steps.is_safe(code):
            return steps.allowed(code, chosen)
        return chosen in set(steps.allowed_sets(code, lambda _: True))

    def following(self, world: World, state: State, chosen: ActionSet) -> set[State]:
        """`Steps.next_states`."""
        packing, steps = self._steps(world)
        return {packing.unpack(code) for code in steps.next_states(packing.pack(state), chosen)}

    def level(self, world: World, state: State) -> int:
        """`Steps.level`."""
        packing, steps = self._steps(world)
        return steps.level(packing.pack(state))

    def efforts(self, world: World, rows: Rows) -> dict[State, Effort]:
        """`Efforts.worst`."""
        packing, steps = self._steps(world)
        decided = {packing.pack(state): chosen for state, chosen in rows.items()}
        worst = Efforts(world.spec, steps, decided, lambda _: None).worst
        return {packing.unpack(code): effort for code, effort in worst.items()}

    def _steps(self, world: World) -> tuple[Packing, Steps]:
        packing = Packing(world.spec)
        return packing, Steps(world.spec, packing, world.ordering, lambda _: None)


class Walk(Prover):
    """The prover on decision diagrams."""

    def __init__(self) -> None:
        super().__init__("walk", "walk")

    def following(self, world: World, state: State, chosen: ActionSet) -> set[State]:
        """`WalkEfforts.worst_next` of being each state."""
        model = self._model(world.spec, world.ordering)
        worst_next = WalkEfforts(model, world.ordering).worst_next
        return {
            there for there in all_states(world.spec) if model.holds(worst_next(model.is_state(there)), state, chosen)
        }

    def level(self, world: World, state: State) -> int:
        """How many of `ClosedLoop.tiers`, but for the valid states, have it."""
        model = self._model(world.spec, world.ordering)
        return sum(model.holds(tier, state, frozenset()) for tier in model.tiers[1:])

    def efforts(self, world: World, rows: Rows) -> dict[State, Effort]:
        """`WalkEfforts.exact_worst`."""
        model = ClosedLoop(world.spec, as_diagram(policy_from_rows(world.spec, dict(rows))), world.ordering)
        efforts = WalkEfforts(model, world.ordering)
        largest = sum(action.duration for action in world.spec.actions) * len(rows)
        number_of = {efforts.number((d, k)): (d, k) for d in range(largest + 1) for k in range(len(rows) + 1)}
        walk, worst = model.walk, efforts.exact_worst()
        return {
            state: number_of[number]
            for number in walk.values_of(worst)
            for state in rows
            if number in number_of
            and model.holds(walk.apply(operator.eq, worst, walk.constant(number)), state, frozenset())
        }

    def guarantees(self, world: World, rows: Rows) -> dict[State, Guarantee | None]:
        """`WalkProspects.levels`."""
        model = ClosedLoop(world.spec, as_diagram(policy_from_rows(world.spec, dict(rows))), world.ordering)
        goals, found = WalkGoals(model), dict[State, Guarantee | None]()
        for goal, pending in goals.residuals(model.decided, model.policy):
            for guarantee, states in WalkProspects(model, goals, goal).levels(pending):
                found |= {state: guarantee for state in rows if model.holds(states, state, frozenset())}
        return found

    def finds(self, world: World, state: State, chosen: ActionSet) -> bool:
        """`ClosedLoop.allowed`, by which better sets are looked for; false where two actions are of one group."""
        model = self._model(world.spec, world.ordering)
        if any(len(chosen & set(group)) > 1 for group in model.groups):
            return False
        return model.holds(model.allowed, state, chosen)

    @lru_cache(maxsize=REMEMBERED)  # noqa: B019 - there is one of them
    def _model(self, spec: Spec, ordering: Ordering) -> ClosedLoop:
        return ClosedLoop(spec, as_diagram(policy_from_rows(spec, {})), ordering)


class Z3(Prover):
    """The prover that asks Z3, and with it the room that judges certificates of unrealizability.

    Z3 is imported when it is asked: the other provers are tested where there is none.
    """

    def __init__(self) -> None:
        super().__init__("z3", "z3")

    @cached_property
    def _context(self) -> z3.Context:
        import z3

        return z3.Context()

    def finds(self, world: World, state: State, chosen: ActionSet) -> bool:
        """Whether `AllowedStep`, which looks for better sets and for allowed steps, finds this one."""
        import z3

        from tumato_symbolic.verify.unrealizability.allowed_step import is_state

        step = self._step(world.spec, world.ordering)
        executed = [term if n in chosen else z3.Not(term) for n, term in enumerate(step.executed)]
        return step.some_step("this set is not allowed", is_state(step.state, state), *executed) is not None

    def believes(self, world: World, certificate: Unrealizability) -> bool:
        """`verify_unrealizable`."""
        verdict = verify_unrealizable(certificate, world.spec, ordering=world.ordering).verdict
        assert verdict != "undecided"
        return verdict == "proved"

    def _refuted(self, names: Sequence[str], spec: Spec, ordering: Ordering, rows: Rows) -> set[str]:
        """In one context for all questions: Z3 takes longer to make one than to answer."""
        context = self._context
        with patch("z3.Context", lambda: context):
            return super()._refuted(names, spec, ordering, rows)

    @lru_cache(maxsize=REMEMBERED)  # noqa: B019 - there is one of them
    def _step(self, spec: Spec, ordering: Ordering) -> AllowedStep:
        from tumato_symbolic.verify.unrealizability.allowed_step import AllowedStep

        context = self._context
        with patch("z3.Context", lambda: context):
            return AllowedStep(spec, ordering, Budget())
