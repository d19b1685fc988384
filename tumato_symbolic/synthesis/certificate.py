"""The policy as data, and the ranks that prove it."""

from __future__ import annotations

from collections.abc import Sequence

from msgspec.structs import replace

from tumato_symbolic.diagrams import Diagram, DiagramBuilder, Reference
from tumato_symbolic.game import Layers, Problem, Restoration
from tumato_symbolic.policy import (
    Certificate,
    DecisionDiagram,
    Policy,
    RankedGoal,
    Restoring,
    Vocabulary,
    minimized,
    minimized_decisions,
)
from tumato_symbolic.semantics import Effort, Residual, action_names, actions_of
from tumato_symbolic.spec import Spec, canonical_text, digest
from tumato_symbolic.symbolic import Bdd, Extractor


def goal_names(spec: Spec, residual: Residual) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """A residual goal as certificates name it: canonical texts of its bodies, and the executed actions; sorted."""
    bodies = sorted(canonical_text(spec, spec.bodies[body].formula) for body in residual.bodies)
    return tuple(bodies), tuple(sorted(action_names(spec, residual.executed)))


def policy_diagram(
    problem: Problem, policy: Bdd, ranks: Sequence[Layers], restoration: Restoration | None = None
) -> Policy:
    """A policy that is defined in every valid state, with its certificate; `ranks` must be exact.

    `restoration` is how the policy restores safety, where that may take several steps; `ranks` then are of all valid
    states. What its diagrams say of other states is free, and chosen so that they are small. Where residual goals are
    many it has no ranks: a proof computes them, for all goals together.
    """
    encoding, steps = problem.encoding, problem.steps
    builder: DiagramBuilder[bool] = DiagramBuilder(encoding.order, (False, True))
    extract = Extractor(encoding, builder, default=False)
    acting = encoding.states_executing(policy)
    roots = [
        extract.function([(True, encoding.manager.union(acting[case] for case in cases))])
        for cases in problem.spec.cases
    ]
    defined = extract.function([(True, steps.valid)])
    ranked = extract.function([(True, steps.safe if restoration is None else steps.valid)])
    unsafe = extract.function([(True, steps.unsafe)]) if restoration is not None else defined
    found, vocabulary = builder.finish(), Vocabulary.of(problem.spec)
    proof = None
    if restoration is not None or not problem.goals_are_many:
        own = minimized(certificate(problem, policy, ranks), vocabulary.sizes, (found, ranked))
        proof = _with_restoring(problem, own, restoration, (found, unsafe))
    return Policy(
        vocabulary,
        minimized_decisions(DecisionDiagram(found, tuple(roots), defined), vocabulary.sizes),
        steps.ordering,
        digest(problem.spec),
        proof,
        restoration=problem.spec.restoration,
    )


def _with_restoring(
    problem: Problem,
    ranks: Certificate,
    restoration: Restoration | None,
    states: tuple[Diagram[bool], Reference],
) -> Certificate:
    """The certificate with the efforts in unsafe states, where safety may take several steps to restore."""
    if restoration is None:
        return ranks
    efforts = sorted({*restoration.worst, *restoration.nominal})
    builder: DiagramBuilder[Effort | None] = DiagramBuilder(problem.encoding.order, (None, *efforts))
    extract = Extractor(problem.encoding, builder, default=None)
    roots = [extract.function(sorted(found.items())) for found in (restoration.worst, restoration.nominal)]
    spec = problem.spec
    deviations = (replace(each, better=actions_of(spec, each.better)) for each in restoration.deviations)
    restoring = Restoring(builder.finish(), roots[0], roots[1], tuple(deviations))
    return replace(ranks, restoring=minimized(restoring, Vocabulary.of(problem.spec).sizes, states))


def certificate(problem: Problem, policy: Bdd, ranks: Sequence[Layers]) -> Certificate:
    """The ranks of every residual goal of the policy's decisions, and of allowed sets in unsafe states.

    There are none where one target stands for all residual goals.
    """
    spec, steps = problem.spec, problem.steps
    concerned = policy | (steps.allowed & steps.unsafe)
    deepest = max((len(layers) for layers in ranks), default=0)
    builder: DiagramBuilder[int | None] = DiagramBuilder(problem.encoding.order, (None, *range(deepest)))
    extract = Extractor(problem.encoding, builder, default=None)
    goals: list[RankedGoal] = []
    for target, layers in zip(problem.targets, ranks, strict=True):
        residuals = [residual for residual, pairs in target.residuals if (pairs & concerned) != problem.false]
        if residuals:
            root = extract.function(list(enumerate(layers)))
            goals.extend(RankedGoal(*goal_names(spec, residual), root) for residual in residuals)
    goals.sort(key=lambda goal: (goal.bodies, goal.executed))
    return Certificate(builder.finish(), tuple(goals))
