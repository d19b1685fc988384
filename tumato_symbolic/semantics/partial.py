"""The truth of predicates while some actions are still open."""

from __future__ import annotations

from tumato_symbolic.semantics.states import ActionSet, State
from tumato_symbolic.spec import And, Constant, Executing, Formula, Iff, Is, Not, Or


def settled_truth(formula: Formula, state: State, executed: ActionSet, idle: ActionSet) -> bool | None:
    """The truth value of `formula` in `state`, if the actions that are neither executed nor idle cannot change it.

    None where they may (Kleene's strong three-valued logic: a value that is returned is right, None is cautious).
    """
    match formula:
        case Constant(value):
            return value
        case Is(variable, number):
            return state[variable] == number
        case Executing(action):
            return True if action in executed else False if action in idle else None
        case Not(operand):
            truth = settled_truth(operand, state, executed, idle)
            return None if truth is None else not truth
        case And(operands):
            values = [settled_truth(part, state, executed, idle) for part in operands]
            return False if False in values else None if None in values else True
        case Or(operands):
            values = [settled_truth(part, state, executed, idle) for part in operands]
            return True if True in values else None if None in values else False
        case Iff(left, right):
            sides = [settled_truth(side, state, executed, idle) for side in (left, right)]
            return None if None in sides else sides[0] == sides[1]
