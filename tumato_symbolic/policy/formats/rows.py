"""Tables in policy files: a row for every state that is decided, rows that are wrong or contradict."""

from __future__ import annotations

from collections.abc import Iterator
from json import dumps as _json
from typing import Any

from tumato_symbolic.diagnostics import Code, UserError
from tumato_symbolic.diagnostics.wording import listed
from tumato_symbolic.policy.formats.kinds import VALUE, Names, Schema
from tumato_symbolic.policy.formats.tables import Attributes, Block, Part, Place, block
from tumato_symbolic.policy.records import Table, Vocabulary
from tumato_symbolic.policy.text import (
    Row,
    as_list,
    as_object,
    as_text,
    as_value,
    described,
    fault,
    member,
    show,
    way_out,
    wrong,
)
from tumato_symbolic.semantics import ActionSet, State
from tumato_symbolic.spec import value_of

ROWS: Schema = {
    "description": "One row for every state that is decided: value by variable, and the actions executed at the same "
    "time.",
    "type": "array",
    "items": {
        "type": "object",
        "required": ["Actions"],
        "minProperties": 2,
        "properties": {"Actions": {"type": "array", "items": {"type": "string"}}},
        "additionalProperties": VALUE,
    },
}


class RowsPart(Part):
    """The decisions of a policy as rows."""

    def read(self, section: dict[str, Any], place: Place, names: Names) -> dict[str, Any]:
        """See `Part`."""
        return {"decisions": _table(member(section, "Policy", place.name), names.vocabulary)}

    def blocks(self, record: Attributes, names: Names, indent: str) -> Iterator[Block]:
        """See `Part`."""
        yield block(f'{indent}"Policy": [', _rows(record.decisions, names.vocabulary), "]")

    def describe(self) -> tuple[dict[str, Schema | bool], list[str]]:
        """See `Part`."""
        return {"Policy": ROWS}, ["Policy"]


def fits_table(vocabulary: Vocabulary) -> bool:
    """Whether rows can hold a policy: a variable named `Actions` would share its key with the actions."""
    return all(name != "Actions" for name, _ in vocabulary.variables)


def _rows(table: Table, vocabulary: Vocabulary) -> Iterator[str]:
    cells = [[f"{_json(name)}: {_json(value_of(value))}" for value in values] for name, values in vocabulary.variables]
    names = {
        chosen: _json([vocabulary.actions[action] for action in sorted(chosen)]) for chosen in set(table.rows.values())
    }
    for state, chosen in sorted(table.rows.items()):
        shown = ", ".join([values[value] for values, value in zip(cells, state, strict=True)])
        yield f'{{{shown}, "Actions": {names[chosen]}}}'


def _table(section: object, vocabulary: Vocabulary) -> Table:
    if not fits_table(vocabulary):
        message = "a table cannot hold a variable named `Actions`: its value and the actions would share one key"
        raise fault(Code.TUM502, message, 'rename the variable, or use the type "policy-diagram"')
    entries = as_list(section, "`Policy`")
    decoder = _RowDecoder(vocabulary)
    rows: dict[State, ActionSet] = {}
    for place, row in enumerate(entries, 1):
        decoded = decoder.decode(row)
        if decoded is None:
            raise _bad_row(row, place, vocabulary)
        state, executed = decoded
        if rows.setdefault(state, executed) != executed:
            earlier = map(decoder.decode, entries)
            first = next(number for number, each in enumerate(earlier, 1) if each is not None and each[0] == state)
            raise _contradiction(vocabulary, state, first, place)
    return Table(dict(sorted(rows.items())))


class _RowDecoder:
    """Rows of a table to numbers."""

    def __init__(self, vocabulary: Vocabulary) -> None:
        self._values = {
            name: {value: number for number, value in enumerate(values)} for name, values in vocabulary.variables
        }
        self._actions = {name: number for number, name in enumerate(vocabulary.actions)}
        self._sets: dict[tuple[str, ...], ActionSet] = {}
        self._names: tuple[str, ...] = ()
        self._columns: list[tuple[int, dict[str, int]]] = []

    def decode(self, row: object) -> tuple[State, ActionSet] | None:
        """The state and its actions; None where the row does not have just what it should."""
        if type(row) is not Row:
            return None
        if row.names is not self._names:
            if row.names != tuple(self._values) and set(row.names) != set(self._values):
                return None
            self._names = row.names
            self._columns = [(row.names.index(name), numbers) for name, numbers in self._values.items()]
        texts = row.texts
        key = tuple(row.actions)
        try:
            state = tuple([numbers[texts[place]] for place, numbers in self._columns])
            executed = self._sets.get(key)
            if executed is None:
                executed = self._sets[key] = frozenset([self._actions[name] for name in key])
        except KeyError:
            return None
        return state, executed


def _bad_row(row: object, place: int, vocabulary: Vocabulary) -> UserError:
    """Why row number `place` cannot be read."""
    where = f"row {place} of `Policy`"
    section = as_object(row, where)
    values = dict(vocabulary.variables)
    for key in section:
        if key != "Actions" and key not in values:
            return fault(
                Code.TUM503, f"{where} has the unknown variable {show(key)}", way_out(key, values, "variables")
            )
    for name, known in values.items():
        if name not in section:
            return fault(Code.TUM503, f"{where} has no value for {show(name)}", f"its values: {listed(known)}")
        value = as_value(section[name], f"{show(name)} in {where}")
        if value not in known:
            message = f"{where} gives {show(name)} the unknown value {show(value)}"
            return fault(Code.TUM504, message, way_out(value, known, "values"))
    for action in as_list(member(section, "Actions", where), f"`Actions` in {where}"):
        name = as_text(action, f"an entry of `Actions` in {where}")
        if name not in vocabulary.actions:
            message = f"{where} executes the unknown action {show(name)}"
            return fault(Code.TUM505, message, way_out(name, vocabulary.actions, "actions"))
    return wrong(where, "a state and its actions", row)


def _contradiction(vocabulary: Vocabulary, state: State, first: int, second: int) -> UserError:
    named = {name: values[value] for (name, values), value in zip(vocabulary.variables, state, strict=True)}
    message = f"rows {first} and {second} of `Policy` decide the same state differently: {described(named)}"
    return fault(Code.TUM506, message, "keep one of the two rows")
