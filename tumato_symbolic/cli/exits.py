"""The exit codes, a contract with scripts (`docs/semantics.md` says what the verdicts mean)."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final

YES: Final = 0
"""Realizable and proved, proved, decided, no errors."""

NO: Final = 1
"""Not realizable, refuted, a state about which the policy says nothing, or a line that is no state."""

USAGE: Final = 2
"""The command line, a specification or a policy cannot be used, or the output cannot be written."""

UNDECIDED: Final = 3
"""No verdict within the limits."""

BUG: Final = 70
"""An error of this program; the traceback is on the standard error stream."""

INTERRUPTED: Final = 130
"""Ctrl-C (128 + SIGINT)."""

TERMINATED: Final = 128
"""What is added to the number of a signal that ends the program (SIGTERM: 143)."""

BROKEN_PIPE: Final = 141
"""The reader of the output has gone (128 + SIGPIPE)."""

_WORST_FIRST: Final = (BUG, USAGE, NO, UNDECIDED, YES)
"""Of several answers of one command the first of these is its exit code."""


def worst(codes: Iterable[int]) -> int:
    """The exit code of a command that did several things, of which these are the codes."""
    return min(codes, key=_WORST_FIRST.index)
