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

    TUM501 = ("error", "policy cannot be read")
    TUM502 = ("error", "policy has the wrong shape")
    TUM503 = ("error", "unknown or missing variable in a policy or state")
    TUM504 = ("error", "unknown or missing value in a policy or state")
    TUM505 = ("error", "unknown or missing action in a policy")
    TUM506 = ("error", "contradictory rows in a policy")
    TUM507 = ("warning", "certificate does not fit")
    TUM508 = ("error", "policy is too large")
    TUM509 = ("error", "state cannot be read")
    TUM510 = ("error", "policy cannot be written")

    def __init__(self, severity: Literal["error", "warning"], title: str) -> None:
        self.severity = severity
        self.title = title
