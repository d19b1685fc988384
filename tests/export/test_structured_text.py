"""Policies in Structured Text: executed as the text says, and read by a parser of the language."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import pytest

from tests.export.mixed import FROM_STARTS, mixed
from tests.export.policies import EXAMPLES, decisions, example, exported, random_request, request, written
from tumato_symbolic.export import structured_text
from tumato_symbolic.export.request import Request
from tumato_symbolic.export.structured_text import Names

try:
    from blark.parse import parse_source_code
except ImportError:
    parse_source_code = None

needs_blark = pytest.mark.skipif(
    parse_source_code is None, reason="blark is not installed: no block is read by a parser that is not ours"
)

_EXPRESSION = {"=": "==", "AND": "and", "OR": "or", "NOT": "not", "(": "(", ")": ")"}


def program(text: str) -> tuple[Mapping[str, int], Sequence[str], Any]:
    """The numbers of the enumeration constants, the inputs, and the body as a function of Python over a dict."""
    text = re.sub(r"\(\*.*?\*\)", "", text, flags=re.DOTALL)
    listed = re.findall(r"TYPE\s+\w+ : \((.*?)\);\s+END_TYPE", text)
    constants = {name: number for values in listed for number, name in enumerate(values.split(", "))}
    assert len(constants) == sum(values.count(",") + 1 for values in listed)
    inputs = re.findall(r"(\w+) : \w+;", text[text.index("VAR_INPUT") : text.index("END_VAR")])
    body = text[text.rindex("END_VAR") + len("END_VAR") : text.index("END_FUNCTION_BLOCK")]
    scope: dict[str, Any] = {}
    exec("\n".join(["def body(v):", *_lines(re.sub(r"\n +OR", " OR", body), 1)]), scope)
    return constants, inputs, scope["body"]


def _lines(body: str, depth: int) -> Iterator[str]:
    """Each statement of the body, which stand on lines of their own."""
    for line in filter(None, map(str.strip, body.splitlines())):
        word = line.split()[0].rstrip(";")
        depth -= word in {"ELSIF", "ELSE", "END_IF"}
        if word in {"IF", "ELSIF"}:
            assert line.endswith(" THEN")
            text = f"{'if' if word == 'IF' else 'elif'} {_value(line[len(word) : -len(' THEN')])}:"
        elif word in {"ELSE", "END_IF"}:
            text = {"ELSE": "else:", "END_IF": "pass"}[word]
        elif line in {"RETURN;", ";"}:
            text = {"RETURN;": "return", ";": "pass"}[line]
        else:
            name, assigned = line.removesuffix(";").split(" := ")
            text = f"v[{name!r}] = {_value(assigned)}"
        yield "    " * depth + text
        depth += word in {"IF", "ELSIF", "ELSE"}


def _value(expression: str) -> str:
    def read(match: re.Match[str]) -> str:
        token = match[0]
        return _EXPRESSION.get(token) or (token.capitalize() if token in {"TRUE", "FALSE"} else f"v[{token!r}]")

    return re.sub(r"\w+|[=()]", read, expression)


def answers(made: Request, states: Sequence[Sequence[int]]) -> list[tuple[str, ...] | str]:
    """What the block says of states: the status where that is not `decided`, else the actions."""
    names = Names.of(made)
    constants, inputs, body = program(structured_text.files(made)[0])
    assert inputs == list(names.inputs)
    statuses = {constants[f"{names.prefix}_{each}"]: each for each in ("invalid", "undecided", "decided")}
    found: list[tuple[str, ...] | str] = []
    for state in states:
        values: dict[str, Any] = {**constants, **dict(zip(inputs, state, strict=True))}
        body(values)
        executed = zip(made.policy.vocabulary.actions, names.outputs, strict=True)
        chosen = tuple(action for action, output in executed if values[output])
        status = statuses[values["status"]]
        assert status == "decided" or not chosen
        found.append(chosen if status == "decided" else status)
    return found


def _compare(made: Request) -> None:
    said = list(decisions(made))
    expected = ["undecided" if actions is None else actions for _, actions in said]
    assert answers(made, [state for state, _ in said]) == expected


@pytest.mark.parametrize("name", EXAMPLES)
def test_every_example_decides_as_decide_does(name: str) -> None:
    """In every state."""
    _compare(example(name))


@pytest.mark.parametrize("seed", range(12))
def test_random_policies_with_nasty_names(seed: int) -> None:
    """Words of the language, names that differ in case alone, undecided states."""
    _compare(random_request(seed))


def test_policies_from_starts() -> None:
    """What is not decided has the status that says so."""
    _compare(exported(mixed(FROM_STARTS[0])[0]))


@needs_blark
@pytest.mark.parametrize("name", ["coin", "lid"])
def test_a_parser_of_the_language_reads_it(name: str) -> None:
    """Types, then the block; with every variable and every statement."""
    made = example(name)
    *types, block = parse_source_code(structured_text.files(made)[0]).transform().items
    assert len(types) == len(made.spec.variables) + 1
    inputs, outputs = block.declarations
    assert len(inputs.items) == len(made.spec.variables)
    assert len(outputs.items) == 1 + len(made.spec.actions)
    assert len(block.body.statements) == len(made.spec.actions) + 4


def test_values_out_of_range_are_invalid() -> None:
    """Each input is checked, and no output is true then."""
    bad = [tuple(value if place == other else 0 for other in range(4)) for place in range(4) for value in (4, -1)]
    assert answers(example("amr"), bad) == ["invalid"] * len(bad)


def test_identifiers_are_those_of_the_standard() -> None:
    """No two differ in case alone, none ends with `_` or has two in a row, none is a word of the language."""
    spec = written(
        {"Case": "a__b, A_b, on_", "_x": "b, B"},
        ["status", "STATUS_", "charge", "Charge", "end__if", "end_if", "POLICY_status"],
    )
    names = Names.of(request(spec, {}))
    listed = [*names.types, *names.inputs, *names.outputs, *(value for values in names.values for value in values)]
    assert len({each.lower() for each in listed}) == len(listed)
    assert not [
        each for each in listed if "__" in each or each.endswith("_") or each.upper() in {"CASE", "IF", "STATUS"}
    ]
