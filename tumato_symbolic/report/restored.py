"""In how many steps a policy restores safety, where that may be several."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from tumato_symbolic.report.layout import count, enumeration
from tumato_symbolic.synthesis.result import Statistics


def restored_text(statistics: Statistics) -> Iterator[str]:
    """Lines for a person; none where one step has to do, or no state is unsafe."""
    restored = statistics.restored
    if restored is None or not statistics.unsafe:
        return
    promises = {"whatever happens": restored.bounded, "if nominal effects occur often enough": restored.fair}
    told = [
        f"in at most {count(by_steps[-1][0], 'step')}, {promise} ({_counts(by_steps)})"
        for promise, by_steps in promises.items()
        if by_steps
    ]
    what = "safety is restored" if len(restored.levels) == 1 else "the level is raised"
    yield f"  {what} {'; else '.join(told)}; the longest way takes a duration of {restored.longest}"
    if len(restored.levels) > 1:
        levels = [f"{number:,} at level {level}" for level, number in enumerate(restored.levels)]
        yield f"  unsafe states by level, severe rules first: {enumeration(levels)} of {len(restored.levels)}"


def _counts(by_steps: Sequence[tuple[int, int]]) -> str:
    """`416 states in 1 step, 96 in 2, 16 in 3`."""
    (steps, states), *rest = by_steps
    return ", ".join([f"{count(states, 'state')} in {count(steps, 'step')}", *(f"{n:,} in {k}" for k, n in rest)])


def restored_json(statistics: Statistics | None) -> dict[str, object]:
    """The same for a program: states by number of steps."""
    restored = statistics.restored if statistics else None
    if restored is None:
        return {}
    counts = {"bounded": restored.bounded, "fair": restored.fair}
    by_steps = {name: {str(steps): number for steps, number in found} for name, found in counts.items()}
    return {"restored": {**by_steps, "longest_duration": restored.longest, "unsafe_by_level": list(restored.levels)}}
