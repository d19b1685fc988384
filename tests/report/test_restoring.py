"""What `verify` reports where safety may take several steps to restore."""

from msgspec.structs import replace

from tests.semantics.test_restoration import EDGE, RETRY, VALVES
from tests.verify.several_steps import Rows
from tumato_symbolic import parse
from tumato_symbolic.diagnostics import Source
from tumato_symbolic.policy import policy_from_rows
from tumato_symbolic.report.verified import Verified, as_json, as_text
from tumato_symbolic.spec import Restoration
from tumato_symbolic.verify import verify

NOTHING = frozenset[int]()
STOP: Rows = {(0,): frozenset((0,)), (1,): NOTHING}
SINGLY: Rows = {(0, 0): frozenset((0,)), (0, 1): frozenset((0,)), (1, 0): frozenset((1,)), (1, 1): NOTHING}


def verified(text: str, restoration: Restoration, rows: Rows, made_for: Restoration = "one_step") -> Verified:
    """The verification of some rows against a text."""
    spec = replace(parse(text), restoration=restoration)
    policy = replace(policy_from_rows(spec, rows), restoration=made_for)
    return Verified(Source("x.tum", text), spec, "p.json", verify(policy, spec), (), 0.1)


def shown(text: str, restoration: Restoration, rows: Rows, made_for: Restoration = "one_step") -> str:
    """Its report."""
    return as_text(verified(text, restoration, rows, made_for), colour=False)


def test_how_safety_is_restored() -> None:
    """It is said for all modes but the plain one, with the claim about it."""
    assert "within a bound whatever effects occur (bounded)" in shown(VALVES, "bounded", SINGLY)
    assert "safety is restored from every unsafe state, whatever effects occur" in shown(VALVES, "bounded", SINGLY)
    assert "if nominal effects occur again and again" in shown(RETRY, "fair", STOP)
    retreating: Rows = {(0, 0): frozenset((0,)), (0, 1): frozenset((0,)), (1, 0): frozenset((1,)), (1, 1): NOTHING}
    assert "in one step for each severity" in shown(EDGE.format(1, 2), "one_step", retreating)
    assert "restor" not in shown(RETRY, "one_step", {(1,): NOTHING}).replace("where safety is restored", "")


def test_a_loop_of_outcomes() -> None:
    """A stop that may do nothing, and one that is not even tried."""
    text = shown(RETRY, "bounded", STOP)
    assert "which need not restore safety: its outcomes and those of later decisions may lead back to a state:" in text
    assert "  → {stop} → M=on" in text
    text = shown(RETRY, "fair", {**STOP, (0,): NOTHING})
    assert "after which the nominal run does not restore safety: it comes back to a state:" in text
    assert "but its goal is none but safety" in text
    assert "which does not restore safety; {stop} restores it in 1 nominal step that takes 1," in text


def test_a_better_set() -> None:
    """How well either restores, for people and for programs."""
    both: Rows = {**SINGLY, (0, 0): frozenset((0, 1))}
    text = shown(VALVES, "bounded", both)
    assert "which restores safety in at most 2 steps that take at most 3; {close_a} restores it in at most 2" in text
    report = as_json(verified(VALVES, "bounded", both))
    minimal = report["properties"]["minimal"]["refutation"]  # type: ignore[index]
    assert report["restoration"] == "bounded"
    assert minimal["restoring"] == {
        "decision": {"how": "bounded", "duration": 3, "steps": 2},
        "cheaper": {"how": "bounded", "duration": 2, "steps": 2},
    }
    assert "restoration" not in as_json(verified(RETRY, "one_step", STOP))


def test_made_for_a_weaker_restoration() -> None:
    """The policy is refuted for that alone."""
    text = shown(VALVES, "bounded", SINGLY, made_for="fair")
    assert "restoration refuted" in text
    assert "choose one of them with --restoration" in text
    assert "restoration refuted" not in shown(VALVES, "bounded", SINGLY, made_for="bounded")
