"""How variants are divided among those who work, and what becomes of portions that are lost."""

import json
from concurrent.futures import Future

import pytest

from tests.sweep.here import KNOWN, PLAN, run, shuffling, whole
from tumato_symbolic.sweep.portions import Portion, Portions, Workers
from tumato_symbolic.sweep.tasks import NOTHING, Answer, Reply
from tumato_symbolic.sweep.variants import Variant


def portions_of(number: int, hands: int = 2, seconds: float = 1.0) -> Portions:
    """So many variants for so many who work."""
    return Portions(map(Variant, range(number)), Workers(lambda _: Future(), lambda: hands, seconds))


def reply(answers: int, seconds: float) -> Reply:
    """So many answers."""
    return Reply((Answer(NOTHING),) * answers, seconds)


def next_of(portions: Portions, under_way: int = 0) -> Portion:
    """The next portion, which there is."""
    portion = portions.next(under_way)
    assert portion is not None
    return portion


def numbers(portion: Portion) -> list[int]:
    """Which variants they are."""
    return [each.number for each in portion.variants]


def sizes(portions: Portions, each: float) -> list[int]:
    """The sizes of all portions where every variant takes so many seconds."""
    found: list[int] = []
    while (portion := portions.next(0)) is not None:
        found.append(len(portion.variants))
        portions.replied(portion, reply(found[-1], each * found[-1]))
    return found


def test_few_at_first_and_few_at_last() -> None:
    """In between, as many as take as long as they should."""
    found = sizes(portions_of(500), 0.025)
    assert found[:2] == [1, 40]
    assert max(found) == 40
    assert found[2:] == sorted(found[2:], reverse=True)
    assert found[-1] <= 4
    assert sum(found) == 500
    assert len(found) < 30


def test_long_ones_go_one_by_one() -> None:
    """Also with many who work, and where there is one variant only."""
    assert sizes(portions_of(20, hands=8), 3.0) == [1] * 20
    assert sizes(portions_of(1), 0.001) == [1]
    assert sizes(portions_of(0), 1.0) == []


def test_no_more_is_handed_over_than_can_be_worked_on() -> None:
    """Two portions for each who works."""
    portions = portions_of(100)
    assert [portions.next(under_way) is None for under_way in (0, 3, 4, 5)] == [False, False, True, True]


def test_what_has_no_answer_comes_next() -> None:
    """In its order, before what was not asked for."""
    portions = portions_of(100)
    portions.replied(next_of(portions), reply(1, 0.1))
    portion = next_of(portions)
    assert numbers(portion) == list(range(1, 11))
    portions.replied(portion, reply(4, 0.4))
    assert numbers(next_of(portions)) == list(range(5, 15))


def test_what_is_lost_is_asked_for_alone() -> None:
    """One by one, last, while nothing else is under way; also what was handed over by itself."""
    portions = portions_of(21, seconds=0.05)
    single, another = next_of(portions), next_of(portions)
    portions.replied(another, reply(1, 0.01))
    several = next_of(portions, 1)
    assert len(several.variants) == 5
    portions.lost(several)
    portions.lost(single)
    rest: list[int] = []
    while (portion := portions.next(1)) is not None:
        assert not portion.alone
        rest += numbers(portion)
    assert rest == list(range(7, 21))
    again = [next_of(portions) for _ in range(6)]
    assert [numbers(each) for each in again] == [[2], [3], [4], [5], [6], [0]]
    assert all(each.alone for each in again)
    assert portions.next(0) is None


@pytest.mark.parametrize("seed", range(5))
def test_only_one_that_kills_is_lost(seed: int) -> None:
    """All others are answered, with the same bytes, whatever they were asked for with."""
    guilty = PLAN.variants[5]
    text = guilty.text(PLAN.source)
    found = run(None, shuffling(seed, KNOWN, deadly=lambda task: task.text == text)).splitlines()
    others = whole().splitlines()
    place = guilty.number + 1
    assert found[:place] + found[place + 1 :] == others[:place] + others[place + 1 :]
    line = json.loads(found[place])
    assert (line["verdict"], line["limit"], line["differs"]) == ("undecided", "it was killed", None)


def test_a_specification_that_kills_is_undecided() -> None:
    """Nothing is compared with it; the others are solved."""
    found = run(None, shuffling(0, {}, deadly=lambda task: task.policy)).splitlines()
    lines = [json.loads(each) for each in found[1:]]
    assert [each["variant"] for each in lines] == list(range(len(PLAN.variants)))
    assert lines[0]["verdict"] == "undecided"
    assert {each["verdict"] for each in lines[1:]} == {"realizable"}
    assert {each["differs"] for each in lines} == {None}
