"""How two policies or two specifications differ, for a person, for a program and for GitHub."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Literal, TypeAlias

from tumato_symbolic.diagnostics import Span
from tumato_symbolic.report.cubes import named_cube_text, shown
from tumato_symbolic.report.findings import Finding
from tumato_symbolic.report.layout import Paint, count
from tumato_symbolic.synthesis.result import Realizable, SynthesisResult, Undecided, Unrealizable
from tumato_symbolic.views import Altered, Change, Decided, Difference

Verdict: TypeAlias = Literal["same", "different", "undecided"]

_CHANGES = 20
_CUBES = 4
_ANNOTATED = 8
"""GitHub shows ten annotations of a kind."""


@dataclass(frozen=True, slots=True)
class PoliciesDiffer:
    """How the policies of two files differ; in the valid states of `specification`, if that is given."""

    old: str
    new: str
    found: Difference
    specification: str | None = None

    @property
    def verdict(self) -> Verdict:
        """Whether they decide alike."""
        return "same" if self.found.same else "different"


@dataclass(frozen=True, slots=True)
class SpecificationsDiffer:
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
        return "\n".join(_policies(f"{done.old} → {done.new}", done.found, noun))
    return "\n".join(_specifications(done, paint))


def _policies(title: str, found: Difference, noun: str) -> Iterator[str]:
    names = list(_names(found))
    if not found.changed:
        but = ", but their names differ" if names else ""
        yield f"{title}: {count(found.compared, noun)} decided, all alike{but}."
    else:
        yield f"{title}: {found.changed:,} of {count(found.compared, noun)} decided otherwise."
    if names:
        yield from ("", *names)
    for change in found.changes[:_CHANGES]:
        yield from ("", *_change(found, change))
    yield from _left(found)


def _names(found: Difference) -> Iterator[str]:
    """What only one of them has, and how states are compared then."""
    names = found.names
    for name, values in names.added_variables:
        yield f"+ variable {_declared(name, values)}: an old decision counts for each of its values"
    for name, values in names.removed_variables:
        yield f"- variable {_declared(name, values)}: a new decision counts for each of its values"
    for name, values in names.added_values:
        yield f"+ {_of(name, values)}, of which the old policy knows no state"
    for name, values in names.removed_values:
        yield f"- {_of(name, values)}, of which the new policy knows no state"
    yield from (f"+ action {shown(name)}" for name in names.added_actions)
    yield from (f"- action {shown(name)}" for name in names.removed_actions)


def _declared(name: str, values: Sequence[str]) -> str:
    return f"{shown(name)} ({', '.join(map(shown, values))})"


def _of(name: str, values: Sequence[str]) -> str:
    return f"{'value' if len(values) == 1 else 'values'} {', '.join(map(shown, values))} of {shown(name)}"


def _change(found: Difference, change: Change) -> Iterator[str]:
    """`in 3,072 states: {charge} → {}`, and where."""
    yield f"in {count(change.states, 'state')}: {_change_text(change)}"
    yield from (f"  {line}" for line in _where(found, change))


def _change_text(change: Change) -> str:
    return f"{_decided(change.before)} → {_decided(change.after)}"


def _decided(decided: Decided) -> str:
    if not decided.known:
        return "no such state"
    if decided.actions is None:
        return "undecided"
    return f"{{{', '.join((*([] if decided.whole else ['…']), *map(shown, decided.actions)))}}}"


def _where(found: Difference, change: Change) -> Iterator[str]:
    if change.cubes is None:
        yield f"such as {' '.join(f'{name}={value}' for name, value in change.example)}"
        return
    known = dict(found.variables)
    texts = [named_cube_text(known, cube, " and ") for cube in change.cubes]
    if texts == [""]:
        yield "everywhere"
        return
    yield from (f"{'or' if number else 'where'} {text}" for number, text in enumerate(texts[:_CUBES]))
    if len(texts) > _CUBES:
        yield f"or {len(texts) - _CUBES:,} more"


def _left(found: Difference) -> Iterator[str]:
    """What is not shown, and then the changes by action."""
    left = None if found.left is None else found.left + len(found.changes[_CHANGES:])
    if left == 0 and found.limit is None:
        return
    yield ""
    if left:
        yield f"{count(left, 'more kind')} of change {'is' if left == 1 else 'are'} left out. By action:"
    elif left is None:
        yield "The changes are not described one by one. By action:"
    if left or left is None:
        for each in found.by_action:
            parts = [(each.started, "newly executed"), (each.stopped, "no longer executed")]
            said = " and ".join(f"{what} in {count(number, 'state')}" for number, what in parts if number)
            yield f"  {shown(each.action)}: {said}"
    if found.limit is not None:
        yield f"Something is left out: {found.limit}."


def _specifications(done: SpecificationsDiffer, paint: Paint) -> Iterator[str]:
    if done.elements:
        yield f"{done.old} → {done.new}: {count(len(done.elements), 'element differs', 'elements differ')}."
        yield ""
        for element in done.elements:
            yield from _element(done, element, paint)
    else:
        yield f"{done.old} → {done.new}: the same meaning."
    if done.outcomes:
        yield ""
        yield from _outcomes(done)
    if done.found is not None:
        yield ""
        yield from _policies("policies", done.found, "state")
        yield ""
        yield "These policies are not proved: `tumato-sym synth` does that."
    if done.limit is not None:
        yield f"{'' if done.outcomes else chr(10)}The policies are not compared: {done.limit}."


_SIGNS = {"added": "+", "removed": "-", "changed": "~"}


def _element(done: SpecificationsDiffer, element: Altered, paint: Paint) -> Iterator[str]:
    colours = {"added": paint.good, "removed": paint.bad, "changed": paint.doubt}
    yield f"  {colours[element.how](_SIGNS[element.how])} {_element_text(element)}{_place_text(done, element)}"
    for detail in element.details if element.name else ():
        yield f"      {_detail(detail.what, detail.before, detail.after)}"


def _element_text(element: Altered) -> str:
    if element.name:
        between = ": " if element.kind not in ("variable", "action", "goal") else " "
        return element.name if element.kind == "goal" else f"{element.kind}{between}{element.name}"
    return "".join((element.kind, *(f": {each.before or 'none'} → {each.after or 'none'}" for each in element.details)))


def _detail(what: str, before: str | None, after: str | None) -> str:
    if before is None or after is None:
        return f"{what}: {'+' if before is None else '-'} {after if before is None else before}"
    return f"{what}: {before} → {after}"


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
        return {**head, "of": "policies", "specification": done.specification, "policy": _difference_json(done.found)}
    return {
        **head,
        "of": "specifications",
        "elements": [_element_json(element) for element in done.elements],
        "outcomes": [_outcome_json(each) for each in done.outcomes],
        "policy": None if done.found is None else _difference_json(done.found),
        "limit": done.limit,
    }


def _difference_json(found: Difference) -> dict[str, object]:
    names = found.names
    return {
        "compared": found.compared,
        "changed": found.changed,
        "names": {
            "added_variables": {name: list(values) for name, values in names.added_variables},
            "removed_variables": {name: list(values) for name, values in names.removed_variables},
            "added_values": {name: list(values) for name, values in names.added_values},
            "removed_values": {name: list(values) for name, values in names.removed_values},
            "added_actions": list(names.added_actions),
            "removed_actions": list(names.removed_actions),
        },
        "changes": [_change_json(change) for change in found.changes],
        "by_action": [
            {"action": each.action, "started": each.started, "stopped": each.stopped} for each in found.by_action
        ],
        "left": found.left,
        "limit": found.limit,
    }


def _change_json(change: Change) -> dict[str, object]:
    cubes = change.cubes
    return {
        "before": _decided_json(change.before),
        "after": _decided_json(change.after),
        "states": change.states,
        "cubes": None if cubes is None else [{name: list(values) for name, values in cube} for cube in cubes],
        "example": dict(change.example),
    }


def _decided_json(decided: Decided) -> dict[str, object]:
    actions = None if decided.actions is None else list(decided.actions)
    return {"known": decided.known, "whole": decided.whole, "actions": actions}


def _element_json(element: Altered) -> dict[str, object]:
    return {
        "kind": element.kind,
        "name": element.name or None,
        "how": element.how,
        "old_line": None if element.old is None else element.old.line,
        "new_line": None if element.new is None else element.new.line,
        "details": [
            {"what": each.what or None, "before": each.before, "after": each.after} for each in element.details
        ],
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
        first, *_ = _policies("decisions", difference, "state")
        message = "\n".join((first, *_names(difference)))
        found.append(Finding("warning", message, done.new, title="policy changed"))
        for change in difference.changes[:_ANNOTATED]:
            lines = "\n".join(_change(difference, change))
            found.append(Finding("warning", lines, done.new, title="decision changed"))
    return found or [Finding("notice", f"{done.old} and {done.new} are the same", done.new)]


def _of_specifications(done: SpecificationsDiffer) -> Iterator[Finding]:
    for element in done.elements:
        file, span = _place(done, element)
        details = (_detail(each.what, each.before, each.after) for each in element.details if element.name)
        message = "\n".join((f"{element.how}: {_element_text(element)}", *details))
        yield Finding("warning", message, file, span, title="specification changed")
    if done.limit is not None:
        yield Finding("warning", f"the policies are not compared: {done.limit}", done.new, title="undecided")
    if any(isinstance(each, Unrealizable) for each in done.outcomes[1:]):
        yield Finding("warning", f"it is {_outcome(done.outcomes[1])}", done.new, title="no policy")
