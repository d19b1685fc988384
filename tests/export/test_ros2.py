"""The example for ROS 2: its loop with a simulated robot, its node with headers that stand for those of ROS."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.export.c_compiler import needs_cxx
from tests.export.policies import example, request
from tests.export.ros2.loop import HEADER, Limits, Loop, Said, compiled
from tests.export.ros2.robot import SimulatedRobot, rows_of
from tumato_symbolic.semantics import successor

MOVE_TO_CHARGER, MOVE_TO_CORRIDOR, CHARGE = 2, 3, 7
IN_CORRIDOR, AT_CHARGER, EXCLUDED = (0, 0, 0, 1), (1, 0, 0, 1), (0, 0, 0, 0)
"""States of the robot whose battery is low; the last is not decided by the policy that these tests use."""

NOTHING = Said((), (), "no")


@needs_cxx
@pytest.mark.parametrize("name", ["amr", "amr_two_loads", "nested_goals"])
def test_the_loop_executes_the_policy(name: str, tmp_path: Path) -> None:
    """Just what is decided, in a state seen after all effects, with nothing else running; else it waits or halts."""
    made = example(name)
    with Loop(compiled(made, tmp_path)) as loop:
        robot = SimulatedRobot(made, loop, seed=1)
        robot.live(7_000)
    assert robot.complaints == []
    assert min(robot.counts[each] for each in ("decisions", "effects", "ends", "failures", "halts")) > 30, robot.counts


@needs_cxx
@pytest.mark.parametrize(
    ("rule", "broken"),
    [
        ("asked.endings != endings_ || ", ""),
        ("halt(now); // and only", "halt(now); start(decision.actions, now); // and only"),
        ("        started(action).reset();", "        started_ = {}; started(action).reset();"),
        ("if (halting_since_) {\n            return;", "if (halting_since_ && false) {\n            return;"),
    ],
    ids=["an effect is not seen", "the old is not over", "what runs is forgotten", "halted twice"],
)
def test_a_loop_with_a_fault_is_noticed(rule: str, broken: str, tmp_path: Path) -> None:
    """Each of these faults leads to complaints of the same robot."""
    header = HEADER.read_text()
    assert header.count(rule) == 1
    made = example("nested_goals")
    with Loop(compiled(made, tmp_path, header=header.replace(rule, broken))) as loop:
        robot = SimulatedRobot(made, loop, seed=1)
        robot.live(2_000)
    assert robot.complaints != []


@pytest.fixture(scope="module")
def program(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The loop with the policy of the AMR, but for one state that it does not decide."""
    made = example("amr")
    rows = {state: chosen for state, chosen in rows_of(made).items() if state != EXCLUDED}
    limits = Limits(state=1_000, action=60_000, halting=10_000)
    return compiled(request(made.spec, rows), tmp_path_factory.mktemp("loop"), limits)


@pytest.fixture
def loop(program: Path) -> Iterator[Loop]:
    """A loop that waits a second for a state, a minute for an action, ten seconds for one that is halted."""
    with Loop(program) as made:
        yield made


@needs_cxx
def test_the_loop_follows_nominal_runs(loop: Loop) -> None:
    """From every state: each decision at the first sight of its state, and the next when all have ended."""
    made = example("amr")
    rows = rows_of(made)
    for start in rows.keys() - {EXCLUDED}:
        state = start
        for _ in range(5):
            assert loop.seen(state, loop.ask()) == Said(tuple(sorted(rows[state])), (), "no")
            state, ends = successor(made.spec, state, rows[state]), [loop.ended(action) for action in rows[state]]
            assert ends == [NOTHING] * len(ends)


@needs_cxx
def test_what_is_still_wanted_goes_on(loop: Loop) -> None:
    """Another state with the same decision changes nothing."""
    assert loop.seen((2, 0, 0, 1), loop.ask()).started == (MOVE_TO_CORRIDOR,)
    assert loop.seen((3, 0, 1, 1), loop.ask()) == NOTHING


@needs_cxx
def test_halted_is_waited_for(loop: Loop) -> None:
    """A new decision halts once; its actions start in a state that was asked for after the end, and not before."""
    assert loop.seen(IN_CORRIDOR, loop.ask()).started == (MOVE_TO_CHARGER,)
    assert loop.seen(AT_CHARGER, loop.ask()).halted == (MOVE_TO_CHARGER,)
    assert loop.seen(AT_CHARGER, loop.ask()) == NOTHING
    early = loop.ask()
    assert loop.ended(MOVE_TO_CHARGER) == NOTHING
    assert loop.seen(AT_CHARGER, early) == NOTHING
    assert loop.seen(AT_CHARGER, loop.ask()).started == (CHARGE,)


@needs_cxx
def test_an_older_answer_is_no_news(loop: Loop) -> None:
    """Answers may come in another order than they were asked for."""
    older = loop.ask()
    loop.now = 10
    assert loop.seen(IN_CORRIDOR, loop.ask()).started == (MOVE_TO_CHARGER,)
    assert loop.seen(AT_CHARGER, older) == NOTHING


@needs_cxx
@pytest.mark.parametrize(
    ("state", "why"), [(EXCLUDED, "undecided"), ((0, 2, 0, 0), "invalid"), ((-1, 0, 0, 0), "invalid")]
)
def test_a_state_without_a_decision_stops(state: tuple[int, ...], why: str, loop: Loop) -> None:
    """What runs is halted, and nothing starts any more, whatever is seen."""
    assert loop.seen(IN_CORRIDOR, loop.ask()).started == (MOVE_TO_CHARGER,)
    assert loop.seen(state, loop.ask()) == Said((), (MOVE_TO_CHARGER,), why)
    _is_over(loop, why)


@needs_cxx
@pytest.mark.parametrize("waits", [False, True])
def test_old_states_stop(waits: bool, loop: Loop) -> None:
    """Where no state is seen for too long, or the answer has taken so long."""
    assert loop.seen(IN_CORRIDOR, loop.ask()).started == (MOVE_TO_CHARGER,)
    question = loop.ask()
    loop.now = 1_000
    assert loop.check() == NOTHING
    loop.now += 1
    said = loop.seen(IN_CORRIDOR, question) if waits else loop.check()
    assert said == Said((), (MOVE_TO_CHARGER,), "stale")
    _is_over(loop, "stale")


@needs_cxx
def test_actions_that_never_end_stop(loop: Loop) -> None:
    """After a minute, with the state seen all the time."""
    assert loop.seen(IN_CORRIDOR, loop.ask()).started == (MOVE_TO_CHARGER,)
    while loop.now < 60_000:
        loop.now += 1_000
        assert loop.seen(IN_CORRIDOR, loop.ask()) == NOTHING
    loop.now += 1
    assert loop.check() == Said((), (MOVE_TO_CHARGER,), "no_result")
    _is_over(loop, "no_result")


@needs_cxx
def test_actions_that_cannot_be_halted_stop(loop: Loop) -> None:
    """After ten seconds; until then, nothing else is started."""
    assert loop.seen(IN_CORRIDOR, loop.ask()).started == (MOVE_TO_CHARGER,)
    assert loop.seen(AT_CHARGER, loop.ask()).halted == (MOVE_TO_CHARGER,)
    while loop.now < 10_000:
        loop.now += 1_000
        assert loop.seen(AT_CHARGER, loop.ask()) == NOTHING
    loop.now += 1
    assert loop.seen(AT_CHARGER, loop.ask()) == Said((), (), "no_result")
    _is_over(loop, "no_result")


def _is_over(loop: Loop, why: str) -> None:
    ended = Said((), (), why)
    assert loop.ended(MOVE_TO_CHARGER) == ended
    assert loop.seen(IN_CORRIDOR, loop.ask()) == ended
    assert loop.check() == ended
