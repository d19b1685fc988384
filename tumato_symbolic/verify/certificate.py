"""Where ranks come from: the policy's certificate as long as it holds, otherwise the runs themselves."""

from __future__ import annotations

from tumato_symbolic.policy.model import Certificate, Policy
from tumato_symbolic.semantics import Residual, State, action_names, named
from tumato_symbolic.spec import Ordering, Spec, canonical_text, digest, executing_atoms
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
                spoken = frozenset[int]().union(*(executing_atoms(spec.bodies[body].formula) for body in key.bodies))
                if key in self.given:
                    return self.reject(f"it ranks {self.described(key)} twice")
                if not executed <= spoken:
                    unspoken = action_names(spec, executed - spoken)[0]
                    return self.reject(f"`Executed` has {unspoken}, of which its goal does not speak")
                self.given[key] = RankFunction(key, certificate.ranks, goal.root, given=True)
        return None

    def owes_a_run(self, state: State) -> bool:
        """Whether the decision for `state` owes a run: those that are not allowed are refuted without one."""
        return self._policy_is_safe or not objections_to(
            self._frame.spec, state, self.decisions[state], self._ordering, self._frame.deadline()
        )

    def reject(self, reason: str) -> None:
        """Set the certificate aside: it is wrong, unless that may be the fault of an unsafe policy."""
        self.given = {}
        self.use = CertificateUse("wrong" if self._policy_is_safe else "set aside", reason)

    def check_given(self) -> bool:
        """Whether there is a certificate all of whose ranks decrease; a false one is set aside.

        Raises `UndecidedError`.
        """
        if self.use != _UNNEEDED:
            return False
        for goal, ranks in self.given.items():
            if not RankProof(self._frame, ranks).decreases():
                self.reject(f"the ranks of {self.described(goal)} do not go down to it")
                return False
        return True

    def serve(self) -> None:
        """The ranks carried a proof."""
        if self.use == _UNNEEDED:
            self.use = CertificateUse("used")

    def lacks(self, goal: Residual, state: State | None = None) -> None:
        """A rank that is needed is missing: that of `goal` after `state`, or all of them."""
        where = "" if state is None else f" after {_listed(self._frame.spec, state)}"
        self.fall_short(f"it has no {'ranks' if state is None else 'rank'} of {self.described(goal)}{where}")

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
                self.serve()
                return given
        elif self.given:
            self.lacks(goal)
        return self.exact(goal)

    def exact(self, goal: Residual) -> RankFunction:
        """The lengths of the runs themselves, proved as a lower bound. Raises `UndecidedError`."""
        if goal in self.given:
            self.fall_short(f"its ranks of {self.described(goal)} are not the lengths of the runs")
        if self.decisions.rows is None:
            why = f"there are no exact ranks of {self.described(goal)}, and too many states to follow all runs"
            raise UndecidedError("no cheaper allowed set serves as well", why)
        ranks = self.recomputed(goal)
        if not RankProof(self._frame, ranks).is_lower_bound():
            raise RuntimeError(f"the lengths of runs are no ranks of {goal}")
        return ranks

    def fall_short(self, reason: str) -> None:
        """Some ranks had to be recomputed."""
        if self.use.status in ("used", "unneeded"):
            self.use = CertificateUse("incomplete", reason)

    def described(self, goal: Residual) -> str:
        """A residual goal in the user's words."""
        spec = self._frame.spec
        text = " AND ".join(f"({spec.bodies[body].text})" for body in sorted(goal.bodies)) or "'no goal'"
        executed = ", ".join(action_names(spec, goal.executed))
        return f"{text} while executing {executed}" if executed else text


def _listed(spec: Spec, state: State) -> str:
    return ", ".join(f"{name} is {value}" for name, value in named(spec, state).items())
