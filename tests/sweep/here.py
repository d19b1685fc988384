"""Sweeps whose tasks are solved in the test process, and answered in any order."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager
from functools import cache
from itertools import count, islice
from pathlib import Path
from random import Random

from tests.repo.documents import ROOT
from tumato_symbolic.diagnostics import Code, Diagnostic, Source, UserError
from tumato_symbolic.sweep import Plan, Task, dropped, kept, sweep
from tumato_symbolic.sweep.portions import Hired, LostError, Workers
from tumato_symbolic.sweep.solving import solved
from tumato_symbolic.sweep.tasks import Answer, Batch, Reply

AMR = Source("amr.tum", (ROOT / "examples" / "amr.tum").read_text())
COIN = Source("coin.tum", (ROOT / "examples" / "coin.tum").read_text())
PLAN = Plan("drop", COIN, dropped(COIN), {"some": "option"})


class GoneError(UserError):
    """Nobody works any more."""

    def __init__(self) -> None:
        super().__init__((Diagnostic(Code.TUM119, "the connection was lost"),))


def shuffling(
    seed: int,
    known: dict[Task, Answer],
    most: int = 10**9,
    deadly: Callable[[Task], bool] = lambda _: False,
) -> Callable[[], Hired]:
    """Workers that reply to the batches they have in any order, some in part, and are gone after so many answers.

    `known` are answers to tasks that were given before. A `deadly` task takes whoever solves it along.
    """

    @contextmanager
    def hired() -> Iterator[Workers]:
        random, given = Random(seed), count()

        def later(batch: Batch, delay: float, part: int) -> str:
            time.sleep(delay)
            answers: list[Answer] = []
            for task in islice(batch.tasks, part):
                if next(given) >= most:
                    raise GoneError
                if deadly(task):
                    raise LostError("it was killed")
                if task not in known:
                    known[task] = solved(task)
                answers.append(known[task])
            return Reply(tuple(answers), len(answers) / random.randint(1, 10)).written()

        with ThreadPoolExecutor(3) as executor:

            def submit(text: str) -> Future[str]:
                batch = Batch.read(text)
                return executor.submit(later, batch, random.random() / 500, random.randint(1, len(batch.texts)))

            yield Workers(submit, lambda: 2, 1.0)

    return hired


KNOWN: dict[Task, Answer] = {}
"""What was answered in tests of `PLAN`, so that it is solved once."""


@cache
def whole() -> str:
    """All results of `PLAN` as text."""
    return run(None, shuffling(0, KNOWN))


def run(path: Path | None, hired: Callable[[], Hired], plan: Plan = PLAN) -> str:
    """The results of a sweep as text."""
    with kept(None if path is None else str(path), plan.header("0")) as results:
        sweep(plan, Task("", "", prove=False), hired, results, heard=lambda: None)
        return results.text()
