"""The report of `verify`: the verdict on each property, the certificate, guarantees; JSON and findings."""

from __future__ import annotations

import shlex
from typing import TYPE_CHECKING, Final

from msgspec import Struct
from msgspec.structs import replace

from tumato_symbolic.diagnostics import Code, Diagnostic, Source
from tumato_symbolic.diagnostics.wording import one_line
from tumato_symbolic.report.findings import Finding, finding_json, findings_of
from tumato_symbolic.report.layout import Paint, enumeration, seconds
from tumato_symbolic.report.objections import Place
from tumato_symbolic.report.proof import (
    ORDERINGS,
    proof_json,
    property_line,
    provers,
    refutation_text,
    states_covered,
)
from tumato_symbolic.spec import Restoration, Spec
from tumato_symbolic.verify.result import (
    CertificateUse,
    OrderingSource,
    PropertyResult,
    Verdict,
    Verification,
    properties_of,
)

if TYPE_CHECKING:
    from tumato_symbolic.verify.guarantees.result import Guarantees

_CERTIFICATES = {
    "used": "used in the proof",
    "incomplete": "used in part; the other ranks were computed anew",
    "absent": "none; the ranks were computed by following the runs",
    "stale": "stale, and ignored",
    "wrong": "made for this specification, but false, and ignored",
    "unneeded": "not needed for these properties",
    "set aside": "set aside",
}

_RESTORATIONS: Final[dict[Restoration, str]] = {
    "one_step": "severe rules first, each severity in one step (one_step)",
    "bounded": "in several steps, within a bound whatever effects occur (bounded)",
    "fair": "in several steps, if nominal effects occur again and again (fair)",
}

_SOURCES: Final[dict[OrderingSource, str]] = {
    "command line": "from the command line",
    "specification": "from the specification",
    "default": "which is the default",
}


class Verified(Struct, frozen=True):
    """A verification with everything that its report needs; `took` is in seconds.

    `strict`: a certificate that is wrong or stale fails, whatever the policy is. `guarantees`: None where not asked.
    """

    source: Source
    spec: Spec
    policy: str
    verification: Verification
    warnings: tuple[Diagnostic, ...]
    took: float
    strict: bool = False
    guarantees: Guarantees | None = None

    @property
    def verdict(self) -> Verdict:
        """The verdict on the policy."""
        return self.verification.verdict

    @property
    def not_accepted(self) -> bool:
        """Whether the certificate alone is a reason to fail."""
        return self.strict and self.verification.certificate.status in ("stale", "wrong")

    @property
    def place(self) -> Place:
        """The specification and its file."""
        return Place(self.spec, self.source.name)


def as_text(done: Verified, colour: bool) -> str:
    """The report for a person."""
    paint, found = Paint(colour), done.verification
    lines = [
        f"{_verdict(done, paint)} In {seconds(done.took)}.",
        f"  effects: {ORDERINGS[found.ordering]}, {_SOURCES[found.ordering_source]}",
        f"  certificate: {_certificate(found.certificate)}",
    ]
    if found.verdict != "proved" and not found.decides_all and found.decided_states is not None:
        lines.append(f"  states: {states_covered(found)}")
    if found.restoration is not None:
        lines.insert(2, f"  restoration: {_RESTORATIONS[found.restoration]}")
    lines.append("")
    for result in found.properties:
        lines.append(f"  {property_line(result, paint, found)}")
        if result.refutation is not None:
            lines += [f"      {line}" for line in refutation_text(done.place, result.refutation).splitlines()]
    meant = replace(done.spec, restoration=found.restoration or done.spec.restoration)
    left = [name for name in properties_of(meant) if name not in {result.name for result in found.properties}]
    if left:
        lines.append(f"Not checked: {enumeration(left)}.")
    if done.guarantees is not None:
        from tumato_symbolic.report.guaranteed import guarantees_lines

        lines += ["", *(f"  {line}" for line in guarantees_lines(done.place, done.guarantees, paint))]
    if done.not_accepted:
        lines += ["", f"{paint.bad('Not accepted')} (--strict): the certificate is {found.certificate.status}."]
    if found.verdict == "refuted":
        lines += ["", f"Next: fix the policy, or make one with `tumato-sym synth {shlex.quote(done.source.name)}`."]
    return "\n".join(lines)


def _verdict(done: Verified, paint: Paint) -> str:
    found = done.verification
    match found.verdict:
        case "proved":
            proved = f"{done.policy} is {paint.good('proved')} against {done.source.name} by {provers(found)}"
            return f"{proved}, for {states_covered(found)}."
        case "refuted":
            return f"{done.policy} is {paint.bad('refuted')} against {done.source.name}."
        case "undecided":
            return f"{done.policy} is {paint.doubt('undecided')} against {done.source.name}."


def _misfits(done: Verified) -> list[Diagnostic]:
    """The warning that the certificate is stale or false; `--strict` makes an error of it."""
    use = done.verification.certificate
    if use.status not in ("stale", "wrong", "set aside"):
        return []
    help_ = f"`tumato-sym synth {shlex.quote(done.source.name)}` makes a policy with a new one"
    return [Diagnostic(Code.TUM507, f"certificate: {_certificate(use)}", help=help_)]


def _certificate(use: CertificateUse) -> str:
    text = _CERTIFICATES[use.status]
    return f"{text} ({use.reason})" if use.reason else text


def as_json(done: Verified) -> dict[str, object]:
    """The report for a program."""
    return {
        **proof_json(done.spec, done.verification),
        "effect_ordering_from": done.verification.ordering_source,
        "policy": done.policy,
        "specification": done.source.name,
        **_guarantees_json(done),
        "strict": done.strict,
        "accepted": done.verification.verdict == "proved" and not done.not_accepted,
        "seconds": round(done.took, 3),
        "warnings": [
            *(finding_json(warning, done.source.name) for warning in done.warnings),
            *(finding_json(warning, done.policy) for warning in _misfits(done)),
        ],
    }


def _guarantees_json(done: Verified) -> dict[str, object]:
    if done.guarantees is None:
        return {}
    from tumato_symbolic.report.guaranteed import guarantees_json

    return {"guarantees": guarantees_json(done.spec, done.guarantees)}


def findings(done: Verified) -> list[Finding]:
    """Warnings at their lines, one error for every property that is not proved, or one notice."""
    found = findings_of(done.warnings, done.source.name)
    open_results = [result for result in done.verification.properties if result.verdict != "proved"]
    found += [_open(done, result) for result in open_results]
    if done.not_accepted:
        use = done.verification.certificate
        return [*found, Finding("error", f"certificate: {_certificate(use)}", done.policy, title=use.status)]
    found += findings_of(_misfits(done), done.policy)
    if not open_results:
        message = f"proved against {done.source.name}, for {states_covered(done.verification)}"
        found.append(Finding("notice", message, done.policy))
    if done.guarantees is not None:
        found.append(_guarantees(done.guarantees, done.policy))
    return found


def _guarantees(guarantees: Guarantees, policy: str) -> Finding:
    from tumato_symbolic.report.guaranteed import guarantees_summary

    summary = guarantees_summary(guarantees)
    if guarantees.status == "undecided":
        return Finding("error", summary, policy, title="guarantees undecided")
    return Finding("notice", summary, policy)


def _open(done: Verified, result: PropertyResult) -> Finding:
    """A property that is not proved; where a rule is broken, at the rule."""
    message = one_line(property_line(result, Paint(False), done.verification))
    title, refutation = f"{result.name} {result.verdict}", result.refutation
    if refutation is None:
        return Finding("error", message, done.policy, title=title)
    message += "\n" + refutation_text(done.place, refutation)
    rule = None if refutation.objection is None else refutation.objection.rule
    if rule is None:
        return Finding("error", message, done.policy, title=title)
    return Finding("error", message, done.source.name, rule.span, title)
