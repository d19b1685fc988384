"""What two specifications require otherwise: elements that were added, removed or changed."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Literal, Protocol, TypeAlias

from msgspec import Struct

from tumato_symbolic.diagnostics import Span
from tumato_symbolic.diagnostics.wording import one_line
from tumato_symbolic.spec import Action, Assignment, EffectSet, Goal, Rule, Spec, fold_goal
from tumato_symbolic.spec.canonical import canonical_text

ElementKind: TypeAlias = Literal[
    "variable",
    "action",
    "state rule",
    "reaction rule",
    "assumption",
    "start",
    "goal",
    "order of goals",
    "plan bound",
    "effect ordering",
    "restoration",
    "preconditions",
]


class Detail(Struct, frozen=True):
    """One thing about an element that was `before` and is `after`; None where it was not, or is not, there."""

    what: str
    before: str | None
    after: str | None


class Altered(Struct, frozen=True):
    """An element that only one specification has, or that differs in `details`.

    `name` is that of a variable or action, or what a rule or goal says. `old` and `new` are where it stands.
    """

    kind: ElementKind
    name: str
    old: Span | None
    new: Span | None
    how: Literal["added", "removed", "changed"]
    details: tuple[Detail, ...] = ()


def altered(old: Spec, new: Spec) -> tuple[Altered, ...]:
    """What differs in meaning: neither layout, aliases and comments count, nor the order of declaration."""
    return (
        *_variables(old, new),
        *_actions(old, new),
        *_rules("state rule", old, old.state_rules, new, new.state_rules),
        *_rules("reaction rule", old, old.reaction_rules, new, new.reaction_rules),
        *_rules("assumption", old, old.assumptions, new, new.assumptions),
        *_rules("start", old, old.starts, new, new.starts),
        *_goals(old, new),
        *_settings(old, new),
    )


def _variables(old: Spec, new: Spec) -> Iterator[Altered]:
    before, after = ({each.name: each for each in spec.variables} for spec in (old, new))
    for name in _all_names(before, after):
        one, other = before.get(name), after.get(name)
        if one is None or other is None:
            yield _one_sided("variable", name, one, other)
        else:
            gone = [Detail("value", value, None) for value in one.values if value not in other.values]
            came = [Detail("value", None, value) for value in other.values if value not in one.values]
            if gone or came:
                yield Altered("variable", name, one.span, other.span, "changed", (*gone, *came))


def _all_names(before: Mapping[str, object], after: Mapping[str, object]) -> list[str]:
    return list(dict.fromkeys((*before, *after)))


class _Standing(Protocol):
    """What stands somewhere."""

    @property
    def span(self) -> Span: ...


def _one_sided(kind: ElementKind, name: str, old: _Standing | None, new: _Standing | None) -> Altered:
    return Altered(kind, name, _span(old), _span(new), "added" if old is None else "removed")


def _span(standing: _Standing | None) -> Span | None:
    return None if standing is None else standing.span


def _actions(old: Spec, new: Spec) -> Iterator[Altered]:
    before, after = ({each.name: each for each in _first_cases(spec)} for spec in (old, new))
    for name in _all_names(before, after):
        one, other = before.get(name), after.get(name)
        if one is None or other is None:
            yield _one_sided("action", name, one, other)
        else:
            details = tuple(_details(_fields(old, one), _fields(new, other)))
            if details:
                yield Altered("action", name, one.span, other.span, "changed", details)


def _first_cases(spec: Spec) -> list[Action]:
    return [spec.actions[cases[0]] for cases in spec.cases]


_Fields: TypeAlias = Mapping[str, Mapping[str, str]]
"""By field of an action, what it has there: as it is compared, and as it is shown."""


def _fields(spec: Spec, action: Action) -> _Fields:
    nominal, *alternatives = _effects(spec, action)
    resources = [spec.resources[number] for number in action.resources]
    return {
        "duration": _same(str(action.duration)),
        "resource": {name: name for name in sorted(resources)},
        "precondition": {canonical_text(spec, rule.formula): one_line(rule.text) for rule in action.preconditions},
        "nominal effects": _same(nominal),
        "alternative effects": {each: each for each in alternatives},
    }


def _same(text: str) -> dict[str, str]:
    return {text: text}


def _details(before: _Fields, after: _Fields) -> Iterator[Detail]:
    for field, one in before.items():
        other = after[field]
        gone = [shown for key, shown in one.items() if key not in other]
        came = [shown for key, shown in other.items() if key not in one]
        if len(gone) == len(came) == 1:
            yield Detail(field, gone[0], came[0])
        else:
            yield from (Detail(field, text, None) for text in gone)
            yield from (Detail(field, None, text) for text in came)


def _effects(spec: Spec, action: Action) -> list[str]:
    """The nominal effects and every alternative, as texts that are equal where they mean the same."""
    if action.written:
        nominal, *others = (_effect_set(spec, each) for each in action.written)
    else:
        nominal = _assignment(spec, action.nominal)
        others = [_assignment(spec, each) for each in action.effects[1:]]
    return [nominal, *dict.fromkeys(others)]


def _assignment(spec: Spec, assignment: Assignment) -> str:
    written = sorted(
        f"{spec.variables[number].name} is {spec.variables[number].values[value]}" for number, value in assignment
    )
    return ", ".join(written) or "none"


def _effect_set(spec: Spec, effects: EffectSet) -> str:
    plain = sorted({canonical_text(spec, each) for each in effects.effects})
    clauses = sorted(
        f"when {canonical_text(spec, condition)}: {', '.join(sorted(canonical_text(spec, each) for each in then))}"
        for condition, then in effects.clauses
    )
    return "; ".join((*([", ".join(plain)] if plain else []), *clauses)) or "none"


def _rules(kind: ElementKind, old: Spec, before: Sequence[Rule], new: Spec, after: Sequence[Rule]) -> Iterator[Altered]:
    ours = {canonical_text(old, rule.formula): rule for rule in before}
    theirs = {canonical_text(new, rule.formula): rule for rule in after}
    for key in _all_names(ours, theirs):
        one, other = ours.get(key), theirs.get(key)
        text = one_line((one or theirs[key]).text)
        if one is None or other is None:
            yield _one_sided(kind, text, one, other)
        elif _tier(old, one) != _tier(new, other):
            detail = Detail("severity", str(one.severity), str(other.severity))
            yield Altered(kind, text, one.span, other.span, "changed", (detail,))


def _tier(spec: Spec, rule: Rule) -> int:
    """Which tier a state rule belongs to; 0 for all other rules."""
    return next((number for number, tier in enumerate(spec.tiers) if rule in tier), 0)


def _goals(old: Spec, new: Spec) -> Iterator[Altered]:
    before, after = _listed_goals(old), _listed_goals(new)
    found = [
        _one_sided("goal", (before.get(key) or after[key]).text, before.get(key), after.get(key))
        for key in _all_names(before, after)
        if (key in before) != (key in after)
    ]
    yield from found
    if not found and _outline(old) != _outline(new):
        yield Altered("order of goals", "", _span(old.goals), _span(new.goals), "changed")


class _ListedGoal(Struct, frozen=True):
    """A simple goal with the conditions on the way to it."""

    text: str
    span: Span


def _listed_goals(spec: Spec) -> dict[str, _ListedGoal]:
    """All of them, by what they mean."""
    if spec.goals is None:
        return {}
    found: list[tuple[str, str, Span]] = fold_goal(
        spec.goals,
        lambda simple: [(*_both_texts(spec, "goal: ", spec.bodies[simple.body], ""), simple.span)],
        lambda conditional, inner: [
            (f"{when}{key}", f"{shown}{text}", span)
            for when, shown in [_both_texts(spec, "when ", conditional.condition, " then ")]
            for key, text, span in inner
        ],
        lambda _, members: [each for member in members for each in member],
    )
    return {key: _ListedGoal(text, span) for key, text, span in reversed(found)}


def _both_texts(spec: Spec, before: str, rule: Rule, after: str) -> tuple[str, str]:
    """What a rule means, and what it says."""
    return f"{before}{canonical_text(spec, rule.formula)}{after}", f"{before}{one_line(rule.text)}{after}"


def _outline(spec: Spec) -> object:
    """The tree of goals; in constraint lists the order does not matter."""
    return None if spec.goals is None else _outlined(spec, spec.goals)


def _outlined(spec: Spec, goal: Goal) -> str:
    return fold_goal(
        goal,
        lambda simple: canonical_text(spec, spec.bodies[simple.body].formula),
        lambda conditional, inner: f"when {canonical_text(spec, conditional.condition.formula)} ({inner})",
        lambda goals, members: f"{goals.kind} {sorted(members) if goals.kind == 'constraint' else members}",
    )


def _settings(old: Spec, new: Spec) -> Iterator[Altered]:
    settings: tuple[tuple[ElementKind, object, object], ...] = (
        ("plan bound", old.max_plan_length, new.max_plan_length),
        ("effect ordering", old.ordering, new.ordering),
        ("restoration", old.restoration, new.restoration),
        ("preconditions", old.preconditions, new.preconditions),
    )
    for kind, one, other in settings:
        if one != other:
            shown = (None if each is None else str(each) for each in (one, other))
            yield Altered(kind, "", old.bound_span, new.bound_span, "changed", (Detail("", *shown),))
