"""What was proved of a certificate that there is no policy."""

from __future__ import annotations

from typing import NamedTuple


class Obligations(NamedTuple):
    """How many were proved: by the explicit meaning, by Z3, and by the walk, to which some were left."""

    by_meaning: int
    by_solver: int
    by_diagrams: int

    def plus(self, other: Obligations) -> Obligations:
        """Both together."""
        return Obligations(*(one + more for one, more in zip(self, other, strict=True)))
