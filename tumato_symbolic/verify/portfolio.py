"""Which prover is asked, in which order, for how long (Z3, the walk, explicit-state checking); if none decides, why."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cached_property
from math import inf
from typing import TYPE_CHECKING, Protocol

from tumato_symbolic.limits import Budget, has_z3, need_z3
from tumato_symbolic.policy import Policy, Table, count_defined
from tumato_symbolic.spec import Ordering, Spec, goal_parameters
from tumato_symbolic.verify.decisions import LARGEST_TABLE
from tumato_symbolic.verify.result import CertificateUse, PropertyName, PropertyResult, ProverName

if TYPE_CHECKING:
    from tumato_symbolic.verify.by_diagrams.prover import WalkProver
    from tumato_symbolic.verify.by_states.prover import StateProver
    from tumato_symbolic.verify.by_z3.prover import Z3Prover

SOON = 2.0
"""How many seconds Z3 may think about a property before the walk is tried."""

SOON_REMEMBERED = 300_000
"""How many results the walk may remember for a property before others are tried.

For `safe` Z3, which does not mind many orders of effects; for all, explicit-state checking, where there is little to
look at.
"""

LITTLE = 20_000_000
"""How many outcomes and steps are listed sooner than Z3 and the walk have used up their time."""

FIRST_TURN = (SOON_REMEMBERED // 3, LITTLE // 50)
"""Where few states are decided, results of the walk, then outcomes, before the walk may remember so many."""

REASONS_TOLD = 3
"""Where no prover decides a property, the reasons of so many attempts are told, the last ones."""

MANY_CASES = 100
"""With more cases than this, formulas and diagrams of all of them take longer than a look at each state."""

MANY_RANK_NODES = 500
"""Ranks with more nodes than that tend to count, and then Z3 takes long."""

MANY_RANKS = 100
"""Where runs have more different ranks than that, and more states than a table lists, the walk is faster."""


class Prover(Protocol):
    """Proves or refutes the properties of one policy, in the order of `PROPERTIES`."""

    @property
    def use(self) -> CertificateUse:
        """What became of the certificate."""

    def has_valid_state(self) -> bool:
        """Whether some state is valid, as far as can be told."""

    def prove_parts(
        self, names: Sequence[PropertyName], jobs: int, started: Callable[[PropertyName], None]
    ) -> Mapping[PropertyName, float]:
        """Prepare for properties that will be asked; have up to `jobs` child processes prove parts of them, if it pays.

        Verdicts do not depend on `jobs`; 1 makes no child. `started` is told whenever a part is begun. Returns how many
        seconds each property took.
        """

    def prove(self, name: PropertyName) -> PropertyResult:
        """The verdict on one property."""

    def valid_states(self) -> int | None:
        """How many states are valid; None where they could not be counted cheaply."""


def make_prover(name: ProverName, spec: Spec, policy: Policy, ordering: Ordering, budget: Budget) -> Prover:
    """The prover of this name for a policy that is bound to `spec`."""
    match name:
        case "z3":
            return _z3(spec, policy, ordering, budget)
        case "walk":
            return _walk(spec, policy, ordering, budget)
        case "explicit":
            return _explicit(spec, policy, ordering, budget)
        case "both":
            return _Both(spec, policy, ordering, budget)
        case _:
            return _Auto(spec, policy, ordering, budget)


def _z3(spec: Spec, policy: Policy, ordering: Ordering, budget: Budget) -> Z3Prover:
    need_z3("prove by it (`--prover walk` does without)")
    from tumato_symbolic.verify.by_z3.prover import Z3Prover

    return Z3Prover(spec, policy, ordering, budget)


def _walk(spec: Spec, policy: Policy, ordering: Ordering, budget: Budget) -> WalkProver:
    from tumato_symbolic.verify.by_diagrams.prover import WalkProver

    return WalkProver(spec, policy, ordering, budget)


def _explicit(spec: Spec, policy: Policy, ordering: Ordering, budget: Budget) -> StateProver:
    from tumato_symbolic.verify.by_states.prover import StateProver

    return StateProver(spec, policy, ordering, budget.context)


class _Pair:
    """Z3 and the walk for one policy; each prover is loaded when it is asked."""

    def __init__(self, spec: Spec, policy: Policy, ordering: Ordering, budget: Budget) -> None:
        self._policy = policy
        self._cases = len(spec.actions) if spec.has_cases else 0
        self._goals_are_many = goal_parameters(spec) is not None
        self._judged = spec, policy, ordering, budget
        self._policy_is_safe = False

    @cached_property
    def _walk(self) -> WalkProver:
        prover = _walk(*self._judged)
        prover.policy_is_safe = self._policy_is_safe
        return prover

    @cached_property
    def _z3(self) -> Z3Prover:
        prover = _z3(*self._judged)
        prover.policy_is_safe = self._policy_is_safe
        return prover

    @cached_property
    def _explicit(self) -> StateProver:
        prover = _explicit(*self._judged)
        prover.policy_is_safe = self._policy_is_safe
        return prover

    @property
    def _asked(self) -> list[Z3Prover | WalkProver | StateProver]:
        return [self.__dict__[name] for name in ("_walk", "_z3", "_explicit") if name in self.__dict__]

    @property
    def use(self) -> CertificateUse:
        """The worse of what became of the certificate."""
        used = (prover.use for prover in self._asked)
        return min(used, key=lambda use: _WORST_FIRST.index(use.status), default=CertificateUse("unneeded"))

    def has_valid_state(self) -> bool:
        """Whether some state is valid, as far as the first who is asked can tell."""
        return self._first.has_valid_state()

    def valid_states(self) -> int | None:
        """How many states are valid, where the first who is asked can tell, or the last."""
        found = self._first.valid_states()
        return self._explicit.valid_states() if found is None and "_explicit" in self.__dict__ else found

    def prove_parts(
        self, names: Sequence[PropertyName], jobs: int, started: Callable[[PropertyName], None]
    ) -> Mapping[PropertyName, float]:
        """What the walk has children do."""
        return self._walk.prove_parts(names, jobs, started)

    @property
    def _first(self) -> Z3Prover | WalkProver:
        return self._z3


_WORST_FIRST = ("wrong", "set aside", "stale", "absent", "incomplete", "used", "unneeded")
"""What is said of a certificate as a whole: the first of these that is said for a property."""


class _Both(_Pair):
    """Both, which must agree."""

    def prove(self, name: PropertyName) -> PropertyResult:
        """Proved or refuted by both; a witness of one of them counts where the other does not answer.

        Raises `RuntimeError` where they differ: a bug of ours.
        """
        one, other = self._z3.prove(name), self._walk.prove(name)
        if {one.verdict, other.verdict} == {"proved", "refuted"}:
            raise RuntimeError(f"Z3 and the walk disagree: {one}, {other}")
        if one.verdict == other.verdict == "proved":
            return PropertyResult(name, "proved", one.obligations, "z3+walk")
        if "refuted" in (one.verdict, other.verdict):
            return one if one.verdict == "refuted" else other
        return one if one.verdict == "undecided" else other


class _Auto(_Pair):
    """Z3 where it answers soon, if there is one, the walk first where ranks are large; explicit-state checking last.

    Where there is little to look at, explicit-state checking comes before the others have used up their time; it is
    the first where actions have many cases, of which only one is met in a state. Once it has proved `safe`, it has
    listed all that it needs, and is the first.
    """

    _is_listed = False

    def prove(self, name: PropertyName) -> PropertyResult:
        """The verdict of the first prover that reaches one."""
        result = self._prove(name)
        if name == "safe" and result.verdict == "proved":
            self._policy_is_safe = True
            self._is_listed = result.proved_by == "explicit"
            for prover in self._asked:
                prover.policy_is_safe = True
        return result

    def _prove(self, name: PropertyName) -> PropertyResult:
        reasons: list[str | None] = []
        for prove in self._attempts(name):
            result = prove()
            if result.verdict != "undecided":
                return result
            reasons.append(result.reason)
        return PropertyResult(name, "undecided", reason="; ".join(dict.fromkeys(filter(None, reasons[-REASONS_TOLD:]))))

    def _attempts(self, name: PropertyName) -> Iterator[Callable[[], PropertyResult]]:
        """Who is asked, one after the other."""
        if self._cases > MANY_CASES and self._is_little:
            yield lambda: self._explicit.prove(name, LITTLE)
        if self._is_large:
            if self._is_listed and self._is_little:
                yield lambda: self._explicit.prove(name, LITTLE)
            elif self._may_be_little:
                remembered, outcomes = FIRST_TURN
                yield lambda: self._walk.prove(name, remembered)
                if self._work <= outcomes:
                    yield lambda: self._explicit.prove(name, LITTLE)
            yield lambda: self._walk.prove(name, SOON_REMEMBERED)
            if self._is_little:
                yield lambda: self._explicit.prove(name, LITTLE)
        if (name == "safe" or not self._is_large) and has_z3():
            yield lambda: self._z3.prove(name, within=SOON)
        if not self._is_large and self._is_little:
            yield lambda: self._explicit.prove(name, LITTLE)
        yield lambda: self._walk.prove(name)
        if has_z3():
            yield lambda: self._z3.prove(name)
        yield lambda: self._explicit.prove(name)

    def prove_parts(
        self, names: Sequence[PropertyName], jobs: int, started: Callable[[PropertyName], None]
    ) -> Mapping[PropertyName, float]:
        """What the walk has children do, where it has to answer."""
        if not self._is_large or self._may_be_little:
            return {}
        return self._walk.prove_parts(names, jobs, started, SOON_REMEMBERED)

    @property
    def _first(self) -> Z3Prover | WalkProver:
        return self._walk if self._is_large or not has_z3() else self._z3

    @property
    def _is_little(self) -> bool:
        """Whether all outcomes of all decisions are soon listed."""
        return self._work <= LITTLE

    @cached_property
    def _work(self) -> float:
        """About how many outcomes all decisions have; infinite where more states are decided than are looked at."""
        work = self._explicit.work if self._may_be_little else None
        return inf if work is None else work

    @cached_property
    def _may_be_little(self) -> bool:
        return count_defined(self._policy) <= LARGEST_TABLE

    @cached_property
    def _is_large(self) -> bool:
        """Ranks with many nodes, or many in a diagram, or those of a diagram, or of many goals, that brings none."""
        certificate, is_diagram = self._policy.certificate, not isinstance(self._policy.decisions, Table)
        if certificate is None:
            return self._goals_are_many or is_diagram
        ranks = certificate.ranks
        return len(ranks.nodes) > MANY_RANK_NODES or (is_diagram and len(ranks.leaves) > MANY_RANKS)
