"""Section 3 to 5 of the semantics once more, word for word from the text: every sequence, every set, nothing clever.

Nothing here calls `tumato_symbolic.semantics`, so that a fault there is not believed here.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import permutations, product

from tumato_symbolic.spec import (
    And,
    Assignment,
    ConditionalGoal,
    Constant,
    Executing,
    Formula,
    Goal,
    Iff,
    Is,
    Not,
    Ordering,
    SimpleGoal,
    Spec,
)

State = tuple[int, ...]
Actions = frozenset[int]
Policy = Mapping[State, Actions]


def states(spec: Spec) -> list[State]:
    """All assignments of values."""
    found: list[State] = [()]
    for variable in spec.variables:
        found = [(*state, value) for state in found for value, _ in enumerate(variable.values)]
    return found


def sets(spec: Spec) -> list[Actions]:
    """All sets of actions."""
    chosen = product((False, True), repeat=len(spec.actions))
    return [frozenset(number for number, taken in enumerate(each) if taken) for each in chosen]


def true(formula: Formula, state: State, executed: Actions = frozenset()) -> bool:
    """The truth of a formula."""
    if isinstance(formula, Constant):
        return formula.value
    if isinstance(formula, Is):
        return state[formula.variable] == formula.value
    if isinstance(formula, Executing):
        return formula.action in executed
    if isinstance(formula, Not):
        return true(formula.operand, state, executed) is False
    if isinstance(formula, Iff):
        return {true(formula.left, state, executed), true(formula.right, state, executed)} != {True, False}
    values = {true(operand, state, executed) for operand in formula.operands}
    return False not in values if isinstance(formula, And) else True in values


def changed(state: State, effect: Assignment) -> State:
    """The state after an effect."""
    written = dict(effect)
    return tuple(written.get(variable, value) for variable, value in enumerate(state))


def valid(spec: Spec, state: State) -> bool:
    """Every assumption holds."""
    return all(true(rule.formula, state) for rule in spec.assumptions)


def safe(spec: Spec, state: State) -> bool:
    """Valid, and every state rule holds."""
    return valid(spec, state) and all(true(rule.formula, state) for rule in spec.state_rules)


def effects(spec: Spec, action: int) -> list[Assignment]:
    """The nominal effect and every alternative one; none where no effect mentions a variable."""
    found = [spec.actions[action].nominal]
    for entry in spec.actions[action].alternatives:
        found += entry.outcomes
    return found if max(map(len, found)) > 0 else []


def ways(spec: Spec, state: State, chosen: Actions, ordering: Ordering) -> Iterator[tuple[State, ...]]:
    """The states met by every non-empty sequence of distinct actions (`first`: of one), one effect each."""
    for length in range(1, 2 if ordering == "first" else len(chosen) + 1):
        for sequence in permutations(chosen, length):
            for taken in product(*(effects(spec, action) for action in sequence)):
                met = [state]
                for effect in taken:
                    met.append(changed(met[-1], effect))
                yield tuple(met)


def outcomes(spec: Spec, state: State, chosen: Actions, ordering: Ordering) -> dict[State, int]:
    """`Out(s, A)`, with the least number of effects that lead there; without effects nothing changes."""
    if all(effects(spec, action) == [] for action in chosen):
        return {state: 0}
    found: dict[State, int] = {}
    for way in ways(spec, state, chosen, ordering):
        found[way[-1]] = min(len(way) - 1, found.get(way[-1], len(chosen)))
    return found


def agrees(spec: Spec, chosen: Actions) -> bool:
    """No variable is given two different values by the nominal effects."""
    written: dict[int, set[int]] = {}
    for action in chosen:
        for variable, value in spec.actions[action].nominal:
            written.setdefault(variable, set()).add(value)
    return all(len(values) == 1 for values in written.values())


def successor(spec: Spec, state: State, chosen: Actions) -> State:
    """`δ(s, A)`: all nominal effects at once."""
    return changed(state, tuple(pair for action in chosen for pair in spec.actions[action].nominal))


def broken(spec: Spec, state: State, chosen: Actions, ordering: Ordering) -> Iterator[str]:
    """The conditions of section 3 that fail, by the kinds of their objections."""
    if any(not true(rule.formula, state) for action in chosen for rule in spec.actions[action].preconditions):
        yield "precondition"
    held = [resource for action in chosen for resource in spec.actions[action].resources]
    if len(held) != len(set(held)):
        yield "resource"
    if not agrees(spec, chosen):
        yield "nominal-conflict"
    if any(not true(rule.formula, state, chosen) for rule in spec.reaction_rules):
        yield "reaction-rule"
    if any(not safe(spec, after) for after in outcomes(spec, state, chosen, ordering)):
        yield "unsafe"
    if spec.preconditions == "throughout" and set(falsified(spec, state, chosen, ordering)):
        yield "falsified"
    if agrees(spec, chosen) and not safe(spec, successor(spec, state, chosen)):
        yield "nominal-unsafe"


def falsified(spec: Spec, state: State, chosen: Actions, ordering: Ordering) -> Iterator[int]:
    """The actions with a precondition that is false in a state that the others lead to, before they take effect."""
    for action in chosen:
        for others in sets(spec):
            if others and others <= chosen - {action}:
                for way in ways(spec, state, others, ordering):
                    if any(not true(rule.formula, way[-1]) for rule in spec.actions[action].preconditions):
                        yield action


def allowed(spec: Spec, state: State, ordering: Ordering) -> list[Actions]:
    """Every set with `Ok(s, A)`: the smallest first, then as declared."""
    found = [chosen for chosen in sets(spec) if next(broken(spec, state, chosen, ordering), None) is None]
    return sorted(found, key=lambda chosen: (len(chosen), sorted(chosen)))


def active(spec: Spec, state: State) -> set[int]:
    """`Γ(s)`."""
    found: set[int] = set()

    def enter(goal: Goal) -> bool:
        if isinstance(goal, SimpleGoal):
            found.add(goal.body)
        elif isinstance(goal, ConditionalGoal):
            if not true(goal.condition.formula, state):
                return False
            enter(goal.goal)
        elif goal.kind == "constraint":
            for member in goal.members:
                enter(member)
        else:
            for member in goal.members:
                if enter(member):
                    break
        return True

    if spec.goals is not None:
        enter(spec.goals)
    return found


def arrives(spec: Spec, policy: Policy, state: State, first: Actions) -> int | None:
    """After how many steps the run that begins with `first` meets its goal, within the bound; None if never."""
    pending = [spec.bodies[body].formula for body in active(spec, state)]
    here, chosen = state, first
    for steps in range(1, (spec.max_plan_length or len(states(spec)) + 1) + 1):
        here = successor(spec, here, chosen)
        if all(true(body, here, first) for body in pending):
            return steps
        if here not in policy or not agrees(spec, policy[here]):
            return None
        chosen = policy[here]
    return None


def duration(spec: Spec, chosen: Actions) -> int:
    """The sum of the durations."""
    return sum(action.duration for number, action in enumerate(spec.actions) if number in chosen)
