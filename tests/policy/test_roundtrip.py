"""What is written is what is read."""

import json
from pathlib import Path
from random import Random

import jsonschema
import pytest
from hypothesis import given
from hypothesis import strategies as st
from msgspec.structs import replace

from tests.policy.strategies import QUICK, amr_like, policies
from tumato_symbolic.diagnostics import UserError
from tumato_symbolic.policy import Policy, Table, Vocabulary, as_diagram, as_table, dumps, fits_table, loads

SCHEMA = json.loads(Path(__file__).parents[2].joinpath("tumato_symbolic/policy/policy.schema.json").read_text())


@QUICK
@given(policies())
def test_a_policy_survives_its_text(policy: Policy) -> None:
    """`loads(dumps(p)) == p` for every policy, table or diagram, with every section or none."""
    assert loads(dumps(policy)) == policy


@QUICK
@given(policies())
def test_equal_policies_have_equal_text(policy: Policy) -> None:
    """The text depends on the policy alone, not on the order in which it was made."""
    again = loads(dumps(policy))
    if isinstance(again.decisions, Table):
        again = replace(again, decisions=Table(dict(reversed(list(again.decisions.rows.items())))))
    assert dumps(again) == dumps(policy)


@QUICK
@given(policies())
def test_every_text_satisfies_the_schema(policy: Policy) -> None:
    """`policy.schema.json` accepts whatever `dumps` writes."""
    jsonschema.Draft202012Validator(SCHEMA).validate(json.loads(dumps(policy)))


def test_the_schema_is_a_schema() -> None:
    """`policy.schema.json` is valid JSON Schema 2020-12."""
    jsonschema.Draft202012Validator.check_schema(SCHEMA)


@QUICK
@given(policies(forms=("table",)), st.randoms(use_true_random=False))
def test_order_in_the_file_means_nothing(policy: Policy, random: Random) -> None:
    """Rows, actions, variables of a row, values and sections may come in any order, rows and actions repeatedly."""
    document = json.loads(dumps(policy))
    shuffled = dict(random.sample(sorted(document.items()), len(document)))
    shuffled["States"] = {
        name: dict(random.sample(sorted(values.items()), len(values))) for name, values in document["States"].items()
    }
    rows = [{**row, "Actions": random.sample(row["Actions"], len(row["Actions"]))} for row in document["Policy"]]
    rows = [dict(random.sample(sorted(row.items()), len(row))) for row in rows + rows[:2]]
    for row in rows[:1]:
        row["Actions"] = row["Actions"] * 2
    random.shuffle(rows)
    shuffled["Policy"] = rows
    assert loads(json.dumps(shuffled)) == policy


def test_the_table_of_tumato_2_is_read() -> None:
    """A table without any of our sections, and with sections that nobody knows, is a policy."""
    text = """{"PolicyFrameworkVersion": "0.0.0", "Type": "policy", "Actions": ["b", "a"],
      "States": {"S": {"on": 0, "off": 1}}, "Whatever": {"a": [1.5, {}]},
      "Policy": [{"S": "off", "Actions": []}, {"Actions": ["a", "b"], "S": "on"}]}"""
    vocabulary = Vocabulary((("S", ("on", "off")),), ("b", "a"))
    assert loads(text) == Policy(vocabulary, Table({(0,): frozenset({0, 1}), (1,): frozenset()}))


def test_a_reader_of_tumato_2_finds_its_table() -> None:
    """The envelope has the old keys with the old shapes, one row per line, in row-major order."""
    text = dumps(amr_like())
    document = json.loads(text)
    assert document["PolicyFrameworkVersion"] == "0.0.0"
    assert document["Type"] == "policy"
    assert document["Actions"] == ["go", "load", "stop"]
    assert document["States"] == {"S_Place": {"dock": 0, "hall": 1}, "S_Load": {"free": 0, "full": 1, "odd": 2}}
    assert document["Policy"][2] == {"S_Place": "hall", "S_Load": "free", "Actions": ["go", "stop"]}
    assert '    {"S_Place": "hall", "S_Load": "free", "Actions": ["go", "stop"]},\n' in text
    assert text.endswith("}\n")


def test_a_variable_named_actions_is_written_as_a_diagram() -> None:
    """The table cannot hold a variable called `Actions`; the diagram can, and decides the same."""
    policy = Policy(Vocabulary((("Actions", ("x", "y")),), ("a",)), Table({(1,): frozenset({0})}))
    assert not fits_table(policy.vocabulary)
    read = loads(dumps(policy))
    assert read.decisions == as_diagram(policy)
    assert as_table(read, 10) == policy.decisions


def test_a_diagram_that_is_not_reduced_is_reduced() -> None:
    """Repeated and superfluous nodes and nodes that nobody needs are accepted, and gone afterwards."""
    document = json.loads(dumps(amr_like(diagram=True)))
    clean = document["Diagram"]
    base, shift = len(clean["Leaves"]), 3
    moved = [[level, [ref if ref < base else ref + shift for ref in below]] for level, below in clean["Nodes"]]
    useless = [[1, [1, 0, 0]], [1, [1, 0, 0]], [0, [2, 3]]]
    roots = {name: root if root < base else root + shift for name, root in clean["Roots"].items()}
    document["Diagram"] = {**clean, "Nodes": useless + moved, "Roots": roots, "Defined": clean["Defined"] + shift}
    assert loads(json.dumps(document)) == amr_like(diagram=True)


@pytest.mark.parametrize("version", [0, 2, -1, 1.0, True, "1", None])
def test_another_version_is_refused(version: object) -> None:
    """`FormatVersion`, where there is one, is the number 1."""
    document = {**json.loads(dumps(amr_like())), "FormatVersion": version}
    with pytest.raises(UserError, match="TUM502: `FormatVersion` is"):
        loads(json.dumps(document))
