"""In which order the walk tests its variables."""

from __future__ import annotations

from collections.abc import Sequence

from tumato_symbolic.spec import Spec


def walk_order(spec: Spec, tested: Sequence[int], groups: Sequence[Sequence[int]]) -> list[int]:
    """The variables as the policy tests them, every group just above the first one that it writes.

    Groups are numbered after the variables; those that write nothing come first.
    """
    states = [*tested, *(variable for variable in range(len(spec.variables)) if variable not in tested)]
    above: dict[int | None, list[int]] = {}
    for number, group in enumerate(groups):
        written = {variable for action in group for effect in spec.actions[action].effects for variable, _ in effect}
        first = next((variable for variable in states if variable in written), None)
        above.setdefault(first, []).append(len(spec.variables) + number)
    return [*above.get(None, ()), *(each for variable in states for each in (*above.get(variable, ()), variable))]
