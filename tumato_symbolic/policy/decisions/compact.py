"""Policies and certificates in smaller diagrams, equal wherever they mean something."""

from __future__ import annotations

from collections.abc import Sequence

from tumato_symbolic.diagrams import Diagram, Reference, smallest
from tumato_symbolic.policy.records import DecisionDiagram, SomeDrawn


def minimized_decisions(decisions: DecisionDiagram, sizes: Sequence[int]) -> DecisionDiagram:
    """The same decisions in every state that is defined; elsewhere actions are whatever makes the diagram small."""
    diagram, (defined, *roots) = smallest(
        decisions.diagram, decisions.roots, sizes, (decisions.diagram, decisions.defined), [decisions.defined]
    )
    return DecisionDiagram(diagram, tuple(roots), defined)


def minimized(record: SomeDrawn, sizes: Sequence[int], states: tuple[Diagram[bool], Reference]) -> SomeDrawn:
    """The same in all `states`, a diagram in the same order and a root of it; elsewhere it means nothing."""
    return record.drawn(*smallest(*record.drawing, sizes, states))
