"""The closed table of codes. A code never changes its meaning and is never used again.

TUM1xx input and syntax, TUM2xx names, TUM3xx what a specification says, TUM4xx why there is no policy,
TUM5xx policies and their certificates.
"""

from __future__ import annotations

from enum import Enum
from typing import Literal


class Code(Enum):
    """A code and its severity."""

    TUM101 = ("error", "input cannot be read")

    def __init__(self, severity: Literal["error", "warning"], title: str) -> None:
        self.severity = severity
        self.title = title
