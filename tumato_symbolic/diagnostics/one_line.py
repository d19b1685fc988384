"""Records that are too large to be shown field by field."""

from __future__ import annotations

from msgspec import Struct


class InOneLine(Struct, frozen=True):
    """A record that is shown as what its `__repr__` says."""

    def __rich_repr__(self) -> None:  # type: ignore[override]  # that of a struct lists its fields
        """Say nothing to `rich`, which takes `__repr__` then."""
