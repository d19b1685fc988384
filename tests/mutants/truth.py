"""What is right, by the explicit meaning: `semantics.judge`, and the claims of a certificate one by one.

A policy file is right with `--strict` when the policy is sound, complete and minimal, and its certificate, if there is
one, carries the digest of the specification and claims nothing false (`docs/certificate.md`).
"""

from __future__ import annotations

from tumato_symbolic.policy import Certificate, Deviation, Policy, as_table, bind, restores_less
from tumato_symbolic.semantics import (
    AT_ONCE,
    ActionSet,
    Effort,
    Residual,
    State,
    all_states,
    allowed,
    count_states,
    duration,
    follow,
    is_safe,
    is_valid,
    judge,
    next_states,
    nominal_agrees,
    reached,
    residual_goal,
    restored,
    successor,
)
from tumato_symbolic.semantics.judge import one_of
from tumato_symbolic.spec import Ordering, Spec, canonical_text, digest, executing_atoms

Rows = dict[State, ActionSet]
Numbers = dict[State, int | None]
Efforts = dict[State, Effort | None]


def is_right(policy: Policy, spec: Spec) -> bool:
    """Whether a policy that was read for a specification passes `--strict`."""
    bound = bind(policy, spec)
    ordering: Ordering = spec.effect_ordering or "any"
    if (bound.ordering, ordering) == ("first", "any") or restores_less(bound, spec):
        return False
    rows = decisions(policy, spec)
    return is_right_policy(spec, rows, ordering) and claims_hold(bound, spec, rows, ordering)


def decisions(policy: Policy, spec: Spec) -> Rows:
    """What a policy decides, as the specification numbers states and actions."""
    table = as_table(bind(policy, spec), count_states(spec))
    assert table is not None
    return dict(table.rows)


def is_right_policy(spec: Spec, rows: Rows, ordering: Ordering) -> bool:
    """Whether decisions are sound, complete and minimal, whatever is claimed of them."""
    judgement = judge(spec, rows, ordering)
    return judgement.sound_and_complete and judgement.minimal


def claims_hold(policy: Policy, spec: Spec, rows: Rows, ordering: Ordering) -> bool:
    """Whether there is no certificate, or one for this specification that claims nothing false."""
    if policy.certificate is None and policy.certificate_problem is None:
        return True
    if policy.digest != digest(spec) or policy.certificate is None:
        return False
    if spec.starts:
        spec = spec.within(one_of({state for state in rows if is_valid(spec, state)}))
    ranks = _ranks(policy.certificate, spec)
    return (
        ranks is not None
        and all(_decreases(spec, rows, goal, numbers) for goal, numbers in ranks.items())
        and all(_within_bound(spec, rows, ranks, state, ordering) for state in rows if is_valid(spec, state))
        and _restoring_holds(policy.certificate, spec, rows, ordering)
    )


def _ranks(certificate: Certificate, spec: Spec) -> dict[Residual, Numbers] | None:
    """The numbers of the states that ranks speak of; None where an entry is about no goal, or doubles another one."""
    bodies = {canonical_text(spec, body.formula): number for number, body in enumerate(spec.bodies)}
    actions = {spec.actions[cases[0]].name: cases[0] for cases in spec.cases}
    everywhere = spec.restores_stepwise and certificate.restoring is not None
    valid = [state for state in all_states(spec) if is_valid(spec, state)]
    covered = [state for state in valid if everywhere or is_safe(spec, state)]
    found: dict[Residual, Numbers] = {}
    for entry in certificate.goals:
        if not set(entry.bodies) <= set(bodies):
            return None
        executed = frozenset(actions[name] for name in entry.executed)
        goal = Residual(frozenset(bodies[text] for text in entry.bodies), executed)
        mentioned = {action for body in goal.bodies for action in executing_atoms(spec.bodies[body].formula)}
        if goal in found or not goal.executed <= mentioned:
            return None
        found[goal] = {state: certificate.ranks.evaluate(entry.root, state) for state in covered}
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
    nothing_pending = not goal.bodies and (is_safe(spec, state) or not spec.restores_stepwise)
    if nothing_pending or spec.max_plan_length is None or not allowed(spec, state, rows[state], ordering):
        return True
    number = ranks.get(goal, {}).get(successor(spec, state, rows[state]))
    return number is None or number < spec.max_plan_length


def _restoring_holds(certificate: Certificate, spec: Spec, rows: Rows, ordering: Ordering) -> bool:
    """Whether every effort and every deviation is true; in one step they claim nothing."""
    restoring = certificate.restoring
    if not spec.restores_stepwise or restoring is None:
        return True
    unsafe = [state for state in all_states(spec) if is_valid(spec, state) and not is_safe(spec, state)]
    worst = {state: restoring.efforts.evaluate(restoring.worst, state) for state in unsafe}
    nominal = {state: restoring.efforts.evaluate(restoring.nominal, state) for state in unsafe}
    return (
        all(_worst_is_true(spec, rows, worst, state, ordering) for state in unsafe)
        and (spec.restoration != "fair" or all(_nominal_is_true(spec, rows, worst, nominal, state) for state in unsafe))
        and all(_misses(spec, rows, deviation) for deviation in restoring.deviations)
    )


def _worst_is_true(spec: Spec, rows: Rows, worst: Efforts, state: State, ordering: Ordering) -> bool:
    """Null, or enough for every state that may follow."""
    effort = worst[state]
    if effort is None:
        return True
    if not _acts(spec, rows, state):
        return False
    after = [each for each in next_states(spec, state, rows[state], ordering) if not restored(spec, state, each)]
    left = [worst.get(each) for each in after]
    return all(each is not None and effort >= _longer(spec, rows[state], each) for each in [*left, AT_ONCE])


def _nominal_is_true(spec: Spec, rows: Rows, worst: Efforts, nominal: Efforts, state: State) -> bool:
    """Null, not read, or enough for the state that nominally follows."""
    effort = nominal[state]
    if effort is None or worst[state] is not None:
        return True
    if not _acts(spec, rows, state):
        return False
    after, left = successor(spec, state, rows[state]), nominal.get(successor(spec, state, rows[state]))
    if restored(spec, state, after) or worst.get(after) is not None:
        left = AT_ONCE
    return left is not None and effort >= _longer(spec, rows[state], left)


def _acts(spec: Spec, rows: Rows, state: State) -> bool:
    return state in rows and nominal_agrees(spec, rows[state])


def _longer(spec: Spec, chosen: ActionSet, effort: Effort) -> Effort:
    return effort[0] + duration(spec, chosen), effort[1] + 1


def _misses(spec: Spec, rows: Rows, deviation: Deviation) -> bool:
    """The run of `missed` reaches its goal by the policy, but not with the better set in that state."""
    state, missed, better = deviation.state, deviation.missed, deviation.better
    known = {known: chosen for known, chosen in rows.items() if is_valid(spec, known)}
    if state not in known or is_safe(spec, state) or missed not in known or not nominal_agrees(spec, better):
        return False
    changed = {**known, state: better}
    return (
        follow(spec, known, missed, known[missed]).end == "goal"
        and follow(spec, changed, missed, changed[missed]).end != "goal"
    )
