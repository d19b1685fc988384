"""What would make a specification realizable, for a person: repairs, the largest realizable part, what is left out."""

from __future__ import annotations

from collections.abc import Iterator

from tumato_symbolic.explain.additions import Addition, NewAction, NoGoalWhile, Setting, conditions_of
from tumato_symbolic.explain.as_predicates import cube_formula, predicate_text
from tumato_symbolic.explain.environment import Restriction
from tumato_symbolic.explain.explanation import Change, Explanation, RealizablePart, Repair, Stage
from tumato_symbolic.report.cubes import cube_text
from tumato_symbolic.report.element_roles import KINDS, declared, where
from tumato_symbolic.report.layout import count, enumeration
from tumato_symbolic.report.objections import Place
from tumato_symbolic.spec import Is, Spec, canonical_text

_LONGEST_ASSUMPTION = 1_500
"""Characters of an assumption that is shown; the rest is cut off."""

_LONGEST_CONDITION = 80
"""Characters of a condition about the environment that is told."""

_MOST_CHANGES = 6
"""So many changed lines of a repair are shown."""


def repair_pieces(place: Place, found: Explanation) -> Iterator[str]:
    """Repairs, each as it is found; those that give up safety last, under a heading of their own."""
    lacking = found.unavoidable is not None and found.is_over("repairs")
    for number, repair in enumerate(found.repairs, 1):
        if repair.gives_up_safety and not any(each.gives_up_safety for each in found.repairs[: number - 1]):
            yield f"\nGives up safety ({_why_given_up(found)}; each was tried and gives a policy):"
        elif number == 1:
            yield "\nPossible changes (each was tried and gives a policy; whether it is safe is for you to judge):"
        yield "\n".join([f"  {number}. {_summary(place.spec, repair)}", *_lines(place, repair)])
    if lacking:
        why = "states still fail" if found.unavoidable == "failing" else "the goals still conflict"
        yield (
            f"\nNo repair by dropping: with every rule, precondition, alternative, resource and bound dropped, {why}.\n"
            "The robot needs another action or effect, or other goals."
        )
    elif "repairs" in found.finished and not found.repairs:
        yield "\nNo repair was looked for, or none was found within the limits."


def _why_given_up(found: Explanation) -> str:
    if any(not repair.gives_up_safety for repair in found.repairs):
        return "all repairs were asked for"
    return "nothing else was found in time" if found.others_untried else "nothing else that was tried serves"


_NAMES: dict[Stage, str] = {
    "states": "failing states",
    "part": "the largest realizable part",
    "reasons": "reasons",
    "near": "nearest sets",
    "repairs": "repairs",
}


def left_out_lines(found: Explanation) -> Iterator[str]:
    """What the explanation does not say, and why."""
    yield "Left out:"
    for each in found.left_out:
        yield f"  {_NAMES[each.stage]}: {each.found}; {each.why}"
    if any("time limit" in each.why for each in found.left_out):
        yield "`--timeout SECONDS` gives it more time."


def _summary(spec: Spec, repair: Repair) -> str:
    """What to do, in a line; first what it takes from the environment."""
    added, changed = len(repair.additions), len(repair.changes)
    drops = all(change.text is None for change in repair.changes)
    parts = []
    if added:
        parts.append("add this" if added == 1 else "add these")
    if changed:
        parts.append(f"{'drop' if drops else 'change'} {'this' if changed == 1 else 'these'}")
    summary = " and ".join(parts)
    if any(isinstance(addition, NewAction) for addition in repair.additions):
        summary += ", if the robot can do it"
    taken = [spec.variables[variable].name for variable in sorted(controlled(spec, repair))]
    return f"{summary}; no action controls {enumeration(taken, 'or')}" if taken else summary


def controlled(spec: Spec, repair: Repair) -> frozenset[int]:
    """The variables of the environment that the new actions of a repair change."""
    effects = (each.effects for each in repair.additions if isinstance(each, NewAction))
    return spec.environment & {variable for written in effects for variable, _ in written}


def _lines(place: Place, repair: Repair) -> Iterator[str]:
    """What to add and what to change, line by line."""
    for addition in repair.additions:
        head = f"     {_where_added(place.spec, addition)}: "
        for number, line in enumerate(added_lines(place.spec, addition)):
            yield f"{' ' * len(head) if number else head}+ {line}"
    changes = repair.changes[:_MOST_CHANGES]
    yield from (f"     {line}" for change in changes for line in _change(place, change))
    if len(repair.changes) > len(changes):
        yield f"     … and {len(repair.changes) - len(changes)} more (--output-format json lists them)"


def _where_added(spec: Spec, addition: Addition) -> str:
    match addition:
        case Setting():
            return "in CONFIG"
        case NewAction():
            return "in ACTIONS"
        case NoGoalWhile():
            return "before the goals" if _in_order(spec) else "around the goals"


def added_lines(spec: Spec, addition: Addition) -> list[str]:
    """The lines of an addition, as they stand in a specification."""
    match addition:
        case Setting(restoration):
            return [f"restoration: {restoration}"]
        case NewAction(condition, effects):
            start = [] if condition is None else [predicate_text(spec, cube_formula(spec, condition))]
            written = ", ".join(canonical_text(spec, Is(variable, value)) for variable, value in effects)
            return ["action NAME", *(f"preconditions: {each}" for each in start), f"nominal effects: {written}"]
        case NoGoalWhile():
            conditions = [predicate_text(spec, each) for each in conditions_of(spec, addition)]
            free = [f"when {condition} then goal: true" for condition in conditions]
            return free if _in_order(spec) else ["goal type: priority", *free, "BEGIN GOALS", "…", "END GOALS"]


def _in_order(spec: Spec) -> bool:
    return spec.goals is not None and spec.goals.kind == "priority"


def _change(place: Place, change: Change) -> Iterator[str]:
    element = change.element
    of = ""
    if element.kind in ("precondition", "alternative", "resource"):
        of = f" of {place.spec.actions[element.number].name}"
    old = declared(place.spec, element)
    yield f"{where(place, element)}: - {old}  ({KINDS[element.kind]}{of})"
    if change.text is not None:
        yield f"{' ' * len(where(place, element))}  + {declared(place.spec, element, change.text)}"


def part_lines(spec: Spec, part: RealizablePart | None, written: str | None) -> Iterator[str]:
    """The largest realizable part, and first what it takes from the environment. `written` is the file with it."""
    if part is None:
        yield (
            "No part of the starts is realizable: no narrower start condition would help."
            if spec.starts
            else "No part of the states is realizable: no assumption would help."
        )
        return
    kind = "The largest" if part.unique else "A largest" if part.largest else "A"
    total = count(part.states + part.given_up, "start" if spec.starts else "valid state")
    head = f"{kind} realizable part: {part.states:,} of {total}"
    assumed = environment_text(spec, part)
    as_said = "if it never begins elsewhere" if spec.starts else "under this assumption"
    yield f"{head}; it {assumed}:" if assumed else f"{head}, {as_said}:"
    text, word = part.text, "start" if spec.starts else "assume"
    if len(text) > _LONGEST_ASSUMPTION and written is None:
        text = f"{text[:_LONGEST_ASSUMPTION]} … ({len(text):,} characters; --write FILE writes all of it)"
    yield f"  {word}: {text}"
    if part.steady is not None and len(part.steady[1]) <= _LONGEST_ASSUMPTION:
        states, text = part.steady
        yield f"A smaller one, {states:,} of {total}, assumes nothing of what no action controls:"
        yield f"  {word}: {text}"
    if not part.unique:
        yield "  (goals conflict: this is one choice among several)"
    what = "with this start condition and no other" if spec.starts else "with this assumption"
    if written is None:
        yield f"`--write FILE` writes the specification {what if spec.starts else 'with it'}."
    elif written == "-":
        yield f"The specification {what} is on the standard output."
    else:
        yield f"{written} is written: the specification {what}."


def environment_text(spec: Spec, part: RealizablePart) -> str:
    """`assumes that S_Human is always clear; no action controls S_Human`; empty where it assumes nothing of it."""
    told = [sentence for each in part.environment for sentence in _restriction(spec, each)]
    names = enumeration([spec.variables[each.variable].name for each in part.environment], "or")
    return f"assumes that {enumeration(told)}; no action controls {names}" if told else ""


def _restriction(spec: Spec, taken: Restriction) -> Iterator[str]:
    """What is assumed of one variable, a clause for each kind."""
    name, values = spec.variables[taken.variable].name, spec.variables[taken.variable].values
    if taken.never and taken.only is not None:
        yield f"{name} is always {values[taken.only]}"
    elif taken.never:
        yield f"{name} is never {enumeration([values[each] for each in taken.never], 'or')}"
    for value, cubes in taken.partly:
        while_ = " or ".join(cube_text(spec, cube, " and ") for cube in cubes)
        if while_ and len(while_) <= _LONGEST_CONDITION:
            yield f"{name} is never {values[value]} while {while_}"
        else:
            yield f"{name} is not {values[value]} in some states"
