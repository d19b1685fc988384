"""What synthesis answers, with its statistics: always one of three records, never None."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, TypeAlias

from msgspec import Struct

from tumato_symbolic.diagnostics import Diagnostic
from tumato_symbolic.diagnostics.one_line import InOneLine
from tumato_symbolic.diagnostics.wording import count
from tumato_symbolic.policy import Policy
from tumato_symbolic.semantics import State
from tumato_symbolic.spec import Formula, Ordering, Spec

if TYPE_CHECKING:
    from tumato_symbolic.policy.unrealizability import Unrealizability
    from tumato_symbolic.synthesis.diagnosis import Restorability

FailureKind: TypeAlias = Literal["no-allowed-set", "no-restoration", "no-plan", "conflict"]


class Statistics(Struct, frozen=True):
    """Exact counts of states, and how the answer was found.

    `longest_run` is None where there is no policy. `own_region` counts the safe states that were decided by staying
    where their goals are active, `changed` those whose decision then had to deviate because goals interact. `restored`
    is there where safety may take several steps to restore, and does.
    """

    total: int
    valid: int
    safe: int
    unsafe: int
    longest_run: int | None
    backend: str
    ordering: Ordering
    own_region: int = 0
    changed: int = 0
    restored: RestoredIn | None = None
    part: DecidedPart | None = None
    one_at_a_time: bool = False

    @property
    def longest_told(self) -> str:
        """How many steps the longest run takes, in words."""
        return ("at most " if self.one_at_a_time else "") + count(self.longest_run or 0, "step")


class DecidedPart(Struct, frozen=True):
    """How many valid states a policy from the starts decides, and why not the others; `starts` counts the starts.

    Where there is no policy, `decided` is how many any one could decide, goals that conflict aside. `left_out` are the
    others by why they fail, those of a conflict too. `unsafe` is the number of unsafe states among those that are
    decided.
    """

    decided: int
    unsafe: int
    starts: int
    left_out: tuple[Failure, ...]


class RestoredIn(Struct, frozen=True):
    """How a policy restores safety, where that may take several steps: exact counts of unsafe states.

    `bounded` has them by the number of steps in the worst case, `fair` those that are restored along nominal effects
    only, by the number of these. `longest` is the largest duration, in the worst case or along nominal effects;
    `levels` has the number of unsafe states of each level, from 0 on.
    """

    bounded: tuple[tuple[int, int], ...]
    fair: tuple[tuple[int, int], ...]
    longest: int
    levels: tuple[int, ...]


class Failure(InOneLine, frozen=True):
    """States that fail for one reason (`docs/semantics.md`, section 7).

    `count` is exact. `states` holds them in the order of declaration, up to `STATES_LISTED`; of a conflict it is the
    inclusion-minimal set that no policy serves together. `example` is the first of them. With starts, they fail where
    only the states in `within` may be met: the others have failed before.
    """

    kind: FailureKind
    count: int
    example: State
    states: tuple[State, ...]
    within: Formula | None = None

    def __repr__(self) -> str:
        return f"<Failure: {_failure_text(self)}>"


STATES_LISTED = 10_000
"""So many states of a failure are listed at most; all are counted."""


class Realizable(InOneLine, frozen=True):
    """There is a policy, and this is it, with its certificate."""

    policy: Policy
    statistics: Statistics
    warnings: tuple[Diagnostic, ...] = ()

    def __repr__(self) -> str:
        return f"<Realizable: {self._said}>"

    def _repr_html_(self) -> str:
        from tumato_symbolic.notebook import panel, rules_html

        lines = (f"It has {self._said}. Not proved yet: `verify(policy, spec)` does that.", *_remarks(self.warnings))
        return panel("plain", "Realizable", lines, rules_html(self.policy))

    @property
    def _said(self) -> str:
        known = self.statistics
        states, unsafe = known.valid, known.unsafe
        if known.part is not None:
            states, unsafe = known.part.decided, known.part.unsafe
        run = "" if known.longest_run is None else f", runs of up to {count(known.longest_run, 'step')}"
        return f"a policy for {count(states, 'valid state')}, {states - unsafe:,} of them safe{run}"


class Unrealizable(InOneLine, frozen=True):
    """There is no policy: these states fail, or these goals conflict; `certificate` proves it.

    It is None where `limit` was met before it was made. `restorability` tells what would restore the states that
    cannot be restored as the specification asks, where there are any and that was asked for. `spec` names the states.
    """

    failures: tuple[Failure, ...]
    statistics: Statistics
    certificate: Unrealizability | None
    warnings: tuple[Diagnostic, ...] = ()
    limit: str | None = None
    restorability: Restorability | None = None
    spec: Spec | None = None

    def __repr__(self) -> str:
        proof = "with a certificate" if self.certificate is not None else "without a certificate"
        return f"<Unrealizable: {'; '.join(map(_failure_text, self.failures))}; {proof}>"

    def _repr_html_(self) -> str:
        from tumato_symbolic.notebook import failing_html, panel

        proof = "`tumato-sym verify` proves it by the certificate." if self.certificate is not None else ""
        texts = [f"{text[0].upper()}{text[1:]}." for text in map(_failure_text, self.failures)]
        lines = (*([proof] if proof else []), *_remarks(self.warnings))
        if self.spec is None:
            return panel("bad", "Unrealizable", (*texts, *lines))
        failures = ((text, each.count, each.states) for text, each in zip(texts, self.failures, strict=True))
        return panel("bad", "Unrealizable", lines, failing_html(self.spec, failures))


class Undecided(InOneLine, frozen=True):
    """A limit was met before there was an answer. `statistics` is what was known by then, if anything."""

    limit: str
    statistics: Statistics | None
    warnings: tuple[Diagnostic, ...] = ()

    def __repr__(self) -> str:
        return f"<Undecided: {self._said}>"

    def _repr_html_(self) -> str:
        from tumato_symbolic.notebook import panel

        return panel("doubt", "Undecided", (f"{self._said}.", *_remarks(self.warnings)))

    @property
    def _said(self) -> str:
        known = "" if self.statistics is None else f"; {count(self.statistics.valid, 'valid state')}"
        return f"{self.limit}{known}"


SynthesisResult: TypeAlias = Realizable | Unrealizable | Undecided


def _failure_text(failure: Failure) -> str:
    """Why so many states fail, as a clause."""
    states = count(failure.count, "state")
    match failure.kind:
        case "no-allowed-set":
            return f"no set of actions is allowed in {states}"
        case "no-restoration":
            return f"safety is not restored from {states}"
        case "no-plan":
            return f"no plan leads from {states} to the goals"
        case "conflict":
            return f"the goals of {states} conflict"


def _remarks(warnings: tuple[Diagnostic, ...]) -> tuple[str, ...]:
    return tuple(f"{each.code.name}: {each.message}" for each in warnings)
