"""Certificates of unrealizability where an action nominally changes nothing (`docs/semantics.md`, rule 3.9)."""

from __future__ import annotations

import pytest

from tumato_symbolic import parse
from tumato_symbolic.spec import Ordering
from tumato_symbolic.synthesis import Unrealizable, synthesize
from tumato_symbolic.verify import verify_unrealizable

FUMBLING = """\
BEGIN STATE VECTOR
state x can be bad, good
END STATE VECTOR
BEGIN ACTIONS
action fix
  preconditions: x is bad
  nominal effects: x is good
action beep
  nominal effects: none
  alternative effects: x is good
END ACTIONS
BEGIN REACTION RULES
rule: IF executing fix THEN executing beep
END REACTION RULES
BEGIN STATE RULES
rule: x is good
END STATE RULES
"""
"""The second action may write, so that nothing at all is one of its effects: the state stays bad."""


@pytest.mark.parametrize("ordering", ["any", "first"])
def test_an_action_that_may_write_does_not_accompany_what_restores(ordering: Ordering) -> None:
    """With an alternative that writes, changing nothing is an effect like others."""
    spec = parse(FUMBLING)
    found = synthesize(spec, ordering)
    assert isinstance(found, Unrealizable) and found.certificate is not None
    assert [(failure.kind, failure.count) for failure in found.failures] == [("no-allowed-set", 1)]
    assert verify_unrealizable(found.certificate, spec).verdict == "proved"
