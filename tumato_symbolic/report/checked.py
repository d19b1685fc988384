"""What `check` found, for a person and for programs."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from msgspec import Struct

from tumato_symbolic.diagnostics import Diagnostic, Severity, Source, render
from tumato_symbolic.report.findings import Finding, finding_json, findings_of
from tumato_symbolic.report.layout import Paint, count
from tumato_symbolic.semantics import count_states
from tumato_symbolic.spec import Spec


class Checked(Struct, frozen=True):
    """One checked file: `source` is None where it could not be read, `spec` where it has errors."""

    path: str
    source: Source | None
    spec: Spec | None
    diagnostics: tuple[Diagnostic, ...]

    @property
    def failed(self) -> bool:
        """Whether the specification cannot be used."""
        return any(diagnostic.severity == "error" for diagnostic in self.diagnostics)


def as_text(files: Sequence[Checked], colour: bool) -> str:
    """The findings of every file, and a line on what was read."""
    paint = Paint(colour)
    parts = []
    for file in files:
        if file.diagnostics:
            parts.append(render(file.diagnostics, file.source, color=colour).rstrip("\n") + "\n")
        numbers = Counter(diagnostic.severity for diagnostic in file.diagnostics)
        kinds: tuple[Severity, ...] = ("error", "warning", "remark")
        found = [count(numbers[kind], kind) for kind in kinds if numbers[kind]]
        if file.spec is None or file.failed:
            parts.append(f"{file.path}: {paint.bad(', '.join(found))}")
        else:
            mood = (paint.doubt if numbers["warning"] else paint.good)(", ".join(found) or "no findings")
            parts.append(f"{file.path}: {mood} ({_size(file.spec)})")
    return "\n".join(parts)


def _size(spec: Spec) -> str:
    rules = len(spec.reaction_rules) + len(spec.state_rules)
    return ", ".join(
        (
            count(len(spec.variables), "state variable"),
            count(count_states(spec), "state"),
            count(len(spec.cases), "action"),
            count(rules, "rule"),
        )
    )


def as_json(files: Sequence[Checked]) -> dict[str, object]:
    """One object: a verdict (`ok` or `error`) over all files, and the findings of each."""
    return {
        "verdict": "error" if any(file.failed for file in files) else "ok",
        "files": [{"file": file.path, "verdict": "error" if file.failed else "ok"} for file in files],
        "diagnostics": [finding_json(found, file.path) for file in files for found in file.diagnostics],
    }


def findings(files: Sequence[Checked]) -> list[Finding]:
    """All that was found, and a notice."""
    found = [each for file in files for each in findings_of(file.diagnostics, file.path)]
    failed = sum(file.failed for file in files)
    return [*found, Finding("notice", f"{count(len(files), 'specification')} checked, {failed} with errors")]
