"""In which order predicates are conjoined."""

from __future__ import annotations

from itertools import combinations
from math import factorial

from hypothesis import given
from hypothesis import strategies as st

from tumato_symbolic import parse
from tumato_symbolic.diagrams import conjoin
from tumato_symbolic.spec import Spec
from tumato_symbolic.symbolic import encode
from tumato_symbolic.verify.by_diagrams.steps import Steps

PLACES = 7
LEVELS = st.sets(st.integers(0, 5)).map(sorted)


@given(st.lists(LEVELS))
def test_every_predicate_is_conjoined_once(levels: list[list[int]]) -> None:
    """Whatever they test, each predicate is in the conjunction, and only once."""
    predicates = [(number,) for number in range(len(levels))]

    def join(one: tuple[int, ...], other: tuple[int, ...]) -> tuple[int, ...]:
        return one + other

    found = conjoin(predicates, lambda each: levels[each[0]], join, ())
    assert sorted(found) == list(range(len(levels)))


def test_the_lowest_come_first() -> None:
    """What tests the same variables first is conjoined first, and of these conjunctions the lowest."""
    pairs = [f"{one}{other}" for one, other in combinations("0123", 2)]

    def join(one: str, other: str) -> str:
        return f"({one} {other})" if one else other

    assert conjoin(pairs, lambda pair: [*map(int, pair)], join, "") == "((23 (13 12)) ((03 02) 01))"


def test_few_are_conjoined_as_they_come() -> None:
    """Nobody asks what three predicates test."""
    assert conjoin(["a", "b", "c"], lambda each: [][len(each)], lambda one, other: one + other, "") == "abc"


def different(count: int) -> Spec:
    """So many things in as many places, no two in the same, declared as is worst."""
    values = ", ".join(f"p{place}" for place in range(count))
    states = "\n".join(f"state v{thing} can be {values}" for thing in range(count))
    rules = "\n".join(
        "assume: NOT (" + " OR ".join(f"(v{one} is p{place} AND v{other} is p{place})" for place in range(count)) + ")"
        for other in range(count)
        for one in range(other)
    )
    return parse(
        f"BEGIN STATE VECTOR\n{states}\nEND STATE VECTOR\nBEGIN ASSUMPTIONS\n{rules}\nEND ASSUMPTIONS\n"
        "BEGIN GOALS goal type: priority goal: true END GOALS"
    )


def test_the_engine_conjoins_pairs_in_little_room() -> None:
    """That no two of seven things are in one place is found with five times as many nodes as it has, at most."""
    spec = different(PLACES)
    encoding = encode(spec, "autoref")
    valid = encoding.states_where(rule.formula for rule in spec.assumptions)
    assert encoding.count_states(valid) == factorial(PLACES)
    assert len(encoding.manager._bdd) < 5 * encoding.manager.nodes(valid)


def test_the_walk_conjoins_pairs_in_little_room() -> None:
    """That no two of seven things are in one place takes a third of the steps that it takes as declared."""
    steps = Steps(different(PLACES), "any", range(PLACES))
    assert steps.count(steps.valid) == factorial(PLACES)
    assert steps.walk.remembered < 2_500
