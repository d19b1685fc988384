"""A text that is open in an editor, and what was found out about this version of it."""

from __future__ import annotations

from functools import cached_property
from pathlib import PurePosixPath
from typing import cast
from urllib.parse import unquote, urlsplit

from lsprotocol import types
from msgspec import Struct

from tumato_symbolic.diagnostics import Source
from tumato_symbolic.editor.mentions import Index, index
from tumato_symbolic.editor.positions import Encoding, Position, Positions


class Document(Struct, dict=True):
    """One version of a text; what is known of it is found out once."""

    uri: str
    text: str
    version: int | None
    encoding: types.PositionEncodingKind | str

    @cached_property
    def source(self) -> Source:
        """The text as we read it."""
        return Source(PurePosixPath(unquote(urlsplit(self.uri).path)).name or self.uri, self.text)

    @cached_property
    def positions(self) -> Positions:
        """Between our places and the editor's."""
        return Positions(self.source, self.text, cast(Encoding, str(getattr(self.encoding, "value", self.encoding))))

    @cached_property
    def index(self) -> Index:
        """What is mentioned in it."""
        return index(self.source)

    def place(self, position: types.Position) -> tuple[int, int]:
        """An editor's place as a line and a column."""
        return self.positions.place(Position(position.line, position.character))
