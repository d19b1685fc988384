"""`dataclass`: what that of the standard library makes, in a tenth of its time.

The standard library writes and compiles the methods of a dataclass where it is defined, six of them for a frozen one.
A command defines two hundred such classes, and calls few of their methods. Here those in which speed counts are
compiled when they are first looked up, and all classes share the others.
"""

from __future__ import annotations

import dataclasses
import sys
from collections.abc import Callable, Iterator, Sequence
from dataclasses import MISSING, Field, FrozenInstanceError, fields
from functools import partial
from reprlib import recursive_repr
from typing import TYPE_CHECKING, Any, cast

if TYPE_CHECKING:
    from dataclasses import dataclass
else:

    def dataclass(cls: type | None = None, /, **wanted: bool) -> Any:  # noqa: ANN401 - a class, or what makes one
        """With `frozen`, `slots`, `eq` and `repr`, which are what they are for `dataclasses.dataclass`."""
        return partial(_defined, **wanted) if cls is None else _defined(cls, **wanted)


__all__ = ["dataclass"]


def _defined(cls: type, *, frozen: bool = False, slots: bool = False, eq: bool = True, repr: bool = True) -> type:
    made: Any = dataclasses.dataclass(init=False, repr=False, eq=False, slots=slots)(cls)
    methods: dict[str, object] = {"__init__": _Later(partial(_init, frozen=frozen), made)}
    if repr:
        methods["__repr__"] = _repr
    if eq:
        methods |= {"__eq__": _Later(_eq, made), "__hash__": _Later(_hash, made) if frozen else None}
    if frozen:
        methods |= {"__setattr__": _setattr, "__delattr__": _delattr}
    if frozen and slots:
        methods |= {"__getstate__": _getstate, "__setstate__": _setstate}
    for name, method in methods.items():
        if vars(cls).get(name) is None:
            setattr(made, name, method)
    return cast("type", made)


class _Later:
    """A method that is made when it is first looked up, and then takes this one's place."""

    def __init__(self, make: Callable[[type], Any], owner: type) -> None:
        self._make, self._owner = make, owner

    def __get__(self, instance: object, owner: type | None = None) -> Any:  # noqa: ANN401 - a method or its function
        method = self._make(self._owner)
        type.__setattr__(self._owner, method.__name__, method)
        return method.__get__(instance, owner)


def _init(cls: type, frozen: bool) -> Any:  # noqa: ANN401 - a function with the fields as its parameters
    taken = [each for each in fields(cls) if each.init]
    known: dict[str, object] = {"_set": object.__setattr__, "_missing": MISSING}
    for each in fields(cls):
        known |= {f"_default_{each.name}": each.default, f"_make_{each.name}": each.default_factory}
    body = [f"_set(self, {name!r}, {value})" if frozen else f"self.{name} = {value}" for name, value in _values(cls)]
    if hasattr(cls, "__post_init__"):
        body.append("self.__post_init__()")
    made = _compiled(cls, f"__init__({', '.join(['self', *map(_parameter, taken)])})", body or ["pass"], known)
    made.__annotations__ = {each.name: each.type for each in taken} | {"return": None}
    return made


def _parameter(each: Field[Any]) -> str:
    if each.default_factory is not MISSING:
        return f"{each.name}=_missing"
    return each.name if each.default is MISSING else f"{each.name}=_default_{each.name}"


def _values(cls: type) -> Iterator[tuple[str, str]]:
    """The fields that have a value from the start, and what it is."""
    for each in fields(cls):
        name, made = each.name, f"_make_{each.name}()"
        if each.default_factory is not MISSING:
            yield name, f"{made} if {name} is _missing else {name}" if each.init else made
        elif each.init:
            yield name, name
        elif each.default is not MISSING:
            yield name, f"_default_{name}"


def _eq(cls: type) -> Any:  # noqa: ANN401
    names = [each.name for each in fields(cls) if each.compare]
    equal = f"{_tuple('self', names)} == {_tuple('other', names)}"
    body = [f"return {equal} if other.__class__ is self.__class__ else NotImplemented"]
    return _compiled(cls, "__eq__(self, other)", body, {})


def _hash(cls: type) -> Any:  # noqa: ANN401
    names = [each.name for each in fields(cls) if (each.compare if each.hash is None else each.hash)]
    return _compiled(cls, "__hash__(self)", [f"return hash({_tuple('self', names)})"], {})


def _tuple(record: str, names: Sequence[str]) -> str:
    return f"({''.join(f'{record}.{name}, ' for name in names)})"


def _compiled(cls: type, head: str, body: Sequence[str], known: dict[str, object]) -> Any:  # noqa: ANN401
    """A method of a class in whose body some more values are known than in its module."""
    name = head.partition("(")[0]
    lines = f"def within({', '.join(known)}):", f" def {head}:", *(f"  {line}" for line in body), f" return {name}"
    found: dict[str, Any] = {}
    exec("\n".join(lines), vars(sys.modules[cls.__module__]), found)
    made = found["within"](**known)
    made.__qualname__ = f"{cls.__qualname__}.{name}"
    return made


@recursive_repr("...")
def _repr(self: Any) -> str:  # noqa: ANN401 - any dataclass, here and below
    shown = (f"{each.name}={getattr(self, each.name)!r}" for each in fields(self) if each.repr)
    return f"{type(self).__qualname__}({', '.join(shown)})"


def _setattr(self: Any, name: str, value: object) -> None:  # noqa: ANN401
    _refuse(self, name, "assign to")
    object.__setattr__(self, name, value)


def _delattr(self: Any, name: str) -> None:  # noqa: ANN401
    _refuse(self, name, "delete")
    object.__delattr__(self, name)


def _refuse(record: Any, name: str, what: str) -> None:  # noqa: ANN401
    """Raise where a frozen record would change; what a subclass adds that is no dataclass itself may."""
    if "__dataclass_fields__" in vars(type(record)) or name in record.__dataclass_fields__:
        raise FrozenInstanceError(f"cannot {what} field {name!r}")


def _getstate(self: Any) -> list[object]:  # noqa: ANN401
    return [getattr(self, each.name) for each in fields(self)]


def _setstate(self: Any, state: list[object]) -> None:  # noqa: ANN401
    for each, value in zip(fields(self), state, strict=True):
        object.__setattr__(self, each.name, value)
