"""Who proves what: Z3, the walk, both, or whoever is quicker (`docs/certificate.md`)."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Protocol

from tumato_symbolic.policy.model import Policy, Table
from tumato_symbolic.spec import Ordering, Spec
from tumato_symbolic.verify.by_walk.prover import WalkProver
from tumato_symbolic.verify.result import CertificateUse, PropertyName, PropertyResult, ProverName

if TYPE_CHECKING:
    from tumato_symbolic.verify.by_z3.prover import Z3Prover

SOON = 2.0
"""How many seconds Z3 may think about a property before the walk is tried."""

MANY_RANK_NODES = 500
"""Ranks with more nodes than that tend to count, and then Z3 takes long."""


class Prover(Protocol):
    """Judges the properties of one policy, in the order of `PROPERTIES`."""

    @property
    def use(self) -> CertificateUse:
        """What became of the certificate."""

    def has_valid_state(self) -> bool:
        """Whether some state is valid, as far as can be told."""

    def prove(self, name: PropertyName) -> PropertyResult:
        """The verdict on one property."""

    def valid_states(self) -> int | None:
        """How many states are valid; None where they could not be counted cheaply."""


def make_prover(name: ProverName, spec: Spec, policy: Policy, ordering: Ordering, timeout: float | None) -> Prover:
    """The prover of this name for a policy that is bound to `spec`."""
    match name:
        case "z3":
            return _z3(spec, policy, ordering, timeout)
        case "walk":
            return WalkProver(spec, policy, ordering, timeout)
        case "both":
            return _Both(spec, policy, ordering, timeout)
        case _:
            return _Auto(spec, policy, ordering, timeout)


def _z3(spec: Spec, policy: Policy, ordering: Ordering, timeout: float | None) -> Z3Prover:
    from tumato_symbolic.verify.by_z3.prover import Z3Prover

    return Z3Prover(spec, policy, ordering, timeout)


class _Pair:
    """Z3 and the walk for one policy."""

    def __init__(self, spec: Spec, policy: Policy, ordering: Ordering, timeout: float | None) -> None:
        self._policy = policy
        self._z3 = _z3(spec, policy, ordering, timeout)
        self._walk = WalkProver(spec, policy, ordering, timeout)

    @property
    def use(self) -> CertificateUse:
        """The worse of what became of the certificate."""
        return min((self._z3.use, self._walk.use), key=lambda use: _WORST_FIRST.index(use.status))

    def has_valid_state(self) -> bool:
        """Whether some state is valid, as far as Z3 can tell."""
        return self._z3.has_valid_state()

    def valid_states(self) -> int | None:
        """How many states are valid, where Z3 can tell."""
        return self._z3.valid_states()


_WORST_FIRST = ("wrong", "set aside", "stale", "absent", "incomplete", "used", "unneeded")


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
    """Z3 where it answers soon, otherwise the walk, otherwise Z3 after all."""

    def prove(self, name: PropertyName) -> PropertyResult:
        """The verdict of whoever reaches one."""
        if not self._walk_first(name):
            soon = self._z3.prove(name, within=SOON)
            if soon.verdict != "undecided":
                self._walk.policy_is_safe |= name == "safe" and soon.verdict == "proved"
                return soon
        walked = self._walk.prove(name)
        if walked.verdict != "undecided":
            self._z3.policy_is_safe |= name == "safe" and walked.verdict == "proved"
            return walked
        last = self._z3.prove(name)
        if last.verdict == "undecided":
            return PropertyResult(name, "undecided", reason=f"{last.reason}; {walked.reason}")
        return last

    def _walk_first(self, name: PropertyName) -> bool:
        return name in ("goals", "minimal") and self._is_large

    @cached_property
    def _is_large(self) -> bool:
        """Ranks with many nodes, or those of a diagram that brings none."""
        certificate = self._policy.certificate
        if certificate is None:
            return not isinstance(self._policy.decisions, Table)
        return len(certificate.ranks.nodes) > MANY_RANK_NODES
