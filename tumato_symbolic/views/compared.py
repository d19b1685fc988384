"""In which states two policies are compared, and in which of these they decide otherwise."""

from __future__ import annotations

from tumato_symbolic.diagrams import (
    EVERYTHING,
    Reference,
    Sets,
)
from tumato_symbolic.policy import StateSets, Vocabulary
from tumato_symbolic.spec import Spec
from tumato_symbolic.views.placing import (
    Placed,
)


def states_compared(sets: Sets, vocabulary: Vocabulary, spec: Spec | None, decided: Reference) -> Reference:
    """The states that one of the policies decides; where there is a specification, those of them that are valid."""
    if spec is None:
        return decided
    numbers = {name: number for number, (name, _) in enumerate(vocabulary.variables)}
    variables = [numbers[variable.name] for variable in spec.variables]
    values = [
        [vocabulary.variables[number][1].index(value) for value in variable.values]
        for number, variable in zip(variables, spec.variables, strict=True)
    ]
    return sets.both(decided, StateSets(sets, variables, values).where(spec.validity))


def states_changed(sets: Sets, before: Placed, after: Placed) -> Reference:
    """Where one of them decides only, or they decide otherwise."""
    found = _either_only(sets, before.decided, after.decided)
    for one, other in zip(before.executed, after.executed, strict=True):
        found = sets.either(found, _either_only(sets, one, other))
    return found


def _either_only(sets: Sets, one: Reference, other: Reference) -> Reference:
    return sets.choose(one, sets.without(EVERYTHING, other), other)
