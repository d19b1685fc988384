"""What is right, by the explicit meaning: `semantics.judge`, and the claims of a certificate one by one.

A policy file is right with `--strict` when the policy is sound, complete and minimal, and its certificate, if there is
one, carries the digest of the specification and claims nothing false (`docs/certificate.md`).
"""

from __future__ import annotations

from tumato_symbolic.policy import Certificate, Policy, as_table, bind
from tumato_symbolic.semantics import (
    ActionSet,
    Residual,
    State,
    all_states,
    allowed,
    count_states,
    is_safe,
    is_valid,
    judge,
    nominal_agrees,
    reached,
    residual_goal,
    successor,
)
from tumato_symbolic.spec import Ordering, Spec, canonical_text, digest, executing_atoms

Rows = dict[State, ActionSet]
Numbers = dict[State, int | None]


def is_right(policy: Policy, spec: Spec) -> bool:
    """Whether a policy that was read for a specification passes `--strict`."""
    bound = bind(policy, spec)
    ordering: Ordering = spec.effect_ordering or "any"
    if (bound.ordering, ordering) == ("first", "any"):
        return False
    table = as_table(bound, count_states(spec))
    assert table is not None
    rows = dict(table.rows)
    judgement = judge(spec, rows, ordering)
    return judgement.sound_and_complete and judgement.minimal and claims_hold(bound, spec, rows, ordering)


def claims_hold(policy: Policy, spec: Spec, rows: Rows, ordering: Ordering) -> bool:
    """Whether there is no certificate, or one for this specification that claims nothing false."""
    if policy.certificate is None and policy.certificate_problem is None:
        return True
    if policy.digest != digest(spec) or policy.certificate is None:
        return False
    ranks = _ranks(policy.certificate, spec)
    return (
        ranks is not None
        and all(_decreases(spec, rows, goal, numbers) for goal, numbers in ranks.items())
        and all(_within_bound(spec, rows, ranks, state, ordering) for state in rows if is_valid(spec, state))
    )


def _ranks(certificate: Certificate, spec: Spec) -> dict[Residual, Numbers] | None:
    """The numbers of the safe states; None where an entry is about no goal, or about one that another is about."""
    bodies = {canonical_text(spec, body.formula): number for number, body in enumerate(spec.bodies)}
    names = [action.name for action in spec.actions]
    safe = [state for state in all_states(spec) if is_valid(spec, state) and is_safe(spec, state)]
    found: dict[Residual, Numbers] = {}
    for entry in certificate.goals:
        if not set(entry.bodies) <= set(bodies):
            return None
        goal = Residual(frozenset(bodies[text] for text in entry.bodies), frozenset(map(names.index, entry.executed)))
        spoken_of = {action for body in goal.bodies for action in executing_atoms(spec.bodies[body].formula)}
        if goal in found or not goal.executed <= spoken_of:
            return None
        found[goal] = {state: certificate.ranks.evaluate(entry.root, state) for state in safe}
    return found


def _decreases(spec: Spec, rows: Rows, goal: Residual, numbers: Numbers) -> bool:
    """Every number is true: 0 where the goal holds, and otherwise more than that of the next state, which has one."""
    for state, number in numbers.items():
        if number == 0 and not reached(spec, goal, state):
            return False
        if number:
            if state not in rows or not nominal_agrees(spec, rows[state]):
                return False
            following = numbers.get(successor(spec, state, rows[state]))
            if following is None or following >= number:
                return False
    return True


def _within_bound(spec: Spec, rows: Rows, ranks: dict[Residual, Numbers], state: State, ordering: Ordering) -> bool:
    """The state that follows one with a goal has no number for it, or one below the bound."""
    goal = residual_goal(spec, state, rows[state])
    if not goal.bodies or spec.max_plan_length is None or not allowed(spec, state, rows[state], ordering):
        return True
    number = ranks.get(goal, {}).get(successor(spec, state, rows[state]))
    return number is None or number < spec.max_plan_length
