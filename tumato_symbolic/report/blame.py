"""Which states fail, and why, for a person: how many reasons, groups of states and lines are told."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

from msgspec.structs import replace

from tumato_symbolic.explain.as_predicates import predicate_text
from tumato_symbolic.explain.elements import Element, span_of
from tumato_symbolic.explain.explanation import Explanation, FailingGroup, Reason
from tumato_symbolic.explain.near_misses import NearMiss, applicable
from tumato_symbolic.explain.summary import LONG, Summary
from tumato_symbolic.report.cubes import cube_text
from tumato_symbolic.report.element_roles import KINDS, declared, role, where
from tumato_symbolic.report.failures import FAILURE_CODES
from tumato_symbolic.report.layout import count, enumeration
from tumato_symbolic.report.objections import Place, objection_text
from tumato_symbolic.semantics import Objection, State, goals_as_written
from tumato_symbolic.spec import Rule, Spec, variables_of

_REASONS_IN_FULL = 3
"""So many reasons are told with their states and lines."""

_REASONS_IN_SHORT = 12
"""So many more are told in two lines each; the rest is counted."""

_CUBES = 3
"""So many groups of failing states are told of each reason."""

_LINES = 8
"""So many lines to blame are named in one sentence."""

_STATES_TOGETHER = 6
"""So many states of a conflict are shown."""


def group_lines(place: Place, group: FailingGroup, every_cube: bool) -> Iterator[str]:
    """The states that fail in one way."""
    yield f"error[{FAILURE_CODES[group.kind].name}]: {headline(group)}:"
    if group.kind == "conflict":
        yield from _together(place, group)
        return
    yield from (f"  {line}" for line in _cubes(place, group, every_cube))
    yield from _example(place, group)


def _example(place: Place, states: FailingGroup | Reason) -> Iterator[str]:
    if not (states.cubes and all(len(values) == 1 for values in states.cubes[0])):
        yield f"  for example {place.state(states.example)}"


def reason_pieces(place: Place, found: Explanation, every_cube: bool) -> Iterator[str]:
    """The first reasons as they are found, and the others in short when all of them are."""
    for number, reason in enumerate(found.reasons[:_REASONS_IN_FULL], 1):
        yield "\n".join(["", *_reason(place, found, reason, number, every_cube)])
    if not found.is_over("reasons"):
        return
    rest = found.reasons[_REASONS_IN_FULL:]
    if rest:
        lines = ["", f"And {count(len(rest), 'more reason')}:"]
        for reason in rest[:_REASONS_IN_SHORT]:
            lines += [f"  {count(reason.count, 'state')}: {_where(place, reason, 1)}", f"    {_blamed(place, reason)}"]
        hidden = rest[_REASONS_IN_SHORT:]
        if hidden:
            left = count(sum(reason.count for reason in hidden), "state")
            lines.append(
                f"  … and {count(len(hidden), 'more reason')} for {left} (--output-format json lists them all)"
            )
        yield "\n".join(lines)
    if found.omitted and "reasons" in found.finished:
        why = "whose reasons were not analysed: there are too many"
        yield f"\n{count(found.omitted, 'failing state')} more, {why}."


def _blamed(place: Place, reason: Reason) -> str:
    """The lines of a core, or of the goals, in short."""
    if reason.core:
        lines = sorted({span.line for element in reason.core if (span := span_of(place.spec, element))})
        shown = [str(line) for line in lines[:_LINES]]
        if len(lines) > _LINES:
            shown.append(f"{len(lines) - _LINES} more")
        return f"because of {'line' if len(lines) == 1 else 'lines'} {enumeration(shown)}"
    return enumeration(list(goal_sentences(place, reason))) or "nothing can be done"


_HEADLINES = {
    "no-allowed-set": ("no set of actions is allowed in this state", "no set of actions is allowed in these {} states"),
    "no-restoration": (
        "safety cannot be restored from this state",
        "safety cannot be restored from these {} states",
    ),
    "no-plan": ("this state has no plan", "these {} states have no plan"),
    "conflict": (
        "this state has a plan, but none that a policy can follow",
        "no policy works for all of these {} states",
    ),
}


def headline(states: FailingGroup | Reason) -> str:
    """What is wrong with some states."""
    one, many = _HEADLINES[states.kind]
    return one if states.count == 1 else many.format(f"{states.count:,}")


def _reason(place: Place, found: Explanation, reason: Reason, number: int, every_cube: bool) -> Iterator[str]:
    yield f"Why {headline(reason)} (reason {number}):"
    group = next(group for group in found.groups if group.kind == reason.kind)
    if reason.count < group.count:
        yield from (f"  {line}" for line in _cubes(place, reason, every_cube))
    if reason.kind == "conflict":
        if not reason.core:
            yield "  whatever is dropped, what one of these goals needs in a state, another one forbids there"
    elif not reason.core:
        blamed_first = sorted(reason.goals, key=lambda goal: not (goal.never or goal.clashes))
        told = replace(reason, goals=tuple(blamed_first))
        yield from (f"  {sentence}" for sentence in goal_sentences(place, told))
    for position, core in enumerate(reason.cores):
        if core:
            yield _because(position, len(core))
            yield from _core(place, core, reason)
    if reason.later:
        yield "  A step is left out here if it may lead to a state from where there is no policy."
    if reason.core and reason.kind == "no-plan":
        yield f"  goal: {place.goals(reason.example)}"
    if reason.kind != "conflict" and reason.example != group.example:
        yield from _example(place, reason)


def _because(position: int, size: int) -> str:
    also = "also " if position else ""
    return f"  {also}because of this line:" if size == 1 else f"  {also}because of these {size}, taken together:"


def _core(place: Place, core: tuple[Element, ...], reason: Reason) -> Iterator[str]:
    """The elements of a core; of a long one what it comes to, and each line or text once."""
    able = frozenset(applicable(place.spec, reason.example))
    core = tuple(sorted(core, key=lambda each: each.kind == "alternative" and each.number not in able))
    groups = _alike(place, core) if len(core) > LONG else [[each] for each in core]
    shown, rest = groups, 0
    if reason.summary is not None and core == reason.core:
        shown = [group for group in groups if group[0].kind != "precondition"][:LONG]
        rest = len(core) - sum(map(len, shown))
        yield f"    {summary_text(place.spec, reason.summary)}"
    elif len(groups) > LONG:
        shown, rest = groups[:LONG], len(core) - sum(map(len, groups[:LONG]))
    for group in shown:
        first, more = group[0], f" (and {len(group) - 1} more like this)" if len(group) > 1 else ""
        yield f"    {where(place, first)}: {declared(place.spec, first)}{more}"
        yield f"      {role(place, first, core, reason)}"
    if rest:
        others = tuple(each for group in groups if group not in shown for each in group)
        yield f"    … and {rest} more: {_kinds(others)} (--output-format json lists them)"


def _alike(place: Place, core: tuple[Element, ...]) -> list[list[Element]]:
    """The elements that stand in one line, or have one text, together."""
    texts = Counter((each.kind, declared(place.spec, each)) for each in core)
    groups: dict[object, list[Element]] = {}
    for each in core:
        text, span = (each.kind, declared(place.spec, each)), span_of(place.spec, each)
        groups.setdefault(text if texts[text] > 1 or span is None else (each.kind, span), []).append(each)
    return list(groups.values())


def summary_text(spec: Spec, said: Summary) -> str:
    """`no action raises S_Battery while S_Place is not dock`."""
    variable = spec.variables[said.variable]
    does = f"{said.change} {variable.name}"
    if said.change == "changes" and len(said.values) < len(variable.values) - 1:
        does = f"sets {variable.name} to {enumeration([variable.values[each] for each in said.values], 'or')}"
    everywhere = all(len(values) == len(each.values) for values, each in zip(said.where, spec.variables, strict=True))
    while_ = "" if everywhere else f" while {cube_text(spec, said.where, ' and ')}"
    return f"no {'action' if said.by_itself else 'allowed set of actions'} {does}{while_}"


def _kinds(elements: tuple[Element, ...]) -> str:
    """How many there are of each kind."""
    numbers = Counter(KINDS[element.kind] for element in elements)
    return enumeration([count(number, kind) for kind, number in numbers.items()])


def _cubes(place: Place, states: FailingGroup | Reason, every_cube: bool) -> Iterator[str]:
    if not states.cubes:
        return
    shown = states.cubes if every_cube else states.cubes[:_CUBES]
    yield from (cube_text(place.spec, cube) for cube in shown)
    hidden = len(states.cubes) - len(shown)
    if hidden:
        yield f"… and {count(hidden, 'more such group')} (--max-cubes lists them)"
    if states.omitted:
        yield f"… and {count(states.omitted, 'more state')} (--max-cubes is met)"


def _where(place: Place, reason: Reason, limit: int) -> str:
    more = len(reason.cubes) - limit
    texts = [cube_text(place.spec, cube) for cube in reason.cubes[:limit]]
    return "; ".join(texts) + (f" (and {more} more)" if more > 0 else "")


def first_written(spec: Spec, state: State) -> dict[int, Rule]:
    """The bodies of the active goals, each with the place of the first that has it."""
    return dict(reversed(goals_as_written(spec, state)))


def goal_sentences(place: Place, reason: Reason) -> Iterator[str]:
    """The goals of a state that fails whatever is dropped, and what in them never comes true; one sentence each."""
    written = first_written(place.spec, reason.example)
    for goal in reason.goals:
        rule = place.rule(written[goal.body])
        never = [f"`{predicate_text(place.spec, part)}`" for part in goal.never]
        if never:
            yield f"the goal is {rule}, and no nominal effect ever makes {enumeration(never)} true"
        elif not goal.clashes:
            yield f"the goal is {rule}, too"
        else:
            clashing = [each.body for each in reason.goals if each.clashes and each.body != goal.body]
            others = [place.rule(written[body]) for body in clashing]
            whole = f"it and {enumeration(others)}" if others else "all of it"
            yield f"the goal is {rule}, and nominal effects never make {whole} true at once"


def _together(place: Place, group: FailingGroup) -> Iterator[str]:
    for state in group.together[:_STATES_TOGETHER]:
        yield f"  {place.state(state)}"
        yield f"    goal: {place.goals(state)}"
    if len(group.together) > _STATES_TOGETHER:
        yield f"  … and {len(group.together) - _STATES_TOGETHER} more"


def near_pieces(place: Place, found: Explanation) -> Iterator[str]:
    """What comes near to being allowed in the example of the first reason that no set is."""
    for number, reason in enumerate(found.reasons[:_REASONS_IN_FULL], 1):
        if reason.near:
            yield f"\nThe nearest sets in the example of reason {number}:"
            for near in reason.near:
                yield "\n".join(f"  {line}" for line in near_miss_lines(place, near))
            return


def near_miss_lines(place: Place, near: NearMiss) -> list[str]:
    """Why a set is not allowed, in one or two lines."""
    first = near.objections[0]
    others = {(each.rule, each.actions) for each in near.objections} - {(first.rule, first.actions)}
    more = f" (and {len(others)} more)" if others else ""
    doing = f"executing {place.actions(near.chosen)}" if near.chosen else "doing nothing"
    if first.rule is not None and first.state is not None and near.chosen:
        told = objection_text(place, first).split("\n")[0].removeprefix("when ").rstrip(",")
        if first.kind == "nominal-unsafe":
            told = "all nominal effects are applied"
        shown, broken = _facts(place, first), f"breaks {place.rule(first.rule)}"
        if first.kind == "falsified":
            pending = place.spec.actions[first.actions[0]].name
            broken = f"falsifies the precondition {place.rule(first.rule)} of {pending}, which is still to take effect"
        return [f"{doing}: if {told}, then {shown} holds", f"  and {broken}{more}"]
    return [f"{doing}: {objection_text(place, first)}{more}"]


def _facts(place: Place, objection: Objection) -> str:
    """The variables that a broken rule mentions, in the state that breaks it."""
    assert objection.rule is not None and objection.state is not None
    pairs = tuple((variable, objection.state[variable]) for variable in sorted(variables_of(objection.rule.formula)))
    return place.assignment(pairs)
