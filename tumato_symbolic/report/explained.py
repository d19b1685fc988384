"""Why there is no policy, for a person: short first, detail after."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, replace

from tumato_symbolic.diagnostics import Diagnostic, Source
from tumato_symbolic.explain.cubes import StateCube
from tumato_symbolic.explain.elements import Element, span_of
from tumato_symbolic.explain.explanation import Explanation, NothingToExplain, Reason, Unexplained
from tumato_symbolic.explain.near import NearMiss, applicable
from tumato_symbolic.explain.predicates import predicate_text
from tumato_symbolic.report.failures import FAILURE_CODES
from tumato_symbolic.report.layout import Paint, count, enumeration
from tumato_symbolic.report.proof import ORDERINGS
from tumato_symbolic.report.reasons import Place, objection_text
from tumato_symbolic.report.roles import KINDS, declared, role, where
from tumato_symbolic.report.ways_out import ways_out
from tumato_symbolic.semantics import Objection, State
from tumato_symbolic.spec import Spec, variables_of

_REASONS_IN_FULL = 3
_REASONS_IN_SHORT = 12
_CUBES = 3
_ELEMENTS = 6
_LINES = 8
_STATES_TOGETHER = 6


@dataclass(frozen=True, slots=True)
class Explained:
    """What `explain` found, with everything that its report needs. `written` is the file with the assumption."""

    source: Source
    spec: Spec
    found: Explanation | NothingToExplain | Unexplained
    warnings: tuple[Diagnostic, ...]
    written: str | None
    every_cube: bool

    @property
    def place(self) -> Place:
        """The specification and its file."""
        return Place(self.spec, self.source.name)


def as_text(done: Explained, colour: bool) -> str:
    """The report for a person."""
    paint, name = Paint(colour), done.source.name
    match done.found:
        case NothingToExplain():
            return (
                f"{name} is {paint.good('realizable')}: there is nothing to explain.\n"
                "`tumato-sym synth` writes its policy, and `tumato-sym why` explains the decisions."
            )
        case Unexplained(limit):
            return f"{name}: {paint.doubt('undecided')}: {limit}."
        case Explanation() as found:
            return "\n\n".join(
                [_head(done, found, paint), *_reasons(done, found), *ways_out(done.place, found, done.written)]
            )


def _head(done: Explained, found: Explanation, paint: Paint) -> str:
    numbers = found.statistics
    verdict = f"{done.source.name} is {paint.bad('not realizable')}: "
    if found.failing_states:
        fail = "fails" if found.failing_states == 1 else "fail"
        some = f"{found.failing_states:,} of {count(numbers.valid, 'valid state')} {fail}"
        verdict += f"{some}, for {count(len(found.reasons), 'reason')}."
    else:
        verdict += "each state alone has a plan, but no policy serves all of them."
    first = "" if numbers.ordering == "any" else f"\n  effects: {ORDERINGS[numbers.ordering]}"
    return f"{verdict}{first}"


def _reasons(done: Explained, found: Explanation) -> Iterator[str]:
    for number, reason in enumerate(found.reasons[:_REASONS_IN_FULL]):
        yield "\n".join(_reason(done, found, reason, number))
    rest = found.reasons[_REASONS_IN_FULL:]
    if rest:
        lines = [f"and for {count(len(rest), 'more reason')}:"]
        for reason in rest[:_REASONS_IN_SHORT]:
            lines += [f"  {count(reason.count, 'state')}: {_where(done, reason, 1)}", f"    {_blamed(done, reason)}"]
        hidden = rest[_REASONS_IN_SHORT:]
        if hidden:
            left = count(sum(reason.count for reason in hidden), "state")
            lines.append(
                f"  … and {count(len(hidden), 'more reason')} for {left} (--output-format json lists them all)"
            )
        yield "\n".join(lines)
    if found.omitted:
        yield f"{count(found.omitted, 'failing state')} more, whose reasons were not looked for: there are too many."


def _blamed(done: Explained, reason: Reason) -> str:
    """The lines of a core, or of the goals, in short."""
    if reason.core:
        lines = sorted({span.line for element in reason.core if (span := span_of(done.spec, element))})
        shown = [str(line) for line in lines[:_LINES]]
        if len(lines) > _LINES:
            shown.append(f"{len(lines) - _LINES} more")
        return f"because of {'line' if len(lines) == 1 else 'lines'} {enumeration(shown)}"
    return enumeration(list(goal_sentences(done.place, reason))) or "nothing can be done"


_HEADLINES = {
    "no-allowed-set": ("no set of actions is allowed in this state", "no set of actions is allowed in these {} states"),
    "no-plan": ("this state has no plan", "these {} states have no plan"),
    "conflict": (
        "this state has a plan, but none that a policy can follow",
        "no policy serves these {} states together",
    ),
}


def headline(reason: Reason) -> str:
    """What is wrong with the states of a reason."""
    one, many = _HEADLINES[reason.kind]
    return one if reason.count == 1 else many.format(f"{reason.count:,}")


def _reason(done: Explained, found: Explanation, reason: Reason, number: int) -> Iterator[str]:
    place = done.place
    yield f"error[{FAILURE_CODES[reason.kind].name}]: {headline(reason)}:"
    yield from (f"  {line}" for line in _cubes(done, reason))
    if reason.kind == "conflict":
        yield from _together(place, reason)
    elif not reason.core:
        blamed_first = sorted(reason.goals, key=lambda goal: not (goal.never or goal.clashes))
        told = replace(reason, goals=tuple(blamed_first))
        yield from (f"  {sentence}" for sentence in goal_sentences(place, told))
    for position, core in enumerate(reason.cores):
        if core:
            yield _because(reason, position, len(core))
            yield from _core(place, core, reason)
    if reason.core and reason.kind == "no-plan":
        yield f"  goal: {place.goals(reason.example)}"
    if reason.kind != "conflict" and not (reason.cubes and all(len(values) == 1 for values in reason.cubes[0])):
        yield f"  for example {place.state(reason.example)}"
    if reason.near and number == 0:
        yield "  the nearest sets:"
        for near in reason.near:
            yield from (f"    {line}" for line in near_story(place, reason.example, near))


def _because(reason: Reason, position: int, size: int) -> str:
    also = "also " if position else ""
    return f"  {also}because of this line:" if size == 1 else f"  {also}because of these {size}, taken together:"


def _core(place: Place, core: tuple[Element, ...], reason: Reason) -> Iterator[str]:
    able = frozenset(applicable(place.spec, reason.example))
    core = tuple(sorted(core, key=lambda each: each.kind == "alternative" and each.number not in able))
    for element in core[:_ELEMENTS]:
        yield f"    {where(place, element)}: {declared(place.spec, element)}"
        yield f"      {role(place, element, core, reason)}"
    rest = core[_ELEMENTS:]
    if rest:
        yield f"    … and {len(rest)} more: {_kinds(rest)} (--output-format json lists them)"


def _kinds(elements: tuple[Element, ...]) -> str:
    """How many there are of each kind."""
    numbers = Counter(KINDS[element.kind] for element in elements)
    return enumeration([count(number, kind) for kind, number in numbers.items()])


def _cubes(done: Explained, reason: Reason) -> Iterator[str]:
    shown = reason.cubes if done.every_cube else reason.cubes[:_CUBES]
    yield from (cube_text(done.spec, cube) for cube in shown)
    hidden = len(reason.cubes) - len(shown)
    if hidden:
        yield f"… and {count(hidden, 'more such group')} (--max-cubes lists them)"
    if reason.omitted:
        yield f"… and {count(reason.omitted, 'more state')} (--max-cubes is met)"


def _where(done: Explained, reason: Reason, limit: int) -> str:
    more = len(reason.cubes) - limit
    texts = [cube_text(done.spec, cube) for cube in reason.cubes[:limit]]
    return "; ".join(texts) + (f" (and {more} more)" if more > 0 else "")


def cube_text(spec: Spec, cube: StateCube) -> str:
    """`S_Location in {corridor, charger}, S_Conveyor is on`."""
    parts = []
    for variable, values in zip(spec.variables, cube, strict=True):
        others = [value for value in range(len(variable.values)) if value not in values]
        if len(values) == 1 and others:
            parts.append(f"{variable.name} is {variable.values[values[0]]}")
        elif len(others) == 1:
            parts.append(f"{variable.name} is not {variable.values[others[0]]}")
        elif others:
            parts.append(f"{variable.name} in {{{', '.join(variable.values[value] for value in values)}}}")
    return ", ".join(parts) or "every valid state"


def goal_sentences(place: Place, reason: Reason) -> Iterator[str]:
    """The goals of a state that fails whatever is dropped, and what in them never comes true; one sentence each."""
    for goal in reason.goals:
        rule = place.rule(place.spec.bodies[goal.body])
        never = [f"`{predicate_text(place.spec, part)}`" for part in goal.never]
        if never:
            yield f"the goal is {rule}, and no nominal effect ever makes {enumeration(never)} true"
        elif not goal.clashes:
            yield f"the goal is {rule}, too"
        else:
            clashing = [each.body for each in reason.goals if each.clashes and each.body != goal.body]
            others = [place.rule(place.spec.bodies[body]) for body in clashing]
            whole = f"it and {enumeration(others)}" if others else "all of it"
            yield f"the goal is {rule}, and nominal effects never make {whole} true at once"


def _together(place: Place, reason: Reason) -> Iterator[str]:
    for state in reason.together[:_STATES_TOGETHER]:
        yield f"  {place.state(state)}"
        yield f"    goal: {place.goals(state)}"
    if len(reason.together) > _STATES_TOGETHER:
        yield f"  … and {len(reason.together) - _STATES_TOGETHER} more"
    if not reason.core:
        yield "  Whatever is dropped, what one of these goals needs in a state, another one forbids there."


def near_story(place: Place, state: State, near: NearMiss) -> list[str]:
    """Why a set is not allowed, as a short story."""
    first = near.objections[0]
    others = {(each.rule, each.actions) for each in near.objections} - {(first.rule, first.actions)}
    more = f" (and {len(others)} more)" if others else ""
    doing = f"executing {place.actions(near.chosen)}" if near.chosen else "doing nothing"
    if first.rule is not None and first.state is not None and near.chosen:
        told = objection_text(place, first).split("\n")[0].removeprefix("when ").rstrip(",")
        if first.kind == "nominal-unsafe":
            told = "all nominal effects strike"
        shown = _facts(place, first)
        return [f"{doing}: if {told}, then {shown} holds", f"  and breaks {place.rule(first.rule)}{more}"]
    return [f"{doing}: {objection_text(place, first)}{more}"]


def _facts(place: Place, objection: Objection) -> str:
    """What a broken rule speaks of, in the state that breaks it."""
    assert objection.rule is not None and objection.state is not None
    pairs = tuple((variable, objection.state[variable]) for variable in sorted(variables_of(objection.rule.formula)))
    return place.assignment(pairs)
