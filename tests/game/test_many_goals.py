"""Residual goals that are many, solved together: as each by itself, in steps that do not count them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from pathlib import Path

import pytest
from msgspec.structs import replace

from benchmarks.cleaning import errands, rooms
from tests.generate import ALL_PROFILES, random_spec
from tumato_symbolic import Realizable, parse, synthesize, verify
from tumato_symbolic.diagnostics import UserError
from tumato_symbolic.game import build_problem
from tumato_symbolic.policy import dumps
from tumato_symbolic.spec import Restoration, Spec, many_goals
from tumato_symbolic.symbolic import Manager, available_backend, goals

SEEDS = range(8)
RESTORATIONS: tuple[Restoration, ...] = ("one_step", "bounded", "fair")


def _looked_at_apart(monkeypatch: pytest.MonkeyPatch, most: int) -> None:
    monkeypatch.setattr(many_goals, "MOST_APART", most)
    monkeypatch.setattr(goals, "MOST_APART", most)


def _answer(spec: Spec) -> object:
    """The policy without its certificate, and the numbers; or what fails."""
    try:
        found = synthesize(spec)
    except UserError as error:
        return [each.code for each in error.diagnostics]
    if isinstance(found, Realizable):
        return dumps(replace(found.policy, certificate=None)), found.statistics, found.warnings
    return found.statistics, getattr(found, "failures", None)


@pytest.mark.parametrize("restoration", RESTORATIONS)
@pytest.mark.parametrize("profile", sorted(ALL_PROFILES))
def test_goals_together_are_solved_as_goals_apart(
    profile: str, restoration: Restoration, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Policies, counts, warnings and failing states are the same, whatever goals speak of."""
    for seed in SEEDS:
        spec = replace(random_spec(seed, ALL_PROFILES[profile]), restoration=restoration)
        apart = _answer(spec)
        _looked_at_apart(monkeypatch, 0)
        assert _answer(spec) == apart
        monkeypatch.undo()


@pytest.mark.parametrize("name", ["nested_goals", "amr_two_loads", "forklift", "fleet", "lid", "concurrent"])
def test_examples_are_solved_as_goals_apart(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Also where goals interact, where there are starts, and where safety takes several steps."""
    spec = parse(Path(f"examples/{name}.tum").read_text(encoding="utf-8"))
    apart = _answer(spec)
    _looked_at_apart(monkeypatch, 0)
    assert _answer(spec) == apart


@pytest.mark.parametrize("family", [rooms, errands])
def test_the_policy_is_proved_without_ranks(family: Callable[[int, bool], str]) -> None:
    """Nothing is written for each goal, and the walk proves the policy all the same."""
    spec = parse(family(12, True))
    found = synthesize(spec)
    assert isinstance(found, Realizable)
    assert found.policy.certificate is None
    answer = verify(found.policy, spec)
    assert answer.verdict == "proved"
    assert {result.proved_by for result in answer.properties} == {"walk"}


def test_the_work_grows_with_the_goals_and_not_with_their_sets(monkeypatch: pytest.MonkeyPatch) -> None:
    """Twice as many goals take at most ten times as many operations, not 256 times as many."""
    counted: Counter[str] = Counter()

    def counting(taken: Callable[..., object]) -> Callable[..., object]:
        def count(manager: Manager, *values: object) -> object:
            counted["operations"] += 1
            return taken(manager, *values)

        return count

    for name in ("cofactor", "compose", "exists", "and_exists", "union", "intersection"):
        monkeypatch.setattr(Manager, name, counting(getattr(Manager, name)))
    found = []
    for size in (9, 18):
        counted.clear()
        assert isinstance(synthesize(parse(rooms(size, True))), Realizable)
        found.append(counted["operations"])
    assert found[1] < 10 * found[0]


def test_conditions_that_exclude_each_other_are_looked_at_apart() -> None:
    """Twelve conditions of which one holds at a time are no 8,192 sets of goals."""
    values = [f"v{number}" for number in range(12)]
    states = f"state X can be {', '.join(values)} state Y can be no, yes"
    listed = "".join(f"when X is {value} then goal: Y is yes " for value in values)
    text = (
        f"BEGIN STATE VECTOR {states} END STATE VECTOR BEGIN ACTIONS action go nominal effects: Y is yes END ACTIONS "
        f"BEGIN GOALS goal type: constraint {listed} when Y is no then goal: X is v3 END GOALS"
    )
    problem = build_problem(parse(text), "any", available_backend())
    assert len(problem.regions) == 2
    assert not problem.goals_are_many
