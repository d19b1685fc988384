"""What provers raise where they come to no verdict."""

from __future__ import annotations


class UndecidedError(Exception):
    """An obligation is neither proved nor refuted."""

    def __init__(self, claim: str, why: str = "Z3 did not answer within the time limit of one obligation") -> None:
        super().__init__(f"{why}: {claim}")
