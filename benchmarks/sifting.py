"""What reordering the bits would bring: `python -m benchmarks.sifting`, on CUDD.

For each specification, processor seconds from the text's meaning to a policy in the own regions of the goals, and the
nodes of that policy: in our order, which never changes; where CUDD reorders by sifting while it computes; and in the
order that sifting finds at the end, from the start. A dash: not in time.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any
from unittest.mock import patch

from benchmarks.families import FAMILIES
from tumato_symbolic.diagnostics import Source
from tumato_symbolic.game import build_problem, own_region_policy
from tumato_symbolic.limits import Context, LimitReachedError, Limits
from tumato_symbolic.spec import Spec, load
from tumato_symbolic.symbolic import Bdd, Manager, layout

CASES = (
    ("samples", 15),
    ("samples", 30),
    ("sampler", 20),
    ("loads", 15),
    ("robots", 4),
    ("plant", 10),
    ("grid", 32),
    ("shelves", 6),
    ("shelves", 8),
)
LIMIT = 60.0


class _Sifting(Manager):
    """A manager that reorders its bits whenever CUDD thinks that it pays."""

    def __init__(self, *arguments: Any) -> None:  # noqa: ANN401 - those of a manager
        super().__init__(*arguments)
        self._bdd.configure(reordering=True)


class _Ordered(Manager):
    """A manager with an order of its own, whatever it is asked for."""

    order: tuple[str, ...] = ()

    def __init__(self, _: object, *arguments: Any) -> None:  # noqa: ANN401 - those of a manager
        super().__init__(self.order, *arguments)


def main() -> None:
    """One line for every case."""
    print(f"{'case':<14}{'our order':>18}{'reordered':>18}{'found order':>18}")
    for name, size in CASES:
        spec = _read(FAMILIES[name].text(size, True))
        print(f"{FAMILIES[name].case(size):<14}" + "".join(f"{cell:>18}" for cell in cells(spec)), flush=True)
    for path in map(Path, sys.argv[1:]):
        print(f"{path.stem:<14}" + "".join(f"{cell:>18}" for cell in cells(_read(path.read_text("utf-8")))), flush=True)


def _read(text: str) -> Spec:
    spec = load(Source("case", text)).spec
    assert spec is not None, "benchmarks are correct specifications"
    return spec


def cells(spec: Spec) -> Iterator[str]:
    """Seconds and nodes in our order, with reordering meanwhile, and in the order found at the end."""
    found = _searched(spec)
    yield _told(found)
    with _made_by(_Sifting):
        yield _told(_searched(spec))
    if found is None:
        yield "–"
        return
    manager = found[1]
    manager._module.reorder(manager._bdd)  # noqa: SLF001 - there is no door for what is not done
    levels: dict[str, int] = manager._bdd.var_levels  # noqa: SLF001
    _Ordered.order = tuple(sorted(levels, key=levels.__getitem__))
    with _made_by(_Ordered):
        yield _told(_searched(spec))


@contextmanager
def _made_by(manager: type[Manager]) -> Iterator[None]:
    with patch.object(layout, "Manager", manager):
        yield


def _searched(spec: Spec) -> tuple[float, Manager, Bdd] | None:
    began = time.process_time()
    try:
        problem = build_problem(spec, spec.ordering, "cudd", Context(Limits(LIMIT)))
        policy = own_region_policy(problem).policy
    except LimitReachedError:
        return None
    return time.process_time() - began, problem.encoding.manager, policy


def _told(found: tuple[float, Manager, Bdd] | None) -> str:
    if found is None:
        return "–"
    seconds, manager, policy = found
    return f"{seconds:.2f}; {manager.nodes(policy):,}"


if __name__ == "__main__":
    main()
