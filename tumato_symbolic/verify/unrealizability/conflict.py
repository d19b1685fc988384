"""*No policy serves these states together*: complete options, distances, and cuts that no choice respects.

Why this is a proof: `docs/certificate.md`, the section on unrealizability.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TypeAlias

import z3

from tumato_symbolic.policy.unrealizability import Choice, Conflict, Cut
from tumato_symbolic.semantics import Residual, State, is_valid, level, reached, residual_goal, state_text
from tumato_symbolic.spec import Spec
from tumato_symbolic.verify.by_z3.goal_terms import reached_term
from tumato_symbolic.verify.by_z3.solver import Solver, UndecidedError
from tumato_symbolic.verify.by_z3.terms import Context, Term, at_most_one, conjunction, disjunction, negation
from tumato_symbolic.verify.unrealizability.allowed_step import AllowedStep, is_state
from tumato_symbolic.verify.unrealizability.distances import Distances, DistanceTerms
from tumato_symbolic.verify.unrealizability.false_claim import FalseClaimError
from tumato_symbolic.verify.unrealizability.named_goals import goal_text, named_goal, set_text

Pick: TypeAlias = tuple[int, int]
"""An option (by number) of a choice (by number)."""


def check_conflict(reason: Conflict, step: AllowedStep) -> int:
    """How many claims were checked without Z3. Raises `FalseClaimError` and `UndecidedError`."""
    goals = _Goals(reason, step.spec, step.context)
    check_choices(reason, step.spec)
    _check_distances(goals, step)
    _check_options(reason, goals, step)
    refute_choices(reason, goals.distances, step.spec, step.deadline())
    step.proved += 1
    return len(reason.choices) + len(reason.cuts)


def check_choices(reason: Conflict, spec: Spec) -> None:
    """Only valid states have choices."""
    for choice in reason.choices:
        if not is_valid(spec, choice.state):
            text = state_text(spec, choice.state)
            raise FalseClaimError(f"the state {text} is not valid, so no policy has to decide there")


class _Goals:
    """The goals of a certificate by class: goals with one root are one."""

    def __init__(self, reason: Conflict, spec: Spec, context: Context) -> None:
        self.members: dict[int, list[Residual]] = {}
        for goal in reason.goals:
            self.members.setdefault(goal.root, []).append(named_goal(spec, goal.bodies, goal.executed))
        self.distances = DistanceTerms(reason.distances, spec.max_plan_length, context)


def _check_distances(goals: _Goals, step: AllowedStep) -> None:
    """`D(t) = 0` in every safe state that meets the goal, and no allowed step makes `D` smaller by more than one."""
    spec = step.spec
    for root, members in goals.members.items():
        here, after = goals.distances.count(root, step.state), goals.distances.count(root, step.after)
        for goal in members:
            state = step.some_state(
                "distances are 0 at the goal", step.safe, reached_term(spec, goal, step.state), here != 0
            )
            if state is not None:
                if not reached(spec, goal, state) or goals.distances.of(root, state) == 0:
                    raise RuntimeError(f"the distance of {state} is 0 or it does not meet {goal}, against the solver")
                text = f"the state {state_text(spec, state)} meets {goal_text(spec, goal)}"
                raise FalseClaimError(f"{text}, and its distance is not 0")
        drops = goals.distances.drops(here, after)
        found = step.some_step("distances are lower bounds", step.safe, drops)
        if found is not None:
            before, chosen, next_state = found
            if goals.distances.of(root, before) <= goals.distances.of(root, next_state) + 1:
                raise RuntimeError(f"the distance does not drop from {before} to {next_state}, against the solver")
            told = f"{set_text(spec, chosen)} leads from {state_text(spec, before)} to {state_text(spec, next_state)}"
            raise FalseClaimError(
                f"{told}, from where {goal_text(spec, members[0])} is nearer by more than one step", before, chosen
            )


def _check_options(reason: Conflict, goals: _Goals, step: AllowedStep) -> None:
    """Every allowed set of a choice's state leads where one of its options says, and has that residual goal."""
    is_residual = {
        root: step.name(disjunction(step.goals.is_residual(goal, step.executed) for goal in members))
        for root, members in goals.members.items()
    }
    for choice in reason.choices:
        listed = [(after, reason.goals[goal].root) for after, goal in choice.options]
        others = [negation(conjunction((is_state(step.after, after), is_residual[root]))) for after, root in listed]
        found = step.some_step("the options of a state are complete", is_state(step.state, choice.state), *others)
        if found is not None:
            state, chosen, after = found
            goal = residual_goal(step.spec, state, chosen)
            if any(after == other and goal in goals.members[root] for other, root in listed):
                raise RuntimeError(f"{sorted(chosen)} is an option of {state}, against the solver")
            told = f"in {state_text(step.spec, state)}, {set_text(step.spec, chosen)} is allowed"
            leads = f"leads to {state_text(step.spec, after)} and leaves {goal_text(step.spec, goal)} pending"
            raise FalseClaimError(f"{told}, {leads}, which is no option there", state, chosen)


def clause(reason: Conflict, distances: Distances, cut: Cut, number: int, spec: Spec) -> list[Pick]:
    """One of these picks is made by every policy that serves the first state of the cut.

    Raises `FalseClaimError` where the cut is none.
    """
    if cut.states[0] not in reason.starts:
        raise FalseClaimError(f"cut {number} begins in a state that is not among the starts")
    if cut.kind == "outcomes":
        return _avoiding(reason, cut, number, spec)
    root = reason.goals[cut.goal].root
    start = reason.choices[cut.states[0]]
    other_goals = [
        (cut.states[0], option) for option, (_, goal) in enumerate(start.options) if reason.goals[goal].root != root
    ]
    picks = (
        _leaving(reason, distances, cut, root)
        if cut.kind == "loop"
        else _turning_off(reason, distances, cut, number, spec)
    )
    return [*other_goals, *picks]


def _leaving(reason: Conflict, distances: Distances, cut: Cut, root: int) -> Iterator[Pick]:
    """The options that hit the goal, or leave the states of the cut for one from where it is near enough."""
    inside = {reason.choices[place].state for place in cut.states}
    for place in dict.fromkeys(cut.states):
        for option, (after, _) in enumerate(reason.choices[place].options):
            if distances.of(root, after) == 0 or (after not in inside and distances.near(root, after, 1)):
                yield place, option


def _turning_off(reason: Conflict, distances: Distances, cut: Cut, number: int, spec: Spec) -> list[Pick]:
    """The options that leave the path for a state from where the goal is near enough.

    The path itself must not meet the goal, and its end must be too far away from it.
    """
    root = reason.goals[cut.goal].root
    if cut.end is None:
        raise FalseClaimError(f"cut {number} has no end")
    states = [reason.choices[place].state for place in cut.states]
    hit = next((state for state in states[1:] if distances.of(root, state) == 0), None)
    if hit is not None:
        raise FalseClaimError(f"cut {number} passes {state_text(spec, hit)}, where the goal may be met")
    if distances.near(root, cut.end, len(states)):
        raise FalseClaimError(f"cut {number} ends in {state_text(spec, cut.end)}, from where the goal may be reached")
    return [
        (place, option)
        for steps, (place, following) in enumerate(zip(cut.states, [*states[1:], cut.end], strict=True), 1)
        for option, (after, _) in enumerate(reason.choices[place].options)
        if after != following and distances.near(root, after, steps)
    ]


def _avoiding(reason: Conflict, cut: Cut, number: int, spec: Spec) -> list[Pick]:
    """The options that cannot lead to the state that comes next.

    The states that come again and again must be unsafe and of one level: then none of them is restored by that.
    """
    states = [reason.choices[place].state for place in cut.states]
    if spec.restoration != "bounded":
        raise FalseClaimError(f"cut {number} is about outcomes, but not all of them have to restore safety")
    if cut.back is None or cut.back >= len(states):
        raise FalseClaimError(f"the outcomes of cut {number} do not lead back to one of its states")
    levels = {level(spec, state) for state in states[cut.back :]}
    if len(levels) > 1 or levels == {len(spec.tiers)}:
        raise FalseClaimError(f"the outcomes of cut {number} restore something")
    return [
        (place, option)
        for place, following in zip(cut.states, [*states[1:], states[cut.back]], strict=True)
        for option, (after, _) in enumerate(reason.choices[place].options)
        if following not in (after, *outcomes_of(reason.choices[place], option))
    ]


def outcomes_of(choice: Choice, option: int) -> tuple[State, ...]:
    """The states to which the sets of an option may lead as well, as far as they are listed."""
    return choice.outcomes[option] if choice.outcomes else ()


def refute_choices(reason: Conflict, distances: Distances, spec: Spec, deadline: float) -> None:
    """No choice of one option everywhere respects all cuts."""
    clauses = [clause(reason, distances, cut, number, spec) for number, cut in enumerate(reason.cuts)]
    solver = Solver()
    picked: list[list[Term]] = [
        [z3.Bool(f"p.{place}.{option}", solver.context) for option in range(len(choice.options))]
        for place, choice in enumerate(reason.choices)
    ]
    for place, terms in enumerate(picked):
        if terms or place in reason.starts or not spec.starts:  # with starts, others need not be decided
            solver.add(disjunction(terms), at_most_one(terms))
    for picks in clauses:
        solver.add(disjunction(picked[place][option] for place, option in picks))
    answer = solver.ask(deadline=deadline)
    if answer == "unknown":
        raise UndecidedError("no choice of options respects all cuts")
    if answer == "sat":
        raise FalseClaimError("there is a choice of options that respects all cuts")
