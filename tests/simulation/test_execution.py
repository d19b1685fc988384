"""Executions by chance are executions, as the explicit meaning knows them, and depend on the seed alone."""

from collections.abc import Iterator, Mapping
from random import Random

import pytest
from msgspec.structs import replace

from tests.generate import random_spec
from tests.profiles import PROFILES
from tests.repo.examples import EXAMPLES, solved
from tests.simulation.replay import faults
from tests.verify.policies import near_policies
from tumato_symbolic import Realizable
from tumato_symbolic.explain.decision import Decisions
from tumato_symbolic.semantics import (
    ActionSet,
    Disturbance,
    EffectStep,
    End,
    Move,
    State,
    Trace,
    is_valid,
    next_states,
    nominal_agrees,
)
from tumato_symbolic.simulation import Dice, Simulation, Starts, executed, random_move, summarized
from tumato_symbolic.spec import Ordering, Spec

ORDERINGS: tuple[Ordering, ...] = ("any", "first")


def _simulations(spec: Spec, policy: Mapping[State, ActionSet], ordering: Ordering) -> Iterator[Simulation]:
    for disturb in (0.0, 0.3):
        yield Simulation(spec, policy, ordering, "random", disturb, 40)
        yield Simulation(spec, policy, ordering, "none", disturb, 40)


def test_executions_of_examples_are_replayed() -> None:
    """A thousand traces of policies that were synthesized, from states that chance chooses."""
    dice, traces, ends = Dice(1), 0, set[End | None]()
    for example in EXAMPLES:
        spec, outcome = solved(example)
        if not isinstance(outcome, Realizable):
            continue
        policy = Decisions(spec, outcome.policy)
        starts = Starts(spec, outcome.policy, {})
        for simulation in _simulations(spec, policy, spec.ordering):
            for _ in range(30):
                trace = executed(simulation, starts.draw(dice), dice)
                assert faults(spec, policy, spec.ordering, trace) == []
                traces, ends = traces + 1, ends | {trace.end}
    assert traces >= 1_000
    assert "goal" in ends


def test_executions_of_any_policy_are_replayed() -> None:
    """A thousand traces of policies that may be partial, unsafe, and miss their goals, in both orderings."""
    traces, ends, deviations, disturbances = 0, set[End | None](), 0, 0
    for seed in range(40):
        profile = PROFILES[sorted(PROFILES)[seed % len(PROFILES)]]
        spec, random, dice = random_spec(seed, profile), Random(seed), Dice(seed)
        ordering = ORDERINGS[seed % 2]
        for rows in near_policies(spec, ordering, random, count=1):
            for simulation in _simulations(spec, rows, ordering):
                for start in random.sample(sorted(rows), min(3, len(rows))):
                    trace = executed(simulation, start, dice)
                    assert faults(spec, rows, ordering, trace) == []
                    traces, ends = traces + 1, ends | {trace.end}
                    deviations += sum(move.deviation is not None for move in trace.moves)
                    disturbances += len(trace.events) - len(trace.moves)
    assert traces >= 1_000
    assert ends == {"goal", "bound", "loop", "undefined"}
    assert deviations > 100
    assert disturbances > 100


@pytest.mark.parametrize("ordering", ORDERINGS)
def test_chance_leaves_out_no_outcome(ordering: Ordering) -> None:
    """Drawn often enough, the states after a step are all of `Next`, and no others."""
    several = 0
    for seed in range(30):
        spec, random, dice = random_spec(seed, PROFILES["interacting"]), Random(seed), Dice(seed)
        state = tuple(random.randrange(len(variable.values)) for variable in spec.variables)
        chosen = frozenset(random.sample(range(len(spec.actions)), min(2, len(spec.actions))))
        if nominal_agrees(spec, chosen):
            drawn = {random_move(spec, state, chosen, ordering, dice).after for _ in range(600)}
            assert drawn == next_states(spec, state, chosen, ordering)
            several += len(drawn) > 2
    assert several > 3


def test_the_seed_decides() -> None:
    """The same seed makes the same draws, for ever: these are the first ones of seed 0."""
    dice = Dice(0)
    assert [dice.below(1_000) for _ in range(4)] == [844, 420, 511, 783]
    large, again = Dice(7), Dice(7)
    assert [large.below(10**30) for _ in range(3)] == [again.below(10**30) for _ in range(3)]
    assert {Dice(seed).below(3) for seed in range(40)} == {0, 1, 2}


def test_disturbances_keep_to_valid_states() -> None:
    """One variable changes, where the assumptions allow it; else nothing does."""
    seen = 0
    for seed in range(20):
        spec = random_spec(seed, PROFILES["restoring"])
        states = [state for state in _rows(spec, seed) if is_valid(spec, state)]
        for state in states[:3]:
            trace = executed(Simulation(spec, _rows(spec, seed), "any", "random", 1.0, 5), state, Dice(seed))
            assert all(is_valid(spec, event.after) for event in trace.events if isinstance(event, Disturbance))
            seen += any(isinstance(event, Disturbance) for event in trace.events)
    assert seen > 10


def _rows(spec: Spec, seed: int) -> dict[State, ActionSet]:
    return next(iter(near_policies(spec, "any", Random(seed), count=0)))


def test_a_trace_that_is_no_execution_is_noticed() -> None:
    """The replay that judges traces here objects to another state, another set, and a wrong end."""
    spec, outcome = solved(EXAMPLES[0])
    assert isinstance(outcome, Realizable)
    policy = Decisions(spec, outcome.policy)
    dice = Dice(3)
    trace = executed(Simulation(spec, policy, "any"), Starts(spec, outcome.policy, {}).draw(dice), dice)
    move = trace.moves[0]
    other = tuple(
        (value + 1) % len(variable.values) for value, variable in zip(move.after, spec.variables, strict=True)
    )
    assert faults(spec, policy, "any", trace) == []
    for wrong in (
        replace(trace, end="bound"),
        replace(trace, events=(replace(move, after=other), *trace.events[1:])),
        replace(trace, events=(replace(move, decision=move.decision ^ {0}), *trace.events[1:])),
        replace(trace, events=(replace(move, deviation=(EffectStep(0, (), trace.start),)), *trace.events[1:])),
    ):
        assert faults(spec, policy, "any", wrong)


def test_what_happened_is_counted() -> None:
    """Restorations are steps to safe states, deviations and disturbances are counted, and so is what an end is."""
    spec, outcome = solved(next(each for each in EXAMPLES if each.stem == "amr"))
    assert isinstance(outcome, Realizable)
    policy = Decisions(spec, outcome.policy)
    start = tuple(spec.variables[n].values.index(v) for n, v in enumerate(("corridor", "low", "free", "on")))
    trace = executed(Simulation(spec, policy, "any"), start, Dice(0))
    assert [isinstance(event, Move) for event in trace.events] == [True] * 3
    found = summarized(spec, [trace, replace(trace, end="bound"), Trace(start, (Disturbance(start),), "undefined")])
    assert (found.ends, found.met, found.runs) == ({"goal": 1, "bound": 1, "undefined": 1}, 1, 3)
    assert (found.restorations, found.unsafe, found.deviations, found.disturbances) == (2, 0, 0, 1)
    assert dict(found.steps.counts) == {3: 1}
    assert found.missed is not None
    assert found.missed[0] == 2
