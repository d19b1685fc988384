"""Looking up what to do."""

from pathlib import Path
from typing import Any, Literal
from unittest.mock import patch

import pytest
from hypothesis import given

from tests.policy.strategies import QUICK, amr_like, policies, rows_of
from tumato_symbolic import Realizable, parse, synthesize
from tumato_symbolic.diagnostics import UserError
from tumato_symbolic.policy import Policy, UndecidedState, dumps, parse_assignments, parse_state


@QUICK
@given(policies())
def test_decide_is_the_row(policy: Policy) -> None:
    """In every decided state: the actions of its row, by name, in the order of declaration."""
    variables, actions = policy.vocabulary.variables, policy.vocabulary.actions
    for state, chosen in rows_of(policy).items():
        named = {name: values[value] for (name, values), value in zip(variables, state, strict=True)}
        assert policy.decide(named) == tuple(name for number, name in enumerate(actions) if number in chosen)


@QUICK
@given(policies(forms=("diagram",)))
def test_what_is_forgotten_is_found_again(policy: Policy) -> None:
    """Answers are the same when almost nothing is remembered, in whatever order states are asked."""
    variables, actions = policy.vocabulary.variables, policy.vocabulary.actions
    rows = list(rows_of(policy).items())
    with patch("tumato_symbolic.policy.lookup.deciders._MOST_REMEMBERED", 2):
        for state, chosen in rows + rows[::-1]:
            named = {name: values[value] for (name, values), value in zip(variables, state, strict=True)}
            assert policy.decide(named) == tuple(name for number, name in enumerate(actions) if number in chosen)


@pytest.mark.parametrize("diagram", [False, True])
def test_an_undecided_state_has_its_own_error(diagram: bool) -> None:
    """A state of the policy that it does not decide is a ValueError that carries the state."""
    state = {"S_Load": "odd", "S_Place": "hall"}
    with pytest.raises(UndecidedState, match="S_Load is odd") as raised:
        amr_like(diagram).decide(state)
    assert isinstance(raised.value, ValueError)
    assert raised.value.state == state


WRONG = [
    ({"S_Place": "hall"}, "TUM503", "`S_Load` has no value"),
    ({"S_Place": "hall", "S_Load": "free", "X": "free"}, "TUM503", "no variable `X`"),
    ({"S_Place": "hall", "S_Laod": "free"}, "TUM503", "no variable `S_Laod`"),
    ({"S_Place": "hall", "S_Load": "fre"}, "TUM504", "`S_Load` has no value `fre`"),
    ({"S_Place": "hall", "S_Load": 1}, "TUM504", "`S_Load` has no value `1`"),
    ({"S_Place": "hall", "S_Load": True}, "TUM504", "the value of `S_Load` is true"),
    ({"S_Place": "hall", "S_Load": 1.0}, "TUM504", "the value of `S_Load` is a number"),
    ({"S_Place": "hall", "S_Load": ["free"]}, "TUM504", "the value of `S_Load` is a list"),
    ({"S_Place": "hall", "S_Load": None}, "TUM504", "the value of `S_Load` is null"),
    ({"S_Place": "hall", 3: "free"}, "TUM503", "a number is not the name of a variable"),
    ({}, "TUM503", "`S_Place` has no value"),
    (None, "TUM509", "is not of type NoneType"),
    ("ab", "TUM509", "is not of type str"),
    ([("S_Place", "hall"), ("S_Load", "free")], "TUM509", "is not of type list"),
    (("hall", "free"), "TUM509", "is not of type tuple"),
    (2, "TUM509", "is not of type int"),
]


@pytest.mark.parametrize(("state", "code", "message"), WRONG)
@pytest.mark.parametrize("diagram", [False, True])
def test_what_is_no_state_is_a_user_error(state: Any, code: str, message: str, diagram: bool) -> None:
    """Unknown variables, unknown values and missing variables are told apart from undecided states."""
    with pytest.raises(UserError) as raised:
        amr_like(diagram).decide(state)
    assert raised.value.diagnostics[0].code.name == code
    assert message in raised.value.diagnostics[0].message


def test_words_describe_a_state() -> None:
    """`VARIABLE=VALUE` words in any order give a state; the same word twice is harmless."""
    words = ["S_Load=free", "S_Place=hall", "S_Load=free"]
    assert amr_like().decide(parse_assignments(amr_like().vocabulary, words)) == ("go", "stop")


@pytest.mark.parametrize(
    ("words", "code", "message", "way_out"),
    [
        (["S_Place=hall", "S_Load"], "TUM509", "`S_Load` is not of the form VARIABLE=VALUE", None),
        (["S_Place=hall", "S_Place=dock", "S_Load=odd"], "TUM509", "given two values, `hall` and `dock`", None),
        (["S_Place=hall", "S_Loed=odd"], "TUM503", "no variable `S_Loed`", "did you mean `S_Load`?"),
        (["S_Place=haul", "S_Load=odd"], "TUM504", "no value `haul`", "did you mean `hall`?"),
        (["S_Place=qqq", "S_Load=odd"], "TUM504", "no value `qqq`", "values: `dock` and `hall`"),
        (["S_Place=hall"], "TUM503", "`S_Load` has no value", "its values: `free`, `full` and `odd`"),
    ],
)
def test_wrong_words_have_a_way_out(words: list[str], code: str, message: str, way_out: str | None) -> None:
    """Every mistake on the command line names the word and what could be meant."""
    with pytest.raises(UserError) as raised:
        parse_assignments(amr_like().vocabulary, words)
    first = raised.value.diagnostics[0]
    assert (first.code.name, first.help) == (code, way_out)
    assert message in first.message


def test_a_line_describes_a_state() -> None:
    """One JSON object per line gives a state."""
    assert parse_state(amr_like().vocabulary, '{"S_Load": "free", "S_Place": "dock"}\n') == {
        "S_Load": "free",
        "S_Place": "dock",
    }


@pytest.mark.parametrize(
    "line",
    [
        "",
        "[]",
        "3",
        '{"S_Load": 3.0}',
        '{"S_Load": true}',
        '{"S_Load": "free", "S_Load": "full"}',
        "{",
        "NaN",
        "[" * 10**5,
        '{"a": "\\ud800"}',
    ],
)
def test_a_wrong_line_is_a_user_error(line: str) -> None:
    """What is no JSON object of strings and whole numbers is TUM509, whatever it is."""
    with pytest.raises(UserError) as raised:
        parse_state(amr_like().vocabulary, line)
    assert raised.value.diagnostics[0].code.name == "TUM509"


@pytest.mark.parametrize("form", ["table", "diagram"])
def test_numbers_are_numbers_or_their_digits(form: Literal["table", "diagram"]) -> None:
    """A value that is a number may be given as either; nothing else passes for a number."""
    text = "BEGIN STATE VECTOR state N can be -1..1 state B can be 0, 1 END STATE VECTOR"
    found = synthesize(parse(text), policy_format=form)
    assert isinstance(found, Realizable)
    assert found.policy.decide({"N": -1, "B": 0}) == found.policy.decide({"N": "-1", "B": "0"}) == ()
    assert parse_state(found.policy.vocabulary, '{"N": 1, "B": "0"}') == {"N": "1", "B": "0"}
    for wrong in (True, 1.0, "01", "+1", 2, None):
        with pytest.raises(UserError):
            found.policy.decide({"N": 0, "B": wrong})  # type: ignore[dict-item]


def test_load_and_decide(tmp_path: Path) -> None:
    """`Policy.load(path).decide({...})` is all that a controller needs."""
    path = tmp_path / "policy.json"
    path.write_text(dumps(amr_like()))
    assert Policy.load(path).decide({"S_Place": "dock", "S_Load": "free"}) == ("load",)
    assert Policy.load(str(path)).decide({"S_Place": "dock", "S_Load": "full"}) == ()
