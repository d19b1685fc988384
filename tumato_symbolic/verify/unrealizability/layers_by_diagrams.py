"""Whether allowed steps stay in layers of states, by the walk: for layers that count, which are hard for Z3."""

from __future__ import annotations

from collections.abc import Sequence

from tumato_symbolic.diagrams import Diagram, DiagramBuilder, Reference
from tumato_symbolic.policy import DecisionDiagram
from tumato_symbolic.semantics import State
from tumato_symbolic.spec import Ordering, Spec
from tumato_symbolic.verify.by_diagrams.model import Model
from tumato_symbolic.verify.by_diagrams.walk import FALSE


def first_left(
    spec: Spec, ordering: Ordering, diagram: Diagram[bool], roots: Sequence[Reference], deadline: float
) -> State | None:
    """A safe state of a layer from where some allowed step leads to none that may follow; None where there is none.

    After layer `n` layers 1 to `n + 1` may follow, and after the last one anything where it meets the plan bound.
    Raises `BudgetError` when `deadline` (monotonic) comes first, or memory is used up.
    """
    nothing: Diagram[bool] = DiagramBuilder(diagram.order, (False, True)).finish()
    model = Model(spec, DecisionDiagram(nothing, (0,) * len(spec.actions), 0), ordering, deadline)
    walk, following = model.walk, model.successor(model.chosen)
    taken = walk.taken(diagram, int)
    layers = [taken[root] for root in roots]
    bound, held = spec.max_plan_length, layers[0]
    for number, layer in enumerate(layers, 1):
        if bound is not None and number == len(layers) >= bound:
            break
        walk.check_time()
        held = walk.any_of((held, *layers[number : number + 1]))
        steps = walk.all_of((model.allowed, model.safe, layer))
        left = walk.without(steps, walk.substitute(held, following))
        if left != FALSE:
            return model.first_state(left)
    return None
