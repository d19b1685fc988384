"""How two policies or two specifications differ, for a person, for a program and for GitHub."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal, TypeAlias

from msgspec import Struct

from tumato_symbolic.diagnostics import Span
from tumato_symbolic.report.differing_decisions import change_lines, difference_json, difference_lines, names_lines
from tumato_symbolic.report.differing_elements import element_json, element_lines, element_message
from tumato_symbolic.report.findings import Finding
from tumato_symbolic.report.layout import Paint, count
from tumato_symbolic.synthesis.result import Realizable, SynthesisResult, Undecided, Unrealizable
from tumato_symbolic.views import Altered, Difference

Verdict: TypeAlias = Literal["same", "different", "undecided"]

_ANNOTATED = 8
"""So many differences are annotated: GitHub shows ten annotations of a kind."""


class PoliciesDiffer(Struct, frozen=True):
    """How the policies of two files differ; in the valid states of `specification`, if that is given."""

    old: str
    new: str
    found: Difference
    specification: str | None = None

    @property
    def verdict(self) -> Verdict:
        """Whether they decide alike."""
        return "same" if self.found.same else "different"


class SpecificationsDiffer(Struct, frozen=True):
    """How the specifications of two files differ, and the policies that are synthesized from them.

    `found` is None where one has no policy, or `limit` was met before there were both, and compared.
    """

    old: str
    new: str
    elements: tuple[Altered, ...]
    outcomes: tuple[SynthesisResult, ...] = ()
    found: Difference | None = None
    limit: str | None = None

    @property
    def verdict(self) -> Verdict:
        """Whether they mean the same, and so do their policies."""
        if self.elements or (self.found is not None and not self.found.same):
            return "different"
        return "undecided" if self.limit is not None else "same"


Differing: TypeAlias = PoliciesDiffer | SpecificationsDiffer


def as_text(done: Differing, colour: bool) -> str:
    """The report for a person."""
    paint = Paint(colour)
    if isinstance(done, PoliciesDiffer):
        noun = "state" if done.specification is None else "valid state"
        return "\n".join(difference_lines(f"{done.old} → {done.new}", done.found, noun))
    return "\n".join(_specifications(done, paint))


def _specifications(done: SpecificationsDiffer, paint: Paint) -> Iterator[str]:
    if done.elements:
        yield f"{done.old} → {done.new}: {count(len(done.elements), 'element differs', 'elements differ')}."
        yield ""
        for element in done.elements:
            yield from element_lines(element, _place_text(done, element), paint)
    else:
        yield f"{done.old} → {done.new}: the same meaning."
    if done.outcomes:
        yield ""
        yield from _outcomes(done)
    if done.found is not None:
        yield ""
        yield from difference_lines("policies", done.found, "state")
        yield ""
        yield "These policies are not proved: `tumato-sym synth` does that."
    if done.limit is not None:
        yield f"{'' if done.outcomes else chr(10)}The policies are not compared: {done.limit}."


def _place(done: SpecificationsDiffer, element: Altered) -> tuple[str, Span | None]:
    """Where an element stands: in the new file, or where it was in the old one."""
    return (done.old, element.old) if element.how == "removed" else (done.new, element.new)


def _place_text(done: SpecificationsDiffer, element: Altered) -> str:
    file, span = _place(done, element)
    return "" if span is None else f"  ({file}:{span.line})"


def _outcomes(done: SpecificationsDiffer) -> Iterator[str]:
    one, other = done.outcomes
    for what in ("valid", "safe"):
        before, after = (getattr(each.statistics, what, None) for each in (one, other))
        if before is not None and after is not None:
            yield (
                f"{what} states: {before:,} → {after:,}" if before != after else f"{what} states: {before:,}, as before"
            )
    texts = [_outcome(each) for each in (one, other)]
    yield f"policy: {texts[0]} → {texts[1]}" if texts[0] != texts[1] else f"policy: {texts[0]}, as before"


def _outcome(outcome: SynthesisResult) -> str:
    match outcome:
        case Realizable():
            return "realizable"
        case Unrealizable(failures):
            kinds = sorted({failure.kind for failure in failures})
            return f"not realizable ({', '.join(kinds)})"
        case Undecided(limit):
            return f"undecided ({limit})"


def as_json(done: Differing) -> dict[str, object]:
    """The report for a program; `diff.schema.json` describes it."""
    head: dict[str, object] = {"verdict": done.verdict, "old": done.old, "new": done.new}
    if isinstance(done, PoliciesDiffer):
        return {**head, "of": "policies", "specification": done.specification, "policy": difference_json(done.found)}
    return {
        **head,
        "of": "specifications",
        "elements": [element_json(element) for element in done.elements],
        "outcomes": [_outcome_json(each) for each in done.outcomes],
        "policy": None if done.found is None else difference_json(done.found),
        "limit": done.limit,
    }


def _outcome_json(outcome: SynthesisResult) -> dict[str, object]:
    verdicts = {Realizable: "realizable", Unrealizable: "unrealizable", Undecided: "undecided"}
    statistics = outcome.statistics
    return {
        "verdict": verdicts[type(outcome)],
        "valid": None if statistics is None else statistics.valid,
        "safe": None if statistics is None else statistics.safe,
    }


def findings(done: Differing) -> list[Finding]:
    """Each element at its line, and each change of decisions; where nothing differs, one notice."""
    found = list(_of_specifications(done)) if isinstance(done, SpecificationsDiffer) else []
    difference = done.found
    if difference is not None and not difference.same:
        first, *_ = difference_lines("decisions", difference, "state")
        message = "\n".join((first, *names_lines(difference)))
        found.append(Finding("warning", message, done.new, title="policy changed"))
        for change in difference.changes[:_ANNOTATED]:
            lines = "\n".join(change_lines(difference, change))
            found.append(Finding("warning", lines, done.new, title="decision changed"))
    return found or [Finding("notice", f"{done.old} and {done.new} are the same", done.new)]


def _of_specifications(done: SpecificationsDiffer) -> Iterator[Finding]:
    for element in done.elements:
        file, span = _place(done, element)
        yield Finding("warning", element_message(element), file, span, title="specification changed")
    if done.limit is not None:
        yield Finding("warning", f"the policies are not compared: {done.limit}", done.new, title="undecided")
    if any(isinstance(each, Unrealizable) for each in done.outcomes[1:]):
        yield Finding("warning", f"it is {_outcome(done.outcomes[1])}", done.new, title="no policy")
