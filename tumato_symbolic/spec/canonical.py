"""The digest of a specification, and canonical texts: they depend on the meaning only."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable
from typing import Any

from tumato_symbolic.spec.by_action import executing_actions
from tumato_symbolic.spec.fold import Connectives, fold, fold_goal
from tumato_symbolic.spec.formula import Executing, Formula, Is
from tumato_symbolic.spec.specification import Action, Assignment, EffectSet, Goal, Rule, Spec

_VERSION = 1
"""Part of every digest; changes when the same meaning would be digested differently."""


def canonical_text(spec: Spec, formula: Formula) -> str:
    """A formula by names, with all parentheses.

    The structure is kept as it is, operands in their order: two formulas over the same names have the same text
    exactly when they are equal. Which position a variable, value or action was declared in plays no part.
    """

    def atom(atom: Is | Executing) -> str:
        if isinstance(atom, Executing):
            return f"executing {spec.actions[atom.action].name}"
        variable = spec.variables[atom.variable]
        return f"{variable.name} is {variable.values[atom.value]}"

    return fold(executing_actions(spec, formula), atom, _TEXTS)


_TEXTS: Connectives[str] = Connectives(
    constant=lambda value: "true" if value else "false",
    negation=lambda text: f"NOT ({text})",
    conjunction=lambda texts: " AND ".join(f"({text})" for text in texts),
    disjunction=lambda texts: " OR ".join(f"({text})" for text in texts),
    equivalence=lambda left, right: f"({left}) IFONLYIF ({right})",
)


def digest(spec: Spec) -> str:
    """`sha256:…` of the meaning of a specification.

    Comments, layout, aliases, resources that nothing controls, and the order of rules, actions, resources, variables
    and values do not matter; `effect_ordering` and `restoration` are left out, since policies record them themselves.
    """
    meaning: dict[str, Any] = {
        "version": _VERSION,
        "variables": {each.name: sorted(each.values) for each in spec.variables},
        "actions": {spec.actions[cases[0]].name: _action(spec, spec.actions[cases[0]]) for cases in spec.cases},
        "reaction_rules": _texts(spec, spec.reaction_rules),
        "state_rules": _texts(spec, spec.state_rules),
        "assumptions": _texts(spec, spec.assumptions),
        "goals": None if spec.goals is None else _goal(spec, spec.goals),
        "max_plan_length": spec.max_plan_length,
    }
    if len(spec.tiers) > 1:
        meaning["severities"] = [_texts(spec, tier) for tier in spec.tiers]
    if spec.preconditions != "at_start":
        meaning["preconditions"] = spec.preconditions
    if spec.starts:
        meaning["starts"] = _texts(spec, spec.starts)
    text = json.dumps(meaning, sort_keys=True, separators=(",", ":"), ensure_ascii=True)
    return f"sha256:{hashlib.sha256(text.encode('ascii')).hexdigest()}"


def _texts(spec: Spec, rules: Iterable[Rule]) -> list[str]:
    return sorted({canonical_text(spec, rule.formula) for rule in rules})


def _action(spec: Spec, action: Action) -> dict[str, Any]:
    found = {
        "duration": action.duration,
        "resources": sorted(spec.resources[number] for number in action.resources),
        "preconditions": _texts(spec, action.preconditions),
    }
    if action.written:
        nominal, *alternatives = (_effect_set(spec, each) for each in action.written)
        return {**found, "nominal": nominal, "alternatives": _each_once(alternatives)}
    return {
        **found,
        "nominal": _assignment(spec, action.nominal),
        "alternatives": sorted(
            (_assignment(spec, outcome) for outcome in action.effects[1:]), key=lambda each: sorted(each.items())
        ),
    }


def _effect_set(spec: Spec, effects: EffectSet) -> dict[str, Any]:
    clauses = [
        [canonical_text(spec, condition), sorted({canonical_text(spec, each) for each in then})]
        for condition, then in effects.clauses
    ]
    return {
        "effects": sorted({canonical_text(spec, each) for each in effects.effects}),
        "clauses": _each_once(clauses),
    }


def _each_once(values: Iterable[Any]) -> list[Any]:
    """Values of JSON, sorted."""
    return [json.loads(text) for text in sorted({json.dumps(each, sort_keys=True) for each in values})]


def _assignment(spec: Spec, assignment: Assignment) -> dict[str, str]:
    return {spec.variables[number].name: spec.variables[number].values[value] for number, value in assignment}


def _goal(spec: Spec, goal: Goal) -> list[Any]:
    """The order of goals matters in a priority list only."""
    return fold_goal(
        goal,
        lambda simple: ["goal", canonical_text(spec, spec.bodies[simple.body].formula)],
        lambda conditional, inner: ["when", canonical_text(spec, conditional.condition.formula), inner],
        lambda goals, members: [
            goals.kind,
            *(sorted(members, key=json.dumps) if goals.kind == "constraint" else members),
        ],
    )
