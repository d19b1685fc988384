"""Ranks claimed by a policy, unverified until checked, and why its certificate is not used (`docs/certificate.md`)."""

from __future__ import annotations

from collections.abc import Callable

from tumato_symbolic.diagrams import Reference
from tumato_symbolic.policy import Certificate, Deviation, Policy, Restoring
from tumato_symbolic.semantics import ActionSet, Residual, State, action_names, named
from tumato_symbolic.spec import Spec, canonical_text, digest, executing_atoms
from tumato_symbolic.verify.result import CertificateUse

UNNEEDED = CertificateUse("unneeded")

NO_RANKS = "it has no ranks"

NOT_ALL = "not all of its ranks could be checked"
"""What is said of a certificate where a run fails, and it takes too much to look at the rest of the ranks."""


class ClaimedRanks:
    """The ranks that came with a policy, by residual goal; `use` tells what became of them.

    `roots` is empty where there are none, or they were set aside. `restoring` is what came with them about restoring
    safety in several steps, where the specification has that: None where there is nothing, or it was set aside.
    """

    def __init__(self, spec: Spec, policy: Policy, policy_is_safe: Callable[[], bool]) -> None:
        self._spec = spec
        self._policy_is_safe = policy_is_safe
        self.roots: dict[Residual, Reference] = {}
        self.restoring: Restoring | None = None
        self.use = self._first_look(policy)
        if self.use == UNNEEDED and policy.certificate is not None:
            self._read(policy.certificate)

    def _first_look(self, policy: Policy) -> CertificateUse:
        if policy.certificate is None and policy.certificate_problem is None:
            return CertificateUse("absent")
        if policy.digest != digest(self._spec):
            made_for = "no specification in particular" if policy.digest is None else "another specification"
            return CertificateUse("stale", f"it was made for {made_for}")
        if policy.certificate_problem is not None:
            return CertificateUse("wrong", policy.certificate_problem)
        return UNNEEDED

    def _read(self, certificate: Certificate) -> None:
        """Know the goals of the certificate by the numbers of the specification."""
        spec = self._spec
        self.restoring = certificate.restoring if spec.restores_stepwise else None
        bodies = {canonical_text(spec, rule.formula): number for number, rule in enumerate(spec.bodies)}
        actions = {spec.actions[cases[0]].name: cases[0] for cases in spec.cases}
        unknown = [text for goal in certificate.goals for text in goal.bodies if text not in bodies]
        if unknown:
            self.reject(f"it ranks '{unknown[0]}', which is no goal of the specification")
        elif any(leaf is not None and leaf < 0 for leaf in certificate.ranks.leaves):
            self.reject("it has a negative rank")
        else:
            for goal in certificate.goals:
                executed = frozenset(actions[name] for name in goal.executed)
                key = Residual(frozenset(bodies[text] for text in goal.bodies), executed)
                mentioned = frozenset[int]().union(*(executing_atoms(spec.bodies[body].formula) for body in key.bodies))
                if key in self.roots:
                    self.reject(f"it ranks {self.described(key)} twice")
                    return
                if not executed <= mentioned:
                    other = action_names(spec, executed - mentioned)[0]
                    self.reject(f"`Executed` has {other}, which its goal does not mention")
                    return
                self.roots[key] = goal.root

    @property
    def stands(self) -> bool:
        """Whether there is a certificate for this specification that was not found to be false."""
        return self.use.status in ("unneeded", "used", "incomplete")

    @property
    def covers_unsafe(self) -> bool:
        """Whether numbers at unsafe states claim something too: where it tells how these are left in several steps."""
        return self.restoring is not None

    def reject(self, reason: str) -> None:
        """Set the certificate aside: it is wrong, unless that may be the fault of an unsafe policy."""
        self.roots, self.restoring = {}, None
        self.use = CertificateUse("wrong" if self._policy_is_safe() else "set aside", reason)

    def join(self, use: CertificateUse) -> None:
        """Take over what became of the same certificate in a part of the proof that was done elsewhere."""
        if use.status == "used":
            self.serve()
        elif use.status == "incomplete":
            self.fall_short(use.reason)

    def serve(self) -> None:
        """The ranks carried a proof."""
        if self.use == UNNEEDED:
            self.use = CertificateUse("used")

    def fall_short(self, reason: str | None) -> None:
        """Some ranks had to be recomputed."""
        if self.use.status in ("used", "unneeded"):
            self.use = CertificateUse("incomplete", reason)

    def lacks(self, goal: Residual, state: State | None = None) -> None:
        """A rank that is needed is missing: that of `goal` after `state`, or all of them."""
        where = "" if state is None else f" after {_listed(self._spec, state)}"
        self.fall_short(f"it has no {'ranks' if state is None else 'rank'} of {self.described(goal)}{where}")

    def tells_nothing_of_restoring(self) -> None:
        """How unsafe states are left had to be computed."""
        self.fall_short("it does not say how safety is restored in several steps")

    def lacks_effort(self, state: State) -> None:
        """The effort of an unsafe state is missing."""
        self.fall_short(f"it does not say how safety is restored from {_listed(self._spec, state)}")

    def false_effort(self, state: State) -> None:
        """The effort of an unsafe state does not follow from those of its outcomes."""
        self.reject(f"its effort from {_listed(self._spec, state)} is not enough")

    def inexact_effort(self, state: State) -> None:
        """The effort of an unsafe state is larger than needed."""
        self.fall_short(f"its effort from {_listed(self._spec, state)} is more than it takes")

    def false_deviation(self, deviation: Deviation) -> None:
        """The run that a better set is said to spoil reaches its goal with it, or misses it without."""
        better = ", ".join(action_names(self._spec, deviation.better)) or "nothing"
        self.reject(
            f"with {better} in {_listed(self._spec, deviation.state)}, the run from "
            f"{_listed(self._spec, deviation.missed)} does not miss its goal because of that"
        )

    def lacks_deviation(self, state: State, better: ActionSet) -> None:
        """It is not said why a better set is not chosen in an unsafe state."""
        named_set = ", ".join(action_names(self._spec, better)) or "nothing"
        self.fall_short(f"it does not say why {named_set} is not chosen in {_listed(self._spec, state)}")

    def inexact(self, goal: Residual) -> None:
        """The ranks of `goal` are no proof that a run is too long, or are larger than it is."""
        self.fall_short(f"its ranks of {self.described(goal)} are not the lengths of the runs")

    def described(self, goal: Residual) -> str:
        """A residual goal in the user's words."""
        text = " AND ".join(f"({self._spec.bodies[body].text})" for body in sorted(goal.bodies)) or "'no goal'"
        executed = ", ".join(action_names(self._spec, goal.executed))
        return f"{text} while executing {executed}" if executed else text


def _listed(spec: Spec, state: State) -> str:
    return ", ".join(f"{name} is {value}" for name, value in named(spec, state).items())
