"""Why there is no policy where safety may take several steps to restore, against the explicit meaning."""

import pytest

from tests.restoration.campaign import specifications
from tests.restoration.test_repair import crossing
from tests.restoration.truth import World
from tests.semantics.test_restoration import RETRY, restoring
from tumato_symbolic.diagnostics import Source
from tumato_symbolic.explain.elements import keep_only
from tumato_symbolic.explain.explain import explain
from tumato_symbolic.explain.explanation import Explanation
from tumato_symbolic.report.explained import Explained, as_text
from tumato_symbolic.spec import Spec


def explained(spec: Spec) -> Explanation:
    """The whole explanation of a specification without a policy."""
    found = explain(spec)
    assert isinstance(found, Explanation)
    return found


def test_what_may_change_nothing_is_to_blame() -> None:
    """The rule that is broken and the alternative by which nothing happens; dropping either gives a policy."""
    spec = restoring(RETRY, "bounded")
    found = explained(spec)
    (reason,) = found.reasons
    assert reason.kind == "no-restoration"
    assert sorted(element.kind for element in reason.core) == ["alternative", "state-rule"]
    everything = explain(spec, wanted_repairs="all")
    assert isinstance(everything, Explanation)
    assert everything.repairs[: len(found.repairs)] == found.repairs
    changed = [[change.element.kind for change in repair.changes] for repair in everything.repairs if repair.changes]
    assert changed == [["alternative"], ["state-rule"]]
    assert found.part is not None
    assert found.part.states == 1


def test_states_that_no_policy_serves_together() -> None:
    """The conflict of two unsafe states is told, with what would settle it."""
    found = explained(crossing(north="right", south="left"))
    assert [reason.kind for reason in found.reasons] == ["conflict"]
    assert found.part is not None
    assert found.repairs


@pytest.mark.parametrize("seed", range(5100, 5103))
def test_reasons_hold_and_are_minimal(seed: int) -> None:
    """What a core requires suffices for each failing state, and without any one element the state does not fail so."""
    for name, spec in specifications(seed):
        if len(spec.tiers) > 1 or not name.startswith(("restoring", "stepwise")):
            continue
        found = explain(spec, wanted_repairs=1)
        if not isinstance(found, Explanation):
            continue
        for reason in found.reasons:
            if reason.kind != "no-restoration":
                continue
            core = frozenset(reason.core)
            assert World(keep_only(spec, core), spec.ordering).kind(reason.example) == "no-restoration", name
            for element in core:
                fewer = keep_only(spec, core - {element})
                assert World(fewer, spec.ordering).kind(reason.example) != "no-restoration", (name, element)


def test_the_report_says_that_safety_is_not_restored() -> None:
    """The headline of the failing states and of the reason."""
    spec = restoring(RETRY, "bounded")
    text = as_text(Explained(Source("spec.tum", RETRY), spec, explained(spec), (), None, False), False)
    assert "error[TUM404]: safety cannot be restored from this state" in text
    assert "Why safety cannot be restored from this state" in text
