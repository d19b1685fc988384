"""The verdict on a certificate of unrealizability, for a person and for programs."""

from __future__ import annotations

import shlex
from typing import Final

from msgspec import Struct

from tumato_symbolic.diagnostics import Code, Diagnostic, Source
from tumato_symbolic.report.findings import Finding, finding_json, findings_of
from tumato_symbolic.report.layout import Paint, count, seconds
from tumato_symbolic.report.proof import ORDERINGS
from tumato_symbolic.semantics import action_names, in_json
from tumato_symbolic.spec import Spec
from tumato_symbolic.verify.result import PROVERS, UnrealizabilityKind, UnrealizabilityVerdict, Verdict

_REASONS: Final[dict[UnrealizabilityKind, str]] = {
    "no-allowed-set": "there is a state in which no set of actions is allowed",
    "no-restoration": "there is a state from which no decisions are sure to restore safety",
    "no-plan": "there is a state from which no run reaches the goal",
    "conflict": "there are states that each have a plan, but no policy works for all of them",
    "no-part": "there is no policy from the starts that never leaves what it decides",
}
_NO_PART_WITHOUT_STARTS: Final = "there is no policy that decides every valid state"


class VerifiedUnrealizable(Struct, frozen=True):
    """A verdict on a certificate with everything that its report needs; `took` is in seconds.

    `strict`: a certificate that was made for another specification fails, whatever it proves.
    """

    source: Source
    spec: Spec
    certificate: str
    found: UnrealizabilityVerdict
    warnings: tuple[Diagnostic, ...]
    took: float
    strict: bool = False

    @property
    def verdict(self) -> Verdict:
        """The verdict on the certificate."""
        return self.found.verdict

    @property
    def not_accepted(self) -> bool:
        """Whether its being stale is a reason to fail."""
        return self.strict and self.found.stale


def as_text(done: VerifiedUnrealizable, colour: bool) -> str:
    """The report for a person."""
    paint, found = Paint(colour), done.found
    fits = "another specification; checked against this one all the same" if found.stale else "this specification"
    head = [
        f"{_verdict(done, paint)} In {seconds(done.took)}.",
        f"  effects: {ORDERINGS[found.ordering]}, from the {found.ordering_source}",
        f"  certificate: made for {fits}",
    ]
    if found.verdict == "proved":
        head.append(f"  {proof_line(done.spec, found)}")
        if done.not_accepted:
            head += ["", f"{paint.bad('Not accepted')} (--strict): the certificate is stale."]
        return "\n".join(head)
    head += ["", f"  {found.reason}."]
    synth = f"tumato-sym synth {shlex.quote(done.source.name)}"
    if found.verdict == "refuted":
        head += ["", f"The certificate proves nothing; `{synth}` finds out whether there is a policy."]
    return "\n".join(head)


def proof_line(spec: Spec, found: UnrealizabilityVerdict) -> str:
    """What a certificate that holds proves."""
    reason = _REASONS[found.kind] if spec.starts or found.kind != "no-part" else _NO_PART_WITHOUT_STARTS
    by = proved_by(found)
    how = f"proved by {by}" if by else "checked by direct evaluation"
    obligations = "" if found.by_checker else f"{count(found.obligations, 'obligation')} "
    return f"{reason} ({found.kind}): {obligations}{how}"


def proved_by(found: UnrealizabilityVerdict) -> str:
    """The names of the provers that were needed; empty where none was."""
    if found.by_checker:
        return "the stand-alone checker"
    return " and ".join(PROVERS[name] for name in _proved_by(found) if name in PROVERS)


def _proved_by(found: UnrealizabilityVerdict) -> list[str]:
    """Which provers a proof needed; the explicit meaning where none was."""
    return [*(["z3"] if found.by_solver else []), *(["walk"] if found.by_diagrams else [])] or ["meaning"]


def _verdict(done: VerifiedUnrealizable, paint: Paint) -> str:
    spec = done.source.name
    match done.found.verdict:
        case "proved":
            return f"{spec} is {paint.good('proved unrealizable')} by {done.certificate}."
        case "refuted":
            return f"{done.certificate} is {paint.bad('refuted')} against {spec}."
        case "undecided":
            return f"{done.certificate} is {paint.doubt('undecided')} against {spec}."


def verdict_json(spec: Spec, found: UnrealizabilityVerdict) -> dict[str, object]:
    """The verdict for a program."""
    witness = None
    if found.state is not None:
        witness = {
            "state": in_json(spec, found.state),
            "actions": list(action_names(spec, found.chosen or frozenset())),
        }
    return {
        "verdict": found.verdict,
        "kind": found.kind,
        "obligations": found.obligations,
        "proved_by": ", ".join(_proved_by(found)) if found.verdict == "proved" else None,
        "reason": found.reason,
        "witness": witness,
    }


def as_json(done: VerifiedUnrealizable) -> dict[str, object]:
    """The report for a program."""
    found = done.found
    return {
        **verdict_json(done.spec, found),
        "stale": found.stale,
        "effect_ordering": found.ordering,
        "effect_ordering_from": found.ordering_source,
        "certificate": done.certificate,
        "specification": done.source.name,
        "strict": done.strict,
        "accepted": found.verdict == "proved" and not done.not_accepted,
        "seconds": round(done.took, 3),
        "warnings": [
            *(finding_json(warning, done.source.name) for warning in done.warnings),
            *(finding_json(warning, done.certificate) for warning in _misfits(done)),
        ],
    }


def _misfits(done: VerifiedUnrealizable) -> list[Diagnostic]:
    """The warning that the certificate is stale; `--strict` makes an error of it."""
    if not done.found.stale:
        return []
    help_ = f"`tumato-sym synth {shlex.quote(done.source.name)}` makes a new one"
    return [Diagnostic(Code.TUM507, "certificate: it was made for another specification", help=help_)]


def findings(done: VerifiedUnrealizable) -> list[Finding]:
    """Warnings at their lines, and one notice or error with the verdict."""
    found = findings_of(done.warnings, done.source.name)
    if not done.not_accepted:
        found += findings_of(_misfits(done), done.certificate)
    return [*found, _main_finding(done)]


def _main_finding(done: VerifiedUnrealizable) -> Finding:
    found, name = done.found, done.source.name
    if done.not_accepted and found.verdict == "proved":
        message = f"proves that {name} has no policy, but was made for another specification"
        return Finding("error", message, done.certificate, title="certificate stale")
    if found.verdict == "proved":
        return Finding("notice", f"{name} is proved unrealizable: {proof_line(done.spec, found)}", done.certificate)
    message = f"{found.verdict} against {name}: {found.reason}"
    return Finding("error", message, done.certificate, title=f"certificate {found.verdict}")
