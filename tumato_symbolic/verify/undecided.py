"""How long a prover may think about one obligation, and what it raises when it gives up."""

from __future__ import annotations

from typing import Final

OBLIGATION_BUDGET: Final = 30.0
"""How many seconds Z3 may think about one obligation, and the walk about one property."""


class UndecidedError(Exception):
    """An obligation is neither proved nor refuted."""

    def __init__(self, claim: str, why: str = "Z3 did not answer within the time limit of one obligation") -> None:
        super().__init__(f"{why}: {claim}")
