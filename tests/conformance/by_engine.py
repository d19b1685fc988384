"""The explicit meaning, and the engine on BDDs."""

from __future__ import annotations

from functools import lru_cache

from tests.conformance.by_trying import best_answer, from_starts
from tests.conformance.roles import PROPERTIES, Answer, Rows
from tests.conformance.world import REMEMBERED, World
from tests.oracle import Together, decide_world
from tests.oracle import World as OracleWorld
from tests.reference_policy import reference_policy
from tumato_symbolic import parse
from tumato_symbolic.diagnostics import Code, UserError
from tumato_symbolic.game import Evaluator, build_problem
from tumato_symbolic.policy import as_table
from tumato_symbolic.semantics import (
    ActionSet,
    Effort,
    Guarantee,
    Restorations,
    State,
    all_states,
    allowed,
    allowed_sets,
    guarantees,
    is_safe,
    is_valid,
    judge,
    level,
    next_states,
    reached,
    residual_goal,
    successor,
)
from tumato_symbolic.semantics.lint import lint
from tumato_symbolic.spec import Ordering, Spec
from tumato_symbolic.symbolic import (
    Backend,
    Encoding,
    Steps,
    Target,
    build_steps,
    compatible_sets,
    encode,
    regions,
    staying_in,
    targets,
)
from tumato_symbolic.synthesis import Realizable, Unrealizable, synthesize


class Explicit:
    """`tumato_symbolic.semantics`; what it does not decide is found by trying (`tests.oracle`)."""

    name = "explicit"

    def refuses(self, text: str) -> bool:
        """When it is read, or looked at state by state."""
        try:
            return any(found.code in (Code.TUM312, Code.TUM317) for found in lint(parse(text)))
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
        failing = (
            (*found.missing, *found.invalid),
            found.not_allowed,
            found.not_restored,
            found.goal_missed,
            found.not_minimal,
        )
        return {name for name, states in zip(PROPERTIES, failing, strict=True) if states}

    def following(self, world: World, state: State, chosen: ActionSet) -> set[State]:
        """`next_states`."""
        return next_states(world.spec, state, chosen, world.ordering)

    def level(self, world: World, state: State) -> int:
        """`level`."""
        return level(world.spec, state)

    def efforts(self, world: World, rows: Rows) -> dict[State, Effort]:
        """`Restorations.worst`."""
        return dict(Restorations(world.spec, rows, world.ordering).worst)

    def guarantees(self, world: World, rows: Rows) -> dict[State, Guarantee | None]:
        """`guarantees`."""
        return guarantees(world.spec, rows, world.ordering)

    def answer(self, world: World) -> Answer:
        """The preferred policy where the preferences alone make one, else any; states that fail, or a conflict."""
        if world.spec.starts:
            return from_starts(world.spec, world.ordering)
        if world.spec.restores_stepwise:
            return best_answer(world.spec, world.ordering)
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

    def following(self, world: World, state: State, chosen: ActionSet) -> set[State]:
        """The states without which `staying_in` is false."""
        steps = self._steps(world.spec, world.ordering)
        encoding = steps.encoding
        pair, compatible = encoding.state_cube(state) & encoding.choices_cube(chosen), compatible_sets(encoding)
        found = set()
        for there in all_states(world.spec):
            others = encoding.domain() & ~encoding.state_cube(there)
            if pair & ~staying_in(encoding, world.ordering, others, compatible, pair) != encoding.manager.false:
                found.add(there)
        return found

    def level(self, world: World, state: State) -> int:
        """How many of `Steps.tiers`, but for the valid states, have it."""
        steps = self._steps(world.spec, world.ordering)
        return sum(steps.encoding.contains(tier, state) for tier in steps.tiers[1:])

    def efforts(self, world: World, rows: Rows) -> dict[State, Effort]:
        """What `game` says of a policy for the safe states, where the others have no choice."""
        problem = build_problem(world.spec, world.ordering, self.backend)
        encoding, steps = problem.encoding, problem.steps
        pairs = {state: encoding.state_cube(state) & encoding.choices_cube(chosen) for state, chosen in rows.items()}
        forced = encoding.manager.union(pairs.values())
        judge = Evaluator(problem, forced & steps.unsafe, required=steps.safe)
        restoration = judge.evaluate(forced & steps.safe).restoration
        assert restoration is not None
        return {state: effort for effort, states in restoration.worst.items() for state in encoding.states_in(states)}

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
        (target,) = (each for each in found if pair & each.pending == pair)
        return encoding.contains(target.states, there)

    def answer(self, world: World) -> Answer:
        """`synthesize`."""
        outcome = synthesize(world.spec, world.ordering, backend=self.backend)
        if isinstance(outcome, Realizable):
            table = as_table(outcome.policy, 1000)
            assert table is not None
            return Answer(table.rows, {}, outcome.statistics.longest_run)
        assert isinstance(outcome, Unrealizable)
        assert all((each.count, each.example) == (len(each.states), each.states[0]) for each in outcome.failures)
        return Answer(None, {each.kind: frozenset(each.states) for each in outcome.failures})

    @lru_cache(maxsize=REMEMBERED)  # noqa: B019 - there is one engine of each backend
    def _steps(self, spec: Spec, ordering: Ordering) -> Steps:
        return build_steps(self._encoding(spec), spec, ordering)

    @lru_cache(maxsize=REMEMBERED)  # noqa: B019 - as above
    def _encoding(self, spec: Spec) -> Encoding:
        return encode(spec, self.backend)

    @lru_cache(maxsize=REMEMBERED)  # noqa: B019 - as above
    def _targets(self, spec: Spec, ordering: Ordering) -> list[Target]:
        steps = self._steps(spec, ordering)
        return targets(steps, regions(steps.encoding, steps.valid))
