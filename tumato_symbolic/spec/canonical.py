"""Texts and digests that depend on the meaning only, not on how it is written down."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable
from typing import Any

from tumato_symbolic.spec.formula import And, Constant, Executing, Formula, Iff, Is, Not, Or
from tumato_symbolic.spec.model import Action, Assignment, ConditionalGoal, Goal, Rule, SimpleGoal, Spec

_VERSION = 1
"""Part of every digest; changes when the same meaning would be digested differently."""


def canonical_text(spec: Spec, formula: Formula) -> str:
    """A formula by names, with all parentheses.

    The structure is kept as it is, operands in their order: two formulas over the same names have the same text
    exactly when they are equal. Which position a variable, value or action was declared in plays no part.
    """
    match formula:
        case Constant(value):
            return "true" if value else "false"
        case Is(variable, value):
            return f"{spec.variables[variable].name} is {spec.variables[variable].values[value]}"
        case Executing(action):
            return f"executing {spec.actions[action].name}"
        case Not(operand):
            return f"NOT ({canonical_text(spec, operand)})"
        case And(operands):
            return " AND ".join([f"({canonical_text(spec, part)})" for part in operands])
        case Or(operands):
            return " OR ".join([f"({canonical_text(spec, part)})" for part in operands])
        case Iff(left, right):
            return f"({canonical_text(spec, left)}) IFONLYIF ({canonical_text(spec, right)})"


def digest(spec: Spec) -> str:
    """`sha256:…` of the meaning of a specification.

    Comments, layout, aliases, resources that nothing controls, and the order of rules, actions, resources, variables
    and values do not matter; `effect_ordering` is left out, since policies record it themselves.
    """
    meaning = {
        "version": _VERSION,
        "variables": {each.name: sorted(each.values) for each in spec.variables},
        "actions": {each.name: _action(spec, each) for each in spec.actions},
        "reaction_rules": _texts(spec, spec.reaction_rules),
        "state_rules": _texts(spec, spec.state_rules),
        "assumptions": _texts(spec, spec.assumptions),
        "goals": None if spec.goals is None else _goal(spec, spec.goals),
        "max_plan_length": spec.max_plan_length,
    }
    text = json.dumps(meaning, sort_keys=True, separators=(",", ":"), ensure_ascii=True)
    return f"sha256:{hashlib.sha256(text.encode('ascii')).hexdigest()}"


def _texts(spec: Spec, rules: Iterable[Rule]) -> list[str]:
    return sorted({canonical_text(spec, rule.formula) for rule in rules})


def _action(spec: Spec, action: Action) -> dict[str, Any]:
    return {
        "duration": action.duration,
        "resources": sorted(spec.resources[number] for number in action.resources),
        "preconditions": _texts(spec, action.preconditions),
        "nominal": _assignment(spec, action.nominal),
        "alternatives": sorted(
            (_assignment(spec, outcome) for outcome in action.effects[1:]), key=lambda each: sorted(each.items())
        ),
    }


def _assignment(spec: Spec, assignment: Assignment) -> dict[str, str]:
    return {spec.variables[number].name: spec.variables[number].values[value] for number, value in assignment}


def _goal(spec: Spec, goal: Goal) -> list[Any]:
    """The order of goals matters in a priority list only."""
    if isinstance(goal, SimpleGoal):
        return ["goal", canonical_text(spec, spec.bodies[goal.body].formula)]
    if isinstance(goal, ConditionalGoal):
        return ["when", canonical_text(spec, goal.condition.formula), _goal(spec, goal.goal)]
    members = [_goal(spec, each) for each in goal.members]
    return [goal.kind, *(sorted(members, key=json.dumps) if goal.kind == "constraint" else members)]
