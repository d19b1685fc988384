"""Policies that restore safety in several steps, or by severity: the stand-alone checker and the package agree."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from random import Random

import pytest
from msgspec.structs import replace

from tests.checker.agreement import failing
from tests.checker.standalone import ask
from tests.checker.stepwise import MODES, policies, stepwise_spec, ways
from tests.printing import print_spec
from tumato_symbolic.policy import as_diagram, dumps, policy_from_rows
from tumato_symbolic.semantics import judge
from tumato_symbolic.spec import Restoration, Spec

pytestmark = pytest.mark.usefixtures("read_once")


def disagreements(folder: Path, spec: Spec, seed: int, samples: int = 0) -> tuple[Counter[str], list[str]]:
    """How many policies failed in each property, and where the judges differ."""
    counts = Counter[str]()
    text, found = print_spec(spec, Random(seed)), []
    for ordering in ("any", "first"):
        for number, rows in enumerate(policies(spec, ordering, Random(seed), 2, samples)):
            judgement = judge(spec, rows, ordering)
            policy = policy_from_rows(spec, rows, ordering)
            if number % 2:
                policy = replace(policy, decisions=as_diagram(policy))
            wanted = 0 if judgement.sound_and_complete and judgement.minimal else 1, failing(judgement)
            options = "--effect-ordering", ordering, "--restoration", spec.restoration
            answer = ask(folder, dumps(policy), text, *options)
            given = (answer.code, answer.failing)
            if given != wanted:
                found.append(f"{seed} {ordering} {number}: {given}, not {wanted}\n{answer}")
            counts.update(wanted[1].keys() or {"nothing"})
    return counts, found


@pytest.mark.parametrize(("restoration", "tiers"), MODES)
def test_judges_agree(restoration: Restoration, tiers: int, tmp_path: Path) -> None:
    """Under both orderings every property fails in as many states as the explicit meaning says."""
    met = Counter[str]()
    for seed in range(2, 8):
        drawn = stepwise_spec(seed, restoration, tiers) if seed < 4 else ways(seed, restoration, tiers)
        counts, found = disagreements(tmp_path, drawn, seed, 12 if seed >= 4 else 0)
        assert not found, "\n".join(found)
        met += counts
    assert {"nothing", "total", "safe", "goals", "minimal", "restoring"} <= set(met), met
