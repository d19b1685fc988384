"""Where ranks come from: the policy's certificate as long as it holds, otherwise the runs themselves."""

from __future__ import annotations

from collections.abc import Iterable

from tumato_symbolic.policy.model import Certificate, Policy
from tumato_symbolic.semantics import Residual, State, action_names
from tumato_symbolic.spec import Ordering, canonical_text, digest
from tumato_symbolic.verify.decisions import Decisions, Ranks
from tumato_symbolic.verify.frame import Frame
from tumato_symbolic.verify.outcomes import objections_to
from tumato_symbolic.verify.rank_terms import RankFunction, RankProof
from tumato_symbolic.verify.result import CertificateUse
from tumato_symbolic.verify.solver import UndecidedError

_UNNEEDED = CertificateUse("unneeded")


class RankSource:
    """The ranks of one policy; `use` tells what became of its certificate."""

    def __init__(self, frame: Frame, policy: Policy, ordering: Ordering, policy_is_safe: bool) -> None:
        self._frame = frame
        self._ordering = ordering
        self._policy_is_safe = policy_is_safe
        self.decisions = Decisions(frame.spec, policy)
        self.ranks = Ranks(frame.spec, self.decisions)
        self.given: dict[Residual, RankFunction] = {}
        self._recomputed: dict[Residual, RankFunction] = {}
        self.use = self._first_look(policy)
        if self.use == _UNNEEDED and policy.certificate is not None:
            self._read(policy.certificate)

    def _first_look(self, policy: Policy) -> CertificateUse:
        if policy.certificate is None and policy.certificate_problem is None:
            return CertificateUse("absent")
        if policy.digest != digest(self._frame.spec):
            made_for = "no specification in particular" if policy.digest is None else "another specification"
            return CertificateUse("stale", f"it was made for {made_for}")
        if policy.certificate_problem is not None:
            return CertificateUse("wrong", policy.certificate_problem)
        return _UNNEEDED

    def _read(self, certificate: Certificate) -> None:
        """Know the goals of the certificate by the numbers of the specification."""
        spec = self._frame.spec
        bodies = {canonical_text(spec, rule.formula): number for number, rule in enumerate(spec.bodies)}
        actions = {action.name: number for number, action in enumerate(spec.actions)}
        unknown = [text for goal in certificate.goals for text in goal.bodies if text not in bodies]
        if unknown:
            self.reject(f"it ranks '{unknown[0]}', which is no goal of the specification")
        elif any(leaf is not None and leaf < 0 for leaf in certificate.ranks.leaves):
            self.reject("it has a negative rank")
        else:
            for goal in certificate.goals:
                executed = frozenset(actions[name] for name in goal.executed)
                key = Residual(frozenset(bodies[text] for text in goal.bodies), executed)
                self.given[key] = RankFunction(key, certificate.ranks, goal.root, given=True)

    def owes_a_run(self, state: State) -> bool:
        """Whether the decision for `state` owes a run: those that are not allowed are refuted without one."""
        return self._policy_is_safe or not objections_to(
            self._frame.spec, state, self.decisions[state], self._ordering, self._frame.deadline()
        )

    def reject(self, reason: str) -> None:
        """Set the certificate aside: it is wrong, unless that may be the fault of an unsafe policy."""
        self.given = {}
        self.use = CertificateUse("wrong" if self._policy_is_safe else "set aside", reason)

    def check_given(self, goals: Iterable[Residual]) -> bool:
        """Whether the certificate ranks all of `goals`, and all its ranks decrease; otherwise it is set aside.

        Raises `UndecidedError`.
        """
        if self.use != _UNNEEDED:
            return False
        for goal, ranks in self.given.items():
            if not RankProof(self._frame, ranks).decreases():
                self.reject(f"the ranks of {self._described(goal)} do not go down to it")
                return False
        missing = next((goal for goal in goals if goal not in self.given), None)
        if missing is not None:
            self.use = CertificateUse("incomplete", f"it has no ranks of {self._described(missing)}")
            return False
        self.use = CertificateUse("used")
        return True

    def recomputed(self, goal: Residual) -> RankFunction:
        """The ranks that the runs have. Needs a policy small enough to be followed."""
        if goal not in self._recomputed:
            diagram, root = self.ranks.diagram(goal)
            self._recomputed[goal] = RankFunction(goal, diagram, root, given=False)
        return self._recomputed[goal]

    def lower_bound(self, goal: Residual) -> RankFunction:
        """Ranks proved to be nowhere larger than the run is long. Raises `UndecidedError`."""
        given = self.given.get(goal)
        if given is not None:
            if RankProof(self._frame, given).is_lower_bound():
                if self.use == _UNNEEDED:
                    self.use = CertificateUse("used")
                return given
        elif self.given:
            self._partly(f"it has no ranks of {self._described(goal)}")
        return self.exact(goal)

    def exact(self, goal: Residual) -> RankFunction:
        """The lengths of the runs themselves, proved as a lower bound. Raises `UndecidedError`."""
        if goal in self.given:
            self._partly(f"its ranks of {self._described(goal)} are not the lengths of the runs")
        if self.decisions.rows is None:
            why = f"there are no exact ranks of {self._described(goal)}, and too many states to follow all runs"
            raise UndecidedError("no cheaper allowed set serves as well", why)
        ranks = self.recomputed(goal)
        if not RankProof(self._frame, ranks).is_lower_bound():
            raise RuntimeError(f"the lengths of runs are no ranks of {goal}")
        return ranks

    def _partly(self, reason: str) -> None:
        if self.use.status in ("used", "unneeded"):
            self.use = CertificateUse("incomplete", reason)

    def _described(self, goal: Residual) -> str:
        spec = self._frame.spec
        text = " AND ".join(f"({spec.bodies[body].text})" for body in sorted(goal.bodies)) or "'no goal'"
        executed = ", ".join(action_names(spec, goal.executed))
        return f"{text} while executing {executed}" if executed else text
