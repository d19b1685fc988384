"""What JSON a policy may be: keys, nesting, numbers, and how values are numbered."""

import json
from typing import Any

import pytest

from tests.policy.strategies import amr_like
from tumato_symbolic.diagnostics import UserError
from tumato_symbolic.policy import dumps, loads
from tumato_symbolic.policy.text import Row, parse_json


def numbered(*firsts: int, diagram: bool = False) -> str:
    """The policy with the values of its variables numbered from these numbers on."""
    document = json.loads(dumps(amr_like(diagram=diagram)))
    for values, first in zip(document["States"].values(), firsts, strict=True):
        values.update({value: number + first for value, number in values.items()})
    return json.dumps(document)


@pytest.mark.parametrize("diagram", [False, True])
def test_values_may_be_numbered_from_one(diagram: bool) -> None:
    """Where no value of any variable has the number 0, counting begins with 1; the policy is the same."""
    assert loads(numbered(1, 1, diagram=diagram)) == amr_like(diagram=diagram)


@pytest.mark.parametrize("firsts", [(0, 1), (1, 0), (2, 2), (1, 2), (-1, -1)])
def test_other_numbers_are_refused(firsts: tuple[int, ...]) -> None:
    """All variables are numbered alike, from 0 or from 1."""
    with pytest.raises(UserError, match="TUM502: the index of"):
        loads(numbered(*firsts))


@pytest.mark.parametrize(
    "section", ['{"a": 1, "a": 1}', '[[{"Actions": [], "b": 0, "Actions": []}]]', '{"x": {"y": [{"z": 0, "z": 1}]}}']
)
def test_a_key_comes_once(section: str) -> None:
    """A key that comes twice spoils the file, also in a section that nobody knows."""
    with pytest.raises(UserError, match=r"TUM502: an object has the key `\w+` twice"):
        loads(dumps(amr_like()).replace('"Type"', f'"Remarks": {section}, "Type"'))


@pytest.mark.parametrize(("start", "end"), [("[", "]"), ('{"a":', "}"), ('[{"Actions":', "}]")])
def test_nesting_ends_at_a_hundred_levels(start: str, end: str) -> None:
    """The object of the file is the first level."""
    levels = 99 // (start.count("[") + start.count("{"))
    for depth, fits in ((levels, True), (levels + 1, False), (5000, False)):
        text = dumps(amr_like()).replace('"Type"', f'"Remarks": {start * depth}0{end * depth}, "Type"', 1)
        if fits:
            assert loads(text) == amr_like()
        else:
            with pytest.raises(UserError, match="TUM501: objects and lists are nested more than 100 levels deep"):
                loads(text)


def test_rows_share_what_is_equal() -> None:
    """Equal names, texts and lists of rows are one object each; an object that is no row stays as it is."""
    rows: Any = parse_json(
        '[{"S": "on", "Actions": ["a"]}, {"S": "on", "Actions": ["a"]}, {"S": 1, "Actions": ["a"]},'
        ' {"S": true, "Actions": ["a"]}, {"S": 1.0, "Actions": ["a"]}]',
        "rows",
    )
    one, other, number, *odd = rows
    assert one == other == Row(("S",), ("on",), ["a"])
    assert all(first is second for first, second in zip(one, other, strict=True) if type(first) is not tuple)
    assert one.names is other.names
    assert number == Row(("S",), ("1",), ["a"])
    assert [json.dumps(each) for each in odd] == ['{"S": true, "Actions": ["a"]}', '{"S": 1.0, "Actions": ["a"]}']


@pytest.mark.parametrize("actions", ["", "a", {}, {"a": 1}, None, [["a"]], [1], 0])
def test_what_is_no_list_of_actions_is_no_row(actions: object) -> None:
    """Not even after rows whose actions would look alike as a sequence."""
    rows = [{"S": "on", "Actions": each} for each in ([], ["a"], actions)]
    found: Any = parse_json(json.dumps(rows), "rows")
    assert found[2] == rows[2]
