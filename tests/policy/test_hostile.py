"""No text, however broken, gets anything but a policy or a coded error out of the reader."""

import json
import random
from pathlib import Path

import pytest

from tests.policy.mutations import mutate, mutations
from tests.policy.strategies import amr_like, rows_of, spec_of
from tumato_symbolic.diagnostics import UserError
from tumato_symbolic.policy import Policy, UndecidedState, as_diagram, bind, count_defined, dumps, load, loads

TEXTS = [dumps(amr_like()), dumps(amr_like(diagram=True))]
SPEC = spec_of(amr_like().vocabulary)


def use(policy: Policy) -> None:
    """Everything that is done with a policy that was read."""
    assert loads(dumps(policy)).decisions == policy.decisions
    as_diagram(policy)
    assert count_defined(policy) == len(rows_of(policy, 10**6))
    state = {name: values[0] for name, values in policy.vocabulary.variables}
    try:
        policy.decide(state)
    except UndecidedState as undecided:
        assert undecided.state == state
    bound = bind(policy, SPEC)
    assert count_defined(bound) == count_defined(policy)


@pytest.mark.parametrize("text", TEXTS, ids=["table", "diagram"])
@pytest.mark.parametrize("block", range(10))
def test_mutants_end_in_a_policy_or_a_coded_error(text: str, block: int, tmp_path: Path) -> None:
    """300 mutants of each form: read, written, converted, asked and bound, or refused with TUM501 to TUM508."""
    path = tmp_path / "policy.json"
    for seed in range(block * 30, block * 30 + 30):
        path.write_bytes(mutations(text, seed))
        try:
            use(load(str(path)))
        except UserError as error:
            for diagnostic in error.diagnostics:
                assert diagnostic.code.name in {f"TUM50{number}" for number in (1, 2, 3, 4, 5, 6, 8)}
                assert len(diagnostic.message) < 1000
                assert diagnostic.message.isprintable()
                diagnostic.message.encode()


@pytest.mark.parametrize("text", TEXTS, ids=["table", "diagram"])
def test_a_broken_certificate_leaves_the_policy(text: str) -> None:
    """Whatever stands in `Certificate`: the decisions are read, and what cannot be used is set aside with a reason."""
    good = json.loads(text)
    reasons = set()
    for seed in range(300):
        document = {**good, "Certificate": mutate(json.loads(text)["Certificate"], random.Random(seed))}
        policy = loads(json.dumps(document))
        assert policy.decisions == loads(text).decisions
        assert (policy.certificate is None) == (policy.certificate_problem is not None)
        reasons.add(policy.certificate_problem)
    assert len(reasons) > 20
