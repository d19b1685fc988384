"""All variants of a plan solved, by several processes or on a cluster; what is found does not depend on which."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from contextlib import contextmanager
from functools import partial
from math import inf
from typing import Final

from msgspec.structs import replace

from tumato_symbolic.sweep.asking import Children
from tumato_symbolic.sweep.portions import Hired, LostError, Portion, Portions, Workers
from tumato_symbolic.sweep.results import Line, Results
from tumato_symbolic.sweep.tasks import NOTHING, Answer, Batch, Reply, Task
from tumato_symbolic.sweep.variants import Plan

_SECONDS: Final = 0.2
"""How long a batch should take on this machine: what is found is recorded that often."""

_LOOK: Final = 1.0
"""Seconds without a reply after which it is asked who works."""


class SolverError(Exception):
    """An exception in a process that solves variants: a bug, with its traceback."""


@contextmanager
def processes(jobs: int) -> Iterator[Workers]:
    """So many processes of this machine. None is left when this ends, however it ends."""
    children = Children()
    with ThreadPoolExecutor(jobs) as executor:

        def submit(batch: str) -> Future[str]:
            return executor.submit(children.ask, batch)

        try:
            children.start(jobs)
            yield Workers(submit, lambda: jobs, _SECONDS)
        finally:
            executor.shutdown(wait=False, cancel_futures=True)
            children.end()


def sweep(plan: Plan, common: Task, hired: Callable[[], Hired], results: Results, *, heard: Callable[[], None]) -> None:
    """Add to `results` what is not there; `heard` is told when there is more.

    `common` is what all tasks share. The specification itself is solved first, since the others are compared with it.
    Raises `UserError` where nobody works, or nobody is left who does.
    """
    todo = [each for each in plan.variants if each.number not in results.lines]
    if not todo:
        return
    common = replace(common, name=plan.source.name)
    with hired() as workers:
        submit = partial(_submit, workers, plan)
        base = Portion(plan.variants[:1], alone=True)
        (future,) = _first([submit(base, replace(common, policy=True))], workers)
        reply = _reply(future, base)
        _add(results, base, reply)
        heard()
        portions = Portions([each for each in todo if each.number], workers)
        portions.replied(base, reply)
        common = replace(common, against=reply.answers[0].policy)
        running: dict[Future[str], Portion] = {}
        while True:
            while (portion := portions.next(len(running))) is not None:
                running[submit(portion, common)] = portion
            if not running:
                return
            for future in sorted(_first(running, workers), key=_fails):
                if _settle(future, running.pop(future), portions, results):
                    heard()


def _first(running: Iterable[Future[str]], workers: Workers) -> set[Future[str]]:
    """Those that are done first. Raises `UserError` where none will be, since nobody works."""
    while not (done := wait(running, _LOOK, FIRST_COMPLETED).done):
        workers.hands()
    return done


def _settle(future: Future[str], portion: Portion, portions: Portions, results: Results) -> bool:
    """Add what is found of a portion; False where it is lost."""
    try:
        reply = _reply(future, portion)
    except LostError:
        portions.lost(portion)
        return False
    portions.replied(portion, reply)
    _add(results, portion, reply)
    return True


def _fails(future: Future[str]) -> bool:
    """Whether there is no reply; those that there are are kept first."""
    return future.exception() is not None


def _submit(workers: Workers, plan: Plan, portion: Portion, common: Task) -> Future[str]:
    texts = tuple(each.text(plan.source) for each in portion.variants)
    return workers.submit(Batch(common, texts, workers.enough).written())


def _reply(future: Future[str], portion: Portion) -> Reply:
    """What is found of a portion: nothing, where that was lost alone; where it was not, `LostError` is raised."""
    try:
        return Reply.read(future.result())
    except LostError as lost:
        if not portion.alone:
            raise
        return Reply((Answer({**NOTHING, "limit": str(lost)}),), inf)


def _add(results: Results, portion: Portion, reply: Reply) -> None:
    """Add what was not there. Raises `SolverError` where the reply ends in a bug."""
    lines: list[Line] = []
    for variant, answer in zip(portion.variants, reply.answers, strict=False):
        if variant.number not in results.lines:
            changes = [each.as_json() for each in variant.changes]
            line: Line = {"variant": variant.number, "changes": changes, **answer.result}
            lines.append({**line, "differs": differs(line, results.lines.get(0))})
    results.add(lines)
    if reply.bug is not None:
        raise SolverError(f"in a process that solves variants\n\n{reply.bug}")


def differs(line: Line, base: Line | None) -> bool | None:
    """Whether the answer is another one than that of the specification itself; None where that is not known.

    It is where there is a policy for one of them only, where other states fail, or where a decision is another: then a
    robot does something else.
    """
    if base is None or not {line["verdict"], base["verdict"]} <= {"realizable", "unrealizable"}:
        return None
    if line["verdict"] != base["verdict"] or line["failures"] != base["failures"]:
        return True
    if line["verdict"] == "unrealizable":
        return bool(line["states"] != base["states"])
    return None if line["compared"] is None else bool(line["compared"]["changed"])
