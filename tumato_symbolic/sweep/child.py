"""A process that solves texts: a batch a line on its standard input, a line on its output for each answer.

It ends with its owner, however that ends, and by itself when it has had nothing to do for a while.
"""

from __future__ import annotations

import gc
import json
import os
import signal
import sys
import time
from collections.abc import Iterator
from typing import Final, Literal, TextIO, TypeAlias

from msgspec.structs import asdict

from tumato_symbolic.limits.processes import end_with, megabytes_of
from tumato_symbolic.sweep.tasks import Batch, Task

IDLE = 60
"""Seconds without a batch after which the process ends; its owner gives it none that late."""

Then: TypeAlias = Literal["more", "ready", "end"]
"""What comes after an answer: another one; another batch; the end, for the next text would be blamed for memory."""

_SMALLEST: Final = """\
BEGIN STATE VECTOR state s can be x, y END STATE VECTOR
BEGIN ACTIONS action a preconditions: s is x nominal effects: s is y END ACTIONS
BEGIN STATE RULES rule: s is y END STATE RULES
BEGIN GOALS goal type: priority goal: s is y END GOALS
"""


def main(owner: int) -> None:
    """Answer batches until there are no more. `owner` is the number of the process that asks."""
    end_with(owner)
    gc.set_threshold(100_000)
    answers = _answers()
    _solved(Task("smallest", _SMALLEST))  # loads what is loaded when it is needed first
    while line := _next_line():
        for each in _answered(Batch.read(line)):
            answers.write(f"{json.dumps(each)}\n")
            answers.flush()


def _answered(batch: Batch) -> Iterator[dict[str, object]]:
    """The answers to the first texts of a batch, each with what comes after it; a bug in place of the last."""
    until = time.monotonic() + batch.enough
    for number, task in enumerate(batch.tasks, 1):
        found = _solved(task)
        goes_on = number < len(batch.texts) and "bug" not in found and time.monotonic() < until
        then: Then = "more" if goes_on else "ready"
        if _has_grown(task):
            then = "end"
        yield {**found, "then": then}
        if then != "more":
            return


def _solved(task: Task) -> dict[str, object]:
    """The answer, or the traceback of an exception, which is our bug."""
    from tumato_symbolic.sweep.solving import solved

    try:
        return asdict(solved(task))
    except Exception:  # noqa: BLE001 - the owner raises it
        import traceback

        return {"bug": traceback.format_exc()}


def _has_grown(task: Task) -> bool:
    """Whether this process keeps so much memory that the next text would be blamed for it."""
    return task.megabytes is not None and megabytes_of(os.getpid()) > task.megabytes / 2


def _next_line() -> str:
    """The next batch; none where the owner has no more."""
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
