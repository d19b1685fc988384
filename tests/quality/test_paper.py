"""The numbers of the paper's example, and those stated for the other specifications."""

import pytest

from tests.repo.documents import ROOT
from tests.repo.examples import solved
from tumato_symbolic import Policy, Realizable, Unrealizable, verify
from tumato_symbolic.policy import as_table, policy_from_rows
from tumato_symbolic.semantics import ActionSet, State, action_names, allowed_sets, duration, is_safe

AMR = ROOT / "examples" / "amr.tum"


def _amr_rows() -> dict[State, ActionSet]:
    _, outcome = solved(AMR)
    assert isinstance(outcome, Realizable)
    table = as_table(outcome.policy, 32)
    assert table is not None
    return dict(table.rows)


def test_amr_restorations() -> None:
    """In all 8 unsafe states the conveyor is stopped, with duration 1."""
    spec, _ = solved(AMR)
    unsafe = [state for state in _amr_rows() if not is_safe(spec, state)]
    assert len(unsafe) == 8
    assert {action_names(spec, _amr_rows()[state]) for state in unsafe} == {("stop_conveyor",)}


def test_amr_what_restores() -> None:
    """In (corridor, low, free, on) three sets restore safety, with durations 1, 10 and 11; none goes to the charger."""
    spec, _ = solved(AMR)
    sets = {action_names(spec, found): duration(spec, found) for found in allowed_sets(spec, (0, 0, 1, 0), "any")}
    assert sets == {
        ("stop_conveyor",): 1,
        ("move_to_workstation_2",): 10,
        ("move_to_workstation_2", "stop_conveyor"): 11,
    }


def test_amr_slower_restoration_is_refuted() -> None:
    """Restoring (corridor, ok, loaded, on) by a move: everything holds but minimal, refuted by stop_conveyor."""
    spec, _ = solved(AMR)
    rows = _amr_rows()
    rows[0, 1, 0, 0] = frozenset((1,))
    verification = verify(policy_from_rows(spec, rows), spec)
    verdicts = {found.name: found.verdict for found in verification.properties}
    assert verdicts == {"total": "proved", "safe": "proved", "goals": "proved", "minimal": "refuted"}
    (refuted,) = (found.refutation for found in verification.properties if found.refutation)
    assert refuted.state == (0, 1, 0, 0)
    assert refuted.cheaper is not None
    assert action_names(spec, refuted.cheaper) == ("stop_conveyor",)


def test_amr_with_two_loads() -> None:
    """128 states, 112 valid, 80 safe; realizable, with 14 states that need a run through another goal's region."""
    _, outcome = solved(ROOT / "examples" / "amr_two_loads.tum")
    assert isinstance(outcome, Realizable)
    counts = outcome.statistics
    assert (counts.total, counts.valid, counts.safe) == (128, 112, 80)
    assert counts.safe - counts.own_region > 0


def test_two_robots() -> None:
    """1,024 states, 496 safe; not realizable: exactly 112 states have no allowed set, and no other state fails."""
    _, outcome = solved(ROOT / "examples" / "two_robots.tum")
    assert isinstance(outcome, Unrealizable)
    assert (outcome.statistics.total, outcome.statistics.safe) == (1024, 496)
    assert [(failure.kind, failure.count) for failure in outcome.failures] == [("no-allowed-set", 112)]


def test_reaction_rules_stand_in_for_the_state_rule() -> None:
    """The policy made from reaction rules is proved against the paper's state rule, every property of it."""
    spec, _ = solved(AMR)
    policy = Policy.load(ROOT / "proofs" / "amr_reaction_rules.policy.json")
    assert verify(policy, spec).verdict == "proved"


@pytest.mark.parametrize(
    "line",
    [
        "AND NOT executing charge AND NOT executing move_to_workstation_2",
        "THEN NOT executing move_to_corridor",
        "AND NOT executing move_to_charger",
        "AND NOT executing move_to_workstation_1",
    ],
)
def test_a_forgotten_reaction_rule_goes_unnoticed(line: str) -> None:
    """Without any of these lines the reaction rules stay realizable, and the state rule is no longer proved."""
    from tumato_symbolic import parse, synthesize

    text = (ROOT / "examples" / "amr_reaction_rules.tum").read_text()
    assert line in text
    changed = text.replace(line, "THEN true" if line.startswith("THEN") else "")
    outcome = synthesize(parse(changed))
    assert isinstance(outcome, Realizable)
    spec, _ = solved(AMR)
    assert verify(outcome.policy, spec).verdict == "refuted"


def test_concurrent_effects_under_both_orderings() -> None:
    """Where order matters, `first` starts both actions at once and `any` does not: longest runs of 2 and 3 steps."""
    from tumato_symbolic import synthesize

    spec, outcome = solved(ROOT / "examples" / "concurrent.tum")
    other = synthesize(spec, "first")
    assert isinstance(outcome, Realizable)
    assert isinstance(other, Realizable)
    assert (outcome.statistics.longest_run, other.statistics.longest_run) == (3, 2)
    state = {"S_Pressure": "low", "S_Valve": "closed", "S_Regulator": "off"}
    assert outcome.policy.decide(state) == ("start_regulator",)
    assert other.policy.decide(state) == ("start_regulator", "open_valve")


def test_the_grid_is_walked_around_the_stairs() -> None:
    """From the centre of the grid the policy avoids the shortest way, which may slip to the stairs."""
    _, outcome = solved(ROOT / "examples" / "grid3.tum")
    assert isinstance(outcome, Realizable)
    assert outcome.policy.decide({"S_Column": "centre", "S_Row": "middle"}) == ("down_from_middle_centre",)
