"""What `verify` found in a folder of policies and certificates, for a person and for programs."""

from __future__ import annotations

from collections import Counter
from typing import Literal

from msgspec import Struct

from tumato_symbolic.diagnostics import UserError, render
from tumato_symbolic.report import unrealizable, verified
from tumato_symbolic.report.findings import Finding, finding_json, findings_of, undecided
from tumato_symbolic.report.layout import Paint, count, seconds
from tumato_symbolic.report.proof import states_covered
from tumato_symbolic.report.unrealizable import VerifiedUnrealizable
from tumato_symbolic.report.verified import Verified
from tumato_symbolic.verify.result import Verdict

Outcome = Literal["error", "refuted", "not accepted", "missing", "undecided", "proved"]

_MISSING = "no NAME.policy.json and no NAME.unrealizable.json is about this specification (--require-all)"


class Entry(Struct, frozen=True):
    """One file: its verification, or the error or limit for which there is none; or a specification without a file."""

    path: str
    done: Verified | VerifiedUnrealizable | None = None
    error: UserError | None = None
    missing: bool = False
    limit: str | None = None

    @property
    def outcome(self) -> Outcome:
        """The verdict; *not accepted* is what is not refuted, with a certificate that fails."""
        if self.done is None:
            if self.missing:
                return "missing"
            return "undecided" if self.error is None else "error"
        verdict: Verdict = self.done.verdict
        return "not accepted" if self.done.not_accepted and verdict != "refuted" else verdict


class Folder(Struct, frozen=True):
    """All files of a folder; `took` is in seconds."""

    path: str
    entries: tuple[Entry, ...]
    strict: bool
    took: float

    @property
    def counts(self) -> list[tuple[Outcome, int]]:
        """How many files have which outcome, the worst outcome first."""
        found = Counter(entry.outcome for entry in self.entries)
        order: tuple[Outcome, ...] = ("error", "refuted", "not accepted", "missing", "undecided", "proved")
        return [(outcome, found[outcome]) for outcome in order if found[outcome]]


def as_text(folder: Folder, colour: bool) -> str:
    """A line for every file, a summary, and the whole report of every file that is not proved."""
    paint = Paint(colour)
    width = max(len(entry.path) for entry in folder.entries)
    across = max(len(entry.outcome) for entry in folder.entries)
    lines = [f"{entry.path:<{width}}  {_words(entry, across, paint)}" for entry in folder.entries]
    lines.append(_summary(folder))
    for entry in folder.entries:
        if entry.error is not None:
            lines += ["", f"{entry.path}:", render(entry.error.diagnostics, entry.error.source, color=colour).rstrip()]
        elif entry.done is not None and entry.outcome != "proved":
            lines += ["", _text(entry.done, colour)]
    return "\n".join(lines)


def _text(done: Verified | VerifiedUnrealizable, colour: bool) -> str:
    return (
        unrealizable.as_text(done, colour) if isinstance(done, VerifiedUnrealizable) else verified.as_text(done, colour)
    )


def _words(entry: Entry, width: int, paint: Paint) -> str:
    outcome = f"{entry.outcome:<{width}}"
    painted = paint.good(outcome) if entry.outcome == "proved" else paint.bad(outcome)
    match entry.done:
        case None if entry.missing:
            return f"{painted}  {_MISSING}"
        case None:
            return f"{painted}  {entry.limit}" if entry.limit else painted.rstrip()
        case VerifiedUnrealizable():
            stale = ", certificate stale" if entry.done.found.stale else ""
            return f"{painted}  {entry.done.source.name}, unrealizable: {entry.done.found.kind}{stale}"
        case Verified():
            found = entry.done.verification
            states = "" if found.valid_states is None else f", {count(found.valid_states, 'valid state')}"
            states = states if found.decides_all else f", {states_covered(found)}"
            return f"{painted}  {entry.done.source.name}{states}, certificate {found.certificate.status}"


def _summary(folder: Folder) -> str:
    outcomes = ", ".join(
        count(number, "error") if outcome == "error" else f"{number} {outcome}"
        for outcome, number in reversed(folder.counts)
    )
    return f"{count(len(folder.entries), 'file')}: {outcomes}. In {seconds(folder.took)}."


def as_json(folder: Folder) -> dict[str, object]:
    """One object: the worst outcome, and for every file what `verify` says of it."""
    worst = folder.counts[0][0]
    return {
        "verdict": "refuted" if worst in ("not accepted", "missing") else worst,
        "folder": folder.path,
        "strict": folder.strict,
        "counts": {outcome.replace(" ", "_"): number for outcome, number in folder.counts},
        "files": [_json(entry) for entry in folder.entries],
        "seconds": round(folder.took, 3),
    }


def _json(entry: Entry) -> dict[str, object]:
    match entry.done:
        case Verified():
            return {"file": entry.path, **verified.as_json(entry.done)}
        case VerifiedUnrealizable():
            return {"file": entry.path, **unrealizable.as_json(entry.done)}
    if entry.missing:
        return {"file": entry.path, "verdict": "missing", "accepted": False}
    if entry.error is None:
        return {"file": entry.path, "verdict": "undecided", "accepted": False, "reason": entry.limit}
    found = entry.error.diagnostics
    findings = [finding_json(diagnostic, _blamed(entry)) for diagnostic in found]
    return {"file": entry.path, "verdict": "error", "accepted": False, "diagnostics": findings}


def _blamed(entry: Entry) -> str:
    """The file in which an error is."""
    return entry.error.source.name if entry.error is not None and entry.error.source is not None else entry.path


def findings(folder: Folder) -> list[Finding]:
    """What was found of every file, and a notice with the summary."""
    found: list[Finding] = []
    for entry in folder.entries:
        match entry.done:
            case Verified():
                found += verified.findings(entry.done)
            case VerifiedUnrealizable():
                found += unrealizable.findings(entry.done)
            case None if entry.missing:
                found.append(Finding("error", _MISSING, entry.path, title="missing"))
            case None if entry.error is not None:
                found += findings_of(entry.error.diagnostics, _blamed(entry))
            case None:
                found.append(undecided(str(entry.limit), entry.path))
    return [*found, Finding("notice", _summary(folder))]
