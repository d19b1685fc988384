"""The judge of the page finds in every policy what the explicit one finds; `python -m tests.page` tries many."""

from __future__ import annotations

import json
import subprocess
from itertools import islice

import pytest

from tests.page.judged import JUDGE, NODE, Asked, Tally, asked, compare, needs_node

SEEDS = (4, 6)


@pytest.fixture(scope="module")
def sample() -> Tally:
    """Some policies of specifications of every kind, most of them changed."""
    tally = Tally()
    compare([each for seed in SEEDS for each in asked(seed, 1, 2)], tally)
    return tally


@needs_node
def test_the_judges_agree(sample: Tally) -> None:
    """State by state, in all that can be wrong."""
    assert not sample.complaints
    assert sample.judged > 15


@needs_node
def test_the_sample_has_every_fault(sample: Tally) -> None:
    """Decisions missing, not allowed, that miss goals, that restore nothing, or not well."""
    assert {"missing", "not_allowed", "goal_missed", "not_minimal", "not_restored"} <= sample.faults.keys()
    assert sample.wrong < sample.judged


@needs_node
def test_a_difference_is_noticed() -> None:
    """A judge that is told of another specification disagrees."""

    tally = Tally()
    compare([Misled(each.name, each.spec, each.policy) for each in islice(asked(1, 1), 5)], tally)
    assert tally.complaints


class Misled(Asked, frozen=True):
    """A question that forgets the rules of the specification, and says another one."""

    @property
    def question(self) -> str:
        """The wrong one."""
        told = json.loads(Asked.question.fget(self))  # type: ignore[attr-defined]
        told["spec"]["state_rules"] = [{"is": [0, 0], "text": "", "line": 1, "severity": 1}]
        return json.dumps(told)


@needs_node
def test_states_are_merged_into_cubes() -> None:
    """Which hold the same states, each once, with the same decisions."""
    command = [str(NODE), str(JUDGE.with_name("merging.mjs"))]
    ran = subprocess.run(command, capture_output=True, text=True, check=False)
    assert ran.returncode == 0, ran.stderr
