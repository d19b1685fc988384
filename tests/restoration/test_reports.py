"""What `synth` says of a policy that takes several steps to restore safety."""

from dataclasses import replace

from tests.semantics.test_restoration import EDGE, RETRY, VALVES, restoring
from tumato_symbolic import Realizable, parse, synthesize
from tumato_symbolic.report.restored import restored_json, restored_text
from tumato_symbolic.spec import Spec
from tumato_symbolic.synthesis import Statistics


def statistics(spec: Spec) -> Statistics:
    """Those of a specification with a policy."""
    outcome = synthesize(spec)
    assert isinstance(outcome, Realizable)
    return outcome.statistics


def test_worst_cases_are_counted() -> None:
    """One of three states of two valves takes two steps."""
    found = statistics(restoring(VALVES, "bounded"))
    assert list(restored_text(found)) == [
        "  safety is restored in at most 2 steps, whatever happens (2 states in 1 step, 1 in 2); "
        "the longest way takes a duration of 2"
    ]
    assert restored_json(found) == {
        "restored": {"bounded": {"1": 2, "2": 1}, "fair": {}, "longest_duration": 2, "unsafe_by_level": [3]}
    }


def test_what_is_repeated_is_told_apart() -> None:
    """Under `fair` nothing bounds the number of steps."""
    (line,) = restored_text(statistics(restoring(RETRY, "fair")))
    assert "in at most 1 step, if nominal effects occur often enough (1 state in 1 step)" in line


def test_levels_are_counted() -> None:
    """Two states are on the edge, one is off it with the arm out."""
    lines = list(restored_text(statistics(parse(EDGE.format(1, 2)))))
    assert lines[0].startswith("  the level is raised in at most 1 step")
    assert lines[1] == "  unsafe states by level, severe rules first: 2 at level 0 and 1 at level 1 of 2"


def test_one_step_is_told_as_before() -> None:
    """Nothing is said of several steps where one has to do."""
    plain = replace(parse(VALVES.replace("rule: B is closed", "")), restoration="one_step")
    assert not list(restored_text(statistics(plain)))
    assert restored_json(statistics(plain)) == {}
