"""Why a set of actions is not allowed, in sentences: the explicit meaning, told with the user's own rules and lines."""

from __future__ import annotations

from typing import TYPE_CHECKING

from msgspec import Struct

from tumato_symbolic.report.layout import enumeration
from tumato_symbolic.semantics import (
    ActionSet,
    EffectSequence,
    EffectStep,
    Objection,
    State,
    action_names,
    goals_as_written,
    holds,
    in_json,
    is_safe,
    state_text,
)
from tumato_symbolic.spec import Assignment, Ordering, Rule, Spec

if TYPE_CHECKING:
    from tumato_symbolic.explain.near_misses import NearMiss


class Place(Struct, frozen=True):
    """A specification with the name of its file, for `file:line`."""

    spec: Spec
    file: str

    def rule(self, rule: Rule) -> str:
        """A rule as the user wrote it, on one line, and where."""
        return f"`{' '.join(rule.text.split())}` ({self.file}:{rule.span.line})"

    def state(self, state: State) -> str:
        """A state as `decide` reads it."""
        return state_text(self.spec, state)

    def actions(self, chosen: ActionSet) -> str:
        """A set of actions; the empty one is `nothing`."""
        names = action_names(self.spec, chosen)
        return f"{{{', '.join(names)}}}" if names else "nothing"

    def assignment(self, assignment: Assignment) -> str:
        """What an effect writes, or `no change`."""
        variables = self.spec.variables
        written = [f"{variables[place].name}={variables[place].values[value]}" for place, value in assignment]
        return " ".join(written) or "no change"

    def goals(self, state: State) -> str:
        """The goals that are active in a state."""
        bodies = [*dict.fromkeys(self.rule(rule) for _, rule in goals_as_written(self.spec, state))]
        if self.spec.restores_stepwise and not is_safe(self.spec, state):
            return f"{enumeration(bodies)}, in a safe state" if bodies else "none but safety"
        return enumeration(bodies) or "none: any allowed step will do"


def effects_text(place: Place, outcome: EffectSequence) -> str:
    """How effects happened one after the other."""
    return ", then ".join(_effectuation(place, step) for step in outcome)


def outcome_json(spec: Spec, outcome: EffectSequence) -> list[dict[str, object]]:
    """The same for a program."""
    return [{"action": spec.actions[step.action].name, "after": in_json(spec, step.after)} for step in outcome]


def _effectuation(place: Place, step: EffectStep) -> str:
    action = place.spec.actions[step.action]
    written = place.assignment(step.effect)
    if step.effect == action.nominal:
        return f"{action.name} takes its nominal effect ({written})"
    source = next(entry for entry in action.alternatives if step.effect in entry.outcomes)
    return f"{action.name} takes an alternative effect ({written}; {place.file}:{source.span.line})"


def objection_text(place: Place, objection: Objection, start: State | None = None) -> str:
    """One objection to a set, as a clause without a full stop; an effect sequence has a second, indented line.

    `start` is where the set would be executed: a rule that is broken there, and all the way, *stays* broken.
    """
    names = [place.spec.actions[number].name for number in objection.actions]
    rule = place.rule(objection.rule) if objection.rule else ""
    match objection.kind:
        case "precondition":
            return f"{names[0]} has the precondition {rule}, which does not hold"
        case "resource":
            first, second = (place.spec.actions[number].resources for number in objection.actions)
            shared = [place.spec.resources[number] for number in sorted(first & second)]
            return f"{names[0]} and {names[1]} both control {enumeration(shared)}"
        case "nominal-conflict":
            return f"the nominal effects of {names[0]} and {names[1]} contradict each other"
        case "reaction-rule":
            return f"the reaction rule {rule} forbids it"
        case "unsafe" | "nominal-unsafe" if objection.rule is None and objection.state is not None:
            happens = effects_text(place, objection.outcome) if objection.outcome else "all nominal effects happen"
            return f"when {happens},\n  it comes to {place.state(objection.state)}, where nothing is decided"
        case "unsafe" if objection.outcome:
            verb = "stays" if _never_held(objection, start) else "is"
            return f"when {effects_text(place, objection.outcome)},\n  {rule} {verb} broken"
        case "unsafe":
            return f"{rule} stays broken"
        case "falsified":
            lost = f"the precondition {rule} of {names[0]} no longer holds"
            return f"when {effects_text(place, objection.outcome)},\n  {lost}"
        case "nominal-unsafe":
            return f"after all nominal effects, {rule} is broken"


def _never_held(objection: Objection, start: State | None) -> bool:
    """Whether the rule is broken from the start to the end of the outcome."""
    assert objection.rule is not None
    states = [start, *(step.after for step in objection.outcome)] if start is not None else []
    return bool(states) and not any(holds(objection.rule.formula, state) for state in states)


def broken_here(place: Place, state: State) -> str:
    """What an unsafe state breaks, as a remark in brackets; empty in a safe state."""
    if is_safe(place.spec, state):
        return ""
    broken = [place.rule(rule) for rule in place.spec.state_rules if not holds(rule.formula, state)]
    return f"unsafe: it breaks {enumeration(broken)}"


def why_no_set(place: Place, state: State, ordering: Ordering, limit: int = 3) -> list[str]:
    """The sets that come nearest to being allowed in a state where none is, each with what speaks against it.

    Nearest: see `near_misses`.
    """
    from tumato_symbolic.explain.near_misses import near_misses

    nearest = near_misses(place.spec, state, ordering, limit).misses
    lines = [f"{place.actions(near.chosen)}: {_together(place, state, near)}" for near in nearest]
    if len(nearest) == 1:
        lines.append("anything else: no action has preconditions that hold here")
    return lines


def _together(place: Place, state: State, near: NearMiss) -> str:
    first, more = objection_text(place, near.objections[0], state), len(near.objections) - 1
    return f"{first} (and {more} more)" if more else first
