"""What the order of the variables costs: `python -m benchmarks.orders` compares orders, whatever was declared.

For each specification, declared as its family does and in random orders: seconds of the search, and nodes of the
policy with its ranks, when variables are tested as declared, by FORCE alone, and with hubs first. A dash: not in time.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from random import Random
from unittest.mock import patch

from benchmarks.families import FAMILIES
from tumato_symbolic.diagnostics import Source
from tumato_symbolic.policy import DecisionDiagram
from tumato_symbolic.spec import Spec, load
from tumato_symbolic.symbolic import order
from tumato_symbolic.synthesis import Context, Limits, Realizable, synthesize

CASES = (
    ("loads", 6),
    ("uav", 1),
    ("factory", 1),
    ("robots", 3),
    ("robots", 4),
    ("samples", 15),
    ("plant", 4),
    ("plant", 10),
    ("pairs", 8),
)
DECLARED = (None, 1, 2, 3)
"""As the family does, or shuffled by a seed."""
LIMIT = 15.0

Order = Callable[[Spec], tuple[int, ...]]


def as_declared(spec: Spec) -> tuple[int, ...]:
    """No order of our own."""
    return tuple(range(len(spec.variables)))


def without_hubs(spec: Spec) -> tuple[int, ...]:
    """Related variables near each other, hubs among them."""
    with patch.object(order, "SHARE_OF_HUBS", 1.0):
        return order.variable_order(spec)


ORDERS: dict[str, Order] = {"declared": as_declared, "FORCE": without_hubs, "hubs first": order.variable_order}


def main() -> None:
    """One line for every case and order."""
    print(f"{'case':<12}{'order':<12}" + "".join(f"{'shuffled' if seed else 'as it is':>16}" for seed in DECLARED))
    for name, size in CASES:
        for title, chosen in ORDERS.items():
            cells = [measured(_declared(FAMILIES[name].text(size, True), seed), chosen) for seed in DECLARED]
            print(f"{FAMILIES[name].case(size):<12}{title:<12}" + "".join(f"{cell:>16}" for cell in cells), flush=True)


def _declared(text: str, seed: int | None) -> Spec:
    """A specification with its variables declared in a random order, or as they are."""
    lines = text.splitlines()
    states = [number for number, line in enumerate(lines) if line.lstrip().startswith("state ")]
    moved = list(states) if seed is None else Random(seed).sample(states, len(states))
    for place, line in zip(states, [lines[number] for number in moved], strict=True):
        lines[place] = line
    spec = load(Source("case", "\n".join(lines))).spec
    assert spec is not None, "benchmarks are correct specifications"
    return spec


def measured(spec: Spec, chosen: Order) -> str:
    """Processor seconds and nodes of one synthesis."""
    with patch("tumato_symbolic.symbolic.layout.variable_order", chosen):
        began = time.process_time()
        outcome = synthesize(spec, policy_format="diagram", context=Context(Limits(LIMIT)))
        seconds = time.process_time() - began
    if not isinstance(outcome, Realizable):
        return "–"
    policy, decisions = outcome.policy, outcome.policy.decisions
    assert policy.certificate is not None, "synthesis brings ranks"
    assert isinstance(decisions, DecisionDiagram), "it was asked for"
    return f"{seconds:.2f}; {len(decisions.diagram.nodes) + len(policy.certificate.ranks.nodes):,}"


if __name__ == "__main__":
    main()
