"""The paper's example: a right policy is proved, Tumato 2.0's choice is refuted as not minimal."""

from functools import cache

from tests.oracle import World
from tests.reference_policy import reference_policy
from tests.repo.documents import ROOT
from tests.verify.policies import certified, exact_ranks
from tumato_symbolic import parse
from tumato_symbolic.policy import policy_from_rows
from tumato_symbolic.semantics import ActionSet, State, action_names
from tumato_symbolic.spec import Spec
from tumato_symbolic.verify import CertificateUse, verify

CORRIDOR_LOADED_ON = (0, 1, 0, 0)


@cache
def _amr() -> Spec:
    path = ROOT / "examples" / "amr.tum"
    return parse(path.read_text(encoding="utf-8"))


@cache
def _right() -> dict[State, ActionSet]:
    rows = reference_policy(World(_amr(), "any"))
    assert rows is not None
    return rows


def _named(*actions: str) -> ActionSet:
    names = [action.name for action in _amr().actions]
    return frozenset(map(names.index, actions))


def test_a_right_policy_is_proved_without_certificate() -> None:
    """A plain table of the right decisions is proved in all four properties, for 32 states."""
    answer = verify(policy_from_rows(_amr(), _right()), _amr())
    assert answer.verdict == "proved"
    assert [(result.name, result.verdict, result.proved_by) for result in answer.properties] == [
        (name, "proved", "z3") for name in ("total", "safe", "goals", "minimal")
    ]
    assert answer.valid_states == 32
    assert answer.certificate == CertificateUse("absent")
    assert (answer.ordering, answer.ordering_source) == ("any", "default")


def test_a_right_certificate_is_used() -> None:
    """The ranks that come with the policy carry the proof."""
    rows = _right()
    answer = verify(certified(_amr(), rows, exact_ranks(_amr(), rows, "any")), _amr())
    assert answer.verdict == "proved"
    assert answer.certificate == CertificateUse("used")


def test_the_restoration_of_tumato_2_is_not_minimal() -> None:
    """Restoring (corridor, ok, loaded, on) by a move (10) is total, safe and reaches its goal; stopping costs 1."""
    rows = {**_right(), CORRIDOR_LOADED_ON: _named("move_to_workstation_2")}
    answer = verify(policy_from_rows(_amr(), rows), _amr())
    assert answer.verdict == "refuted"
    assert [result.verdict for result in answer.properties] == ["proved", "proved", "proved", "refuted"]
    refutation = answer.properties[-1].refutation
    assert refutation is not None
    assert refutation.state == CORRIDOR_LOADED_ON
    assert refutation.decision == _named("move_to_workstation_2")
    assert refutation.cheaper is not None
    assert action_names(_amr(), refutation.cheaper) == ("stop_conveyor",)
    assert refutation.run is not None
    assert refutation.run.end == "goal"


def test_an_unsafe_decision_is_refuted_with_the_rule() -> None:
    """The witness of an unsafe step is the outcome that breaks the rule, and the rule with its line."""
    workstation_2_on = (3, 1, 1, 0)
    rows = {**_right(), workstation_2_on: _named("move_to_corridor")}
    answer = verify(policy_from_rows(_amr(), rows), _amr(), properties=("safe",))
    refutation = answer.properties[0].refutation
    assert refutation is not None
    objection = refutation.objection
    assert objection is not None
    assert (refutation.state, objection.kind, objection.state) == (workstation_2_on, "unsafe", (0, 1, 1, 0))
    assert objection.rule == _amr().state_rules[0]
    assert [step.after for step in objection.outcome] == [(0, 1, 1, 0)]


def test_a_loop_is_refuted_with_the_run() -> None:
    """A policy that stays where it is reaches no goal: the run that loops is the witness."""
    corridor_free = (0, 1, 1, 1)
    rows = {**_right(), corridor_free: frozenset[int]()}
    answer = verify(policy_from_rows(_amr(), rows), _amr(), properties=("goals",))
    refutation = answer.properties[0].refutation
    assert refutation is not None
    assert refutation.run is not None
    assert refutation.run.end == "loop"
