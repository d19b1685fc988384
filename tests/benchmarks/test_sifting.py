"""What the comparison of orders compares is what it says."""

import pytest

from benchmarks.families import FAMILIES
from benchmarks.sifting import cells
from tumato_symbolic.diagnostics import Source
from tumato_symbolic.game import build_problem, own_region_policy
from tumato_symbolic.spec import load

pytest.importorskip("dd.cudd")


def test_the_first_is_our_order_and_no_order_is_left_behind() -> None:
    """Nodes in our order are those of a search of our own, before and after others were tried."""
    spec = load(Source("case", FAMILIES["samples"].text(4, True))).spec
    assert spec is not None
    for _ in range(2):
        ours, meanwhile, found = (int(cell.split("; ")[1].replace(",", "")) for cell in cells(spec))
        problem = build_problem(spec, spec.ordering, "cudd")
        assert ours == problem.encoding.manager.nodes(own_region_policy(problem).policy)
        assert meanwhile > 0
        assert found < ours
