"""What clauses about choices consist of."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Pick:
    """Option number `option` of choice number `choice`."""

    choice: int
    option: int
