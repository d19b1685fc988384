"""What Z3 and the walk answer is replayed: where the explicit meaning says otherwise, that is a bug, and no verdict."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import pytest

from tests.semantics.build import Build, chosen
from tests.unrealizability import certified as certificate_of
from tests.verify.test_forged_ranks import along, restoring
from tests.verify.test_unrealizable_by_hand import conflicting, line
from tumato_symbolic.policy import policy_from_rows
from tumato_symbolic.policy.unrealizability import Unrealizability
from tumato_symbolic.semantics import ActionSet, Run, State
from tumato_symbolic.spec import Not, Spec
from tumato_symbolic.verify import PropertyName, verify, verify_unrealizable
from tumato_symbolic.verify.by_z3 import goals_property, minimal_property, outcomes, step_property
from tumato_symbolic.verify.by_z3.rank_terms import RankProof
from tumato_symbolic.verify.unrealizability import allowed_step
from tumato_symbolic.verify.unrealizability.allowed_step import AllowedStep, is_state

Rows = Mapping[State, ActionSet]


def _judged(spec: Spec, rows: Rows, name: PropertyName) -> None:
    verify(policy_from_rows(spec, rows), spec, prover="z3", properties=[name])


def _forbidden() -> tuple[Spec, Rows]:
    """A precondition that does not hold."""
    build = Build({"x": "ab"})
    action = build.action("x=b", when=[build.atom("x=b")])
    return build.spec(), {(0,): chosen(action)}


def _unsafe() -> tuple[Spec, Rows]:
    """An outcome that is not safe."""
    build = Build({"x": "abc"})
    action = build.action("x=b", ["x=c"])
    return build.spec(state_rules=[Not(build.atom("x=c"))]), {(0,): chosen(action)}


def _reaches(*_: object) -> Run:
    return Run((), (), "goal")


def _loops(*_: object) -> Run:
    return Run((), (), "loop")


def test_a_decision_that_is_allowed_is_no_witness(monkeypatch: pytest.MonkeyPatch) -> None:
    """A condition that Z3 finds broken, and an outcome that it finds unsafe, are looked at again."""
    monkeypatch.setattr(step_property, "objections", lambda *_: iter(()))
    with pytest.raises(RuntimeError, match=r"is allowed in .*, against the solver"):
        _judged(*_forbidden(), "safe")
    monkeypatch.setattr(outcomes, "fault_after", lambda *_: None)
    with pytest.raises(RuntimeError, match="is safe, against the solver"):
        _judged(*_unsafe(), "safe")


def test_a_run_that_reaches_its_goal_is_no_witness(monkeypatch: pytest.MonkeyPatch) -> None:
    """Neither is one whose ranks Z3 does not confirm, though they are the lengths of all runs."""
    spec, rows = along(2)
    with monkeypatch.context() as patched:
        patched.setattr(goals_property, "follow", _reaches)
        with pytest.raises(RuntimeError, match="reaches its goal, against its rank"):
            _judged(spec, {**rows, (1,): frozenset()}, "goals")
    for claim, answer in (("decreases", False), ("first_beyond", (0,))):
        with monkeypatch.context() as patched:
            patched.setattr(RankProof, claim, lambda *_, answer=answer: answer)
            with pytest.raises(RuntimeError, match="the lengths of runs are no ranks"):
                _judged(spec, rows, "goals")


def test_a_set_that_is_not_better_is_no_witness(monkeypatch: pytest.MonkeyPatch) -> None:
    """One that is not cheaper, or from which runs fail, although it has exact ranks."""
    spec, rows = restoring(1, 3)
    with monkeypatch.context() as patched:
        patched.setattr(minimal_property, "duration", lambda *_: 0)
        with pytest.raises(RuntimeError, match=r"is not cheaper in .*, against the solver"):
            _judged(spec, rows, "minimal")
    with monkeypatch.context() as patched:
        patched.setattr(minimal_property, "follow", _loops)
        with pytest.raises(RuntimeError, match="and a run takes longer"):
            _judged(spec, rows, "minimal")
        patched.setattr(RankProof, "is_lower_bound", lambda _: False)
        with pytest.raises(RuntimeError, match="the lengths of runs are no ranks"):
            _judged(spec, rows, "minimal")


# Certificates of no


def _unrealizable(spec: Spec) -> Unrealizability:
    certificate = certificate_of(spec, "any")
    assert certificate is not None
    return certificate


Lie = Callable[[AllowedStep], object]


def _lying(monkeypatch: pytest.MonkeyPatch, claim: str, lie: Lie) -> None:
    """Have Z3 answer one claim falsely, whichever of the two questions it is."""
    for question in ("some_state", "some_step"):
        asked = getattr(AllowedStep, question)

        def answer(step: AllowedStep, told: str, *terms: object, asked: Any = asked, **options: Any) -> object:
            return lie(step) if told == claim else asked(step, told, *terms, **options)

        monkeypatch.setattr(AllowedStep, question, answer)


def _step(here: State, number: int, there: State) -> Lie:
    """The step of one action."""
    return lambda _: (here, frozenset((number,)), there)


LIES: dict[str, tuple[Spec, str, Lie, str]] = {
    "a goal that is listed": (
        line(2),
        "no other residual goal is possible in the state",
        _step((0,), 0, (1,)),
        "is listed",
    ),
    "a step into layer 1": (
        line(2),
        "the first layer holds the first successors",
        _step((0,), 0, (1,)),
        "layer 1 holds",
    ),
    "a step into layer 2": (
        line(2),
        "the next layers hold all successors of a layer",
        _step((1,), 1, (2,)),
        "a layer holds",
    ),
    "an option that is listed": (
        conflicting(),
        "the options of a state are complete",
        _step((0,), 0, (1,)),
        "is an option of",
    ),
    "a goal whose distance is 0": (
        conflicting(),
        "distances are 0 at the goal",
        lambda _: (4,),
        "the distance of .* is 0 or it does not meet",
    ),
    "a state that is no goal": (
        conflicting(),
        "distances are 0 at the goal",
        lambda _: (0,),
        "the distance of .* is 0 or it does not meet",
    ),
    "a step that is one nearer": (
        conflicting(),
        "distances are lower bounds",
        _step((0,), 0, (1,)),
        "the distance does not drop",
    ),
}


@pytest.mark.parametrize("name", LIES)
def test_a_false_refutation_of_a_certificate(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """A step or a state that does not show the claim to be false."""
    spec, claim, lie, told = LIES[name]
    certificate = _unrealizable(spec)
    _lying(monkeypatch, claim, lie)
    with pytest.raises(RuntimeError, match=f"{told}.*, against the solver"):
        verify_unrealizable(certificate, spec)


def test_doing_nothing_has_no_unsafe_outcome_of_several_effects(monkeypatch: pytest.MonkeyPatch) -> None:
    """There is nothing to learn where the empty set is refused."""
    monkeypatch.setattr(allowed_step, "objections_to", lambda *_: [object()])
    spec = line(2)
    certificate = _unrealizable(spec)
    _lying(
        monkeypatch,
        "no other residual goal is possible in the state",
        lambda step: AllowedStep.some_step(step, "nothing is done", is_state(step.state, (3,))),
    )
    with pytest.raises(RuntimeError, match="the solver does nothing in"):
        verify_unrealizable(certificate, spec)
