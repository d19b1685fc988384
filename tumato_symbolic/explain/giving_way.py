"""Values of the environment while which no goal need be met, so that states without a plan have one."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from tumato_symbolic.explain.additions import NoGoalWhile
from tumato_symbolic.explain.requirements import Requirements
from tumato_symbolic.explain.trouble import Trouble
from tumato_symbolic.symbolic import Bdd


def goals_that_give_way(trouble: Trouble) -> NoGoalWhile | None:
    """Values of the environment while which no goal need be met, so that no state is without a plan.

    As few as can be found, and those first of whose states most have none. None where they do not cover all of these,
    or where some goal would never be active.
    """
    requirements, spec = trouble.requirements, trouble.spec
    encoding, false, left = requirements.encoding, requirements.false, trouble.failing.no_plan
    if left == false or spec.goals is None:
        return None
    every = {
        (variable, value): encoding.value(variable, value) & requirements.valid
        for variable in sorted(spec.environment)
        for value in range(len(spec.variables[variable].values))
    }
    literals = {literal: states for literal, states in every.items() if not _silences_a_goal(requirements, states)}

    def share(some: Bdd, states: Bdd) -> float:
        return encoding.count_states(some) / encoding.count_states(states)

    chosen: list[tuple[int, int]] = []
    while left != false:
        shares = {
            literal: (share(states & trouble.failing.no_plan, states), share(states & left, states))
            for literal, states in literals.items()
            if states & left != false
        }
        if not shares:
            return None
        chosen.append(max(shares, key=lambda literal: (shares[literal], (-literal[0], -literal[1]))))
        left = left & ~literals[chosen[-1]]
    chosen = _needed(chosen, {literal: literals[literal] & trouble.failing.no_plan for literal in chosen}, requirements)
    if _silences_a_goal(requirements, requirements.manager.union(literals[literal] for literal in chosen)):
        return None
    variables = sorted({variable for variable, _ in chosen})
    return NoGoalWhile(tuple((each, tuple(sorted(value for v, value in chosen if v == each))) for each in variables))


def values_that_take_goals(trouble: Trouble) -> Iterator[NoGoalWhile]:
    """For each variable of the environment, the value of whose states most have no plan: no goal need be met then.

    Not where some goal would never be active. Those that cover only some of the states without a plan are told too.
    """
    requirements, count = trouble.requirements, trouble.requirements.encoding.count_states
    for variable in sorted(trouble.spec.environment):
        shares = {}
        for value in range(len(trouble.spec.variables[variable].values)):
            states = requirements.encoding.value(variable, value) & requirements.valid
            if states & trouble.failing.no_plan != requirements.false and not _silences_a_goal(requirements, states):
                shares[value] = count(states & trouble.failing.no_plan) / count(states)
        if shares:
            yield NoGoalWhile(((variable, (max(shares, key=lambda value: (shares[value], -value)),)),))


def _silences_a_goal(requirements: Requirements, states: Bdd) -> bool:
    """Whether some goal is active in these states alone."""
    active = [(body, region) for bodies, region in requirements.regions.items() for body in bodies]
    lasting = {body for body, region in active if region & ~states != requirements.false}
    return not lasting.issuperset(body for body, _ in active)


def _needed(
    chosen: Sequence[tuple[int, int]], covered: dict[tuple[int, int], Bdd], requirements: Requirements
) -> list[tuple[int, int]]:
    """Those of some literals without which something is not covered."""
    kept = list(chosen)
    for literal in chosen:
        others = requirements.manager.union(covered[other] for other in kept if other != literal)
        if covered[literal] & ~others == requirements.false:
            kept.remove(literal)
    return kept
