"""Policies that follow each other are judged as if each were judged anew."""

from __future__ import annotations

from random import Random

import pytest

from benchmarks.families import FAMILIES
from tests.game.test_fixpoints import policies, problems, some_states
from tests.generate import ALL_PROFILES
from tumato_symbolic import Realizable, parse, synthesize
from tumato_symbolic.game import Evaluator, Problem, Reevaluator, build_problem, closed_loop, mixed
from tumato_symbolic.symbolic import Bdd, available_backend

ROUNDS = 6


def few_states(problem: Problem, random: Random) -> Bdd:
    """Up to three safe states."""
    states = list(problem.encoding.states_in(problem.steps.safe))
    some = random.sample(states, min(len(states), random.randint(0, 3)))
    return problem.encoding.manager.union(map(problem.encoding.state_cube, some))


@pytest.mark.parametrize("profile", sorted(ALL_PROFILES))
def test_the_same_states_fail_as_when_all_targets_are_judged(profile: str) -> None:
    """Whatever changes from one policy to the next, in few states or in many."""
    for seed, problem in enumerate(problems(profile)):
        random = Random(seed)
        one, other = (closed_loop(problem, policy) for policy in policies(problem, random))
        if (one.moves is None) != (other.moves is None):
            continue
        evaluator = Evaluator(problem)
        judge, turned = Reevaluator(evaluator), problem.false
        for _ in range(ROUNDS):
            found = mixed(one, other, turned)
            assert judge.failing(found) == evaluator.evaluate(found.policy).failing
            change = few_states(problem, random) if random.random() < 0.8 else some_states(problem, random)
            turned = (turned & ~change) | (change & ~turned)


UNSEEN = """
BEGIN STATE VECTOR
  state S_Place can be ditch, path, lane, home
END STATE VECTOR
BEGIN ACTIONS
  action climb  preconditions: S_Place is ditch  nominal effects: S_Place is path
  action walk  preconditions: S_Place is path OR S_Place is lane  nominal effects: S_Place is home
END ACTIONS
BEGIN STATE RULES
  rule: NOT S_Place is ditch
END STATE RULES
BEGIN GOALS
  goal type: priority
  when S_Place is ditch then goal: S_Place is home
  when S_Place is lane then goal: S_Place is lane OR S_Place is home
END GOALS
"""
"""Only who was in the ditch has to go on from the path: no run from a safe state passes it on the way home."""


def test_runs_from_unsafe_states_are_followed() -> None:
    """A change that concerns none but those who had to restore safety first is noticed."""
    problem = build_problem(parse(UNSEEN), "any", available_backend())
    encoding, steps = problem.encoding, problem.steps
    idle, walk = encoding.choices_cube(frozenset()), encoding.choices_cube(frozenset({1}))
    path = encoding.state_cube((1,))
    walking = closed_loop(problem, (path & walk) | (steps.safe & ~path & idle))
    judge = Reevaluator(Evaluator(problem))
    assert judge.failing(walking) == problem.false
    assert judge.failing(closed_loop(problem, steps.safe & idle)) == steps.unsafe != problem.false


RESTING = """
BEGIN STATE VECTOR
  state S_Place can be path, home
END STATE VECTOR
BEGIN RESOURCES
  resource LEGS
END RESOURCES
BEGIN ACTIONS
  action rest  controlled resources: LEGS  preconditions: S_Place is path
  action walk  controlled resources: LEGS  preconditions: S_Place is path  nominal effects: S_Place is home
END ACTIONS
BEGIN GOALS
  goal type: priority
  goal: S_Place is home OR executing rest
END GOALS
"""
"""Who rests has reached the goal; who walks is on the way home."""


def test_a_decision_may_change_the_target_of_its_state() -> None:
    """Then the new target is judged, though no run to it was met by the change."""
    problem = build_problem(parse(RESTING), "any", available_backend())
    encoding, (path, home) = problem.encoding, map(problem.encoding.state_cube, ((0,), (1,)))
    idle, rest, walk = (encoding.choices_cube(frozenset(chosen)) for chosen in ((), (0,), (1,)))
    judge, at_home = Reevaluator(Evaluator(problem)), home & idle
    assert judge.failing(closed_loop(problem, at_home | (path & rest))) == problem.false
    assert judge.failing(closed_loop(problem, at_home | (path & walk))) == problem.false
    assert judge.failing(closed_loop(problem, at_home | (path & idle))) == path


def test_only_targets_whose_runs_meet_a_change_are_judged_again(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of eight load places all but the first are delivered as before, whatever is done where the first is loaded."""
    problem = build_problem(parse(FAMILIES["loads"].text(8, True)), "any", available_backend())
    judged: list[int] = []
    served = Evaluator.served

    def noting(evaluator: Evaluator, *values: object) -> Bdd:
        judged.append(values[1])  # type: ignore[arg-type]
        return served(evaluator, *values)  # type: ignore[arg-type]

    monkeypatch.setattr(Evaluator, "served", noting)
    assert isinstance(synthesize(problem.spec), Realizable)
    again = judged[len(problem.targets) :]
    assert judged[: len(problem.targets)] == list(range(len(problem.targets)))
    assert 0 < len(again) < 3 * len(problem.targets)
    assert len(set(again)) < len(problem.targets) / 2
