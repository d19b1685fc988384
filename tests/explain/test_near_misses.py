"""Tests of near misses."""

from tumato_symbolic import parse
from tumato_symbolic.explain.near_misses import MOST_OUTCOMES, near_misses
from tumato_symbolic.semantics import NOTHING

VALUES = ", ".join(f"v{number}" for number in range(10))
ANYTHING = ", ".join("(" + " OR ".join(f"{name} is v{number}" for number in range(10)) + ")" for name in "PQRS")


def test_sets_with_too_many_outcomes_are_passed_over() -> None:
    """Two actions with ten thousand effects each have a hundred million outcomes together: nobody lists these."""
    spec = parse(
        f"BEGIN STATE VECTOR {' '.join(f'state {name} can be {VALUES}' for name in 'PQRS')} END STATE VECTOR"
        f" BEGIN ACTIONS action a nominal effects: none alternative effects: {ANYTHING}"
        f" action b nominal effects: none alternative effects: {ANYTHING} END ACTIONS"
        " BEGIN STATE RULES rule: NOT (P is v1 AND Q is v2) END STATE RULES"
    )
    found = near_misses(spec, (1, 2, 0, 0), "any")
    assert [miss.chosen for miss in found.misses] == [NOTHING, frozenset({0}), frozenset({1})]
    assert found.passed_over == 1
    assert len(spec.actions[0].effects) <= MOST_OUTCOMES
