"""The meaning of specifications: explicit, one state at a time, slow and plain. See `docs/semantics.md`."""

from tumato_symbolic.semantics.goals import ActiveGoals, Residual, active_goals, reached, residual_goal
from tumato_symbolic.semantics.judge import Judgement, better_sets, judge
from tumato_symbolic.semantics.partial import settled_truth
from tumato_symbolic.semantics.runs import Run, follow
from tumato_symbolic.semantics.states import (
    NOTHING,
    ActionSet,
    State,
    action_names,
    all_states,
    apply,
    count_states,
    duration,
    holds,
    is_safe,
    is_valid,
    named,
)
from tumato_symbolic.semantics.step import (
    Effectuation,
    Objection,
    Outcome,
    allowed,
    allowed_sets,
    broken_rule,
    nominal_agrees,
    objections,
    outcomes,
    successor,
)

__all__ = [
    "NOTHING",
    "ActionSet",
    "ActiveGoals",
    "Effectuation",
    "Judgement",
    "Objection",
    "Outcome",
    "Residual",
    "Run",
    "State",
    "action_names",
    "active_goals",
    "all_states",
    "allowed",
    "allowed_sets",
    "apply",
    "better_sets",
    "broken_rule",
    "count_states",
    "duration",
    "follow",
    "holds",
    "is_safe",
    "is_valid",
    "judge",
    "named",
    "nominal_agrees",
    "objections",
    "outcomes",
    "reached",
    "residual_goal",
    "settled_truth",
    "successor",
]
