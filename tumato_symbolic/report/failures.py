"""Why there is no policy: the failing states of one kind, with an example and what could be changed."""

from __future__ import annotations

from typing import Final

from msgspec.structs import replace

from tumato_symbolic.diagnostics import Code
from tumato_symbolic.report.layout import count, enumeration
from tumato_symbolic.report.objections import Place, broken_here, why_no_set
from tumato_symbolic.semantics import State, active_goals, in_json, is_safe
from tumato_symbolic.spec import TRUE, Ordering, Spec
from tumato_symbolic.synthesis.result import DecidedPart, Failure, FailureKind

FAILURE_CODES: Final[dict[FailureKind, Code]] = {
    "no-allowed-set": Code.TUM401,
    "no-restoration": Code.TUM404,
    "no-plan": Code.TUM402,
    "conflict": Code.TUM403,
}

_STATES_IN_JSON = 100
"""So many failing states of a kind are listed in JSON; all are counted."""

_STATES_IN_TEXT = 8
"""So many states of a conflict are listed in the text."""

_NAMES = 5
"""So many variables are named in a sentence."""


def failure_text(place: Place, failure: Failure, ordering: Ordering) -> str:
    """One kind of failure for a person."""
    if failure.within is not None:
        place = replace(place, spec=place.spec.within(failure.within))
    match failure.kind:
        case "no-allowed-set":
            lines = _no_allowed_set(place, failure, ordering)
        case "no-restoration":
            lines = _no_restoration(place, failure)
        case "no-plan":
            lines = _no_plan(place, failure)
        case "conflict":
            lines = _conflict(place, failure)
    return f"error[{FAILURE_CODES[failure.kind].name}]: " + "\n".join(lines)


def failure_line(place: Place, failure: Failure) -> str:
    """One kind of failure in short: how many states, and one of them."""
    what = {
        "no-allowed-set": "no allowed set of actions",
        "no-restoration": "no way back to safety",
        "no-plan": "allowed sets, but no plan",
        "conflict": "a plan each, but no policy works for all of them",
    }[failure.kind]
    return f"error[{FAILURE_CODES[failure.kind].name}]: " + "\n".join(_head(place, failure, what))


def _head(place: Place, failure: Failure, what: str) -> list[str]:
    has = "has" if failure.count == 1 else "have"
    noun = "start" if place.spec.starts else "state"
    lines = [f"{count(failure.count, noun)} {has} {what}. For example:", f"  {place.state(failure.example)}"]
    broken = broken_here(place, failure.example)
    lines += [f"  ({broken})"] if broken else []
    return lines if failure.within is None else [*lines, _LEFT_OUT]


_LEFT_OUT = "A step is left out here if it may lead to a state from where there is no policy."


def _no_allowed_set(place: Place, failure: Failure, ordering: Ordering) -> list[str]:
    from textwrap import indent

    return [
        *_head(place, failure, "no allowed set of actions"),
        "The sets that come nearest, and what rules them out:",
        *(indent(reason, "  ") for reason in why_no_set(place, failure.example, ordering)),
        "Give the robot an action for such states, or exclude what cannot happen with `assume:`.",
    ]


def _no_restoration(place: Place, failure: Failure) -> list[str]:
    if place.spec.restoration == "fair":
        meaning = (
            "Whatever is executed there without breaking another rule, its nominal effects never lead back to safety."
        )
    else:
        meaning = "Whatever is executed there without breaking another rule, some outcomes never lead back to safety."
    return [
        *_head(place, failure, "no way back to safety"),
        meaning,
        "Give the robot an action for such states, or exclude what cannot happen with `assume:`.",
    ]


def _no_plan(place: Place, failure: Failure) -> list[str]:
    bound = place.spec.max_plan_length
    length = ", however long," if bound is None else f" of at most {count(bound, 'step')} (max_plan_length)"
    runs, raise_it = f"no run of allowed sets{length}", "." if bound is None else ", or raise max_plan_length."
    head = _head(place, failure, "allowed sets, but no plan")
    if _asks_for_safety_only(place.spec, failure.example):
        way_out = "Give the robot an action that leads back to safety, or exclude what cannot happen with `assume:`"
        return [*head, f"Only safety is asked for there, and {runs} restores it.", way_out + raise_it]
    return [
        *head,
        f"Its goal is {place.goals(failure.example)}, and {runs} reaches it.",
        "Give the robot an action towards the goal, or ask for less (`when … then goal: …`)" + raise_it,
        *_left_to_others(place),
    ]


def _asks_for_safety_only(spec: Spec, state: State) -> bool:
    """Whether every safe state meets the goals of an unsafe one: it has none, or all are `true`."""
    goals = (spec.bodies[body].formula for body in active_goals(spec, state))
    return not is_safe(spec, state) and all(goal == TRUE for goal in goals)


def _left_to_others(place: Place) -> list[str]:
    """What no action changes, and a goal therefore cannot wait for."""
    variables = (place.spec.variables[number] for number in sorted(place.spec.environment))
    names = [variable.name for variable in variables if len(variable.values) > 1]
    if not names:
        return []
    shown = [*names[:_NAMES], f"{len(names) - _NAMES:,} more"] if len(names) > _NAMES else names
    return [f"No action changes {enumeration(shown)}, and no plan waits for others: ask for less where a goal does."]


def _conflict(place: Place, failure: Failure) -> list[str]:
    alone = "this state has a plan, but none that a policy could follow,"
    together = f"each of these {count(failure.count, 'state')} has a plan, but no policy works for all of them,"
    lines = [
        f"The goals conflict: {alone if failure.count == 1 else together}",
        "because the plans pass through states where the policy has to pursue other goals.",
    ]
    for state in failure.states[:_STATES_IN_TEXT]:
        lines += [f"  {place.state(state)}", f"    goal: {place.goals(state)}"]
    if failure.count > _STATES_IN_TEXT:
        lines.append(f"  … and {failure.count - _STATES_IN_TEXT} more")
    return [*lines, "Make the goals agree, or let a condition tell such states apart."]


def left_out_lines(place: Place, part: DecidedPart) -> list[str]:
    """Which valid states a policy from the starts does not decide, and why: one line for each kind, with an example."""
    left = sum(failure.count for failure in part.left_out)
    lines = [f"{count(left, 'valid state')} {'is' if left == 1 else 'are'} left out; no run from a start comes there:"]
    lines += [
        f"  {each.count:,} {_WHY_LEFT_OUT[each.kind]}, such as {place.state(each.example)}" for each in part.left_out
    ]
    return lines if left else []


_WHY_LEFT_OUT: Final[dict[FailureKind, str]] = {
    "no-allowed-set": "without an allowed set of actions",
    "no-restoration": "without a way back to safety",
    "no-plan": "without a plan",
    "conflict": "where goals conflict with those of others",
}


def failure_json(spec: Spec, failure: Failure) -> dict[str, object]:
    """One kind of failure for a program: the exact count, an example, and the first states."""
    return {
        "kind": failure.kind,
        "code": FAILURE_CODES[failure.kind].name,
        "count": failure.count,
        "example": in_json(spec, failure.example),
        "states": [in_json(spec, state) for state in failure.states[:_STATES_IN_JSON]],
    }
