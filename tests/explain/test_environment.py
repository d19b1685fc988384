"""Tests of what the largest realizable part takes from the environment: it is said first, and guards are kept."""

import pytest

from tests.explain.robots import BRAKE, FORKLIFT, NEAR, TAUT
from tumato_symbolic import Realizable, parse, synthesize
from tumato_symbolic.diagnostics import Source
from tumato_symbolic.explain.explain import explain
from tumato_symbolic.explain.explanation import Explanation
from tumato_symbolic.explain.writing import with_assumption
from tumato_symbolic.report.explained import Explained, as_text
from tumato_symbolic.semantics import all_states, is_valid
from tumato_symbolic.semantics.lint import lint
from tumato_symbolic.spec import Spec

SAID = {
    NEAR: "it assumes that B is always ok; no action controls B:",
    TAUT: "it assumes that B is never low while P is in; no action controls B:",
    BRAKE: "it assumes that Human is never here while Speed is fast; no action controls Human:",
    FORKLIFT: "it assumes that S_Human is always clear and S_EStop is always released; "
    "no action controls S_Human or S_EStop:",
}


@pytest.mark.parametrize("text", SAID)
def test_what_is_assumed_of_the_environment_is_said_first(text: str) -> None:
    """In the line above the assumption; and once it is written, nobody advises to remove the rules that guard it."""
    spec = parse(text)
    found = explain(spec, wanted_repairs=0)
    assert isinstance(found, Explanation)
    assert found.part is not None
    report = as_text(Explained(Source("x.tum", text), spec, found, (), None, False), False).splitlines()
    number = next(number for number, line in enumerate(report) if "realizable part" in line)
    assert report[number].endswith(SAID[text])
    assert report[number + 1].startswith("  assume: ")
    assert lint(parse(with_assumption(Source("x.tum", text), found.part.text))) == ()


STEADY = {
    NEAR: None,
    TAUT: (2, "P is out"),
    BRAKE: (4, "NOT Speed is fast"),
    FORKLIFT: None,
}


@pytest.mark.parametrize("text", STEADY)
def test_a_part_that_assumes_nothing_of_the_environment_is_offered(text: str) -> None:
    """Where there is one; and with it no warning speaks of what the environment may do."""
    spec = parse(text)
    found = explain(spec, wanted_repairs=0)
    assert isinstance(found, Explanation)
    assert found.part is not None
    assert found.part.steady == STEADY[text]
    report = as_text(Explained(Source("x.tum", text), spec, found, (), None, False), False)
    assert ("assumes nothing of what no action controls:\n  assume: " in report) == (STEADY[text] is not None)
    if found.part.steady is not None:
        written = parse(with_assumption(Source("x.tum", text), found.part.steady[1]))
        assert isinstance(synthesize(written), Realizable)
        assert not _changes_alone_lead_out(written, spec)


def _changes_alone_lead_out(written: Spec, spec: Spec) -> bool:
    """Whether variables that no action writes lead from a state that is assumed to a valid one that is not."""
    kept = [state for state in all_states(spec) if is_valid(written, state)]
    left = [state for state in all_states(spec) if is_valid(spec, state) and state not in kept]
    own = [variable for variable in range(len(spec.variables)) if variable not in spec.environment]
    return any(all(one[each] == other[each] for each in own) for one in kept for other in left)


def test_the_environment_is_what_no_effect_writes() -> None:
    """Alternative effects count: what they write is no longer the environment's alone."""
    text = NEAR.replace("nominal effects: L is on", "nominal effects: L is on alternative effects: B is critical")
    assert parse(NEAR).environment == {0}
    assert parse(text).environment == frozenset()


def test_an_assumption_repeats_no_rule() -> None:
    """What a rule says is assumed in other words, so that nobody advises to remove the rule as a repetition."""
    text = NEAR.replace("can be critical, ok", "can be critical, low, ok")
    found = explain(parse(text), wanted_repairs=0)
    assert isinstance(found, Explanation)
    assert found.part is not None
    written = with_assumption(Source("x.tum", text), found.part.text)
    assert "assume: B is low OR B is ok" in written
    assert lint(parse(written)) == ()
