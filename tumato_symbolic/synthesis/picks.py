"""What clauses about choices consist of."""

from __future__ import annotations

from msgspec import Struct


class Pick(Struct, frozen=True):
    """Option number `option` of choice number `choice`."""

    choice: int
    option: int
