"""What may stand at a place."""

from random import Random

import pytest

from tests.editor.texts import plain_text
from tumato_symbolic.diagnostics import Source
from tumato_symbolic.editor.completion import completions
from tumato_symbolic.editor.mentions import index
from tumato_symbolic.syntax.parser import expected_at, read_terminals

DECLARED = """\
BEGIN STATE VECTOR
state S_A can be on, off
state S_N can be 0..2
END STATE VECTOR
BEGIN ALIASES
define bright as S_A is on
define LISTED as {x, y}
END ALIASES
BEGIN RESOURCES
resource R
END RESOURCES
"""
FIELDS = [
    "alternative effects: ",
    "controlled resources: ",
    "duration: ",
    "for",
    "nominal effects: ",
    "preconditions: ",
]
PREDICATE = ["S_A", "S_N", "bright", "IF", "NOT", "all", "exactly one ", "executing", "false", "some", "true"]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("‸", ["BEGIN STATE VECTOR", "BEGIN ALIASES", "BEGIN RESOURCES"]),
        ("BEGIN ‸", ["STATE VECTOR", "ALIASES", "RESOURCES", "ACTIONS"]),
        ("BEGIN ACTIONS\naction go\n  ‸", ["END ACTIONS", "action", *FIELDS]),
        ("BEGIN ACTIONS\naction go\n  nominal ‸", ["effects: "]),
        ("BEGIN ACTIONS\naction go\n  controlled resources: ‸", ["R", "END ACTIONS"]),
        ("BEGIN ACTIONS\naction go\n  nominal effects: S_A is ‸\nEND ACTIONS", ["on", "off", "not"]),
        ("BEGIN STATE RULES\nrule: ‸\nEND STATE RULES", PREDICATE),
        ("BEGIN STATE RULES\nrule: S_A is o‸\nEND STATE RULES", ["on", "off", "not"]),
        ("BEGIN STATE RULES\nrule: S_N not in {0, ‸", ["0", "1", "2"]),
        ("BEGIN STATE RULES\nrule: S_N >= ‸", ["0", "1", "2", "S_N"]),
        ("BEGIN STATE RULES\nrule: S_A is on ‸", ["AND", "END STATE RULES", "IFONLYIF", "OR"]),
        ("BEGIN STATE RULES\nrule: NOT S_A is not off AND ‸", PREDICATE[:3]),
        ("BEGIN STATE RULES\nfor Q in ‸", ["LISTED"]),
        ("BEGIN REACTION RULES\nrule: executing ‸", []),
        ("BEGIN GOALS\n‸", ["END GOALS", "goal type: priority", "goal type: constraint"]),
        ("BEGIN GOALS\ngoal type: priority\nwhen S_A is on ‸", ["AND", "IFONLYIF", "OR", "then"]),
    ],
)
def test_what_is_offered(text: str, expected: list[str]) -> None:
    """Names of the right kind first, in their order, then the words of the language that fit."""
    before, after = (DECLARED + text).split("‸")
    source = Source("text", before + after)
    line, column = before.count("\n") + 1, len(before.rpartition("\n")[2]) + 1
    found = [each.text for each in completions(source, index(source), line, column)]
    assert found[: len(expected)] == expected
    assert expected or not found


@pytest.mark.parametrize("seed", range(15))
def test_what_stands_there_is_expected(seed: int) -> None:
    """At each of some tokens of a text without mistakes, what the token was read as is among what may stand there."""
    source = Source("text", plain_text(seed))
    _, tokens, terminals = read_terminals(source)
    apart = [
        place for place in range(1, len(tokens) - 1) if tokens[place].span.column > tokens[place - 1].span.end_column
    ]
    for place in Random(seed).sample(apart, min(8, len(apart))):
        read = {"FOR_ACTIONS": "for", "FOR_CLAUSES": "for"}.get(terminals[place], terminals[place])
        assert read in expected_at(source, tokens[place].line, tokens[place].column).terminals, tokens[place]
