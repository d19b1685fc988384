"""What `synth` says of a policy that takes several steps to restore safety."""

from msgspec.structs import replace

from tests.semantics.test_restoration import EDGE, RETRY, VALVES, restoring
from tumato_symbolic import Realizable, Unrealizable, parse, synthesize
from tumato_symbolic.diagnostics import Source
from tumato_symbolic.report.objections import Place
from tumato_symbolic.report.restorable import restorable_json, restorable_lines
from tumato_symbolic.report.restored import restored_json, restored_text
from tumato_symbolic.report.synthesized import Synthesized, as_text
from tumato_symbolic.spec import Spec
from tumato_symbolic.synthesis import Statistics


def statistics(spec: Spec) -> Statistics:
    """Those of a specification with a policy."""
    outcome = synthesize(spec)
    assert isinstance(outcome, Realizable)
    return outcome.statistics


def told(spec: Spec) -> list[str]:
    """What would restore the states of a specification without a policy, for a person."""
    outcome = synthesize(spec)
    assert isinstance(outcome, Unrealizable)
    assert outcome.restorability is not None
    return list(restorable_lines(Place(spec, "spec.tum"), outcome.restorability))


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


def test_what_would_restore_is_told() -> None:
    """Under `one_step`: what each setting would do, with the line to add, and a joint action that was tried."""
    spec = parse(VALVES)
    outcome = synthesize(spec)
    assert isinstance(outcome, Unrealizable)
    assert outcome.restorability is not None
    place = Place(spec, "spec.tum")
    assert list(restorable_lines(place, outcome.restorability)) == [
        "What would restore this state:",
        "  `restoration: bounded` in CONFIG: it, in at most 2 steps (duration 2 at most), whatever happens",
        "  one action with the effects A is closed and B is closed (tried): it, in one step",
    ]
    found = restorable_json(place, outcome.restorability)["restorable"]
    assert found == {
        "bounded": {
            "count": 1,
            "example": {"A": "open", "B": "open"},
            "efforts": [{"duration": 2, "steps": 2, "states": 1}],
        },
        "joint_actions": [{"effects": {"A": "closed", "B": "closed"}, "left": 0}],
    }


def test_with_severities_the_way_to_the_next_level_is_told() -> None:
    """Efforts are of a level; so is what cannot be restored."""
    text = VALVES.replace("END STATE RULES", "severity: 2 rule: A is closed OR B is closed END STATE RULES")
    assert told(parse(text)) == [
        "What would restore this state:",
        "  `restoration: bounded` in CONFIG: it, to a higher level in at most 2 steps (duration 2 at most), "
        "whatever happens",
        "  one action with the effects A is closed and B is closed (tried): it, to a higher level in one step",
    ]
    idle = parse(
        EDGE.format(1, 2).replace(
            "retreat duration: 2 preconditions: Place is edge", "retreat preconditions: Place is floor"
        )
    )
    assert told(idle)[-1].endswith(
        "no sequence of actions leads to a higher level without breaking another rule that has to be kept"
    )


def test_what_no_bound_restores_is_told() -> None:
    """Under `bounded`: whether repetition leads back, or nothing does."""
    idle = RETRY.replace("nominal effects: M is off", "nominal effects: none")
    for text, line in (
        (RETRY, "`restoration: fair` in CONFIG: it, if nominal effects occur often enough"),
        (idle, "for it, no setting: no sequence of actions leads back to safety without breaking another rule"),
    ):
        assert told(restoring(text, "bounded")) == ["What would restore this state:", f"  {line}"]


def test_the_report_of_synth_says_how_to_judge_it() -> None:
    """What overrules the specification is handed on to `verify`."""
    spec = restoring(VALVES, "bounded")
    outcome = synthesize(spec)
    done = Synthesized(Source("spec.tum", VALVES), spec, outcome, None, (), "policy.json", True, restoration="bounded")
    assert "tumato-sym verify policy.json spec.tum --restoration bounded" in as_text(done, False)
