"""What can be dropped, one by one, and which kind is blamed first (`docs/semantics.md`, section 7: elements)."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Final, Literal, TypeAlias

from msgspec import Struct
from msgspec.structs import replace

from tumato_symbolic.diagnostics import Span
from tumato_symbolic.diagnostics.wording import one_line
from tumato_symbolic.spec import Action, Rule, Spec

ElementKind: TypeAlias = Literal[
    "state-rule", "alternative", "reaction-rule", "precondition", "assumption", "plan-bound", "resource"
]

PREFERENCE: Final[tuple[ElementKind, ...]] = (
    "state-rule",
    "alternative",
    "reaction-rule",
    "precondition",
    "assumption",
    "plan-bound",
    "resource",
)
"""Where several reasons are as good, the one whose elements come first is told."""


class Element(Struct, frozen=True):
    """One thing that a specification requires.

    `number` is that of the rule, the assumption or the first case of the action (0 for the plan bound). Of an action,
    `part` is the position of the precondition or the alternative entry, or the number of the resource.
    """

    kind: ElementKind
    number: int = 0
    part: int = 0


Elements: TypeAlias = frozenset[Element]


def elements_of(spec: Spec) -> tuple[Element, ...]:
    """Every element, ordered by kind as in `PREFERENCE`, then as declared."""
    return tuple(sorted(_elements(spec), key=lambda each: PREFERENCE.index(each.kind)))


def _elements(spec: Spec) -> Iterator[Element]:
    yield from (Element("state-rule", number) for number in range(len(spec.state_rules)))
    yield from (Element("reaction-rule", number) for number in range(len(spec.reaction_rules)))
    yield from (Element("assumption", number) for number in range(len(spec.assumptions)))
    for number, action in ((cases[0], spec.actions[cases[0]]) for cases in spec.cases):
        yield from (Element("precondition", number, part) for part in range(len(action.preconditions)))
        yield from (Element("alternative", number, part) for part in range(len(action.alternatives)))
        yield from (Element("resource", number, resource) for resource in sorted(action.resources))
    if spec.max_plan_length is not None:
        yield Element("plan-bound")


def keep_only(spec: Spec, kept: Elements) -> Spec:
    """The specification with every element dropped but `kept`; nominal effects and goals stay."""
    each = zip(spec.first_case, spec.actions, strict=True)
    return replace(
        spec,
        actions=tuple(_action(first, action, kept) for first, action in each),
        reaction_rules=_rules("reaction-rule", spec.reaction_rules, kept),
        state_rules=_rules("state-rule", spec.state_rules, kept),
        assumptions=_rules("assumption", spec.assumptions, kept),
        max_plan_length=spec.max_plan_length if Element("plan-bound") in kept else None,
    )


def without(spec: Spec, dropped: Iterable[Element]) -> Spec:
    """The specification with some elements dropped."""
    return keep_only(spec, frozenset(elements_of(spec)) - frozenset(dropped))


def _action(number: int, action: Action, kept: Elements) -> Action:
    return replace(
        action,
        resources=frozenset(held for held in action.resources if Element("resource", number, held) in kept),
        preconditions=tuple(
            rule for part, rule in enumerate(action.preconditions) if Element("precondition", number, part) in kept
        ),
        alternatives=tuple(
            entry for part, entry in enumerate(action.alternatives) if Element("alternative", number, part) in kept
        ),
    )


def _rules(kind: ElementKind, rules: tuple[Rule, ...], kept: Elements) -> tuple[Rule, ...]:
    return tuple(rule for number, rule in enumerate(rules) if Element(kind, number) in kept)


def replace_rule(spec: Spec, element: Element, rule: Rule) -> Spec:
    """The specification with another rule in the place of a state rule, a reaction rule or a precondition."""
    match element.kind:
        case "state-rule":
            return replace(spec, state_rules=_put(spec.state_rules, element.number, rule))
        case "reaction-rule":
            return replace(spec, reaction_rules=_put(spec.reaction_rules, element.number, rule))
        case "precondition":
            cases = spec.cases_from(element.number)
            rules = _put(spec.actions[element.number].preconditions, element.part, rule)
            wider = (replace(spec.actions[case], preconditions=rules) for case in cases)
            return replace(spec, actions=(*spec.actions[: cases.start], *wider, *spec.actions[cases.stop :]))
    raise ValueError(f"a {element.kind} is not replaced")


def _put(rules: tuple[Rule, ...], number: int, rule: Rule) -> tuple[Rule, ...]:
    return (*rules[:number], rule, *rules[number + 1 :])


def rule_of(spec: Spec, element: Element) -> Rule | None:
    """The rule, the assumption or the precondition that an element is; None for the other kinds."""
    match element.kind:
        case "state-rule":
            return spec.state_rules[element.number]
        case "reaction-rule":
            return spec.reaction_rules[element.number]
        case "assumption":
            return spec.assumptions[element.number]
        case "precondition":
            return spec.actions[element.number].preconditions[element.part]
        case _:
            return None


def text_of(spec: Spec, element: Element) -> str:
    """An element as the user wrote it, on one line."""
    rule = rule_of(spec, element)
    if rule is not None:
        return one_line(rule.text)
    match element.kind:
        case "alternative":
            return one_line(spec.actions[element.number].alternatives[element.part].text)
        case "resource":
            return spec.resources[element.part]
        case _:
            return f"max_plan_length: {spec.max_plan_length}"


def span_of(spec: Spec, element: Element) -> Span | None:
    """Where an element stands."""
    rule = rule_of(spec, element)
    if rule is not None:
        return rule.span
    match element.kind:
        case "alternative":
            return spec.actions[element.number].alternatives[element.part].span
        case "resource":
            return spec.actions[element.number].resource_span or spec.actions[element.number].span
        case _:
            return spec.bound_span
