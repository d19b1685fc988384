"""Where goals take turns, one loop through all of them serves every state; it is taken only where it does."""

from __future__ import annotations

import pytest

from tests.repeats.specs import crossroads
from tumato_symbolic import Realizable, Unrealizable, parse, synthesize
from tumato_symbolic.game import Evaluation, Evaluator
from tumato_symbolic.synthesis import repair, touring
from tumato_symbolic.verify import verify

SHIFTS = """
BEGIN STATE VECTOR
for R in anna, bert
  state S_Place_{R} can be shelf, table
  state S_Box_{R} can be waiting, carried, packed
end for
END STATE VECTOR
BEGIN RESOURCES
resource LANE
resource ROBOT_anna
resource ROBOT_bert
END RESOURCES
BEGIN ACTIONS
for R in anna, bert
  for P in shelf, table
    action {R}_to_{P}
      controlled resources: ROBOT_{R}, LANE
      preconditions: S_Place_{R} is not {P}
      nominal effects: S_Place_{R} is {P}
  end for
  action {R}_load
    controlled resources: ROBOT_{R}
    preconditions: S_Place_{R} is shelf, S_Box_{R} is waiting
    nominal effects: S_Box_{R} is carried
  action {R}_unload
    controlled resources: ROBOT_{R}
    preconditions: S_Place_{R} is table, S_Box_{R} is carried
    nominal effects: S_Box_{R} is packed
  action {R}_next
    controlled resources: ROBOT_{R}
    preconditions: S_Place_{R} is shelf, S_Box_{R} is packed
    nominal effects: S_Box_{R} is waiting
end for
END ACTIONS
BEGIN STATE RULES
rule: S_Place_anna is not table OR S_Place_bert is not table
END STATE RULES
BEGIN GOALS
goal type: constraint
for R in anna, bert
  when S_Box_{R} is waiting then goal: S_Box_{R} is carried
  when S_Box_{R} is carried then goal: S_Box_{R} is packed
  when S_Box_{R} is packed then goal: S_Box_{R} is waiting
end for
END GOALS
BEGIN CONFIG
restoration: one_step
MORE
END CONFIG
"""
"""Two robots whose tasks follow each other: nine residual goals, each met only on the way to others."""


@pytest.fixture
def tours(monkeypatch: pytest.MonkeyPatch) -> list[Evaluation | None]:
    """What tours are found, from now on looked for before anything is repaired."""
    found: list[Evaluation | None] = []
    look = touring.tour

    def looked(evaluator: Evaluator, so_far: Evaluation) -> Evaluation | None:
        found.append(look(evaluator, so_far))
        return found[-1]

    monkeypatch.setattr(touring, "ROUNDS_BEFORE_TOUR", 0)
    monkeypatch.setattr(touring, "tour", looked)
    return found


def test_tasks_that_take_turns_are_served(tours: list[Evaluation | None]) -> None:
    """Every state comes to its own goals, as the proof says."""
    spec = parse(SHIFTS.replace("MORE", ""))
    outcome = synthesize(spec)
    assert isinstance(outcome, Realizable)
    assert len(tours) == 1
    assert tours[0] is not None
    assert all(result.verdict == "proved" for result in verify(outcome.policy, spec).properties)


def test_a_tour_that_is_too_long_is_not_taken(tours: list[Evaluation | None]) -> None:
    """Within a plan bound runs cannot go round all goals; then it is repair that decides."""
    outcome = synthesize(parse(SHIFTS.replace("MORE", "max_plan_length: 5")))
    assert tours == [None]
    assert isinstance(outcome, Unrealizable)


def test_tours_change_no_verdict(tours: list[Evaluation | None], monkeypatch: pytest.MonkeyPatch) -> None:
    """Of generated specifications the same are realizable, and what tours lead to is proved."""
    specs = [parse(crossroads(seed)) for seed in range(30)]
    toured = [synthesize(spec) for spec in specs]
    assert len(tours) > len(list(filter(None, tours))) > 0
    monkeypatch.setattr(touring, "ROUNDS_BEFORE_TOUR", repair.ROUNDS)
    for spec, outcome in zip(specs, toured, strict=True):
        assert type(synthesize(spec)) is type(outcome)
        if isinstance(outcome, Realizable):
            assert all(result.verdict == "proved" for result in verify(outcome.policy, spec).properties)
