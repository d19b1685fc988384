"""Proves parts of a property in worker processes; results equal those of a single process."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Hashable, Iterator, Sequence
from functools import partial
from typing import Any, TypeVar

from msgspec import Struct

from tumato_symbolic.limits import Budget
from tumato_symbolic.verify.by_diagrams.functions import TOO_LARGE, BudgetError, FullError, given_up
from tumato_symbolic.verify.by_diagrams.walk import Walk
from tumato_symbolic.verify.result import PropertyName
from tumato_symbolic.verify.workers import Lost, in_workers

Found = TypeVar("Found")


class Task(Struct, frozen=True):
    """A part of the proof of a property. `key` names it and all that its answer depends on, beside the policy.

    `prepare` is what it has in common with others, and is done before the processes part.
    """

    property: PropertyName
    key: Hashable
    work: Callable[[], object]
    prepare: Callable[[], object] | None = None


class ParallelProofs:
    """The answers of children, by the keys of their tasks.

    `seconds` tells how long each property took already: for children, from the beginning of its first task to the end
    of its last.
    """

    def __init__(self) -> None:
        self.answers: dict[Hashable, Any] = {}
        self.seconds: dict[PropertyName, float] = {}
        self._taken: list[Callable[[], object]] = []
        self._remembered = 0

    def take(self, key: Hashable, compute: Callable[[], Found]) -> Found:
        """The answer of a child; where there is none, what `compute` finds.

        Raises `BudgetError` where the child has given up.
        """
        if key not in self.answers:
            return compute()
        self._taken.append(compute)
        answer: Found | Lost = self.answers[key]
        if isinstance(answer, Lost):
            raise BudgetError(answer.reason)
        return answer

    def ask(
        self,
        walk: Walk,
        tasks: Sequence[Task],
        jobs: int,
        budget: Budget,
        started: Callable[[PropertyName], None],
    ) -> None:
        """Have all `tasks` done by up to `jobs` children at a time; `budget` limits every property.

        Together they may remember as many results as one process: where they need more, no answer counts. Raises
        `BudgetError` where a task cannot be prepared, and `OSError` where there is no room for another process.
        """
        import mmap

        began: dict[PropertyName, float] = {}
        counts = memoryview(mmap.mmap(-1, 8 * len(tasks))).cast("q")

        def works() -> Iterator[Callable[[], tuple[object, float]]]:
            for number, task in enumerate(tasks):
                if task.prepare is not None:
                    task.prepare()
                started(task.property)
                since = began.setdefault(task.property, time.monotonic() - self.seconds.get(task.property, 0.0))
                walk.deadline = budget.until(time.monotonic() - since)
                yield partial(_work, task, walk, counts, number)

        found = in_workers(works(), jobs)
        self._remembered = sum(counts)
        if walk.remembered + self._remembered > walk.most:
            return
        walk.most -= self._remembered
        for task, from_child in zip(tasks, found, strict=True):
            answer, ended = (from_child, time.monotonic()) if isinstance(from_child, Lost) else from_child
            self.seconds[task.property] = max(self.seconds.get(task.property, 0.0), ended - began[task.property])
            if answer is not None:
                self.answers[task.key] = answer

    def forget(self, walk: Walk) -> None:
        """Let no answer count from now on, and find here what was taken already, as if there had been no children."""
        self.answers.clear()
        self.seconds.clear()
        walk.most += self._remembered
        for compute in self._taken:
            compute()


def _work(task: Task, walk: Walk, counts: memoryview[int], number: int) -> tuple[object, float]:
    """What a child does: its answer, and when it ended. None is no answer: the task needs more memory than it may have.

    `counts`, which all processes share, is how much each task has remembered since they parted. A child ends when all
    together have remembered too much, and when it has become an orphan.
    """
    before, most, parent = walk.remembered, walk.most, os.getppid()

    def watch() -> None:
        counts[number] = walk.remembered - before
        if before + sum(counts) > most:
            raise FullError(TOO_LARGE)
        if os.getppid() != parent:
            os._exit(1)

    walk.watch = watch
    try:
        answer = task.work()
    except FullError:
        answer = None
    except (BudgetError, RecursionError) as error:
        answer = Lost(given_up(error))
    counts[number] = walk.remembered - before
    return answer, time.monotonic()
