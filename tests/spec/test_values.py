"""Predicates about values, and values that are numbers: what they are written out as."""

import pytest

from tests.spec.marked import loaded
from tumato_symbolic.spec import FALSE, TRUE, And, Formula, Is, Not, Or, digest

VECTOR = """BEGIN STATE VECTOR
state N can be 0..3
state M can be 2, -1, 0
state S can be a, b, not
END STATE VECTOR
"""


def formula(predicate: str) -> Formula:
    """What a state rule means."""
    found = loaded(f"{VECTOR}BEGIN STATE RULES rule: {predicate} END STATE RULES")
    assert found.spec is not None, found.diagnostics
    return found.spec.state_rules[0].formula


def n(value: int) -> Is:
    """`N` has a value."""
    return Is(0, value)


TWO, MINUS_ONE, ZERO = Is(1, 0), Is(1, 1), Is(1, 2)
A, B, NOT = Is(2, 0), Is(2, 1), Is(2, 2)


@pytest.mark.parametrize(
    ("predicate", "meaning"),
    [
        ("S is not a", Not(A)),
        ("S is not", NOT),
        ("S is not not", Not(NOT)),
        ("S is not AND N is 1", And((NOT, n(1)))),
        ("S in {b, a}", Or((A, B))),
        ("S in {b, b}", B),
        ("S not in {not, a}", Not(Or((A, NOT)))),
        ("S in {a} OR N is 3", Or((A, n(3)))),
        ("S in {a, b} OR N is 3", Or((Or((A, B)), n(3)))),
        ("N in {2..9, 0}", Or((n(0), n(2), n(3)))),
        ("M in {-1..1}", Or((MINUS_ONE, ZERO))),
        ("N = 3", n(3)),
        ("N != 3", Not(n(3))),
        ("N < 2", Or((n(0), n(1)))),
        ("N<=2", Or((n(0), n(1), n(2)))),
        ("N > 2", n(3)),
        ("N >= 4", FALSE),
        ("N>-4", TRUE),
        ("M <= 0", Or((MINUS_ONE, ZERO))),
        ("N < M", Or((And((n(0), TWO)), And((n(1), TWO))))),
        ("M < N", Or((And((TWO, n(3))), MINUS_ONE, And((ZERO, Or((n(1), n(2), n(3)))))))),
        ("N = M", Or((And((n(0), ZERO)), And((n(2), TWO))))),
        ("N != M", Or((And((n(0), Not(ZERO))), n(1), And((n(2), Not(TWO))), n(3)))),
    ],
)
def test_predicates_are_written_out(predicate: str, meaning: Formula) -> None:
    """Values in the order of their declaration, whatever order they are listed in."""
    assert formula(predicate) == meaning


def test_a_range_declares_its_numbers() -> None:
    """In order, among other values."""
    found = loaded("BEGIN STATE VECTOR state S can be off, -1..2, 7 END STATE VECTOR").spec
    assert found is not None
    assert found.variables[0].values == ("off", "-1", "0", "1", "2", "7")


def test_what_is_written_out_by_hand_has_the_same_digest() -> None:
    """Policies fit both."""
    short = loaded(f"{VECTOR}BEGIN STATE RULES rule: N > 1 AND S is not a END STATE RULES").spec
    long_vector = VECTOR.replace("0..3", "0, 1, 2, 3")
    long = loaded(f"{long_vector}BEGIN STATE RULES rule: (N is 2 OR N is 3) AND NOT S is a END STATE RULES").spec
    assert short is not None
    assert long is not None
    assert digest(short) == digest(long)


def test_not_goes_on_as_a_value() -> None:
    """Where a field, a block or a goal follows, `not` is the value: older texts keep their meaning."""
    text = f"""{VECTOR}BEGIN ACTIONS
    action one preconditions: S is not nominal effects: S is not alternative effects: S is not duration: 1
    action two preconditions: S is not, S is not action three nominal effects: S is not a, S is not b
    END ACTIONS
    BEGIN GOALS goal type: priority when S is not then goal: S is not when S is a then goal: S is not END GOALS"""
    found = loaded(text).spec
    assert found is not None
    assert [each.name for each in found.actions] == ["one", "two", "three"]
    assert found.actions[2].nominal == ((2, 2),)
    assert [each.formula for each in found.bodies] == [NOT]
