"""The truth of predicates while some actions are still open."""

from __future__ import annotations

from tumato_symbolic.semantics.states import ActionSet, State
from tumato_symbolic.spec import THREE_VALUED, Executing, Formula, Is, fold


def settled_truth(formula: Formula, state: State, executed: ActionSet, idle: ActionSet) -> bool | None:
    """The truth value of `formula` in `state`, if the actions that are neither executed nor idle cannot change it.

    None where they may (Kleene's strong three-valued logic: a value that is returned is right, None is cautious).
    """

    def atom(atom: Is | Executing) -> bool | None:
        if isinstance(atom, Is):
            return state[atom.variable] == atom.value
        return True if atom.action in executed else False if atom.action in idle else None

    return fold(formula, atom, THREE_VALUED)
