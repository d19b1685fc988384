"""Which parts of a goal can never come true, whatever is dropped."""

from __future__ import annotations

from collections.abc import Iterator

from msgspec.structs import replace

from tumato_symbolic.explain.as_predicates import conjunction
from tumato_symbolic.explain.explanation import OwnGoal
from tumato_symbolic.explain.minimize import minimal
from tumato_symbolic.explain.requirements import Requirements
from tumato_symbolic.game import Problem, distances, winning
from tumato_symbolic.semantics import State, active_goals
from tumato_symbolic.spec import And, Formula, Not, Or, Rule
from tumato_symbolic.symbolic import Encoding, targets


def own_goals(requirements: Requirements, state: State) -> tuple[OwnGoal, ...]:
    """The active goals of a state, each with the parts that no run of nominal effects makes true."""
    bodies = sorted(active_goals(requirements.spec, state))
    never = {body: tuple(_never(requirements, state, body)) for body in bodies}
    clash = frozenset[int]()
    if not any(never.values()) and not _together(requirements, state, frozenset(bodies)):
        clash = minimal(bodies, lambda some: not _together(requirements, state, some))
    return tuple(OwnGoal(body, never[body], body in clash) for body in bodies)


def _together(requirements: Requirements, state: State, bodies: frozenset[int]) -> bool:
    """Whether some run meets these goals at once."""
    rules = [requirements.spec.bodies[body] for body in sorted(bodies)]
    whole = conjunction([rule.formula for rule in rules])
    return not rules or _can_be_met(requirements, state, rules[0], whole)


def _never(requirements: Requirements, state: State, body: int) -> Iterator[Formula]:
    rule = requirements.spec.bodies[body]
    return (part for part in _conjuncts(rule.formula) if not _can_be_met(requirements, state, rule, part))


def _conjuncts(formula: Formula) -> Iterator[Formula]:
    """The parts that all have to hold."""
    match formula:
        case And(operands):
            for part in operands:
                yield from _conjuncts(part)
        case Not(Or(operands)):
            for part in operands:
                yield from _conjuncts(Not(part))
        case Not(Not(operand)):
            yield from _conjuncts(operand)
        case _:
            yield formula


def _can_be_met(requirements: Requirements, state: State, rule: Rule, part: Formula) -> bool:
    """Whether some run from a state meets one part of a goal, with every element dropped."""
    spec = replace(requirements.encoding.spec, bodies=(replace(rule, formula=part),), max_plan_length=None)
    steps = replace(requirements.steps(frozenset()), encoding=Encoding.of(requirements.encoding, spec))
    region = {frozenset((0,)): requirements.encoding.state_cube(state)}
    problem = Problem(spec, steps, region, tuple(targets(steps, region)))
    return winning(problem, distances(problem), steps.allowed) != requirements.false
