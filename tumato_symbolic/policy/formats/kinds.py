"""Kinds of values in files: how each is read, how it is written, and how a JSON Schema describes it."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any, Generic, TypeAlias, TypeVar

from msgspec import Struct

from tumato_symbolic.diagnostics import Code
from tumato_symbolic.diagnostics.wording import count
from tumato_symbolic.policy.records import Vocabulary
from tumato_symbolic.policy.text import (
    as_list,
    as_names,
    as_object,
    as_text,
    as_value,
    as_whole,
    fault,
    show,
    way_out,
    wrong,
)
from tumato_symbolic.semantics import ActionSet, Effort, State
from tumato_symbolic.spec import Assignment, value_of

Value = TypeVar("Value")
Schema: TypeAlias = dict[str, Any]


class Names:
    """What a file means by names and by numbers.

    `counts` says how many there are of what it refers to by number: `reference` (to a diagram), `goal`, `choice`.
    """

    def __init__(self, vocabulary: Vocabulary) -> None:
        self.counts: dict[str, int] = {}
        self.use(vocabulary)

    def use(self, vocabulary: Vocabulary) -> None:
        """Take names from this vocabulary."""
        self.vocabulary = vocabulary
        self._actions = {name: number for number, name in enumerate(vocabulary.actions)}
        self._variables = {name: number for number, (name, _) in enumerate(vocabulary.variables)}
        self._values = [{value: number for number, value in enumerate(values)} for _, values in vocabulary.variables]

    def action(self, value: object, where: str) -> int:
        """The number of an action."""
        name = as_text(value, where)
        if name not in self._actions:
            message = f"{where} mentions the unknown action {show(name)}"
            raise fault(Code.TUM505, message, way_out(name, self._actions, "actions"))
        return self._actions[name]

    def actions(self, value: object, where: str) -> tuple[int, ...]:
        """The numbers of different actions."""
        return tuple(self.action(name, where) for name in as_names(value, where))

    def assignment(self, value: object, where: str) -> Assignment:
        """Values of some variables."""
        return tuple(sorted(self._assigned(name, each, where) for name, each in as_object(value, where).items()))

    def state(self, value: object, where: str) -> State:
        """A value for every variable."""
        values = dict(self.assignment(value, where))
        for name, number in self._variables.items():
            if number not in values:
                raise fault(Code.TUM503, f"{where} has no value for {show(name)}")
        return tuple(values[number] for number in range(len(values)))

    def _assigned(self, name: str, value: object, where: str) -> tuple[int, int]:
        if name not in self._variables:
            message = f"{where} has the unknown variable {show(name)}"
            raise fault(Code.TUM503, message, way_out(name, self._variables, "variables"))
        variable = self._variables[name]
        text, known = as_value(value, f"{show(name)} in {where}"), self._values[variable]
        if text not in known:
            message = f"{where} gives {show(name)} the unknown value {show(text)}"
            raise fault(Code.TUM504, message, way_out(text, known, "values"))
        return variable, known[text]

    def of_actions(self, numbers: Iterable[int]) -> list[str]:
        """The names of actions, in the order given."""
        return [self.vocabulary.actions[number] for number in numbers]

    def of_values(self, assignment: Iterable[tuple[int, int]]) -> dict[str, str | int]:
        """Value by variable."""
        variables = self.vocabulary.variables
        return {variables[number][0]: value_of(variables[number][1][value]) for number, value in assignment}


class Kind(Struct, Generic[Value], frozen=True, eq=False):
    """A kind of value: from JSON (and what it is called in messages), to JSON, and its JSON Schema."""

    read: Callable[[object, str, Names], Value]
    write: Callable[[Value, Names], Any]
    schema: Schema


def _as_it_is(value: Value, _: Names) -> Value:
    return value


_NAMES: Schema = {"type": "array", "items": {"type": "string"}, "uniqueItems": True}
VALUE: Schema = {"type": ["string", "integer"]}
_BY_VARIABLE: Schema = {"description": "Value by variable.", "type": "object", "additionalProperties": VALUE}


def _as_values(value: object, where: str) -> tuple[str, ...]:
    """A list of different values."""
    return as_names([as_value(each, f"an entry of {where}") for each in as_list(value, where)], where)


TEXT = Kind[str](lambda value, where, _: as_text(value, where), _as_it_is, {"type": "string"})
TEXTS = Kind[tuple[str, ...]](lambda value, where, _: as_names(value, where), _as_it_is, _NAMES)
ACTION = Kind[int](
    lambda value, where, names: names.action(value, where),
    lambda number, names: names.vocabulary.actions[number],
    {"type": "string"},
)
ACTION_SET = Kind[ActionSet](
    lambda value, where, names: frozenset(names.actions(value, where)),
    lambda numbers, names: names.of_actions(sorted(numbers)),
    _NAMES,
)
ACTION_NAMES = Kind[tuple[str, ...]](
    lambda value, where, names: tuple(names.of_actions(names.actions(value, where))), _as_it_is, _NAMES
)
STATE = Kind[State](
    lambda value, where, names: names.state(value, where),
    lambda state, names: names.of_values(enumerate(state)),
    _BY_VARIABLE,
)
VALUE_SETS = Kind[dict[str, tuple[str, ...]]](
    lambda value, where, _: {name: _as_values(each, where) for name, each in as_object(value, where).items()},
    lambda sets, _: {name: [value_of(value) for value in values] for name, values in sets.items()},
    {"type": "object", "additionalProperties": {"type": "array", "items": VALUE, "uniqueItems": True}},
)
ASSIGNMENT = Kind[Assignment](
    lambda value, where, names: names.assignment(value, where),
    lambda assignment, names: names.of_values(assignment),
    _BY_VARIABLE,
)


def actions(number: int) -> Kind[tuple[int, ...]]:
    """So many different actions."""

    def read(value: object, where: str, names: Names) -> tuple[int, ...]:
        found = names.actions(value, where)
        if len(found) != number:
            raise fault(Code.TUM502, f"{where} has {count(len(found), 'entry', 'entries')}, expected {number}")
        return found

    schema = {**_NAMES, "minItems": number, "maxItems": number}
    return Kind(read, lambda numbers, names: names.of_actions(numbers), schema)


def whole(counted: str | None = None, least: int = 0) -> Kind[int]:
    """A whole number that is not less than `least`, and smaller than how many there are of what is `counted`."""

    def read(value: object, where: str, names: Names) -> int:
        found = as_whole(value, where, None if counted is None else names.counts[counted])
        if found < least:
            raise fault(Code.TUM502, f"{where} is {found}, expected a number from {least}")
        return found

    return Kind(read, _as_it_is, {"type": "integer", "minimum": least})


def one_of(*words: str) -> Kind[Any]:
    """One of some words."""
    expected = " or ".join(filter(None, (", ".join(f'"{word}"' for word in words[:-1]), f'"{words[-1]}"')))

    def read(value: object, where: str, _: Names) -> object:
        if value not in words:
            raise wrong(where, expected, value)
        return value

    return Kind(read, _as_it_is, {"const": words[0]} if len(words) == 1 else {"enum": list(words)})


def optional(kind: Kind[Value]) -> Kind[Value | None]:
    """The same, or null."""
    return Kind(
        lambda value, where, names: None if value is None else kind.read(value, where, names),
        lambda value, names: None if value is None else kind.write(value, names),
        {**kind.schema, "type": [kind.schema["type"], "null"]},
    )


def listed(kind: Kind[Value], *, filled: bool = False, distinct: bool = False) -> Kind[tuple[Value, ...]]:
    """A list of these; `filled` is not empty, and in one that is `distinct` nothing stands twice."""

    def read(value: object, where: str, names: Names) -> tuple[Value, ...]:
        entries = filled_list(value, where) if filled else as_list(value, where)
        found = tuple(kind.read(entry, f"an entry of {where}", names) for entry in entries)
        if distinct and len(set(found)) != len(found):
            raise fault(Code.TUM502, f"{where} has an entry twice")
        return found

    schema: Schema = {"type": "array", "items": kind.schema}
    schema |= {"minItems": 1} if filled else {}
    schema |= {"uniqueItems": True} if distinct else {}
    return Kind(read, lambda values, names: [kind.write(value, names) for value in values], schema)


def filled_list(value: object, where: str) -> list[Any]:
    """A list that is not empty."""
    entries = as_list(value, where)
    if not entries:
        raise fault(Code.TUM502, f"{where} is empty")
    return entries


def _both(value: object, where: str, _: Names) -> tuple[bool, ...]:
    leaves = filled_list(value, where)
    if leaves != [False, True] or any(type(leaf) is not bool for leaf in leaves):
        raise fault(Code.TUM502, f"{where} must be [false, true]")
    return False, True


def _effort(value: object, where: str, _: Names) -> Effort:
    pair = as_list(value, where)
    if len(pair) != 2:
        raise fault(Code.TUM502, f"{where} is {show(pair)}, expected null or a duration and a number of steps")
    return as_whole(pair[0], where), as_whole(pair[1], where)


REFERENCE = whole("reference")
TRUTH = Kind[tuple[bool, ...]](_both, _as_it_is, {"const": [False, True]})
RANKS = listed(optional(whole()), filled=True, distinct=True)
EFFORT = Kind[Effort](_effort, _as_it_is, {"type": "array", "items": whole().schema, "minItems": 2, "maxItems": 2})
EFFORTS = listed(optional(EFFORT), filled=True, distinct=True)
