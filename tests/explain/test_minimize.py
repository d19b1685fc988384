"""Tests of minimal sets."""

from collections.abc import Callable, Iterable
from itertools import combinations
from random import Random

import pytest

from tumato_symbolic.explain.hitting_sets import SearchedHittingSets
from tumato_symbolic.explain.minimize import minimal
from tumato_symbolic.limits import LimitReachedError
from tumato_symbolic.synthesis.solver import HittingSets


def meets(needs: Iterable[frozenset[int]]) -> Callable[[frozenset[int]], bool]:
    """Whether one of some needs is among the items: a monotone question."""
    return lambda some: any(need <= some for need in needs)


def test_minimal_sets_are_enough_and_minimal() -> None:
    """Against random monotone questions: enough, and nothing can be left out."""
    random = Random(1)
    for _ in range(200):
        items = range(random.randint(1, 9))
        needs = [frozenset(random.sample(items, random.randint(0, len(items)))) for _ in range(3)]
        found = minimal(items, meets(needs))
        assert any(need <= found for need in needs)
        assert not any(need <= found - {item} for need in needs for item in found)


def test_earlier_items_are_preferred() -> None:
    """An item is in it only where all earlier items, with the later ones that are in it, are not enough."""
    random = Random(3)
    for _ in range(300):
        items = range(random.randint(1, 12))
        needs = [frozenset(random.sample(items, random.randint(0, len(items)))) for _ in range(4)]
        expected = frozenset(items)
        for item in reversed(items):
            if any(need <= expected - {item} for need in needs):
                expected -= {item}
        assert minimal(items, meets(needs)) == expected


@pytest.mark.parametrize(
    ("size", "needed", "most"), [(200, 1, 16), (200, 5, 65), (60, 60, 70), (15, 15, 20), (1, 1, 1)]
)
def test_few_questions_are_asked(size: int, needed: int, most: int) -> None:
    """About `k log(n / k)` where few items are needed, and about `n` where nearly all are."""
    random = Random(size)
    for _ in range(20):
        core = frozenset(random.sample(range(size), needed))
        asked: list[int] = []

        def enough(some: frozenset[int], core: frozenset[int] = core, asked: list[int] = asked) -> bool:
            asked.append(len(some))
            return core <= some

        assert minimal(range(size), enough) == core
        assert len(asked) <= most


@pytest.mark.parametrize("kind", [HittingSets, SearchedHittingSets])
def test_smallest_hitting_sets_come_in_order(kind: type[HittingSets] | type[SearchedHittingSets]) -> None:
    """All minimal hitting sets, the smallest first, and of one size the least penalty first."""
    random = Random(2)
    for _ in range(40):
        size = random.randint(1, 6)
        penalties = [random.randint(0, 3) for _ in range(size)]
        sets = [frozenset(random.sample(range(size), random.randint(1, size))) for _ in range(4)]
        search, found = kind(penalties), []
        for each in sets:
            search.require(sorted(each))
        while (best := search.smallest()) is not None:
            found.append(best)
            search.exclude(sorted(best))
        hitting = [frozenset(some) for n in range(size + 1) for some in combinations(range(size), n)]
        hitting = [some for some in hitting if all(some & each for each in sets)]
        expected = {some for some in hitting if not any(other < some for other in hitting)}
        assert set(found) == expected
        ranked = [(len(some), sum(penalties[number] for number in some)) for some in found]
        assert ranked == sorted(ranked)


def test_both_searches_for_hitting_sets_answer_alike() -> None:
    """Z3 and the search name the same sets in the same order, also where what is excluded was never an answer."""
    random = Random(7)
    for _ in range(60):
        size = random.randint(1, 9)
        penalties = [random.randint(0, 2) for _ in range(size)]
        searches = HittingSets(penalties), SearchedHittingSets(penalties)
        for answers in range(12):
            numbers = sorted(random.sample(range(size), random.randint(1, min(3, size))))
            for search in searches:
                search.require(numbers)
            found = [search.smallest() for search in searches]
            assert found[0] == found[1]
            if found[0] is None:
                break
            if answers % 2:
                excluded = sorted(found[0]) if answers % 3 else sorted(random.sample(range(size), min(2, size)))
                for search in searches:
                    search.exclude(excluded)
            else:
                for search in searches:
                    search.penalize(numbers[:1], 2)


@pytest.mark.parametrize("kind", [HittingSets, SearchedHittingSets])
def test_nothing_hits_the_empty_set(kind: type[HittingSets] | type[SearchedHittingSets]) -> None:
    """Where a set to be hit is empty, there is no hitting set."""
    search = kind([0, 0])
    search.require([])
    assert search.smallest() is None


def test_the_search_for_hitting_sets_ends_in_time() -> None:
    """Pigeons and holes, which take Z3 for ever: the search ends by the time that is left."""
    holes, pigeons = 12, 13
    search = HittingSets([0] * holes * pigeons, lambda: 0.2)
    for pigeon in range(pigeons):
        search.require([pigeon * holes + hole for hole in range(holes)])
    for hole in range(holes):
        for one, other in combinations(range(pigeons), 2):
            search.exclude([one * holes + hole, other * holes + hole])
    with pytest.raises(LimitReachedError):
        search.smallest()
