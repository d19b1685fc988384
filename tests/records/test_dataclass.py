"""Our dataclasses are those of the standard library, made later."""

from __future__ import annotations

import copy
import dataclasses
import inspect
import pickle
from collections.abc import Callable
from dataclasses import FrozenInstanceError, field, fields, replace
from functools import cached_property
from typing import Any, ClassVar, get_type_hints

import pytest

from tumato_symbolic import records

FROZEN = {"frozen": True}, {"frozen": True, "slots": True}
SETTINGS: tuple[dict[str, bool], ...] = ({}, {"slots": True}, *FROZEN, {"frozen": True, "eq": False, "repr": False})


def _point(decorated: Callable[[type], type]) -> Any:
    class Point:
        """With every kind of field that ours may have."""

        kind: ClassVar[str] = "point"
        x: int
        y: int = 0
        seen: list[int] = field(default_factory=list, hash=False)
        note: str = field(default="", repr=False, compare=False)
        found: str | None = field(default=None, init=False, repr=False, compare=False)
        later: list[int] = field(default_factory=list, init=False, hash=False)

    return decorated(Point)


def _derived(decorated: Callable[[type], type]) -> Any:
    class Base:
        """What another one extends."""

        first: int
        total: int = field(init=False, repr=False, compare=False)

        def __post_init__(self) -> None:
            """Set what is derived."""
            object.__setattr__(self, "total", self.first + 1)

    base: Any = decorated(Base)

    class Derived(base):  # type: ignore[misc]  # made by a decorator that is an argument
        """With one more, and another name for the first in its text."""

        second: int = 2

    return decorated(Derived)


def _both(make: Callable[[Any], Any], settings: dict[str, bool]) -> tuple[Any, Any]:
    return make(dataclasses.dataclass(**settings)), make(records.dataclass(**settings))


def _parameters(made: type) -> list[tuple[object, ...]]:
    known = inspect.signature(made).parameters.values()
    return [(each.name, each.kind, each.annotation, each.default is each.empty) for each in known]


@pytest.mark.parametrize("settings", SETTINGS)
@pytest.mark.parametrize("make", [_point, _derived])
def test_the_same_of_the_same_fields(make: Callable[[Any], Any], settings: dict[str, bool]) -> None:
    """Parameters, text, equality, hash and patterns are those of the standard library."""
    theirs, ours = _both(make, settings)
    assert _parameters(ours) == _parameters(theirs)
    assert get_type_hints(ours.__init__) == get_type_hints(theirs.__init__)
    assert [each.name for each in fields(ours)] == [each.name for each in fields(theirs)]
    assert ours.__match_args__ == theirs.__match_args__
    assert (ours.__hash__ is None) == (theirs.__hash__ is None)
    for values in ((1,), (1, 5)):
        their, our = theirs(*values), ours(*values)
        assert dataclasses.asdict(our) == dataclasses.asdict(their)
        assert (our == ours(*values), our == ours(7)) == (their == theirs(*values), their == theirs(7))
        assert our != their
        if settings.get("repr", True):
            assert repr(our) == repr(their)
        if settings.get("eq", True) and settings.get("frozen"):
            assert hash(our) == hash(their)


@pytest.mark.parametrize("settings", SETTINGS)
def test_what_may_be_left_out(settings: dict[str, bool]) -> None:
    """Defaults, one of its own for each where it is made anew; what is missing or unknown is refused."""
    ours = _point(records.dataclass(**settings))
    one, other = ours(1), ours(1)
    assert (one.y, one.note, one.seen, one.found, one.later) == (0, "", [], None, [])
    assert one.seen is not other.seen
    assert replace(one, y=3).y == 3
    for wrong in ({}, {"x": 1, "z": 2}):
        with pytest.raises(TypeError, match="__init__"):
            ours(**wrong)


@pytest.mark.parametrize("settings", FROZEN)
def test_nothing_frozen_changes(settings: dict[str, bool]) -> None:
    """Not by assignment and not by deletion; the same is said of it as by the standard library."""
    for made in _both(_derived, settings):
        record = made(1)
        with pytest.raises(FrozenInstanceError, match="cannot assign to field 'first'"):
            record.first = 2
        with pytest.raises(FrozenInstanceError, match="cannot delete field 'second'"):
            del record.second
    with pytest.raises(FrozenInstanceError):
        record.third = 3  # of ours; the standard library forgets which class it has made anew for its slots


def test_what_is_no_field_may_be_remembered() -> None:
    """A frozen record remembers what it has computed, and a class that extends it has what it likes."""

    class Plain(_Remembering):
        def __init__(self) -> None:
            super().__init__(2)
            self.other = 5

    assert (_Remembering(2).twice, Plain().twice, Plain().other) == (4, 4, 5)
    with pytest.raises(FrozenInstanceError):
        Plain().number = 3  # type: ignore[misc]  # the mistake is meant


@records.dataclass(frozen=True)
class _Remembering:
    number: int

    @cached_property
    def twice(self) -> int:
        return 2 * self.number


@records.dataclass(frozen=True, slots=True)
class _Slotted:
    number: int
    rest: _Slotted | None = None


@pytest.mark.parametrize("record", [_Slotted(1, _Slotted(2)), _Remembering(3)])
def test_it_can_be_copied_and_sent(record: Any) -> None:
    """Copies, also through a pickle, are equal, and as frozen."""
    for other in (copy.copy(record), copy.deepcopy(record), pickle.loads(pickle.dumps(record))):
        assert other == record
        with pytest.raises(FrozenInstanceError):
            other.number = 1


def test_a_text_that_contains_itself_ends() -> None:
    """As in the standard library."""

    @records.dataclass
    class Node:
        name: str
        below: list[object]

    node = Node("n", [])
    node.below.append(node)
    assert repr(node).endswith("Node(name='n', below=[...])")


def test_own_methods_stay() -> None:
    """What a class says itself is not replaced."""

    @records.dataclass(frozen=True, slots=True)
    class Own:
        number: int

        def __repr__(self) -> str:
            return "own"

        def __hash__(self) -> int:
            return 5

    assert (repr(Own(1)), hash(Own(1)), Own(1) == Own(1)) == ("own", 5, True)


def test_a_method_is_compiled_once_and_only_where_it_is_used() -> None:
    """Until a method is looked up, there is none; then it is a function like others."""
    made = _point(records.dataclass(frozen=True))
    assert not inspect.isfunction(vars(made)["__init__"])
    made(1)
    assert inspect.isfunction(vars(made)["__init__"])
    assert not inspect.isfunction(vars(made)["__eq__"])
