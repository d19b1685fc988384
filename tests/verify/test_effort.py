"""What a proof may use up, time and remembered results: no more than it was given, and who is asked what is left."""

from __future__ import annotations

import math
import time
from collections.abc import Iterator, Mapping, Sequence
from importlib import import_module
from typing import Any, cast

import pytest
import z3
from msgspec.structs import replace

from tests.unrealizability import certified as certificate_of
from tests.verify.policies import certified
from tests.verify.test_forged_ranks import along, exact
from tests.verify.test_unrealizable_by_hand import line
from tumato_symbolic.limits import Context, LimitReachedError, Limits
from tumato_symbolic.policy import Policy
from tumato_symbolic.semantics import Residual
from tumato_symbolic.spec import Spec
from tumato_symbolic.verify import PROPERTIES, PropertyName, PropertyResult, Verification, verify, verify_unrealizable
from tumato_symbolic.verify.by_diagrams import prover as by_diagrams
from tumato_symbolic.verify.by_diagrams.prover import WalkProver
from tumato_symbolic.verify.by_z3 import rank_terms
from tumato_symbolic.verify.by_z3.solver import LONGEST, NO_TIMEOUT, Solver
from tumato_symbolic.verify.result import Verdict

prove = import_module("tumato_symbolic.verify.prove")
GOAL = Residual(frozenset((0,)), frozenset())


def _policy(length: int = 3) -> tuple[Policy, Spec]:
    spec, rows = along(length)
    return certified(spec, rows, {GOAL: exact(spec, rows)}), spec


# Results that the walk remembers


@pytest.mark.parametrize(
    ("left", "most", "expected"), [(9, 4, 4), (4, 4, 4), (3, 4, 3), (9, 0, 0), (0, 9, 0), (9, None, 9)]
)
def test_a_property_remembers_no_more_than_it_may(left: int, most: int | None, expected: int) -> None:
    """As many results as it is given, and no more than are left; afterwards all that are left may be used again."""
    policy, spec = _policy()
    prover = WalkProver(spec, policy, "any")
    assert prover.prove("safe").verdict == "proved"
    walk = prover._model.walk
    assert walk.remembered > 9
    walk.most = walk.remembered + left
    seen = []

    def work() -> PropertyResult:
        seen.append(walk.most - walk.remembered)
        return PropertyResult("safe", "proved")

    prover._within(most, work)
    assert (seen, walk.most) == ([expected], walk.remembered + left)


@pytest.mark.parametrize(("left", "most", "forgets"), [(0, None, True), (0, 5, False), (5, 0, False), (5, None, True)])
def test_answers_of_children_are_forgotten_only_where_all_memory_is_used(
    left: int, most: int | None, forgets: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A property that may remember little, and does not get by with that, leaves what children have found as it is."""
    monkeypatch.setattr(by_diagrams, "FEWEST_NODES", 0)
    policy, spec = _policy()
    prover = WalkProver(spec, policy, "any")
    prover.prove_parts(("goals", "minimal"), 2, lambda _: None)
    found = dict(prover._parallel.answers)
    walk = prover._model.walk
    walk.most = walk.remembered + left
    monkeypatch.setattr(prover._parallel, "forget", lambda _: prover._parallel.answers.clear())
    assert found and prover.prove("safe", most).verdict == "undecided"
    assert prover._parallel.answers == ({} if forgets else found)


@pytest.mark.parametrize(("more", "asked"), [(0, True), (1, False)])
@pytest.mark.parametrize("jobs", [1, 2])
def test_small_ranks_are_not_prepared(jobs: int, more: int, asked: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    """From a number of nodes on, children begin, or this process does what `goals` and `minimal` have in common."""
    policy, spec = _policy()
    assert policy.certificate is not None
    monkeypatch.setattr(by_diagrams, "FEWEST_NODES", len(policy.certificate.ranks.nodes) + more)
    prover = WalkProver(spec, policy, "any")
    spent = prover.prove_parts(("goals", "minimal"), jobs, lambda _: None)
    assert "goals" in spent if asked else not spent
    assert bool(prover._parallel.answers) == (asked and jobs > 1)


# Time


@pytest.fixture
def deadlines(monkeypatch: pytest.MonkeyPatch) -> list[float]:
    """By when Z3 had to answer each question, from now on."""
    found = []
    ask = Solver.ask

    def recorded(solver: Solver, *terms: object, deadline: float = math.inf) -> object:
        found.append(deadline - time.monotonic())
        return ask(solver, *terms, deadline=deadline)

    monkeypatch.setattr(Solver, "ask", recorded)
    return found


def test_a_question_may_take_all_that_is_left(monkeypatch: pytest.MonkeyPatch) -> None:
    """However little that is; where nothing is left, Z3 is not asked."""
    solver = Solver()
    monkeypatch.setattr(time, "monotonic", lambda: 100.0)
    told: list[int] = []
    monkeypatch.setattr(z3, "Z3_params_set_uint", lambda *asked: told.append(asked[-1]))
    for left, milliseconds in (
        (0.5, 500),
        (2.5, 2500),
        (0.0001, 1),
        (LONGEST, 1000 * int(LONGEST)),
        (LONGEST + 1, NO_TIMEOUT),
        (math.inf, NO_TIMEOUT),
    ):
        assert solver.ask(deadline=100.0 + left) == "sat"
        assert told.pop() == milliseconds
    for left in (0.0, -0.5):
        assert solver.ask(deadline=100.0 + left) == "unknown"
    assert not told


def test_ctrl_c_is_not_lost_in_z3(monkeypatch: pytest.MonkeyPatch) -> None:
    """Z3 takes the signal for itself, and tells so as its reason; any other reason is no interruption."""
    solver = Solver()
    told = [("unknown", "interrupted from keyboard"), ("unknown", "timeout"), ("unsat", "")]
    monkeypatch.setattr(solver._solver, "check", lambda: told[0][0])
    monkeypatch.setattr(solver._solver, "reason_unknown", lambda: told[0][1])
    with pytest.raises(KeyboardInterrupt):
        solver.ask()
    while len(told) > 1:
        del told[0]
        try:
            assert solver.ask() == told[0][0]
        except KeyboardInterrupt:
            pytest.fail("nobody has interrupted Z3")


@pytest.mark.parametrize(("at_once", "timeout"), [(5.0, None), (5.0, 900.0), (900.0, 5.0)])
def test_all_ranks_at_once_are_asked_for_a_while(
    at_once: float, timeout: float | None, deadlines: list[float], monkeypatch: pytest.MonkeyPatch
) -> None:
    """For so many seconds, and no longer than the property may take."""
    monkeypatch.setattr(rank_terms, "AT_ONCE", at_once)
    policy, spec = _policy()
    assert verify(policy, spec, prover="z3", properties=["goals"], timeout=timeout).verdict == "proved"
    assert min(deadlines) <= at_once
    assert max(deadlines) <= (timeout or math.inf)


class _Scripted:
    """A prover that finds what it is told to find, and knows what it was asked."""

    def __init__(self, verdict: Verdict, seconds: Mapping[PropertyName, float] | None = None) -> None:
        self.verdict, self.asked = verdict, list[PropertyName]()
        self.seconds, self.together = seconds or {}, list[tuple[PropertyName, ...]]()

    def prove(self, name: PropertyName) -> PropertyResult:
        """The same verdict on every property."""
        self.asked.append(name)
        return PropertyResult(name, self.verdict)

    def prove_parts(self, names: Sequence[PropertyName], jobs: int, begin: object) -> Mapping[PropertyName, float]:
        """What took how long already."""
        assert jobs == 1 and callable(begin)
        self.together.append((*self.asked, *names))
        return self.seconds


class _Clock(Context):
    """A context whose time is up at the first look after it was told to begin with a property."""

    def tell(self, stage: str) -> None:
        """Goes on, however late it is."""
        self.enter(stage)


@pytest.mark.parametrize(("verdict", "asked"), [("undecided", 1), ("proved", 5), ("refuted", 5)])
def test_what_was_answered_in_time_counts(verdict: Verdict, asked: int) -> None:
    """The limit ends a proof without a verdict; a verdict that was reached when time was up is none the worse."""
    prover = _Scripted(verdict)
    results: Iterator[PropertyResult] = prove._results(cast(Any, prover), PROPERTIES, 1, _Clock(Limits(0.0)))
    if asked == 1:
        with pytest.raises(LimitReachedError):
            next(results)
    else:
        assert [result.verdict for result in results] == [verdict] * 5
    assert len(prover.asked) == asked


@pytest.mark.parametrize(
    ("asked", "together"),
    [
        (PROPERTIES, [("total", "safe", "restoring", "goals", "minimal")]),
        (("total", "minimal"), [("total", "minimal")]),
        (("goals", "minimal"), [("goals", "minimal")]),
        (("total",), []),
    ],
)
def test_what_is_proved_together_is_begun_once(
    asked: Sequence[PropertyName], together: list[tuple[PropertyName, ...]]
) -> None:
    """All but `total`, after it; what a property took there is part of its time."""
    prover = _Scripted("proved", {"goals": 1000.0, "safe": 2000.0})
    results = list(prove._results(cast(Any, prover), asked, 1, Context()))
    assert (prover.asked, prover.together) == (list(asked), together)
    for result in results:
        before = prover.seconds.get(result.name, 0.0) if together else 0.0
        assert before <= result.seconds < before + 100


def test_what_is_known_before_the_first_proof() -> None:
    """Nothing is proved, nothing is said of the certificate, and no state is counted."""
    policy, spec = _policy()
    known: list[Verification] = []
    context = Context(learned=lambda found: known.append(cast("Verification", found)))
    verify(policy, spec, context=context)
    first = known[0]
    assert (first.verdict, first.certificate.status) == ("undecided", "unneeded")
    assert (first.valid_states, first.decided_states, first.ordering, first.ordering_source) == (
        None,
        None,
        "any",
        "default",
    )


def test_without_a_proof_nobody_has_proved_anything() -> None:
    """A certificate of no that is left open, or is refuted, names no prover, no witness that is none, and no count."""
    spec = line(2)
    certificate = certificate_of(spec, "any")
    assert certificate is not None
    late = verify_unrealizable(certificate, spec, timeout=0.0)
    wrong = verify_unrealizable(certificate, replace(spec, effect_ordering="first"))
    for found, verdict in ((late, "undecided"), (wrong, "refuted")):
        assert found.verdict == verdict and found.reason
        assert (found.obligations, found.by_solver, found.by_diagrams) == (0, False, False)
        assert (found.state, found.chosen) == (None, None)
