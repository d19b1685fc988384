"""Why there is no policy, for programs: JSON, and the places that editors and GitHub mark."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from tumato_symbolic.diagnostics import Span
from tumato_symbolic.diagnostics.wording import one_line
from tumato_symbolic.explain.additions import NewAction, NoGoalWhile, Setting
from tumato_symbolic.explain.as_predicates import predicate_text
from tumato_symbolic.explain.elements import Element, span_of, text_of
from tumato_symbolic.explain.environment import Restriction
from tumato_symbolic.explain.explanation import (
    Explanation,
    FailingGroup,
    NothingToExplain,
    OwnGoal,
    RealizablePart,
    Reason,
    Repair,
    Unexplained,
)
from tumato_symbolic.report.blame import first_written, goal_sentences, headline, near_miss_lines, summary_text
from tumato_symbolic.report.cubes import cube_json, cube_text
from tumato_symbolic.report.element_roles import role
from tumato_symbolic.report.explained import Explained
from tumato_symbolic.report.failures import FAILURE_CODES
from tumato_symbolic.report.findings import Finding, finding_json, findings_of, undecided
from tumato_symbolic.report.layout import count
from tumato_symbolic.report.possible_changes import added_lines, controlled, environment_text, left_out_lines
from tumato_symbolic.report.restorable import restorable_json
from tumato_symbolic.semantics import action_names, active_goals, goals_as_written, in_json
from tumato_symbolic.spec import Rule, Spec, value_of


def as_json(done: Explained) -> dict[str, object]:
    """The report for a program."""
    found, numbers = done.found, done.found.statistics
    report: dict[str, object] = {
        "verdict": _verdict(done),
        "specification": done.source.name,
        "effect_ordering": numbers.ordering if numbers else None,
        "states": {"total": numbers.total, "valid": numbers.valid, "safe": numbers.safe, "unsafe": numbers.unsafe}
        if numbers
        else None,
        "failing_states": 0,
        "groups": [],
        "failures": [],
        "omitted": 0,
        "repairs": [],
        "repairs_complete": False,
        "hopeless": None,
        "realizable_part": None,
        "incomplete": [],
        "limit": found.limit if isinstance(found, Unexplained) else None,
        "written": done.written,
        "warnings": [finding_json(warning, done.source.name) for warning in done.warnings],
    }
    if isinstance(found, Explanation):
        report |= {
            "failing_states": found.failing_states,
            "groups": [_states_json(done.spec, group) for group in found.groups],
            "failures": [_reason_json(done, reason) for reason in largest_first(found.reasons)],
            **restorable_json(done.place, found.restorability),
            "omitted": found.omitted,
            "repairs": [_repair_json(done.spec, repair) for repair in found.repairs],
            "repairs_complete": found.repairs_complete,
            "hopeless": found.unavoidable,
            "realizable_part": _part_json(done.spec, found.part) if "part" in found.finished else None,
            "incomplete": incomplete(done),
        }
    return report


def largest_first(reasons: Sequence[Reason]) -> list[Reason]:
    """Reasons by how many states have them."""
    return sorted(reasons, key=lambda reason: -reason.count)


def _states_json(spec: Spec, group: FailingGroup | Reason) -> dict[str, object]:
    return {
        "kind": group.kind,
        "code": FAILURE_CODES[group.kind].name,
        "count": group.count,
        "cubes": [cube_json(spec, cube) for cube in group.cubes],
        "omitted": group.omitted,
        "example": in_json(spec, group.example),
    }


def _verdict(done: Explained) -> str:
    match done.found:
        case NothingToExplain():
            return "realizable"
        case Unexplained():
            return "undecided"
        case _:
            return "unrealizable"


def _reason_json(done: Explained, reason: Reason) -> dict[str, object]:
    place, spec = done.place, done.spec
    return {
        **_states_json(spec, reason),
        "core": [_in_core(done, element, reason.core, reason) for element in reason.core],
        "summary": None if reason.summary is None else summary_text(spec, reason.summary),
        "more_cores": [[_in_core(done, element, core, reason) for element in core] for core in reason.cores[1:]],
        "goals": [_goal_json(spec, goal, first_written(spec, reason.example)[goal.body]) for goal in reason.goals],
        "near": [
            {
                "actions": list(action_names(spec, near.chosen)),
                "story": " ".join(line.strip() for line in near_miss_lines(place, near)),
            }
            for near in reason.near
        ],
        "states": [
            in_json(spec, state) | {"goals": [spec.bodies[body].text for body in sorted(active_goals(spec, state))]}
            for state in reason.together
        ]
        if reason.kind == "conflict"
        else [],
    }


def element_json(spec: Spec, element: Element) -> dict[str, object]:
    """An element: what it is, whose, its text and its line."""
    span = span_of(spec, element)
    has_action = element.kind in ("precondition", "alternative", "resource")
    return {
        "kind": element.kind,
        "action": spec.actions[element.number].name if has_action else None,
        "text": text_of(spec, element),
        "line": span.line if span else None,
    }


def _in_core(done: Explained, element: Element, core: tuple[Element, ...], reason: Reason) -> dict[str, object]:
    return element_json(done.spec, element) | {
        "file": done.source.name,
        "role": role(done.place, element, core, reason),
    }


def _goal_json(spec: Spec, goal: OwnGoal, body: Rule) -> dict[str, object]:
    return {
        "text": one_line(body.text),
        "line": body.span.line,
        "never_true": [predicate_text(spec, part) for part in goal.never],
        "clashes": goal.clashes,
    }


def _repair_json(spec: Spec, repair: Repair) -> dict[str, object]:
    dropped = [element_json(spec, change.element) for change in repair.changes if change.text is None]
    edits = [
        element_json(spec, change.element) | {"replacement": change.text}
        for change in repair.changes
        if change.text is not None
    ]
    added = [
        {"kind": _ADDED[type(addition)], "text": "\n".join(added_lines(spec, addition))}
        for addition in repair.additions
    ]
    parts = {"add": added, "drop": dropped, "edit": edits}
    report: dict[str, object] = {name: part for name, part in parts.items() if part}
    taken = [spec.variables[variable].name for variable in sorted(controlled(spec, repair))]
    return report | {"environment": taken, "gives_up_safety": repair.gives_up_safety, "verified": True}


_ADDED: dict[type, str] = {Setting: "setting", NewAction: "action", NoGoalWhile: "goal"}


def _part_json(spec: Spec, part: RealizablePart | None) -> dict[str, object]:
    if part is None:
        nothing: dict[str, object] = {"states": 0, "given_up": None, "assumption": None, "environment": []}
        return nothing | {"steady": None, "unique": True, "largest": True}
    return {
        "states": part.states,
        "given_up": part.given_up,
        **({"assumption": None, "start": part.text} if spec.starts else {"assumption": part.text}),
        "environment": [_restriction_json(spec, each) for each in part.environment],
        "steady": part.steady
        and dict(zip(("states", "start" if spec.starts else "assumption"), part.steady, strict=True)),
        "unique": part.unique,
        "largest": part.largest,
    }


def _restriction_json(spec: Spec, taken: Restriction) -> dict[str, object]:
    variable = spec.variables[taken.variable]
    return {
        "variable": variable.name,
        "never": [value_of(variable.values[each]) for each in taken.never],
        "in_some_states_not": [value_of(variable.values[each]) for each, _ in taken.partly],
    }


def findings(done: Explained) -> list[Finding]:
    """Warnings and lines to blame, and the verdict or what is realizable."""
    return [*findings_of(done.warnings, done.source.name), *_blamed(done), *_main_findings(done)]


def _blamed(done: Explained) -> Iterator[Finding]:
    """Every line of the first core of each reason; the lines of the goals where a core is empty."""
    if not isinstance(done.found, Explanation):
        return
    for reason in largest_first(done.found.reasons):
        code = FAILURE_CODES[reason.kind]
        head = f"{headline(reason)}: {'; '.join(cube_text(done.spec, cube) for cube in reason.cubes[:1])}"
        head += f" (and {len(reason.cubes) - 1} more)" if len(reason.cubes) > 1 else ""
        told = list(_told(done, reason))
        for number, (sentence, span) in enumerate(told):
            others = tuple((text, other) for text, other in told[:number] + told[number + 1 :] if other is not None)
            yield Finding("error", f"{head}\n{sentence}", done.source.name, span, code=code, related=others)


def _told(done: Explained, reason: Reason) -> list[tuple[str, Span | None]]:
    if reason.core:
        return [(role(done.place, each, reason.core, reason), span_of(done.spec, each)) for each in reason.core]
    if reason.kind == "conflict":
        written = (rule.span for state in reason.together for _, rule in goals_as_written(done.spec, state))
        spans = sorted(set(written), key=lambda span: (span.line, span.column))
        return [("this goal conflicts with others", span) for span in spans]
    first = first_written(done.spec, reason.example)
    spans = [first[goal.body].span for goal in reason.goals]
    found: list[tuple[str, Span | None]] = list(zip(goal_sentences(done.place, reason), spans, strict=True))
    return found or [("no decision here leads to safety and to the goal", None)]


def _main_findings(done: Explained) -> Iterator[Finding]:
    file = done.source.name
    match done.found:
        case NothingToExplain():
            yield Finding("notice", "realizable: there is nothing to explain", file)
        case Unexplained(limit):
            yield undecided(str(limit), file)
        case Explanation() as found:
            if found.part is not None:
                starts = bool(done.spec.starts)
                whole = found.part.states + found.part.given_up
                valid = count(whole, "start") if starts else count(found.statistics.valid, "valid state")
                assumed = environment_text(done.spec, found.part)
                message = f"{f'this {assumed}: ' if assumed else ''}realizable for {found.part.states:,} of {valid}"
                how = "beginning nowhere else" if starts else "assuming"
                yield Finding("notice", f"{message}, {how}: {found.part.text}", file)
            if found.left_out:
                yield Finding("warning", "\n".join(left_out_lines(found)), file, title="incomplete")


def incomplete(done: Explained) -> list[dict[str, object]]:
    """What was left out, and why."""
    left_out = done.found.left_out if isinstance(done.found, Explanation) else ()
    return [{"what": each.stage, "found": each.found, "why": each.why} for each in left_out]
