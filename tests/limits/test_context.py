"""The context of long work: deadline, progress, what is known."""

import math
import time

import pytest

from tumato_symbolic.limits import Budget, Context, LimitReachedError, Limits


def test_without_limits_nothing_ends() -> None:
    """A context without limits never raises, and says that there is no end."""
    context = Context()
    context.check()
    assert context.seconds_left() is None
    assert Budget(None, context).until() == math.inf


def test_a_limit_says_which_and_during_what() -> None:
    """The message names the limit and the stage."""
    context = Context(Limits(seconds=1000.0))
    context.tell("proving goals")
    context.deadline = time.monotonic()
    with pytest.raises(LimitReachedError, match=r"^the time limit of 1000 s was met while proving goals$"):
        context.check()
    with pytest.raises(LimitReachedError):
        context.tell("proving minimal")
    described = Context(Limits(megabytes=20)).described("memory")
    assert described == "the memory limit of 20 MB was met while starting"


def test_a_part_ends_no_later_than_the_whole() -> None:
    """A part has its own limit, the whole's where that comes first, and tells what it does through the whole."""
    told: list[str] = []
    learned: list[object] = []
    whole = Context(Limits(seconds=1000.0), told.append)
    part, longer = whole.within(0.0, learned.append), whole.within(5000.0)
    with pytest.raises(LimitReachedError, match="limit of 0 s"):
        part.check()
    whole.check()
    assert (longer.deadline, longer.limits) == (whole.deadline, whole.limits)
    longer.tell("in the part")
    part.learn(7)
    assert (told, learned, whole.known) == (["in the part"], [7], None)


def test_a_budget_is_for_each_part() -> None:
    """Every part of the work has the same time, less what it took already, and never more than the whole."""
    context, now = Context(Limits(seconds=1000.0)), time.monotonic()
    assert now + 20 <= Budget(30.0, context).until(spent=10.0) < now + 30
    assert Budget(3000.0, context).until() == context.deadline


def test_a_stage_counts_until_the_next_begins(monkeypatch: pytest.MonkeyPatch) -> None:
    """Seconds go to the stage that stood; one that comes again goes on, in a part as well."""
    clock = iter([0.0, 1.0, 3.0, 3.0, 4.0, 4.0, 9.0])
    monkeypatch.setattr(time, "monotonic", lambda: next(clock))
    context = Context()
    context.tell("one")
    context.tell("other")
    part = context.within()
    part.enter("one")
    assert context.stages() == {"starting": 1.0, "one": 7.0, "other": 1.0}
