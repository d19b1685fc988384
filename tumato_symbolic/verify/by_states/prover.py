"""The properties of a policy, checked state by state: the prover that is asked last (`docs/certificate.md`)."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cached_property, partial
from itertools import islice
from operator import itemgetter

from tumato_symbolic.limits import Context
from tumato_symbolic.policy import Policy, Table, as_table
from tumato_symbolic.semantics import ActionSet, State, duration, follow, is_valid, objections
from tumato_symbolic.spec import Ordering, Spec
from tumato_symbolic.verify.by_states.claims import Claims
from tumato_symbolic.verify.by_states.packed import Code, Packing, states_where, valid_states
from tumato_symbolic.verify.by_states.restoring_claims import RestoringClaims
from tumato_symbolic.verify.by_states.runs import Runs
from tumato_symbolic.verify.by_states.several_steps import SeveralSteps
from tumato_symbolic.verify.by_states.steps import MOST_WAYS, Steps, TooManyError, ways
from tumato_symbolic.verify.claimed_ranks import ClaimedRanks
from tumato_symbolic.verify.decisions import LARGEST_TABLE, Decisions
from tumato_symbolic.verify.result import CertificateUse, PropertyName, PropertyResult, Refutation
from tumato_symbolic.verify.ways_back import RestoringWitnesses

MOST_ROWS = 10 * LARGEST_TABLE
"""How many rows are looked at to find those of valid states."""

MOST_UNDECIDED = 1_000_000
"""How many valid states without a decision are looked at for what a certificate claims of them."""

_CHECKED_EVERY = 50_000
"""After so many outcomes and steps, the time limit is looked at."""


class StateProver:
    """Proves or refutes the properties of one policy by looking at every decided state, up to `LARGEST_TABLE` of them.

    Has no time limit but that of the whole.
    """

    def __init__(self, spec: Spec, policy: Policy, ordering: Ordering, context: Context) -> None:
        self._spec, self._policy, self._ordering, self._context = spec, policy, ordering, context
        self._packing = Packing(spec)
        in_part = None if spec.part is None else lambda code: code in (self._stated or {})
        self._steps = Steps(spec, self._packing, ordering, self._spend, in_part)
        self._spent = self._next_look = 0
        self._most: int | None = None
        self.policy_is_safe = False
        self._total = False

    @property
    def use(self) -> CertificateUse:
        """What became of the certificate."""
        return self._claimed.use if "_claimed" in self.__dict__ else CertificateUse("unneeded")

    @property
    def work(self) -> int | None:
        """About how many outcomes there are to look at; None where more states are decided than are looked at."""
        if self._decided is None:
            return None
        each = {chosen: self._ways(chosen) for chosen in set(self._decided.values())}
        return sum(each[chosen] for chosen in self._decided.values())

    def _ways(self, chosen: ActionSet) -> int:
        if self._ordering == "first":
            return 1 + sum(len(self._spec.actions[number].effects) for number in chosen)
        found = ways(self._spec, chosen)
        return found if found <= MOST_WAYS else MOST_WAYS * LARGEST_TABLE

    def prove(self, name: PropertyName, most: int | None = None) -> PropertyResult:
        """The verdict on one property; undecided where there are too many states or outcomes, or more than `most`.

        Raises `LimitReachedError`.
        """
        self._most = None if most is None else self._spent + most
        decided = self._decided
        if decided is None:
            return PropertyResult(
                name, "undecided", reason=f"over {LARGEST_TABLE:,} states are decided, too many to list"
            )
        proofs: dict[str, Callable[[Mapping[Code, ActionSet]], PropertyResult]] = {
            "total": self._prove_total,
            "safe": self._prove_safe,
            "restoring": self._prove_restoring,
            "goals": self._prove_goals,
            "minimal": self._prove_stepwise_minimal if self._spec.restores_stepwise else self._prove_minimal,
        }
        try:
            result = proofs[name](decided)
        except TooManyError as many:
            return PropertyResult(name, "undecided", reason=str(many))
        self._total |= name == "total" and result.verdict == "proved"
        self.policy_is_safe |= name == "safe" and result.verdict == "proved"
        return result

    def prove_parts(
        self, names: Sequence[PropertyName], jobs: int, started: Callable[[PropertyName], None]
    ) -> dict[PropertyName, float]:
        """Nothing: one process looks at all states."""
        del names, jobs, started
        return {}

    def has_valid_state(self) -> bool:
        """Whether some state is valid, and a start."""
        if self._spec.starts:
            return next(self._starts(), None) is not None
        return bool(self._decided) or next(valid_states(self._spec, self._packing), None) is not None

    def valid_states(self) -> int | None:
        """How many states are valid; None where not all of them are decided."""
        return len(self._decided or ()) if self._total else None

    def _spend(self, amount: int) -> None:
        """Account for some work, heeding the limits. Raises `LimitReachedError` and `TooManyError`."""
        self._spent += amount
        if self._spent >= self._next_look:
            self._next_look = self._spent + _CHECKED_EVERY
            self._context.check()
            if self._most is not None and self._spent > self._most:
                raise TooManyError("there are too many cases to check one by one")

    @cached_property
    def _decided(self) -> dict[Code, ActionSet] | None:
        """The decisions in valid states, in the order of the states; None where there are too many."""
        stated, is_valid = self._stated, self._steps.is_valid
        found = dict(islice((row for row in (stated or {}).items() if is_valid(row[0])), LARGEST_TABLE + 1))
        return None if stated is None or len(found) > LARGEST_TABLE else found

    @cached_property
    def _stated(self) -> dict[Code, ActionSet] | None:
        """What the policy says of states, valid or not, in their order; None where that is too much to list."""
        decisions, pack = self._policy.decisions, self._packing.pack
        table = decisions if isinstance(decisions, Table) else as_table(self._policy, MOST_ROWS)
        if table is None:
            return None
        return {pack(state): chosen for state, chosen in sorted(table.rows.items(), key=itemgetter(0))}

    @cached_property
    def _decisions(self) -> Decisions:
        return Decisions(self._spec, self._policy)

    @cached_property
    def _allowed(self) -> dict[Code, ActionSet]:
        """The allowed decisions."""
        allowed = self._steps.allowed
        return {code: chosen for code, chosen in (self._decided or {}).items() if allowed(code, chosen)}

    @cached_property
    def _runs(self) -> Runs:
        return Runs(self._spec, self._packing, self._steps, self._decided or {}, self._spend)

    @cached_property
    def _claimed(self) -> ClaimedRanks:
        return ClaimedRanks(
            self._spec, self._policy, lambda: self.policy_is_safe or len(self._allowed) == len(self._decided or ())
        )

    def _prove_total(self, decided: Mapping[Code, ActionSet]) -> PropertyResult:
        if self._spec.starts:
            return self._prove_starts(decided)
        for state in valid_states(self._spec, self._packing):
            self._spend(1)
            if self._packing.pack(state) not in decided:
                return PropertyResult("total", "refuted", refutation=Refutation("missing", state))
        return PropertyResult("total", "proved", len(decided), "explicit")

    def _prove_starts(self, decided: Mapping[Code, ActionSet]) -> PropertyResult:
        count = 0
        for state in self._starts():
            self._spend(1)
            count += 1
            if self._packing.pack(state) not in decided:
                return PropertyResult("total", "refuted", refutation=Refutation("missing", state))
        for code, chosen in (self._stated or {}).items():
            state = self._packing.unpack(code)
            if not is_valid(self._spec.whole, state):
                return PropertyResult("total", "refuted", refutation=Refutation("invalid", state, chosen))
        return PropertyResult("total", "proved", count, "explicit")

    def _starts(self) -> Iterator[State]:
        """All starts, decided or not."""
        formulas = [*(rule.formula for rule in self._spec.assumptions), self._spec.start]
        return states_where(self._spec, self._packing, formulas)

    def _prove_safe(self, decided: Mapping[Code, ActionSet]) -> PropertyResult:
        wrong = next((code for code in decided if code not in self._allowed), None)
        if wrong is None:
            return PropertyResult("safe", "proved", len(decided), "explicit")
        state, chosen = self._packing.unpack(wrong), decided[wrong]
        objection = next(objections(self._spec, state, chosen, self._ordering), None)
        if objection is None:
            raise RuntimeError(f"{sorted(chosen)} is allowed in {state}, against the steps")
        return PropertyResult("safe", "refuted", refutation=Refutation("not-allowed", state, chosen, objection))

    def _prove_goals(self, decided: Mapping[Code, ActionSet]) -> PropertyResult:
        missed = next((code for code, chosen in self._allowed.items() if not self._runs.serves(code, chosen)), None)
        self._look_at_the_certificate(decided)
        if missed is None:
            return PropertyResult("goals", "proved", len(self._allowed), "explicit")
        state, chosen = self._packing.unpack(missed), decided[missed]
        run = follow(self._spec, self._decisions, state, chosen)
        if run.end == "goal":
            raise RuntimeError(f"the run from {state} reaches its goal, against its number of steps")
        return PropertyResult("goals", "refuted", refutation=Refutation("goal-missed", state, chosen, run=run))

    def _look_at_the_certificate(self, decided: Mapping[Code, ActionSet]) -> None:
        claimed, certificate = self._claimed, self._policy.certificate
        if certificate is None:
            return
        claims = Claims(self._spec, self._packing, self._runs, certificate, claimed)
        try:
            claims.look(self._covered(decided), self._allowed)
        except TooManyError as many:
            if self._most is not None:
                raise
            claimed.fall_short(str(many))

    def _covered(self, decided: Mapping[Code, ActionSet]) -> Iterator[Code]:
        """All states where a rank claims something: the safe ones, decided or not; in several steps the unsafe too."""
        every = self._every_valid(decided)
        return every if self._claimed.covers_unsafe else filter(self._steps.is_safe, every)

    def _every_valid(self, decided: Mapping[Code, ActionSet]) -> Iterator[Code]:
        """All valid states, decided or not; with starts, all that are decided."""
        if self._total or self._spec.starts:
            yield from decided
            return
        undecided = 0
        for state in valid_states(self._spec, self._packing):
            self._spend(1)
            code = self._packing.pack(state)
            undecided += code not in decided
            if undecided > MOST_UNDECIDED:
                raise TooManyError(f"over {MOST_UNDECIDED:,} states are not decided")
            yield code

    @cached_property
    def _several_steps(self) -> SeveralSteps:
        return SeveralSteps(self._spec, self._steps, self._runs, self._decided or {}, self._spend)

    @cached_property
    def _restoring_claims(self) -> RestoringClaims:
        return RestoringClaims(self._packing, self._several_steps, self._claimed)

    def _look_at_restoring(self, decided: Mapping[Code, ActionSet]) -> None:
        try:
            self._restoring_claims.look(self._every_valid(decided))
        except TooManyError as many:
            if self._most is not None:
                raise
            self._claimed.fall_short(str(many))

    def _prove_restoring(self, decided: Mapping[Code, ActionSet]) -> PropertyResult:
        lost = next(self._several_steps.not_restored(), None)
        self._look_at_restoring(decided)
        if lost is None:
            return PropertyResult("restoring", "proved", len(self._several_steps.unsafe), "explicit")
        return self._replayed.not_restored(self._packing.unpack(lost))

    def _prove_stepwise_minimal(self, decided: Mapping[Code, ActionSet]) -> PropertyResult:
        self._look_at_restoring(decided)
        claims = self._restoring_claims
        claims.look_closer()
        for code in self._several_steps.unsafe:
            for rival in self._several_steps.rivals(code, partial(claims.told, code)):
                if rival.misses is None:
                    return self._replayed.not_minimal(self._packing.unpack(code), rival.chosen)
                claims.deviates(code, rival.chosen)
        return PropertyResult("minimal", "proved", len(self._several_steps.unsafe), "explicit")

    @cached_property
    def _replayed(self) -> RestoringWitnesses:
        return RestoringWitnesses(self._spec, self._decisions, self._ordering)

    def _prove_minimal(self, decided: Mapping[Code, ActionSet]) -> PropertyResult:
        looked_at = 0
        for code, chosen in decided.items():
            if self._steps.is_safe(code):
                continue
            looked_at += 1
            better = self._best(code, duration(self._spec, chosen))
            if better is not None:
                return self._not_minimal(self._packing.unpack(code), chosen, better)
        return PropertyResult("minimal", "proved", looked_at, "explicit")

    def _best(self, code: Code, limit: int) -> ActionSet | None:
        """The best set that is shorter than `limit` and serves as well: the shortest, then smallest, then first one."""
        best: tuple[int, int, list[int]] | None = None
        for chosen in self._steps.cheaper_sets(code, limit):
            measure = duration(self._spec, chosen), len(chosen), sorted(chosen)
            if (best is None or measure < best) and self._runs.serves(code, chosen):
                best = measure
        return None if best is None else frozenset(best[2])

    def _not_minimal(self, state: State, chosen: ActionSet, better: ActionSet) -> PropertyResult:
        run = follow(self._spec, self._decisions, state, better)
        if run.end != "goal" or next(objections(self._spec, state, better, self._ordering), None) is not None:
            raise RuntimeError(f"{sorted(better)} is not better in {state}, against the steps")
        refutation = Refutation("not-minimal", state, chosen, run=run, cheaper=better)
        return PropertyResult("minimal", "refuted", refutation=refutation)
