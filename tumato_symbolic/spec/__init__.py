"""Specifications: names resolved, aliases expanded, effects normalised."""

from typing import TYPE_CHECKING

from tumato_symbolic.spec.by_action import executing_actions
from tumato_symbolic.spec.canonical import canonical_text, digest
from tumato_symbolic.spec.fold import FORMULAS, THREE_VALUED, Connectives, active_bodies, fold, fold_goal, subgoals
from tumato_symbolic.spec.formula import (
    FALSE,
    TRUE,
    And,
    Constant,
    Executing,
    Formula,
    Iff,
    Is,
    Not,
    Or,
    conjuncts,
    executing_atoms,
    variables_of,
)
from tumato_symbolic.spec.many_goals import GoalParameters, goal_parameters
from tumato_symbolic.spec.specification import (
    Action,
    Alternative,
    Assignment,
    ConditionalGoal,
    EffectSet,
    Goal,
    GoalList,
    Ordering,
    Restoration,
    Rule,
    SimpleGoal,
    Spec,
    Variable,
)
from tumato_symbolic.spec.value_kinds import Value, text_of, value_of

if TYPE_CHECKING:
    from tumato_symbolic.spec.loading import Loaded, load


def __getattr__(name: str) -> object:
    """Reading texts is imported on first use: those who work with specifications alone need not pay for it."""
    if name not in ("load", "Loaded"):
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from tumato_symbolic.spec import loading

    return getattr(loading, name)
