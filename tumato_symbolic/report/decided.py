"""What `why` says, for a person and a program: goals, the run, other sets and what speaks against them."""

from __future__ import annotations

from collections.abc import Iterator

from msgspec import Struct

from tumato_symbolic.diagnostics.wording import one_line
from tumato_symbolic.explain.decision import Decision, GoalNote, Other
from tumato_symbolic.report.guaranteed import guarantee_json, guarantee_text, shortcoming_json, shortcoming_lines
from tumato_symbolic.report.layout import count, enumeration
from tumato_symbolic.report.objections import Place, broken_here, effects_text, objection_text
from tumato_symbolic.semantics import Quality, Run, State, action_names, in_json, level
from tumato_symbolic.spec import Spec

_LISTED = 6
"""So many other sets of actions are told, with why they were not chosen."""


class Decided(Struct, frozen=True):
    """A decision with everything that its report needs. `asked` is the set that `--not` names."""

    place: Place
    policy: str
    decision: Decision
    asked: Other | None


def as_text(done: Decided) -> str:
    """The report for a person."""
    place, decision = done.place, done.decision
    cost = f" (duration {decision.duration})" if decision.broken else ""
    parts = [f"In {place.state(decision.state)}\n{done.policy} decides: {place.actions(decision.chosen)}{cost}."]
    if decision.broken:
        parts.append("\n".join(_unsafe(place, decision)))
    parts.append("\n".join(_goals(place, decision)))
    parts.append("\n".join(_run(place, decision.run)))
    parts.append("\n".join(_guaranteed(place, decision)))
    if done.asked is not None:
        parts.append(f"Why not {place.actions(done.asked.chosen)}? {_sentence(place, decision, done.asked)}")
    else:
        parts += _others(place, decision)
    return "\n\n".join(parts)


def _unsafe(place: Place, decision: Decision) -> Iterator[str]:
    spec = place.spec
    yield f"The state is unsafe: it breaks {enumeration([place.rule(rule) for rule in decision.broken])}."
    if len(spec.tiers) > 1:
        here = level(spec, decision.state)
        yield f"Its level is {here} of {len(spec.tiers)}: rules of severity {spec.tiers[here][0].severity} come first."
    if not spec.restores_stepwise:
        return
    way = decision.way
    if way is None:
        yield "The policy may never restore safety from here."
        return
    time = f"{count(way.effort[1], 'step')}, duration {way.effort[0]}"
    if way.bounded:
        yield f"Safety is restored in at most {time}, whatever happens. The worst case:"
    else:
        yield f"Safety is restored in {time}, if every effect is the nominal one; else the policy tries again:"
    for number, step in enumerate(way.steps, 1):
        deviation = step.deviation
        happens = "all nominal effects" if deviation is None else effects_text(place, deviation) or "no effect"
        yield f"  {number}. {place.actions(step.decision)}: {happens}; {_after(place, step.after)}"


def _after(place: Place, state: State) -> str:
    broken = broken_here(place, state)
    return f"still {broken}" if broken else "safe"


def _goals(place: Place, decision: Decision) -> Iterator[str]:
    if not any(note.active for note in decision.goals):
        yield "No goal is active: any allowed step will do."
    for note in decision.goals:
        yield _goal(place, note)


def _goal(place: Place, note: GoalNote) -> str:
    *outer, last = (*(place.rule(rule) for rule in note.conditions), "")
    if note.body is None:
        return f"Not active: the goal for {enumeration([*outer])}, which does not hold."
    because = f", because {enumeration([*outer, *([last] if last else [])])} holds" if note.conditions else ""
    return f"Active goal: {place.rule(note.body)}{because}."


_ENDS = {
    "goal": "The goal is reached",
    "bound": "The plan bound is met before the goal",
    "loop": "The run loops without meeting the goal",
    "undefined": "The policy does not say how to go on",
}


def _run(place: Place, run: Run) -> Iterator[str]:
    yield "The run, if every effect is the nominal one:"
    for number, (chosen, before, after) in enumerate(zip(run.decisions, run.states, run.states[1:], strict=False), 1):
        pairs = tuple((variable, value) for variable, value in enumerate(after) if value != before[variable])
        yield f"  {number}. {place.actions(chosen)}: {place.assignment(pairs)}"
    yield f"{_ENDS[run.end]} after {count(run.steps, 'step')}."


def _guaranteed(place: Place, decision: Decision) -> Iterator[str]:
    found = decision.guaranteed
    if found is None:
        yield "Too much can follow to tell here what is guaranteed; `verify --guarantees` looks at all states at once."
    elif found.guarantee is None:
        yield "Nothing is guaranteed: not even the nominal run meets the goal."
    else:
        text = guarantee_text(found.guarantee)
        yield f"{text[0].upper()}{text[1:]}."
        if found.shortcoming is not None:
            yield "Nothing stronger is guaranteed:"
            yield from (f"  {line}" for line in shortcoming_lines(place, found.shortcoming))


def _others(place: Place, decision: Decision) -> Iterator[str]:
    cheaper = [each for each in decision.others if each.duration < decision.duration]
    forbidden = [each for each in decision.others if each.verdict == "forbidden"]
    possible = [each for each in decision.others if each.verdict != "forbidden"]
    if decision.broken and cheaper:
        yield _list(place, decision, cheaper, "Cheaper, but")
        forbidden = [each for each in forbidden if each not in cheaper]
        possible = [each for each in possible if each not in cheaper]
    if possible:
        yield _list(place, decision, possible, "Allowed as well, but")
    if forbidden:
        yield _list(place, decision, forbidden, "Not allowed:")


def _list(place: Place, decision: Decision, others: list[Other], title: str) -> str:
    lines = [title]
    lines.extend(f"  {place.actions(other.chosen)}: {_sentence(place, decision, other)}" for other in others[:_LISTED])
    if len(others) > _LISTED:
        lines.append(f"  … and {len(others) - _LISTED} more")
    return "\n".join(lines)


def _sentence(place: Place, decision: Decision, other: Other) -> str:
    """What speaks against a set."""
    match other.verdict:
        case "forbidden" if other.objection is not None:
            return objection_text(place, other.objection, decision.state).replace("\n", "\n  ")
        case "misses" if other.run is not None:
            return f"its run does not meet the goal ({_ENDS[other.run.end].lower()})"
        case "endless":
            return "it may never restore safety"
        case "costlier" if other.quality is not None and decision.quality is not None:
            what = "restores safety" if len(place.spec.tiers) == 1 else "raises the level"
            return f"it {what} in {_effort(other.quality)} rather than {_effort(decision.quality)}"
        case "costlier":
            return f"it takes longer to restore safety: {other.duration} rather than {decision.duration}"
        case _:
            return _serving(decision, other)


def _serving(decision: Decision, other: Other) -> str:
    """What speaks against a set that restores safety no worse, and whose run meets the goal."""
    steps = other.run.steps if other.run else 0
    match other.verdict:
        case "leaving":
            return f"its run, of {count(steps, 'step')}, passes states where other goals are active"
        case "longer":
            return f"its run has {count(steps, 'step')} rather than {decision.run.steps}"
        case "larger":
            return f"it needs {count(len(other.chosen), 'action')} rather than {len(decision.chosen)}"
        case "later":
            return "it would be just as good, but is declared later"
        case "chosen":
            return "it is what the policy decides"
        case _:
            return f"it would work here, in {count(steps, 'step')}; the decision also has to suit runs to other goals"


def _effort(quality: Quality) -> str:
    kind, (duration, steps) = quality
    time = f"{count(steps, 'step')}, duration {duration},"
    return {0: time, 1: f"at most {time}"}.get(kind, f"{time} if effects are nominal,").rstrip(",")


def as_json(done: Decided) -> dict[str, object]:
    """The report for a program."""
    place, decision = done.place, done.decision
    spec = place.spec
    return {
        "state": in_json(spec, decision.state),
        "decision": list(action_names(spec, decision.chosen)),
        "duration": decision.duration,
        "safe": not decision.broken,
        "broken": [{"text": rule.text, "line": rule.span.line} for rule in decision.broken],
        "goals": [
            {
                "active": note.active,
                "goal": note.body.text if note.body else None,
                "line": note.body.span.line if note.body else note.conditions[-1].span.line,
                "conditions": [rule.text for rule in note.conditions],
            }
            for note in decision.goals
        ],
        "run": _run_json(spec, decision.run),
        **({"restoring": _way_json(spec, decision)} if spec.restores_stepwise and decision.broken else {}),
        "guarantee": _guaranteed_json(spec, decision),
        "others": [_other_json(done, other) for other in ([done.asked] if done.asked else decision.others)],
    }


def _way_json(spec: Spec, decision: Decision) -> dict[str, object]:
    way = decision.way
    found: dict[str, object] = {"level": level(spec, decision.state), "levels": len(spec.tiers), "bounded": None}
    if way is None:
        return found
    steps = [
        {"actions": list(action_names(spec, step.decision)), "state": in_json(spec, step.after)} for step in way.steps
    ]
    return {**found, "bounded": way.bounded, "duration": way.effort[0], "steps": steps}


def _guaranteed_json(spec: Spec, decision: Decision) -> dict[str, object] | None:
    found = decision.guaranteed
    if found is None:
        return None
    level = {"level": "none"} if found.guarantee is None else guarantee_json(found.guarantee)
    why = None if found.shortcoming is None else shortcoming_json(spec, found.shortcoming)
    return {**level, "why_no_more": why}


def _run_json(spec: Spec, run: Run) -> dict[str, object]:
    return {
        "end": run.end,
        "steps": run.steps,
        "decisions": [list(action_names(spec, chosen)) for chosen in run.decisions],
        "states": [in_json(spec, state) for state in run.states],
    }


def _other_json(done: Decided, other: Other) -> dict[str, object]:
    place = done.place
    return {
        "actions": list(action_names(place.spec, other.chosen)),
        "verdict": other.verdict,
        "duration": other.duration,
        "reason": one_line(_sentence(place, done.decision, other)),
    }
