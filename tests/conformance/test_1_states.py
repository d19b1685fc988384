"""Section 1 of docs/semantics.md: states."""

from tests.conformance.asking import Asked
from tests.conformance.roles import Reader, Stepper
from tests.conformance.rules import rule
from tests.conformance.world import text


@rule("1.1")
def test_every_combination_of_values_is_a_state(stepper: Stepper) -> None:
    """Without assumptions and state rules all of them are valid and safe, whatever the numbers of values."""
    asked = Asked(stepper, text({"x": "abc", "y": "a", "z": "de"}))
    assert asked.valid() == asked.safe() == "aad aae bad bae cad cae"


@rule("1.2")
def test_a_state_is_valid_when_every_assumption_holds(stepper: Stepper) -> None:
    """One that fails is enough, and state rules play no part."""
    asked = Asked(
        stepper,
        text(
            {"x": "abc", "y": "ab"},
            ASSUMPTIONS="assume: NOT x is c assume: x is a OR y is a",
            STATE_RULES="rule: x is b",
        ),
    )
    assert asked.valid() == "aa ab ba"


@rule("1.2")
def test_without_any_valid_state_a_specification_is_in_error(reader: Reader) -> None:
    """Also where each assumption alone holds somewhere; one valid state is enough."""
    variables = {"x": "ab", "y": "ab"}
    assert reader.refuses(text(variables, ASSUMPTIONS="assume: x is a assume: y is b assume: NOT (x is a AND y is b)"))
    assert not reader.refuses(text(variables, ASSUMPTIONS="assume: x is a assume: y is b"))


@rule("1.3")
def test_a_state_is_safe_when_it_is_valid_and_every_state_rule_holds(stepper: Stepper) -> None:
    """One rule that fails is enough; an invalid state is not safe, whatever the rules say; unsafe states are valid."""
    asked = Asked(
        stepper,
        text(
            {"x": "abc", "y": "ab"},
            ASSUMPTIONS="assume: NOT (x is a AND y is a)",
            STATE_RULES="rule: NOT x is c rule: IF y is b THEN x is a",
        ),
    )
    assert asked.valid() == "ab ba bb ca cb"
    assert asked.safe() == "ab ba"
