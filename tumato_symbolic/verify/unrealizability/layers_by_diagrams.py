"""Whether allowed steps stay in layers of states, by the walk: for layers that count, which are hard for Z3."""

from __future__ import annotations

from collections.abc import Sequence

from tumato_symbolic.diagrams import Diagram, Reference
from tumato_symbolic.semantics import State
from tumato_symbolic.spec import Ordering, Spec
from tumato_symbolic.verify.by_diagrams.functions import FALSE
from tumato_symbolic.verify.by_diagrams.steps import Steps


def first_left(
    spec: Spec, ordering: Ordering, diagram: Diagram[bool], roots: Sequence[Reference], deadline: float
) -> State | None:
    """A safe state of a layer from where some allowed step leads to none that may follow; None where there is none.

    After layer `n` layers 1 to `n + 1` may follow, and after the last one anything where it meets the plan bound.
    Raises `BudgetError` when `deadline` (monotonic) comes first, or memory is used up.
    """
    steps = Steps(spec, ordering, diagram.order, deadline)
    walk, following = steps.walk, steps.successor(steps.chosen)
    taken = walk.import_diagram(diagram, int)
    layers = [taken[root] for root in roots]
    bound, held = spec.max_plan_length, layers[0]
    for number, layer in enumerate(layers, 1):
        if bound is not None and number == len(layers) >= bound:
            break
        walk.check_time()
        held = walk.any_of((held, *layers[number : number + 1]))
        pairs = walk.all_of((steps.allowed, steps.safe, layer))
        left = walk.without(pairs, walk.compose(held, following))
        if left != FALSE:
            return steps.first_state(left)
    return None
