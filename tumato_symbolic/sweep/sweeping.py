"""All variants of a plan solved, by several processes or on a cluster; what is found does not depend on which."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from contextlib import AbstractContextManager, contextmanager
from dataclasses import asdict, dataclass, replace
from typing import TypeAlias

from tumato_symbolic.sweep.asking import Children
from tumato_symbolic.sweep.results import Line, Results
from tumato_symbolic.sweep.tasks import NOTHING, Answer, Task
from tumato_symbolic.sweep.variants import Plan, Variant


class LostError(Exception):
    """A task without an answer, because those who worked on it were killed again and again."""


@dataclass(frozen=True, slots=True)
class Workers:
    """Who works: `submit` takes a task, of which `ahead` may wait or be worked on at a time."""

    submit: Callable[[str], Future[str]]
    ahead: int


Hired: TypeAlias = AbstractContextManager[Workers]


@contextmanager
def processes(jobs: int) -> Iterator[Workers]:
    """So many processes of this machine. None is left when this ends, however it ends."""
    children = Children()
    with ThreadPoolExecutor(jobs) as executor:

        def submit(task: str) -> Future[str]:
            return executor.submit(children.ask, task)

        try:
            yield Workers(submit, 2 * jobs)
        finally:
            executor.shutdown(wait=False, cancel_futures=True)
            children.end()


def sweep(plan: Plan, common: Task, hired: Callable[[], Hired], results: Results, *, heard: Callable[[], None]) -> None:
    """Add to `results` what is not there; `heard` is told when there is more.

    `common` is what all tasks share. The specification itself is solved first, since the others are compared with it.
    Raises `UserError` where nobody works.
    """
    todo = [each for each in plan.variants if each.number not in results.lines]
    if not todo:
        return
    with hired() as workers:
        base = _answered(workers.submit(_task(plan.variants[0], plan, replace(common, policy=True))))
        if 0 not in results.lines:
            _add(results, plan.variants[0], base)
            heard()
        common = replace(common, against=base.policy)
        waiting = iter([each for each in todo if each.number])
        running: dict[Future[str], Variant] = {}
        while True:
            while len(running) < workers.ahead and (variant := next(waiting, None)) is not None:
                running[workers.submit(_task(variant, plan, common))] = variant
            if not running:
                return
            done = wait(running, return_when=FIRST_COMPLETED).done
            for future in sorted(done, key=_fails):  # what is found is kept first
                _add(results, running.pop(future), _answered(future))
                heard()


def _fails(future: Future[str]) -> bool:
    return future.exception() is not None


def _task(variant: Variant, plan: Plan, common: Task) -> str:
    return json.dumps(asdict(replace(common, name=plan.source.name, text=variant.text(plan.source))))


def _answered(future: Future[str]) -> Answer:
    try:
        return Answer(**json.loads(future.result()))
    except LostError as lost:
        return Answer({**NOTHING, "limit": str(lost)})


def _add(results: Results, variant: Variant, answer: Answer) -> None:
    changes = [each.as_json() for each in variant.changes]
    line: Line = {"variant": variant.number, "changes": changes, **answer.result}
    results.add({**line, "differs": differs(line, results.lines.get(0))})


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
