"""The part of the valid states that a policy from the starts decides (`docs/semantics.md`, section 12)."""

from __future__ import annotations

from tumato_symbolic.diagrams import Diagram, Reference
from tumato_symbolic.policy.decisions.convert import as_diagram
from tumato_symbolic.policy.policy import Policy
from tumato_symbolic.spec import FALSE, TRUE, And, Formula, Is, Or, Spec


def judged_within(spec: Spec, policy: Policy) -> Spec:
    """What a policy that is bound to `spec` is judged by: where there are starts, only the states that it decides."""
    return spec.within(decided_part(policy)) if spec.starts else spec


def decided_part(policy: Policy) -> Formula:
    """Where the policy decides."""
    decisions = as_diagram(policy)
    return formula_of(decisions.diagram, decisions.defined)


def formula_of(diagram: Diagram[bool], root: Reference) -> Formula:
    """Where a diagram leads to true, as a formula that shares its parts as the diagram shares its nodes."""
    parts: list[Formula] = [TRUE if leaf else FALSE for leaf in diagram.leaves]
    for level, below in diagram.nodes:
        values: dict[int, list[Is]] = {}
        for value, child in enumerate(below):
            values.setdefault(child, []).append(Is(diagram.order[level], value))
        cases = [_case(here, parts[child]) for child, here in values.items() if parts[child] is not FALSE]
        parts.append(FALSE if not cases else cases[0] if len(cases) == 1 else Or(tuple(cases)))
    return parts[root]


def _case(values: list[Is], then: Formula) -> Formula:
    """One of the values, and what has to hold then."""
    one = values[0] if len(values) == 1 else Or(tuple(values))
    return one if then is TRUE else And((one, then))
