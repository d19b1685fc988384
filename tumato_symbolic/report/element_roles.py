"""The part that each element of a core plays, in a sentence."""

from __future__ import annotations

from tumato_symbolic.explain.elements import Element, ElementKind, rule_of, span_of, text_of
from tumato_symbolic.explain.explanation import Reason
from tumato_symbolic.report.layout import count, enumeration
from tumato_symbolic.report.objections import Place
from tumato_symbolic.semantics import case_in, holds
from tumato_symbolic.spec import Spec

KINDS: dict[ElementKind, str] = {
    "state-rule": "state rule",
    "reaction-rule": "reaction rule",
    "assumption": "assumption",
    "precondition": "precondition",
    "alternative": "alternative effect",
    "resource": "controlled resource",
    "plan-bound": "plan bound",
}


def role(place: Place, element: Element, core: tuple[Element, ...], reason: Reason) -> str:
    """What an element does to the example of a reason, together with the rest of the core."""
    spec = place.spec
    match element.kind:
        case "state-rule":
            return _state_rule(place, element, reason)
        case "assumption":
            return "no outcome may leave the states that are assumed"
        case "reaction-rule":
            return "this reaction rule forbids the sets of actions that would work"
        case "precondition":
            name, rule = spec.actions[element.number].name, rule_of(spec, element)
            here = rule is None or holds(rule.formula, reason.example)
            return f"`{name}` may only start where this holds{'' if here else ', which it does not in the example'}"
        case "alternative":
            action = spec.actions[case_in(spec, spec.action_of(element.number), reason.example)]
            written = [place.assignment(outcome) for outcome in action.alternatives[element.part].outcomes]
            ends = enumeration(written, "or") if any(written) else "no change"
            return f"`{action.name}` may end with {ends} instead of its nominal effect"
        case "resource":
            return _resource(place, element, core)
        case "plan-bound":
            longest = f"a plan may have at most {count(spec.max_plan_length or 0, 'step')}"
            needed = reason.shortest_plan
            return longest if needed is None else f"{longest}; the shortest from the example has {needed}"


def _state_rule(place: Place, element: Element, reason: Reason) -> str:
    if reason.kind == "conflict":
        return "every outcome has to keep this rule"
    if holds(place.spec.state_rules[element.number].formula, reason.example):
        return "every outcome has to keep this rule"
    return "this rule is broken in the example, and every outcome has to restore it"


def _resource(place: Place, element: Element, core: tuple[Element, ...]) -> str:
    actions, resource = place.spec.actions, place.spec.resources[element.part]
    name = actions[element.number].name
    others = [f"`{actions[each.number].name}`" for each in core if _competes(each, element)]
    return f"`{name}` needs {resource}, so it cannot run together with {enumeration(others)}"


def _competes(each: Element, element: Element) -> bool:
    return each.kind == "resource" and each.part == element.part and each.number != element.number


def where(place: Place, element: Element) -> str:
    """`file:line`."""
    span = span_of(place.spec, element)
    return place.file if span is None else f"{place.file}:{span.line}"


_FIELDS: dict[ElementKind, str] = {
    "state-rule": "rule: ",
    "reaction-rule": "rule: ",
    "assumption": "assume: ",
    "precondition": "preconditions: ",
    "alternative": "alternative effects: ",
    "resource": "controlled resources: ",
    "plan-bound": "",
}


def declared(spec: Spec, element: Element, text: str | None = None) -> str:
    """An element, or a text in its place, as it stands in the specification."""
    return _FIELDS[element.kind] + (text_of(spec, element) if text is None else text)
