"""A process that solves one text after the other: a task a line on its standard input, an answer a line on its output.

It ends with its owner, however that ends, and by itself when it has had nothing to do for a while.
"""

from __future__ import annotations

import gc
import json
import os
import signal
import sys
from dataclasses import asdict
from typing import TextIO

from tumato_symbolic.limits.processes import end_with

IDLE = 60
"""Seconds without a task after which the process ends; its owner gives it none that late."""


def main(owner: int) -> None:
    """Answer tasks until there are no more. `owner` is the number of the process that asks."""
    end_with(owner)
    gc.set_threshold(100_000)
    answers = _answers()
    from tumato_symbolic.sweep.solving import solved
    from tumato_symbolic.sweep.tasks import Task

    while task := _next_line():
        try:
            answer = asdict(solved(Task(**json.loads(task))))
        except Exception:  # noqa: BLE001 - whatever comes here is our bug, which the owner raises
            import traceback

            answer = {"bug": traceback.format_exc()}
        answers.write(f"{json.dumps(answer)}\n")
        answers.flush()


def _next_line() -> str:
    """The next task; none where the owner has no more."""
    if hasattr(signal, "alarm"):
        signal.alarm(IDLE)
    line = sys.stdin.readline()
    if hasattr(signal, "alarm"):
        signal.alarm(0)
    return line


def _answers() -> TextIO:
    """The standard output for answers alone: what libraries print goes to the standard error stream."""
    answers = os.fdopen(os.dup(1), "w", encoding="utf-8")
    os.dup2(2, 1)
    return answers
