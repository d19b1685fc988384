"""In which order the walk tests its variables."""

from __future__ import annotations

from collections.abc import Sequence

from tumato_symbolic.spec import GoalParameters, Spec, variables_of


def walk_order(
    spec: Spec, tested: Sequence[int], groups: Sequence[Sequence[int]], told_by: GoalParameters | None = None
) -> list[int]:
    """The variables as the policy tests them, every group just above the first one that it writes.

    Groups are numbered after the variables; those that write nothing come first. After them those that tell goals
    apart are numbered: each body stands above the first variable that it mentions, actions on top.
    """
    states = [*tested, *(variable for variable in range(len(spec.variables)) if variable not in tested)]
    above: dict[int | None, list[int]] = {}
    for number, group in enumerate(groups):
        written = {variable for action in group for effect in spec.actions[action].effects for variable, _ in effect}
        first = next((variable for variable in states if variable in written), None)
        above.setdefault(first, []).append(len(spec.variables) + number)
    if told_by is not None:
        first_parameter = len(spec.variables) + len(groups)
        for number, body in enumerate(told_by.bodies, first_parameter):
            mentioned = variables_of(spec.bodies[body].formula)
            above.setdefault(next((each for each in states if each in mentioned), None), []).append(number)
        last = first_parameter + len(told_by.bodies)
        above[None] = [*range(last, last + len(told_by.actions)), *above.get(None, ())]
    return [*above.get(None, ()), *(each for variable in states for each in (*above.get(variable, ()), variable))]
