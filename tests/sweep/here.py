"""Sweeps whose tasks are solved in the test process, and answered in any order."""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import asdict
from itertools import count
from pathlib import Path
from random import Random

from tests.repo.documents import ROOT
from tumato_symbolic.diagnostics import Source
from tumato_symbolic.sweep import Plan, Task, dropped, kept, sweep
from tumato_symbolic.sweep.solving import solved
from tumato_symbolic.sweep.sweeping import Hired, Workers

AMR = Source("amr.tum", (ROOT / "examples" / "amr.tum").read_text())
COIN = Source("coin.tum", (ROOT / "examples" / "coin.tum").read_text())
PLAN = Plan("drop", COIN, dropped(COIN), {"some": "option"})


def answer(task: str) -> str:
    """What a child would answer."""
    return json.dumps(asdict(solved(Task(**json.loads(task)))))


class GoneError(Exception):
    """Nobody works any more."""


def shuffling(seed: int, known: dict[str, str], most: int = 10**9) -> Callable[[], Hired]:
    """Workers that answer the tasks they have in any order, and are gone after so many answers.

    `known` are answers to tasks that were given before.
    """

    @contextmanager
    def hired() -> Iterator[Workers]:
        random, given = Random(seed), count()

        def later(task: str, delay: float) -> str:
            if next(given) >= most:
                raise GoneError
            time.sleep(delay)
            if task not in known:
                known[task] = answer(task)
            return known[task]

        with ThreadPoolExecutor(3) as executor:

            def submit(task: str) -> Future[str]:
                return executor.submit(later, task, random.random() / 500)

            yield Workers(submit, 4)

    return hired


def run(path: Path | None, hired: Callable[[], Hired], plan: Plan = PLAN) -> str:
    """The results of a sweep as text."""
    with kept(None if path is None else str(path), plan.header("0")) as results:
        sweep(plan, Task("", "", prove=False), hired, results, heard=lambda: None)
        return results.text()
