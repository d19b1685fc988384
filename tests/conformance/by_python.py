"""The explicit meaning, the engine on BDDs, and the provers of policies."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from unittest.mock import patch

import z3

from tests.conformance.roles import Answer, Rows
from tests.conformance.turned import arriving, as_rival, jumping
from tests.conformance.world import World
from tests.oracle import Together, decide_world
from tests.oracle import World as OracleWorld
from tests.reference_policy import reference_policy
from tumato_symbolic import parse
from tumato_symbolic.diagnostics import Code, UserError
from tumato_symbolic.policy import as_table, policy_from_rows
from tumato_symbolic.policy.unrealizable import Unrealizability
from tumato_symbolic.semantics import (
    ActionSet,
    State,
    all_states,
    allowed,
    allowed_sets,
    is_safe,
    is_valid,
    judge,
    reached,
    residual_goal,
    successor,
)
from tumato_symbolic.semantics.lint import lint
from tumato_symbolic.spec import Ordering, Spec
from tumato_symbolic.symbolic import Backend, Encoding, Steps, Target, build_steps, encode, regions, targets
from tumato_symbolic.synthesis import Realizable, Unrealizable, synthesize
from tumato_symbolic.verify import ProverName, verify, verify_unrealizable

PROPERTIES = ("total", "safe", "goals", "minimal")


class Explicit:
    """`tumato_symbolic.semantics`; what it does not decide is found by trying (`tests.oracle`)."""

    name = "explicit"

    def refuses(self, text: str) -> bool:
        """When it is read, or looked at state by state."""
        try:
            return any(found.code == Code.TUM312 for found in lint(parse(text)))
        except UserError:
            return True

    def valid(self, world: World, state: State) -> bool:
        """`is_valid`."""
        return is_valid(world.spec, state)

    def safe(self, world: World, state: State) -> bool:
        """`is_safe`."""
        return is_safe(world.spec, state)

    def allowed(self, world: World, state: State, chosen: ActionSet) -> bool:
        """`allowed`, which `allowed_sets` has to agree with."""
        found = allowed(world.spec, state, chosen, world.ordering)
        assert (chosen in allowed_sets(world.spec, state, world.ordering)) == found
        return found

    def successor(self, world: World, state: State, chosen: ActionSet) -> State:
        """`successor`."""
        return successor(world.spec, state, chosen)

    def meets(self, world: World, state: State, chosen: ActionSet, there: State) -> bool:
        """`reached`."""
        return reached(world.spec, residual_goal(world.spec, state, chosen), there)

    def faults(self, world: World, rows: Rows) -> set[str]:
        """`judge`."""
        found = judge(world.spec, rows, world.ordering)
        failing = (found.missing, found.not_allowed, found.goal_missed, found.not_minimal)
        return {name for name, states in zip(PROPERTIES, failing, strict=True) if states}

    def answer(self, world: World) -> Answer:
        """The preferred policy where the preferences alone make one, else any; states that fail, or a conflict."""
        oracle = OracleWorld(world.spec, world.ordering)
        verdict = decide_world(oracle)
        if verdict.kind == "realizable":
            policy = reference_policy(oracle) or verdict.policy or {}
            return Answer(policy, {}, judge(world.spec, policy, world.ordering).longest_run)
        if verdict.kind == "failing":
            failures = {"no-allowed-set": verdict.no_allowed_set, "no-plan": verdict.no_plan}
            return Answer(None, {kind: states for kind, states in failures.items() if states})
        together, members = Together(oracle), set(oracle.valid)
        for state in oracle.valid:
            if together.serve(members - {state}) is None:
                members.remove(state)
        return Answer(None, {"conflict": frozenset(members)})


class Bdd:
    """`tumato_symbolic.symbolic`, `game` and `synthesis` on one backend of dd."""

    def __init__(self, backend: Backend) -> None:
        self.name, self.backend = f"bdd-{backend}", backend

    def refuses(self, text: str) -> bool:
        """When it is read, or synthesized."""
        try:
            synthesize(parse(text), backend=self.backend)
        except UserError:
            return True
        return False

    def valid(self, world: World, state: State) -> bool:
        """`Steps.valid`."""
        steps = self._steps(world.spec, world.ordering)
        return steps.encoding.contains(steps.valid, state)

    def safe(self, world: World, state: State) -> bool:
        """`Steps.safe`."""
        steps = self._steps(world.spec, world.ordering)
        return steps.encoding.contains(steps.safe, state)

    def allowed(self, world: World, state: State, chosen: ActionSet) -> bool:
        """`Steps.allowed`; a set that no choice of the groups stands for is not."""
        steps = self._steps(world.spec, world.ordering)
        encoding = steps.encoding
        if any(len(chosen & set(group.actions)) > 1 for group in encoding.groups):
            return False
        return bool((encoding.at(steps.allowed, state) & encoding.choices_cube(chosen)) != encoding.manager.false)

    def successor(self, world: World, state: State, chosen: ActionSet) -> State:
        """`Steps.successors`, which `Steps.before` has to agree with."""
        steps = self._steps(world.spec, world.ordering)
        encoding, false = steps.encoding, steps.encoding.manager.false
        pair = encoding.state_cube(state) & encoding.choices_cube(chosen)
        (found,) = encoding.states_in(steps.successors(pair))
        assert pair & steps.before(encoding.state_cube(found)) != false
        return found

    def meets(self, world: World, state: State, chosen: ActionSet, there: State) -> bool:
        """Whether the target of this allowed pair holds there; it is all of the goal where every state is safe."""
        steps, found = self._steps(world.spec, world.ordering), self._targets(world.spec, world.ordering)
        encoding = steps.encoding
        assert steps.safe == encoding.domain(), "targets are looked for among safe states"
        pair = encoding.state_cube(state) & encoding.choices_cube(chosen)
        (target,) = (each for each in found if pair & each.owed == pair)
        return encoding.contains(target.states, there)

    def answer(self, world: World) -> Answer:
        """`synthesize`."""
        outcome = synthesize(world.spec, world.ordering, backend=self.backend)
        if isinstance(outcome, Realizable):
            table = as_table(outcome.policy, 1000)
            assert table is not None
            return Answer(table.rows, {}, outcome.statistics.longest_run)
        assert isinstance(outcome, Unrealizable)
        return Answer(None, {each.kind: frozenset(each.states) for each in outcome.failures})

    @cache  # noqa: B019 - there is one engine of each backend
    def _steps(self, spec: Spec, ordering: Ordering) -> Steps:
        return build_steps(self._encoding(spec), ordering)

    @cache  # noqa: B019 - as above
    def _encoding(self, spec: Spec) -> Encoding:
        return encode(spec, self.backend)

    @cache  # noqa: B019 - as above
    def _targets(self, spec: Spec, ordering: Ordering) -> list[Target]:
        steps = self._steps(spec, ordering)
        return targets(steps, regions(steps.encoding, steps.valid))


class Prover:
    """One prover of `tumato_symbolic.verify`. It is asked about policies, and so is every step."""

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

    def valid(self, world: World, state: State) -> bool:
        """Whether a policy for all other states is not *total*."""
        rows = {other: frozenset[int]() for other in all_states(world.spec) if other != state}
        return not self._has("total", world.spec, world.ordering, rows)

    def safe(self, world: World, state: State) -> bool:
        """Whether it is valid, and doing nothing there is *safe*; asked without reaction rules."""
        spec = replace(world.spec, reaction_rules=())
        return self.valid(world, state) and self._has("safe", spec, world.ordering, {state: frozenset()})

    def allowed(self, world: World, state: State, chosen: ActionSet) -> bool:
        """Whether a policy for this state alone is *safe*; a set that is refuses to be called *minimal* another."""
        found = self._has("safe", world.spec, world.ordering, {state: chosen})
        if chosen:
            spec, here, longer = as_rival(world.spec, state, chosen)
            assert self._has("minimal", spec, world.ordering, {here: longer}) != found, "its search differs"
        return found

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
        return {name for name in PROPERTIES if not self._has(name, world.spec, world.ordering, rows)}

    def _has(self, name: str, spec: Spec, ordering: Ordering, rows: Rows) -> bool:
        policy = policy_from_rows(spec, dict(rows))
        (result,) = verify(policy, spec, ordering=ordering, properties=[name], prover=self._prover).properties
        assert result.verdict != "undecided", result.reason
        return result.verdict == "proved"


class Z3(Prover):
    """The prover that asks Z3, and with it the room that judges certificates of the answer no."""

    def __init__(self) -> None:
        super().__init__("z3", "z3")
        self._context = z3.Context()

    def _has(self, name: str, spec: Spec, ordering: Ordering, rows: Rows) -> bool:
        """In one context for all questions: Z3 takes longer to make one than to answer."""
        with patch.object(z3, "Context", lambda: self._context):
            return super()._has(name, spec, ordering, rows)

    def believes(self, world: World, certificate: Unrealizability) -> bool:
        """`verify_unrealizable`."""
        verdict = verify_unrealizable(certificate, world.spec, ordering=world.ordering).verdict
        assert verdict != "undecided"
        return verdict == "proved"
