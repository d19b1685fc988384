"""Actions without effects in every room: they may accompany what restores safety (`docs/semantics.md`, rule 3.9)."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.checker.standalone import ask
from tumato_symbolic import parse
from tumato_symbolic.policy import dumps, policy_from_rows
from tumato_symbolic.spec import Ordering
from tumato_symbolic.synthesis import Realizable, Unrealizable, synthesize
from tumato_symbolic.verify import ProverName, verify, verify_unrealizable

NOTIFIER = """\
BEGIN STATE VECTOR
state x can be bad, good
END STATE VECTOR
BEGIN ACTIONS
action fix
  preconditions: x is bad
  nominal effects: x is good
action beep
  preconditions: none
  nominal effects: none
END ACTIONS
BEGIN REACTION RULES
rule: IF executing fix THEN executing beep
END REACTION RULES
BEGIN STATE RULES
rule: x is good
END STATE RULES
"""
BAD, GOOD = (0,), (1,)
FIX, BEEP = 0, 1
FUMBLING = NOTIFIER.replace("effects: none", "effects: none\n  alternative effects: x is good")
"""The second action may write, so that nothing at all is one of its effects: the state stays bad."""


@pytest.mark.parametrize("ordering", ["any", "first"])
def test_a_notifier_accompanies_what_restores(ordering: Ordering, tmp_path: Path) -> None:
    """The set is found, and proved by all judges; the same without the action that restores is refuted."""
    spec = parse(NOTIFIER)
    found = synthesize(spec, ordering)
    assert isinstance(found, Realizable)
    assert found.policy.decide({"x": "bad"}) == ("fix", "beep")
    wrong = policy_from_rows(spec, {BAD: frozenset({BEEP}), GOOD: frozenset()})
    provers: tuple[ProverName, ...] = ("z3", "walk")
    for prover in provers:
        assert verify(found.policy, spec, ordering=ordering, prover=prover).verdict == "proved"
        (refuted,) = [p for p in verify(wrong, spec, ordering=ordering, prover=prover).properties if p.refutation]
        assert refuted.name == "safe"
    assert ask(tmp_path, dumps(found.policy), NOTIFIER, "--effect-ordering", ordering).code == 0
    assert set(ask(tmp_path, dumps(wrong), NOTIFIER, "--effect-ordering", ordering).failing) == {"safe"}


@pytest.mark.parametrize("ordering", ["any", "first"])
def test_a_fumble_does_not(ordering: Ordering) -> None:
    """With an alternative that writes, changing nothing is an effect like others."""
    spec = parse(FUMBLING)
    found = synthesize(spec, ordering)
    assert isinstance(found, Unrealizable) and found.certificate is not None
    assert [(failure.kind, failure.count) for failure in found.failures] == [("no-allowed-set", 1)]
    assert verify_unrealizable(found.certificate, spec).verdict == "proved"
