"""What verification answers: a verdict per property, each refutation with its witness."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, Literal, TypeAlias

from msgspec import Struct
from msgspec.structs import replace

from tumato_symbolic.diagnostics.cubes import actions_text
from tumato_symbolic.diagnostics.one_line import InOneLine
from tumato_symbolic.diagnostics.wording import count
from tumato_symbolic.semantics import (
    ActionSet,
    EffectSequence,
    Objection,
    Quality,
    Run,
    State,
    action_names,
    state_text,
)
from tumato_symbolic.spec import Ordering, Restoration, Spec

if TYPE_CHECKING:
    from tumato_symbolic.notebook import Tone

Verdict: TypeAlias = Literal["proved", "refuted", "undecided"]
PropertyName: TypeAlias = Literal["total", "safe", "restoring", "goals", "minimal", "ordering", "restoration"]
OrderingSource: TypeAlias = Literal["command line", "certificate", "specification", "default"]
ProverName: TypeAlias = Literal["z3", "walk", "explicit", "both", "auto"]
UnrealizabilityKind: TypeAlias = Literal["no-allowed-set", "no-restoration", "no-plan", "conflict", "no-part"]

PROVERS: Final = {"z3": "Z3", "walk": "the walk", "explicit": "explicit-state checking"}
"""What provers are called."""

PROPERTIES: tuple[PropertyName, ...] = ("total", "safe", "restoring", "goals", "minimal")
"""What is asked by default, in the order in which it is proved; see `properties_of`."""


def properties_of(spec: Spec) -> tuple[PropertyName, ...]:
    """Those that a policy for a specification has to have: *restoring* where safety may take several steps to restore.

    In one step, *safe* says it already.
    """
    return tuple(name for name in PROPERTIES if name != "restoring" or spec.restores_stepwise)


class Departure(Struct, frozen=True):
    """A state and what the policy does there, with effects that lead to a state that it does not decide."""

    state: State
    decision: ActionSet
    outcome: EffectSequence


class Refutation(Struct, frozen=True):
    """A state in which a property fails, what the policy does there, and the witness for it.

    `missing` comes with `departure`, the way from a decided state to this one, or is `closed`: no decision may lead to
    an undecided state. It has neither where there were too many to look at, and where there are starts, of which it is
    one.
    `invalid`: a state that is decided although it is not valid, where there are starts.
    `not-allowed` comes with `objection`, the first condition that fails; `goal-missed` with `run`, the run that loops,
    ends without a decision or exceeds the bound; `not-minimal` with `cheaper`, the cheapest set that serves as well,
    and its `run`. Where safety may take several steps to restore, `not-restored` comes with `run`, steps into a loop or
    to where nothing can be done, along nominal effects under `fair`, else by any outcomes, where it was found; and
    `not-minimal` with `qualities`, how well the decision restores safety and how well `cheaper` does, the best set.
    `ordering` and `restoration` have no state: the policy records `first` where the specification means `any`, or a
    weaker way to restore safety than the specification means.
    """

    kind: Literal[
        "missing",
        "invalid",
        "not-allowed",
        "not-restored",
        "goal-missed",
        "not-minimal",
        "ordering",
        "restoration",
    ]
    state: State | None = None
    decision: ActionSet | None = None
    objection: Objection | None = None
    run: Run | None = None
    cheaper: ActionSet | None = None
    departure: Departure | None = None
    closed: bool = False
    qualities: tuple[Quality | None, Quality] | None = None


class PropertyResult(Struct, frozen=True):
    """The verdict on one property.

    `obligations` counts what had to be proved of all states and was; `proved_by` names the prover of a proved
    property, `z3`, `walk`, `z3+walk` (both) or `explicit`; `reason` tells why an undecided one is undecided.
    """

    name: PropertyName
    verdict: Verdict
    obligations: int = 0
    proved_by: str | None = None
    refutation: Refutation | None = None
    reason: str | None = None
    seconds: float = 0.0


class CertificateUse(Struct, frozen=True):
    """What became of the policy's certificate, and why.

    `used`: it carried the proof. `incomplete`: it carried a part, other ranks were recomputed. `absent`: there is none.
    `stale`: it was made for another specification. `wrong`: it was made for this one, and is false. `unneeded`: no
    property that was asked needs ranks. `set aside`: it fails, and so does the policy's own safety.
    """

    status: Literal["used", "incomplete", "absent", "stale", "wrong", "unneeded", "set aside"]
    reason: str | None = None


class Verification(InOneLine, frozen=True):
    """The answer of `verify`.

    It is about the valid states that the policy decides, and of how many is `decided_states`, out of `valid_states`;
    each is None where it could not be counted cheaply. `from_starts`: it has to decide the starts, and all that follows
    from them. `restoration` is how safety is to be restored, where that may
    take several steps. `spec` names the states of refutations.
    """

    verdict: Verdict
    properties: tuple[PropertyResult, ...]
    ordering: Ordering
    ordering_source: OrderingSource
    certificate: CertificateUse
    valid_states: int | None
    decided_states: int | None = None
    restoration: Restoration | None = None
    from_starts: bool = False
    spec: Spec | None = None

    @property
    def decides_all(self) -> bool:
        """Whether the policy is known to decide every valid state."""
        total = not self.from_starts and any(
            (result.name, result.verdict) == ("total", "proved") for result in self.properties
        )
        return total or (self.decided_states is not None and self.decided_states == self.valid_states)

    def __repr__(self) -> str:
        by_verdict: dict[Verdict, list[str]] = {self.verdict: []}
        for each in self.properties:
            by_verdict.setdefault(each.verdict, []).append(each.name)
        found = (f"{verdict} ({', '.join(names)})" for verdict, names in by_verdict.items())
        return f"<Verification: {', '.join([*found, *self._states])}>"

    def _repr_html_(self) -> str:
        from tumato_symbolic.notebook import panel, table

        rows = ((each.name, each.verdict, _why(each, self.spec)) for each in self.properties)
        tone = _TONES[self.verdict]
        return panel(tone, self.verdict.capitalize(), self._states, table(("property", "verdict", ""), rows))

    @property
    def _states(self) -> tuple[str, ...]:
        states = self.valid_states if self.decided_states is None else self.decided_states
        return () if states is None else (count(states, "valid state"),)


_TONES: Final[dict[Verdict, Tone]] = {"proved": "good", "refuted": "bad", "undecided": "doubt"}


def _why(result: PropertyResult, spec: Spec | None) -> str:
    """By whom it is proved, how and where it fails, or why it is undecided."""
    if (refuted := result.refutation) is not None:
        if spec is None or refuted.state is None:
            return refuted.kind
        decision = (
            ""
            if refuted.decision is None
            else f", where it executes {actions_text(action_names(spec, refuted.decision))}"
        )
        return f"{refuted.kind} in {state_text(spec, refuted.state)}{decision}"
    if result.proved_by:
        return f"by {' and '.join(PROVERS.get(name, name) for name in result.proved_by.split('+'))}"
    return result.reason or ""


class UnrealizabilityVerdict(Struct, frozen=True):
    """The answer of `verify_unrealizable`.

    `reason` tells which check failed, or why there is no verdict; `state` and `chosen` are the witness, where there is
    one: an allowed set that the certificate leaves out. `stale`: the certificate was made for another
    specification, and was judged against this one all the same. `by_solver`: Z3 was needed; `by_diagrams`: the walk
    was; `by_checker`: `proofs/checker.py` has judged it instead of all that.
    """

    verdict: Verdict
    kind: UnrealizabilityKind
    ordering: Ordering
    ordering_source: OrderingSource
    stale: bool
    obligations: int = 0
    by_solver: bool = False
    by_diagrams: bool = False
    by_checker: bool = False
    reason: str | None = None
    state: State | None = None
    chosen: ActionSet | None = None


def stopped(known: Verification, limit: str) -> Verification:
    """The answer of work that a limit ended, from what its context had learned by then."""
    properties = (
        replace(each, reason=limit) if (each.verdict, each.reason) == ("undecided", None) else each
        for each in known.properties
    )
    return replace(known, properties=tuple(properties))
