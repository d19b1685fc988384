"""Variants of a specification: each is the text with some edits."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from typing import Literal, TypeAlias

from msgspec import Struct, field

from tumato_symbolic.diagnostics import Source
from tumato_symbolic.syntax.edits import Edit, edited

Kind: TypeAlias = Literal["define", "drop", "mutate"]
"""What is varied: named values, elements that are left out, or anything that a person may get wrong."""


class Change(Struct, frozen=True):
    """What a variant says otherwise: in the place of `before`, `after`; None where that is nothing.

    `what` is the kind of thing that is changed, `name` that of a list or a setting. `line` and `column` are where it
    stands, None where the text does not have it.
    """

    what: str
    before: str | None
    after: str | None
    line: int | None
    column: int | None
    name: str | None = None

    def as_json(self) -> dict[str, object]:
        """As it stands in a line of results."""
        return {
            "what": self.what,
            "name": self.name,
            "line": self.line,
            "column": self.column,
            "before": self.before,
            "after": self.after,
        }


class Variant(Struct, frozen=True):
    """One text: number 0 is the specification as it stands."""

    number: int
    changes: tuple[Change, ...] = ()
    edits: tuple[Edit, ...] = ()

    def text(self, source: Source) -> str:
        """The variant written out."""
        return edited(source, self.edits)


class Plan(Struct, frozen=True):
    """All variants of a specification, the first of which is the specification itself.

    `options` are those of the command on which the results depend, by their names.
    """

    kind: Kind
    source: Source
    variants: Sequence[Variant]
    options: Mapping[str, object] = field(default_factory=dict)

    def header(self, version: str) -> dict[str, object]:
        """The first line of the results: what they are results of."""
        return {
            "sweep": self.kind,
            "specification": self.source.name,
            "text": f"sha256:{hashlib.sha256(self.source.text.encode()).hexdigest()}",
            "options": dict(self.options),
            "variants": len(self.variants),
            "version": version,
        }


def numbered(changes: Sequence[tuple[tuple[Change, ...], tuple[Edit, ...]]]) -> tuple[Variant, ...]:
    """The specification, and a variant for all changes and edits that go together."""
    return (Variant(0), *(Variant(number, *each) for number, each in enumerate(changes, 1)))
