"""The remark about a policy that leaves the region of a goal on the way to it."""

from __future__ import annotations

from tumato_symbolic.diagnostics import Code, Diagnostic, Note
from tumato_symbolic.game import Problem
from tumato_symbolic.policy import Policy
from tumato_symbolic.semantics import (
    ActionSet,
    State,
    active_goals,
    cases_in,
    named,
    reached,
    residual_goal,
    state_text,
    successor,
)
from tumato_symbolic.spec import Spec
from tumato_symbolic.symbolic import Bdd


def leaving(problem: Problem, policy: Policy, states: Bdd) -> tuple[Diagnostic, ...]:
    """The remark, where no run from some safe states stays where their goals are active; `states` are these."""
    if states == problem.false:
        return ()
    spec, encoding = problem.spec, problem.encoding
    state = encoding.first_state(states)
    there = _first_outside(spec, policy, state)
    if there is None:
        return ()
    own, other = active_goals(spec, state), active_goals(spec, there)
    count = encoding.count_states(states)
    places = "1 safe state" if count == 1 else f"{count:,} safe states"
    message = (
        f"in {places} the way to the goal leads through states where other goals are active. For example the run from "
        f"{state_text(spec, state)} passes {state_text(spec, there)}"
    )
    way_out = (
        "the policy serves the goals of every state that it is in; the conditions after `when` say which these are"
    )
    notes = tuple(Note("this goal is active there", spec.bodies[body].span) for body in sorted(other - own)[:1])
    return (Diagnostic(Code.TUM356, message, spec.bodies[min(own)].span, way_out, notes),)


def _first_outside(spec: Spec, policy: Policy, start: State) -> State | None:
    """The first state of a nominal run where other goals are active than at its start, if it passes one."""
    numbers = {name: number for number, name in enumerate(spec.action_names)}

    def decision(state: State) -> ActionSet:
        return cases_in(spec, (numbers[name] for name in policy.decide(named(spec, state))), state)

    here, goal = start, residual_goal(spec, start, decision(start))
    while active_goals(spec, here) == goal.bodies:
        here = successor(spec, here, decision(here))
        if reached(spec, goal, here):
            return None
    return here
