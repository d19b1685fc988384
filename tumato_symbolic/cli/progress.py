"""What a command for many things tells while it goes on: lines in their order, whichever is done first."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Final

from msgspec import Struct

from tumato_symbolic.cli.console import write
from tumato_symbolic.limits import Context

_BETWEEN: Final = 0.5
"""Seconds between two records of what is known."""


class Progress(Struct):
    """A stage, lines for a program in their order, and a record of what is known, for a report if the work ends here.

    `line` is the line of a number; None where it is not known yet, or none is wanted. `known` is all that a report
    needs; None where there is nothing to report.
    """

    context: Context
    line: Callable[[int], str | None]
    known: Callable[[], object]
    _shown: int = 0
    _recorded: float = -_BETWEEN

    def more(self, stage: str) -> None:
        """More is known, or the work begins."""
        self.context.enter(stage)
        while (line := self.line(self._shown)) is not None:
            write(line)
            self._shown += 1
        if time.monotonic() - self._recorded >= _BETWEEN:
            self.record()

    def record(self) -> None:
        """Record what is known."""
        known = self.known()
        if known is not None:
            self.context.learn(known)
            self._recorded = time.monotonic()
