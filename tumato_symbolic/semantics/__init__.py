"""The meaning of specifications: explicit, one state at a time, slow and plain. See `docs/semantics.md`."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from tumato_symbolic.semantics.cases import actions_of, case_in, cases_in, without_cases
from tumato_symbolic.semantics.exclusion import (
    Contest,
    contested_resources,
    contested_values,
    excluded,
    exclusive_groups,
)
from tumato_symbolic.semantics.goals import (
    ActiveGoals,
    Residual,
    active_goals,
    goals_as_written,
    reached,
    residual_goal,
)
from tumato_symbolic.semantics.guarantees import Guarantee, Prospects, guarantees, steps_from
from tumato_symbolic.semantics.judge import Judgement, better_sets, judge
from tumato_symbolic.semantics.restoration import AT_ONCE, Effort, Quality, Restorations, longer, restored
from tumato_symbolic.semantics.runs import End, Run, follow
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
    in_json,
    is_safe,
    is_start,
    is_valid,
    level,
    named,
    required_rules,
    state_text,
)
from tumato_symbolic.semantics.step import (
    EffectSequence,
    EffectStep,
    Objection,
    allowed,
    allowed_sets,
    broken_rule,
    falsified,
    fault_after,
    first_broken,
    next_states,
    nominal_agrees,
    objections,
    outcomes,
    outcomes_in_turn,
    pending,
    replay,
    successor,
    takes_effect,
)

if TYPE_CHECKING:
    from tumato_symbolic.semantics.partial import settled_truth
    from tumato_symbolic.semantics.shortcomings import Shortcoming, Shortcomings, shows
    from tumato_symbolic.semantics.traces import Disturbance, Event, Move, Trace, moves_from

_LATER = {
    "settled_truth": "partial",
    **dict.fromkeys(("Shortcoming", "Shortcomings", "shows"), "shortcomings"),
    **dict.fromkeys(("Disturbance", "Event", "Move", "Trace", "moves_from"), "traces"),
}


def __getattr__(name: str) -> Any:  # noqa: ANN401 - the kinds differ, and type checkers read the imports above
    """Executions, and what they show, are imported on first use: a synthesis and a proof need none."""
    if name not in _LATER:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_LATER[name]}"), name)
