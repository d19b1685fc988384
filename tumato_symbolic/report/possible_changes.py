"""What would make a specification realizable, for a person: repairs, the largest realizable part, what is left out."""

from __future__ import annotations

from collections.abc import Iterator

from tumato_symbolic.explain.environment import Restriction
from tumato_symbolic.explain.explanation import Change, Explanation, RealizablePart, Repair, Stage
from tumato_symbolic.report.cubes import cube_text
from tumato_symbolic.report.element_roles import KINDS, declared, where
from tumato_symbolic.report.layout import count, enumeration
from tumato_symbolic.report.objections import Place
from tumato_symbolic.spec import Spec

_LONGEST_ASSUMPTION = 1_500
_LONGEST_CONDITION = 80


def repair_pieces(place: Place, found: Explanation) -> Iterator[str]:
    """Repairs, each as it is found."""
    if found.unavoidable is not None:
        why = "states still fail" if found.unavoidable == "failing" else "the goals still conflict"
        yield (
            f"\nNo repair by dropping: with every rule, precondition, alternative, resource and bound dropped, {why}.\n"
            "The robot needs another action or effect, or other goals."
        )
    elif found.repairs:
        yield "\nPossible changes (each was tried and gives a policy; whether it is safe is for you to judge):"
        for number, repair in enumerate(found.repairs, 1):
            lines = (f"     {line}" for change in repair.changes for line in _change(place, change))
            yield "\n".join([f"  {number}. {_summary(repair)}", *lines])
    elif "repairs" in found.finished:
        yield "\nNo repair was looked for, or none was found within the limits."


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


def _summary(repair: Repair) -> str:
    if repair.drops:
        return "drop this" if len(repair.changes) == 1 else "drop these"
    return "or change this" if len(repair.changes) == 1 else "or change these"


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
        yield "No part of the states is realizable: no assumption would help."
        return
    kind = "The largest" if part.unique else "A largest" if part.largest else "A"
    total = count(part.states + part.given_up, "valid state")
    head = f"{kind} realizable part: {part.states:,} of {total}"
    assumed = environment_text(spec, part)
    yield f"{head}; it {assumed}:" if assumed else f"{head}, under this assumption:"
    text = part.text
    if len(text) > _LONGEST_ASSUMPTION and written is None:
        text = f"{text[:_LONGEST_ASSUMPTION]} … ({len(text):,} characters; --write FILE writes all of it)"
    yield f"  assume: {text}"
    if not part.unique:
        yield "  (goals conflict: this is one choice among several)"
    if written is None:
        yield "`--write FILE` writes the specification with it."
    elif written == "-":
        yield "The specification with this assumption is on the standard output."
    else:
        yield f"{written} is written: the specification with this assumption."


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
        while_ = " or ".join(cube_text(spec, cube).replace(", ", " and ") for cube in cubes)
        if while_ and len(while_) <= _LONGEST_CONDITION:
            yield f"{name} is never {values[value]} while {while_}"
        else:
            yield f"{name} is not {values[value]} in some states"
