"""What a report says of a policy that leaves valid states undecided: whether it gets there, and how."""

from __future__ import annotations

import json
from random import Random

import pytest
from msgspec.structs import replace

from tests.generate import ALL_PROFILES, random_spec
from tests.verify.policies import leaving, near_policies
from tumato_symbolic import parse
from tumato_symbolic.limits import Context, LimitReachedError, Limits
from tumato_symbolic.policy import as_diagram, policy_from_rows
from tumato_symbolic.report.objections import Place
from tumato_symbolic.report.proof import proof_json, refutation_text
from tumato_symbolic.semantics import ActionSet, State, all_states, is_valid
from tumato_symbolic.spec import Ordering, Spec
from tumato_symbolic.verify import ProverName, Refutation, closure, verify
from tumato_symbolic.verify.decisions import Decisions

PROVERS: tuple[ProverName, ...] = ("z3", "walk", "explicit")


def total(
    spec: Spec, rows: dict[State, ActionSet], ordering: Ordering, prover: ProverName, *, drawn: bool = False
) -> Refutation | None:
    """The refutation of *total*; the policy is a table, or drawn as a diagram."""
    policy = policy_from_rows(spec, rows, ordering)
    policy = replace(policy, decisions=as_diagram(policy)) if drawn else policy
    (result,) = verify(policy, spec, ordering=ordering, properties=("total",), prover=prover).properties
    return result.refutation


@pytest.mark.parametrize("ordering", ["any", "first"])
@pytest.mark.parametrize("profile", sorted(ALL_PROFILES))
def test_an_undecided_outcome_is_the_witness(profile: str, ordering: Ordering) -> None:
    """Where a decision has one, every prover names it, and the same; where none has, the policy is closed."""
    for seed in range(4):
        spec, random = random_spec(seed, ALL_PROFILES[profile]), Random(seed)
        for policy in near_policies(spec, ordering, random, 1):
            rows = {state: chosen for state, chosen in policy.items() if random.random() < 0.7}
            if all(state in rows for state in all_states(spec) if is_valid(spec, state)):
                continue
            found = [total(spec, rows, ordering, prover, drawn=drawn) for prover in PROVERS for drawn in (False, True)]
            exits = leaving(spec, rows, ordering)
            for each in found:
                assert each is not None
                assert each.closed == (not exits)
                if each.departure is None:
                    assert not exits
                else:
                    assert each.departure.state == min(state for state, _ in exits)
                    assert (each.departure.state, each.state) in exits
                    assert each.departure.outcome[-1].after == each.state
            assert len({(each.state, each.departure) for each in found if each and exits}) == bool(exits)


ROWS = """
BEGIN STATE VECTOR
  state S_Place can be hall, lab, roof
END STATE VECTOR
BEGIN ACTIONS
  action go  preconditions: S_Place is hall  nominal effects: S_Place is lab  alternative effects: S_Place is roof
END ACTIONS
"""


def test_a_report_tells_the_way() -> None:
    """A person reads the decision and the effects; a program gets them as data."""
    spec = parse(ROWS)
    go, nothing = frozenset((0,)), frozenset[int]()
    found = total(spec, {(0,): go, (1,): nothing}, "any", "z3")
    assert found is not None
    assert refutation_text(Place(spec, "a.tum"), found).splitlines() == [
        "in the state S_Place=roof",
        "the policy decides nothing",
        "although in S_Place=hall it executes {go},",
        "which may lead there: go takes an alternative effect (S_Place=roof; a.tum:6)",
    ]
    policy = policy_from_rows(spec, {(0,): go, (1,): nothing}, "any")
    told = proof_json(spec, verify(policy, spec))["properties"]["total"]["refutation"]  # type: ignore[index]
    assert json.loads(json.dumps(told)) == {
        "kind": "missing",
        "state": {"S_Place": "roof"},
        "decision": None,
        "closed": False,
        "departure": {
            "state": {"S_Place": "hall"},
            "decision": ["go"],
            "outcome": [{"action": "go", "after": {"S_Place": "roof"}}],
        },
    }
    closed = total(spec, {(1,): nothing}, "any", "walk")
    assert closed is not None
    told_of_none = "(no run from a decided state gets there: all that decisions may lead to is decided)"
    assert refutation_text(Place(spec, "a.tum"), closed).endswith(told_of_none)


BOTH = """
BEGIN STATE VECTOR
  state S_Left can be up, down
  state S_Right can be up, down
END STATE VECTOR
BEGIN ACTIONS
  action left  nominal effects: S_Left is down
  action right  nominal effects: S_Right is down
END ACTIONS
"""


def test_runs_go_where_all_nominal_effects_lead() -> None:
    """Under `first` that need not be an outcome, which one effect alone has to lead to."""
    spec, nothing = parse(BOTH), frozenset[int]()
    rows: dict[State, ActionSet] = {(0, 0): frozenset((0, 1)), (0, 1): nothing, (1, 0): nothing}
    for prover in PROVERS:
        found = total(spec, rows, "first", prover)
        assert found is not None
        assert refutation_text(Place(spec, "b.tum"), found).splitlines() == [
            "in the state S_Left=down S_Right=down",
            "the policy decides nothing",
            "although in S_Left=up S_Right=up it executes {left, right},",
            "which may lead there: left takes its nominal effect (S_Left=down), "
            "then right takes its nominal effect (S_Right=down)",
        ]


def test_too_many_outcomes_are_left_open(monkeypatch: pytest.MonkeyPatch) -> None:
    """Then the witness is a state without a decision, and nothing is said of the way there."""
    for most, is_found in ((0, False), (1, True)):
        monkeypatch.setattr(closure, "MOST_OUTCOMES", most)
        found = total(parse(ROWS), {(0,): frozenset((0,)), (1,): frozenset()}, "any", "explicit")
        assert found is not None
        assert (found.state, found.closed, found.departure is not None) == ((2,), False, is_found)


def test_the_time_limit_holds_for_the_way() -> None:
    """It is looked for in no more time than there is."""
    spec = parse(ROWS)
    policy = policy_from_rows(spec, {(0,): frozenset((0,)), (1,): frozenset()}, "any")
    decisions = Decisions(spec, policy)
    with pytest.raises(LimitReachedError):
        closure.with_departure(Refutation("missing", (2,)), spec, decisions, "any", Context(Limits(0.0)))
