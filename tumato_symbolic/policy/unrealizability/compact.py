"""Certificates of unrealizability in smaller diagrams, equal wherever they mean something."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from tumato_symbolic.diagrams import Reference, smallest
from tumato_symbolic.policy.unrealizability.records import NoPlan, NoRestoration


def minimized_trap(reason: NoRestoration, sizes: Sequence[int], states: Reference) -> NoRestoration:
    """The same set in all `states`, a root of the same diagram; elsewhere it means nothing."""
    diagram, (root,) = smallest(reason.diagram, [reason.root], sizes, (reason.diagram, states))
    return replace(reason, diagram=diagram, root=root)


def minimized_layers(reason: NoPlan, sizes: Sequence[int], states: Reference) -> NoPlan:
    """The same layers in all `states`, a root of the same diagram; elsewhere they mean nothing."""
    diagram = reason.diagram
    return reason.drawn(*smallest(diagram, reason.roots, sizes, (diagram, states)))
