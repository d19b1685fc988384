"""A certificate of guarantees from the fixpoints of the walk (`docs/certificate.md`)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from tumato_symbolic.diagrams import DiagramBuilder, Reference
from tumato_symbolic.policy import Vocabulary
from tumato_symbolic.policy.guarantees import CertifiedGoal, CertifiedLevel, CertifiedRanks, GuaranteesCertificate
from tumato_symbolic.semantics import Residual, action_names
from tumato_symbolic.spec import Ordering, Spec, canonical_text, digest
from tumato_symbolic.verify.by_diagrams.functions import Function
from tumato_symbolic.verify.by_diagrams.walk import Walk
from tumato_symbolic.verify.guarantees.prospects import NO_RANK
from tumato_symbolic.verify.guarantees.result import Level


def certificate_of(
    spec: Spec,
    walk: Walk,
    ordering: Ordering,
    ranks: Mapping[Residual, tuple[Sequence[Function], Function]],
    levels: Sequence[Level],
) -> GuaranteesCertificate:
    """`ranks` has, for every residual goal, those of `W_0, W_1, …, W_ω`, and those of `G`."""
    order = sorted(range(len(spec.variables)), key=lambda variable: walk.level_of[variable])
    places = {variable: level for level, variable in enumerate(order)}
    functions = [each for surviving, forced in ranks.values() for each in (*surviving, forced)]
    numbers = {number for each in functions for number in walk.values_of(each)} - {NO_RANK}
    builder = DiagramBuilder[int | None](order, [None, *sorted(numbers)])

    def taken(function: Function) -> Reference:
        return walk.fold(
            function,
            lambda number: builder.leaf(None if number == NO_RANK else number),
            lambda variable, below: builder.node(places[variable], tuple(below)),
        )

    goals = tuple(
        CertifiedGoal(
            tuple(sorted(canonical_text(spec, spec.bodies[body].formula) for body in goal.bodies)),
            tuple(sorted(action_names(spec, goal.executed))),
            tuple([taken(each) for each in surviving]),
            taken(forced),
        )
        for goal, (surviving, forced) in ranks.items()
    )
    return GuaranteesCertificate(
        Vocabulary.of(spec),
        digest(spec),
        ordering,
        spec.restoration,
        CertifiedRanks(builder.finish(), goals),
        tuple(_claimed(spec, level) for level in levels),
    )


def _claimed(spec: Spec, level: Level) -> CertifiedLevel:
    told = level.guarantee
    cubes = None
    if level.cubes is not None:
        cubes = tuple(
            {
                variable.name: tuple([variable.values[value] for value in values])
                for variable, values in zip(spec.variables, cube, strict=True)
                if len(values) < len(variable.values)
            }
            for cube in level.cubes
        )
    return CertifiedLevel(told.kind, told.steps, told.deviations, level.states, cubes)
