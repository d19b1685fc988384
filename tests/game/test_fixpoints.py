"""Where steps lead: every way to compute it finds the same."""

from __future__ import annotations

from random import Random

import pytest

from tests.generate import ALL_PROFILES, random_spec
from tumato_symbolic import parse
from tumato_symbolic.game import fixpoints
from tumato_symbolic.game.evaluation import Evaluator
from tumato_symbolic.game.fixpoints import attractor, closed_loop, mixed, preimage
from tumato_symbolic.game.problem import Problem, build_problem
from tumato_symbolic.game.routing import only_region, own_region_policy
from tumato_symbolic.symbolic import Bdd, Manager, available_backend, preferred
from tumato_symbolic.synthesis.failing import failing_states

SEEDS = range(12)


def problems(profile: str) -> list[Problem]:
    """Some generated problems, each with a safe state."""
    found = [build_problem(random_spec(seed, ALL_PROFILES[profile]), "any", available_backend()) for seed in SEEDS]
    return [problem for problem in found if problem.steps.safe != problem.false]


def some_states(problem: Problem, random: Random) -> Bdd:
    """About half of the valid states."""
    states = [state for state in problem.encoding.states_in(problem.steps.valid) if random.random() < 0.5]
    return problem.encoding.manager.union(map(problem.encoding.state_cube, states))


def policies(problem: Problem, random: Random) -> tuple[Bdd, Bdd]:
    """Two policies for all safe states: the preferred sets, and the preferred ones of some other pairs."""
    allowed = problem.steps.allowed & problem.steps.safe
    first = preferred(problem.encoding, allowed)
    others = allowed & ~(first & some_states(problem, random))
    second = preferred(problem.encoding, others)
    return first, second | (first & ~problem.steps.states_of(second))


@pytest.mark.parametrize("taken", ["moves", "functions", "turns", "pairs"])
@pytest.mark.parametrize("profile", sorted(ALL_PROFILES))
def test_a_closed_loop_has_the_predecessor_of_its_policy(
    profile: str, taken: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Move by move, as functions, in turns or as a relation, it leads where the pairs of the policy nominally lead."""
    most = fixpoints.MOST_MOVES if taken == "moves" else 0
    if taken in ("turns", "pairs"):
        monkeypatch.setattr(fixpoints, "MANY_COMPOSED", 0)
        monkeypatch.setattr(fixpoints, "MOST_COMPOSED", 0)
        monkeypatch.setattr(Manager, "compose", None)
    if taken == "pairs":
        monkeypatch.setattr(fixpoints, "in_turns", lambda *_: None)
    for problem in problems(profile):
        random = Random(1)
        steps, states, target = problem.steps, some_states(problem, random), some_states(problem, random)
        for policy in policies(problem, random):
            found = closed_loop(problem, policy, most)
            assert (found.moves is None) == (most == 0)
            assert found.predecessor(states, target) == states & steps.states_of(policy & steps.before(target))


@pytest.mark.parametrize("most", [0, fixpoints.MOST_MOVES], ids=["functions", "moves"])
@pytest.mark.parametrize("profile", sorted(ALL_PROFILES))
def test_mixed_closed_loops_are_that_of_the_mixed_policy(profile: str, most: int) -> None:
    """Mixing where two policies lead, and their targets, is the same as mixing the policies."""
    for problem in problems(profile):
        random = Random(2)
        here, states, target = (some_states(problem, random) for _ in range(3))
        one, other = (closed_loop(problem, policy, most) for policy in policies(problem, random))
        found = mixed(one, other, here)
        anew = closed_loop(problem, found.policy, most)
        assert found.policy == (one.policy & ~here) | (other.policy & here)
        assert (found.decided, found.pending) == (anew.decided, anew.pending)
        assert found.predecessor(states, target) == anew.predecessor(states, target)


@pytest.mark.parametrize("profile", sorted(ALL_PROFILES))
def test_what_leads_into_a_set(profile: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Pairs are found move by move as they are found all at once."""
    for problem in problems(profile):
        target = some_states(problem, Random(3))
        expected = problem.steps.allowed & problem.steps.before(target)
        for most in (0, 10_000):
            monkeypatch.setattr(fixpoints, "MOST_MOVES", most)
            assert preimage(problem, problem.steps.allowed)(target) == expected


def test_ranks_that_come_with_the_decisions_are_those_of_the_policy() -> None:
    """The rounds in which states of a single region were decided are the layers that the policy has."""
    seen = 0
    for profile in sorted(ALL_PROFILES):
        for problem in problems(profile):
            own = own_region_policy(problem)
            if own.ranks is not None:
                step, safe = closed_loop(problem, own.policy).predecessor, problem.steps.safe
                found = tuple(attractor(problem, target.states, step, safe, None) for target in problem.targets)
                assert own.ranks == found
                seen += len(found[0]) > 2
    assert seen > 3


@pytest.mark.parametrize("profile", sorted(ALL_PROFILES))
def test_what_fails_is_told_by_the_only_region(profile: str) -> None:
    """Where all have the same goals, their own policy tells which states fail, and how far the others are."""
    for problem in problems(profile):
        own = only_region(problem)
        known, anew = failing_states(problem, own), failing_states(problem)
        assert known.kinds == anew.kinds
        assert known.apart == anew.apart


@pytest.mark.parametrize("profile", sorted(ALL_PROFILES))
def test_whether_all_are_served_is_whether_none_fails(profile: str) -> None:
    """The quick question and the whole judgement agree on every policy, whatever target is asked first."""
    seen = set()
    for problem in problems(profile):
        judge = Evaluator(problem)
        for policy in policies(problem, Random(4)):
            found = judge.evaluate(policy)
            suspects = list(range(len(problem.targets)))
            Random(5).shuffle(suspects)
            serves = judge.serves_all(found.closed_loop, suspects)
            assert serves == (found.failing == problem.false)
            assert sorted(suspects) == list(range(len(problem.targets)))
            seen.add(serves)
    assert False in seen


LEFT_BEHIND = """
BEGIN STATE VECTOR
  state S_Place can be ditch, path, home
END STATE VECTOR
BEGIN ACTIONS
  action climb  preconditions: S_Place is ditch  nominal effects: S_Place is path
  action walk  preconditions: S_Place is path  nominal effects: S_Place is home
END ACTIONS
BEGIN STATE RULES
  rule: NOT S_Place is ditch
END STATE RULES
BEGIN GOALS
  goal type: priority
  when S_Place is ditch then goal: S_Place is home
END GOALS
"""
"""Who was in the ditch wants to go home; who is on the path wants nothing."""


def test_unsafe_states_have_to_be_served_as_well() -> None:
    """A policy that serves all safe states still fails where what restores safety leads to where it stays."""
    problem = build_problem(parse(LEFT_BEHIND), "any", available_backend())
    judge, encoding, steps = Evaluator(problem), problem.encoding, problem.steps
    idle = preferred(encoding, steps.allowed & steps.safe)
    found = judge.evaluate(idle)
    assert found.failing == steps.unsafe == encoding.state_cube((0,))
    assert not judge.serves_all(found.closed_loop, list(range(len(problem.targets))))
    walking = (idle & ~encoding.state_cube((1,))) | (encoding.state_cube((1,)) & encoding.choices_cube(frozenset({1})))
    assert judge.serves_all(judge.evaluate(walking).closed_loop, list(range(len(problem.targets))))
