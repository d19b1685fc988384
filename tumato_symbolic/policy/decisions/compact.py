"""Policies and certificates in smaller diagrams, equal wherever they mean something."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from tumato_symbolic.diagrams import Diagram, Reference, smallest
from tumato_symbolic.policy.records import Certificate, DecisionDiagram, RankedGoal, Restoring


def minimized_decisions(decisions: DecisionDiagram, sizes: Sequence[int]) -> DecisionDiagram:
    """The same decisions in every state that is defined; elsewhere actions are whatever makes the diagram small."""
    diagram, (defined, *roots) = smallest(
        decisions.diagram, decisions.roots, sizes, (decisions.diagram, decisions.defined), [decisions.defined]
    )
    return DecisionDiagram(diagram, tuple(roots), defined)


def minimized_ranks(
    certificate: Certificate, sizes: Sequence[int], states: tuple[Diagram[bool], Reference]
) -> Certificate:
    """The same ranks in all `states`, a diagram in the same order and a root of it; elsewhere they mean nothing."""
    ranks, roots = smallest(certificate.ranks, [goal.root for goal in certificate.goals], sizes, states)
    goals = zip(certificate.goals, roots, strict=True)
    ranked = tuple(RankedGoal(goal.bodies, goal.executed, root) for goal, root in goals)
    return replace(certificate, ranks=ranks, goals=ranked)


def minimized_restoring(
    restoring: Restoring, sizes: Sequence[int], states: tuple[Diagram[bool], Reference]
) -> Restoring:
    """The same efforts in all `states`, a diagram in the same order and a root of it; elsewhere they mean nothing."""
    efforts, (worst, nominal) = smallest(restoring.efforts, (restoring.worst, restoring.nominal), sizes, states)
    return replace(restoring, efforts=efforts, worst=worst, nominal=nominal)
