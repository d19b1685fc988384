"""Tables of fields: from one, a record is read from JSON, written to it, and described by a JSON Schema."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from json import dumps as _json
from typing import Any, Generic, NamedTuple, TypeAlias

from msgspec import Struct

from tumato_symbolic.diagnostics import Code
from tumato_symbolic.policy.formats.kinds import Kind, Names, Schema, Value, one_of
from tumato_symbolic.policy.text import as_list, as_object, fault, member

Attributes: TypeAlias = Any
"""A record, whose attributes tables find by name."""

NEEDED = object()
"""The default of a field that must be there."""

Block: TypeAlias = list[str]
"""The lines of a key and its value."""


class Place(NamedTuple):
    """An object in a file: what messages call it, and how they call its fields."""

    name: str
    style: Callable[[str, str], str]

    def of(self, key: str) -> str:
        """What messages call a field."""
        return self.style(self.name, key)


def plain(_: str, key: str) -> str:
    """How messages call a field of the whole file."""
    return f"`{key}`"


def dotted(name: str, key: str) -> str:
    """How messages call a field of a section."""
    return f"{name[:-1]}.{key}`"


def of(name: str, key: str) -> str:
    """How messages call a field of an entry."""
    return f"`{key}` of {name}"


def within(name: str, key: str) -> str:
    """How messages call a field of what is itself a field of an entry."""
    return f"`{key}` in {name}"


class Part:
    """Some keys of an object, and what they say of a record."""

    def read(self, section: dict[str, Any], place: Place, names: Names) -> dict[str, Any]:
        """What the keys say, by attribute. Raises `UserError`."""
        raise NotImplementedError

    def written(self, record: Attributes, names: Names) -> dict[str, Any]:
        """The keys with their values."""
        raise NotImplementedError

    def blocks(self, record: Attributes, names: Names, indent: str) -> Iterator[Block]:
        """The keys with their values, as text."""
        for key, value in self.written(record, names).items():
            yield [f'{indent}"{key}": {_json(value)}']

    def describe(self) -> tuple[dict[str, Schema | bool], list[str]]:
        """The JSON Schema of every key, and the keys that must be there."""
        raise NotImplementedError


class Record(Struct, Generic[Value], frozen=True, eq=False):
    """An object of a file as a record.

    `view` gives what is written of a record. `first` are parts that are read before others, which count on them;
    `without` are keys that the object must not have.
    """

    make: Callable[..., Value]
    parts: tuple[Part, ...]
    about: str = ""
    style: Callable[[str, str], str] = of
    view: Callable[[Value], Any] = lambda value: value
    first: tuple[Part, ...] = ()
    without: tuple[str, ...] = ()

    def read(self, value: object, where: str, names: Names, **known: object) -> Value:
        """From JSON. Raises `UserError`."""
        section, place, found = as_object(value, where), Place(where, self.style), known
        for key in self.without:
            if key in section:
                raise fault(Code.TUM502, f'{where} is of kind "{section["Kind"]}", and must not have `{key}`')
        for part in (*self.first, *(part for part in self.parts if part not in self.first)):
            found |= part.read(section, place, names)
        return self.make(**found)

    def write(self, value: Value, names: Names) -> dict[str, Any]:
        """To JSON."""
        record = self.view(value)
        return {key: each for part in self.parts for key, each in part.written(record, names).items()}

    def blocks(self, value: Value, names: Names, indent: str) -> Iterator[Block]:
        """To text."""
        record = self.view(value)
        for part in self.parts:
            yield from part.blocks(record, names, indent)

    @property
    def schema(self) -> Schema:
        """The JSON Schema."""
        properties, required = self.describe()
        return described(self.about, {"type": "object", "required": required, "properties": properties})

    def describe(self) -> tuple[dict[str, Schema | bool], list[str]]:
        """The JSON Schema of every key, and the keys that must be there."""
        each = [part.describe() for part in self.parts]
        properties = {key: schema for some, _ in each for key, schema in some.items()}
        return properties | dict.fromkeys(self.without, False), [key for _, needed in each for key in needed]


class Tagged(Struct, Generic[Value], frozen=True, eq=False):
    """Records of several kinds, told apart by the key `Kind` and the attribute `kind`, which may go without saying."""

    variants: Mapping[tuple[str, ...], Record[Any]]
    style: Callable[[str, str], str] = of
    told: bool = True

    def read(self, value: object, where: str, names: Names) -> Value:
        """From JSON. Raises `UserError`."""
        section, words = as_object(value, where), [word for some in self.variants for word in some]
        kind = one_of(*words).read(member(section, "Kind", where), self.style(where, "Kind"), names)
        found: Value = self._variant(kind).read(section, where, names, **({"kind": kind} if self.told else {}))
        return found

    def _variant(self, kind: str) -> Record[Any]:
        return next(record for some, record in self.variants.items() if kind in some)

    def write(self, value: Attributes, names: Names) -> dict[str, Any]:
        """To JSON."""
        return {"Kind": value.kind, **self._variant(value.kind).write(value, names)}

    def blocks(self, value: Attributes, names: Names, indent: str) -> Iterator[Block]:
        """To text."""
        yield [f'{indent}"Kind": "{value.kind}"']
        yield from self._variant(value.kind).blocks(value, names, indent)

    @property
    def schema(self) -> Schema:
        """The JSON Schema."""
        return {"type": "object", "required": ["Kind"], "oneOf": list(map(_variant_schema, self.variants.items()))}


def _variant_schema(variant: tuple[tuple[str, ...], Record[Any]]) -> Schema:
    words, record = variant
    properties, required = record.describe()
    schema: Schema = {"properties": {"Kind": one_of(*words).schema, **properties}}
    return described(record.about, {**schema, "required": required} if required else schema)


class Field(Struct, Part, frozen=True, eq=False):
    """A key for an attribute, its `name` or that of the key; where that equals the default, the key is left out.

    Where the name is "", `kind` says what is written and checks what is read.
    """

    key: str
    kind: Kind[Any] | Record[Any] | Tagged[Any]
    about: str = ""
    name: str | None = None
    default: Any = NEEDED

    def read(self, section: dict[str, Any], place: Place, names: Names) -> dict[str, Any]:
        """See `Part`."""
        value = self.default
        if self.default is NEEDED or self.key in section:
            value = self.kind.read(member(section, self.key, place.name), place.of(self.key), names)
        return {} if self.name == "" else {self.name or self.key.lower(): value}

    def _of(self, record: Attributes) -> Any:  # noqa: ANN401 - of a kind that the field knows
        return None if self.name == "" else getattr(record, self.name or self.key.lower())

    def written(self, record: Attributes, names: Names) -> dict[str, Any]:
        """See `Part`."""
        value = self._of(record)
        return {} if value == self.default else {self.key: self.kind.write(value, names)}

    def blocks(self, record: Attributes, names: Names, indent: str) -> Iterator[Block]:
        """See `Part`: a record on lines of its own."""
        if isinstance(self.kind, Kind):
            yield from super().blocks(record, names, indent)
        elif (value := self._of(record)) != self.default:
            inner = joined(self.kind.blocks(value, names, f"{indent}  "))
            yield [f'{indent}"{self.key}": {{', *inner, f"{indent}}}"]

    def describe(self) -> tuple[dict[str, Schema | bool], list[str]]:
        """See `Part`."""
        return {self.key: described(self.about, self.kind.schema)}, [self.key] if self.default is NEEDED else []


class Entries(Struct, Part, frozen=True, eq=False):
    """A list of records, on a line each; messages call them by a noun and a number, and so may the file (`counts`).

    `or_null`: null stands for None.
    """

    key: str
    kind: Record[Any] | Tagged[Any]
    noun: str
    about: str = ""
    first: int = 0
    or_null: bool = False

    def read(self, section: dict[str, Any], place: Place, names: Names) -> dict[str, Any]:
        """See `Part`."""
        value = member(section, self.key, place.name)
        if value is None and self.or_null:
            return {self.key.lower(): None}
        numbered = enumerate(as_list(value, place.of(self.key)), self.first)
        found = tuple(
            [self.kind.read(each, f"{self.noun} {number} of {place.name}", names) for number, each in numbered]
        )
        names.counts[self.noun] = len(found)
        return {self.key.lower(): found}

    def written(self, record: Attributes, names: Names) -> dict[str, Any]:
        """See `Part`."""
        entries = getattr(record, self.key.lower())
        return {self.key: None if entries is None else [self.kind.write(each, names) for each in entries]}

    def blocks(self, record: Attributes, names: Names, indent: str) -> Iterator[Block]:
        """See `Part`."""
        entries = getattr(record, self.key.lower())
        if entries is None:
            yield [f'{indent}"{self.key}": null']
        else:
            yield block(f'{indent}"{self.key}": [', (_json(self.kind.write(each, names)) for each in entries), "]")

    def describe(self) -> tuple[dict[str, Schema | bool], list[str]]:
        """See `Part`."""
        schema = {"type": ["array", "null"] if self.or_null else "array", "items": self.kind.schema}
        return {self.key: described(self.about, schema)}, [self.key]


def described(about: str, schema: Schema) -> Schema:
    """A schema with a description."""
    return {"description": about, **schema} if about else schema


def block(opening: str, entries: Iterable[str], closing: str) -> Block:
    """Entries between brackets, one on every line, two columns deeper."""
    indent = " " * (len(opening) - len(opening.lstrip()))
    lines = [f"{indent}  {entry}," for entry in entries]
    if lines:
        lines[-1] = lines[-1][:-1]
    return [opening, *lines, f"{indent}{closing}"]


def joined(blocks: Iterable[Block]) -> Iterator[str]:
    """The lines of all, with commas between."""
    waiting: Block = []
    for each in blocks:
        if waiting:
            yield from waiting[:-1]
            yield f"{waiting[-1]},"
        waiting = each
    yield from waiting


def text_of(table: Record[Value], value: Value, names: Names) -> str:
    """The file that holds a record."""
    return "\n".join(["{", *joined(table.blocks(value, names, "  ")), "}"]) + "\n"
