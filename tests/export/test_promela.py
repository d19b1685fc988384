"""The closed loop for SPIN: right policies violate no assertion, and wrong ones do."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import chain, islice
from pathlib import Path
from random import Random

import pytest
from msgspec.structs import replace

from tests.export.cases import generated, stepwise
from tests.export.compiler import Case
from tests.export.model_checkers import needs_spin, spin_accepts
from tests.export.policies import example, random_request, request
from tumato_symbolic import parse
from tumato_symbolic.diagnostics import Code, UserError
from tumato_symbolic.export import promela
from tumato_symbolic.policy import Table
from tumato_symbolic.semantics import is_valid, judge
from tumato_symbolic.spec import Restoration


def _compare(cases: Sequence[Case], folder: Path) -> None:
    """SPIN and the meaning agree on each policy; what is decided in states that are not valid plays no part."""
    for case in cases:
        truth = judge(case.spec, case.rows, case.ordering)
        made = replace(request(case.spec, case.rows), ordering=case.ordering)
        assert spin_accepts(promela.files(made)[0], folder) == truth.sound_and_complete, truth


@needs_spin
@pytest.mark.parametrize("name", ["amr", "brake"])
def test_examples_right_and_wrong(name: str, tmp_path: Path) -> None:
    """The policy of an example is accepted; with a hole, or nothing done in some state, what the meaning says."""
    made = example(name)
    assert isinstance(made.policy.decisions, Table)
    rows, random = made.policy.decisions.rows, Random(name)
    assert spin_accepts(promela.files(example(name, diagram=True))[0], tmp_path)
    hole = random.choice([state for state in rows if is_valid(made.spec, state)])
    idle = random.choice([state for state, chosen in rows.items() if chosen])
    holed = {state: chosen for state, chosen in rows.items() if state != hole}
    _compare([Case(made.spec, each, made.ordering) for each in (holed, {**rows, idle: frozenset()})], tmp_path)


@needs_spin
@pytest.mark.parametrize("profile", ["mixed", "concurrent"])
def test_generated_policies(profile: str, tmp_path: Path) -> None:
    """Right and wrong ones, under both orderings."""
    realizable = (found[:1] + found[-2:] for seed in range(260, 320) if (found := generated(profile, seed, 2)))
    _compare(list(chain.from_iterable(islice(realizable, 1))), tmp_path)


@needs_spin
@pytest.mark.parametrize("restoration", ["one_step", "bounded", "fair"])
def test_where_safety_takes_several_steps(restoration: Restoration, tmp_path: Path) -> None:
    """And with severities of state rules. Of more specifications: `python -m tests.export.trial spin`."""
    cases = stepwise(53, restoration, 2)
    _compare([cases[0], cases[-2]], tmp_path)


@needs_spin
@pytest.mark.parametrize("seed", range(2))
def test_nasty_names_are_read(seed: int, tmp_path: Path) -> None:
    """Words of Promela and of C, and names that are alike once joined, make a model that is searched to the end."""
    spin_accepts(promela.files(random_request(seed))[0], tmp_path)


def test_too_many_states_are_refused() -> None:
    """The model counts steps up to the number of states."""
    variables = "\n".join(f"state S{number} can be a, b" for number in range(31))
    made = request(parse(f"BEGIN STATE VECTOR\n{variables}\nEND STATE VECTOR"), {(0,) * 31: frozenset()})
    with pytest.raises(UserError) as error:
        promela.files(made)
    assert error.value.diagnostics[0].code is Code.TUM508
