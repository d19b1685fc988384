"""Proofs by several processes: the answer is that of one, whatever happens to the others."""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Callable, Iterator
from functools import partial
from importlib import import_module
from random import Random

import pytest
from msgspec.structs import replace

from tests.generate import random_spec
from tests.profiles import ALL_PROFILES
from tests.repo.documents import ROOT
from tests.verify.policies import certified, exact_ranks, near_policies, wrong_ranks
from tests.verify.test_forged_ranks import exact, restoring
from tumato_symbolic import Policy
from tumato_symbolic.diagnostics import Source
from tumato_symbolic.limits import Context
from tumato_symbolic.policy import policy_from_rows
from tumato_symbolic.semantics import Residual, State
from tumato_symbolic.spec import Ordering, Spec, load
from tumato_symbolic.verify import PROPERTIES, ProverName, Verification, portfolio, verify, workers
from tumato_symbolic.verify.by_diagrams import parallel, prover
from tumato_symbolic.verify.by_diagrams.ranks import WalkRanks
from tumato_symbolic.verify.by_diagrams.walk import Walk

TEST_PROCESS = os.getpid()


@pytest.fixture
def asked(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """Have children work on the smallest proof; how many tasks they got each time."""
    counts = []

    def counting(tasks: Iterator[Callable[[], object]], jobs: int) -> list[object]:
        found = workers.in_workers(tasks, jobs)
        counts.append(len(found))
        return found

    monkeypatch.setattr(prover, "FEWEST_NODES", 0)
    monkeypatch.setattr(portfolio, "MANY_RANK_NODES", -1)
    monkeypatch.setattr(portfolio, "LARGEST_TABLE", -1)
    monkeypatch.setattr(parallel, "in_workers", counting)
    return counts


def _amr() -> tuple[Policy, Spec]:
    path = ROOT / "examples" / "amr.tum"
    spec = load(Source("amr.tum", path.read_text(encoding="utf-8"))).spec
    assert spec is not None
    return Policy.load(ROOT / "proofs" / "amr.policy.json"), spec


def _timeless(answer: Verification) -> Verification:
    return replace(answer, properties=tuple(replace(result, seconds=0.0) for result in answer.properties))


def _policies(spec: Spec, ordering: Ordering, random: Random) -> Iterator[Policy]:
    """Policies right and wrong, with certificates right and wrong."""
    for rows in near_policies(spec, ordering, random, count=2):
        ranks = exact_ranks(spec, rows, ordering)
        yield certified(spec, rows, ranks)
        if ranks:
            yield certified(spec, rows, wrong_ranks(ranks, random))


@pytest.mark.parametrize("profile", ALL_PROFILES)
def test_the_answer_does_not_depend_on_the_jobs(profile: str, asked: list[int]) -> None:
    """Verdicts, witnesses, numbers of obligations, provers and certificate are those of one process."""
    for seed in range(400, 402):
        spec, random = random_spec(seed, ALL_PROFILES[profile]), Random(seed)
        ordering: Ordering = "first" if seed % 2 else "any"
        for policy in _policies(spec, ordering, random):
            names: tuple[ProverName, ...] = ("walk", "walk", "auto", "both")
            name, jobs = random.choice(names), random.choice((2, 3))
            assert _ask(policy, spec, ordering, name, jobs) == _ask(policy, spec, ordering, name, 1)
    assert sum(asked) > 20, "children were asked"


def _ask(policy: Policy, spec: Spec, ordering: Ordering, name: ProverName, jobs: int) -> Verification:
    return _timeless(verify(policy, spec, ordering=ordering, prover=name, jobs=jobs))


@pytest.mark.parametrize("name", ["walk", "auto"])
def test_the_limit_on_memory_does_not_depend_on_the_jobs(
    name: ProverName, asked: list[int], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Children together may remember what one process may; where that is too little, the answer is that of one."""
    policy, spec = _amr()
    verdicts = set()
    for most in (*range(200, 1600, 100), 2500, 3900):
        monkeypatch.setattr(
            import_module("tumato_symbolic.verify.by_diagrams.steps"), "Walk", partial(Walk, most_steps=most)
        )
        alone = _ask(policy, spec, "any", name, 1)
        assert _ask(policy, spec, "any", name, 2) == alone
        verdicts |= {(result.name, result.verdict, result.proved_by) for result in alone.properties}
    assert len(verdicts) == 7 if name == "walk" else 8
    assert asked


def test_no_time_is_undecided(asked: list[int]) -> None:
    """The limit on time holds for what children do: nothing is proved in none."""
    policy, spec = _amr()
    answer = verify(policy, spec, prover="walk", timeout=1e-9, jobs=2)
    assert [result.verdict for result in answer.properties] == ["undecided"] * 4


def test_a_child_is_held_to_the_time_of_its_property(asked: list[int], monkeypatch: pytest.MonkeyPatch) -> None:
    """A child that does not end in time leaves its property undecided, and no other."""

    def never_ends(ranks: WalkRanks, _: Residual) -> bool:
        while True:
            ranks._model.walk.check_time()

    monkeypatch.setattr(WalkRanks, "decreases", never_ends)
    policy, spec = _amr()
    answer = verify(policy, spec, prover="walk", timeout=0.3, jobs=2)
    assert [result.verdict for result in answer.properties] == ["proved", "proved", "undecided", "proved"]
    assert answer.properties[2].reason == "the walk did not end within the time limit"
    assert 0.3 <= answer.properties[2].seconds < 5.0


def test_progress_tells_what_is_proved(asked: list[int]) -> None:
    """Each property is told when the first child begins with it."""
    told: list[str] = []
    verify(*_amr(), prover="walk", jobs=2, context=Context(progress=told.append))
    proofs = [f"proving {name}" for name in PROPERTIES if name != "restoring"]
    assert list(dict.fromkeys(told)) == ["looking for a valid state", *proofs, "counting the valid states"]


def _only_in_children(act: Callable[[], object]) -> Callable[[WalkRanks, Residual], bool]:
    original = WalkRanks.decreases

    def decreases(ranks: WalkRanks, goal: Residual) -> bool:
        if os.getpid() != TEST_PROCESS:
            act()
        return original(ranks, goal)

    return decreases


def test_a_killed_child_proves_nothing(asked: list[int], monkeypatch: pytest.MonkeyPatch) -> None:
    """What a child was to prove that was killed is undecided, with the reason; the rest is proved."""
    monkeypatch.setattr(WalkRanks, "decreases", _only_in_children(lambda: os.kill(os.getpid(), signal.SIGKILL)))
    answer = verify(*_amr(), prover="walk", jobs=2)
    assert [result.verdict for result in answer.properties] == ["proved", "proved", "undecided", "proved"]
    assert answer.properties[2].reason == "a worker process was ended by signal 9"


def test_an_exception_in_a_child_arrives(asked: list[int], monkeypatch: pytest.MonkeyPatch) -> None:
    """An exception in a child is raised here, with the child's traceback; a lack of memory stays one."""

    def fail(error: Exception) -> None:
        raise error

    monkeypatch.setattr(WalkRanks, "decreases", _only_in_children(partial(fail, ValueError("planted"))))
    with pytest.raises(workers.WorkerError, match=r'(?s)File ".*test_jobs.py", line .*ValueError: planted'):
        verify(*_amr(), prover="walk", jobs=2)
    monkeypatch.setattr(WalkRanks, "decreases", _only_in_children(partial(fail, MemoryError())))
    with pytest.raises(MemoryError):
        verify(*_amr(), prover="walk", jobs=2)


def _no_fork() -> int:
    raise AssertionError("a process was forked")


def test_one_job_forks_nothing(asked: list[int], monkeypatch: pytest.MonkeyPatch) -> None:
    """`jobs=1` makes no process, however large the proof."""
    monkeypatch.setattr(os, "fork", _no_fork)
    assert verify(*_amr(), prover="walk", jobs=1).verdict == "proved"
    with pytest.raises(AssertionError, match="forked"):
        verify(*_amr(), prover="walk", jobs=2)


@pytest.mark.parametrize("name", ["auto", "z3", "walk", "both"])
def test_a_small_proof_forks_nothing(name: ProverName, monkeypatch: pytest.MonkeyPatch) -> None:
    """A small proof makes no process, however many it may."""
    monkeypatch.setattr(os, "fork", _no_fork)
    assert verify(*_amr(), prover=name, jobs=8).verdict == "proved"


def test_without_fork_one_process_answers(asked: list[int], monkeypatch: pytest.MonkeyPatch) -> None:
    """Where there is no fork, or none that is safe, the answer is the same and comes from this process."""
    policy, spec = _amr()
    alone = _timeless(verify(policy, spec, prover="walk"))
    with monkeypatch.context() as patched:
        patched.setattr(sys, "platform", "darwin")
        assert _timeless(verify(policy, spec, prover="walk", jobs=2)) == alone
    with monkeypatch.context() as patched:
        patched.delattr(os, "fork")
        assert _timeless(verify(policy, spec, prover="walk", jobs=2)) == alone
    assert not asked


def test_no_room_for_a_process_is_no_error(asked: list[int], monkeypatch: pytest.MonkeyPatch) -> None:
    """Where the system makes no further process, this one does all."""

    def refused() -> int:
        raise BlockingIOError("no more processes")

    monkeypatch.setattr(os, "fork", refused)
    assert verify(*_amr(), prover="walk", jobs=2).verdict == "proved"


def test_a_refused_certificate_leaves_minimal_to_be_asked_anew(asked: list[int]) -> None:
    """What a child has proved by ranks that turn out false does not count."""
    policy, spec = _amr()
    certificate = policy.certificate
    assert certificate is not None
    leaves = tuple({1: 2, 2: 1}.get(leaf, leaf) if leaf is not None else None for leaf in certificate.ranks.leaves)
    policy = replace(policy, certificate=replace(certificate, ranks=replace(certificate.ranks, leaves=leaves)))
    answer = _ask(policy, spec, "any", "walk", 2)
    assert (answer.verdict, answer.certificate.status) == ("proved", "wrong")
    assert answer == _ask(policy, spec, "any", "walk", 1)


def test_what_a_child_did_with_the_certificate_is_known(asked: list[int]) -> None:
    """Where only a child has used ranks, the certificate is used; where it lacked some, the reason is told."""
    spec, rows = restoring(2, 2)
    right, other = Residual(frozenset((0,)), frozenset()), Residual(frozenset(), frozenset())
    late: dict[State, int] = {(2,): 0}
    for ranks, status in (({right: exact(spec, rows)}, "used"), ({other: late}, "incomplete")):
        policy = certified(spec, rows, ranks)
        one, two = (
            _timeless(verify(policy, spec, properties=["safe", "minimal"], prover="walk", jobs=jobs)) for jobs in (1, 2)
        )
        assert one == two
        assert (two.verdict, two.certificate.status) == ("proved", status)
    assert asked == [2, 2]


def test_a_policy_without_rows_is_judged_by_many_as_by_one(asked: list[int]) -> None:
    """Without a certificate there is nothing to divide."""
    _, spec = _amr()
    empty = policy_from_rows(spec, {})
    assert _timeless(verify(empty, spec, prover="walk", jobs=2)) == _timeless(verify(empty, spec, prover="walk"))
    assert not asked


def test_one_task_is_no_work_for_children(asked: list[int]) -> None:
    """There is nothing that the others would do meanwhile."""
    spec, rows = restoring(2, 2)
    policy = certified(spec, rows, {Residual(frozenset((0,)), frozenset()): exact(spec, rows)})
    for names, count in ((["minimal"], 0), (["goals"], 0), (["total", "safe"], 0), (["goals", "minimal"], 2)):
        asked.clear()
        assert verify(policy, spec, properties=names, prover="walk", jobs=2).verdict == "proved"
        assert sum(asked) == count, names


def test_a_child_that_refutes_safe_proves_nothing(asked: list[int]) -> None:
    """Where a child finds that a decision is not allowed, its run is not looked at, and no goal is pending."""
    spec, rows = restoring(2, 3)
    wrong = {**rows, (3,): frozenset[int]()}
    policy = certified(spec, wrong, {Residual(frozenset((0,)), frozenset()): exact(spec, rows)})
    one, two = (
        [(each.name, each.verdict) for each in verify(policy, spec, prover="walk", jobs=jobs).properties]
        for jobs in (1, 2)
    )
    assert one == two == [("total", "proved"), ("safe", "refuted"), ("goals", "proved"), ("minimal", "proved")]
    assert asked
