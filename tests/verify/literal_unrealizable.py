"""What `docs/certificate.md` asks of a certificate of unrealizability, claim by claim, by trying every state and set.

Nothing here calls `tumato_symbolic.verify`: a forged certificate is a proof exactly where all its claims hold here.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product
from math import inf

from tests.semantics import literal
from tumato_symbolic.policy.unrealizability import (
    Conflict,
    Cube,
    Cut,
    NoAllowedSet,
    NoPart,
    NoPlan,
    NoRestoration,
    Unrealizability,
)
from tumato_symbolic.spec import Formula, Ordering, Spec, canonical_text

Goal = tuple[frozenset[int], frozenset[int]]
Step = tuple[literal.State, literal.Actions, literal.State, Goal]
Pick = tuple[int, int]


class Meaning:
    """All allowed steps of a specification, each with its residual goal: bodies, and who of them acts."""

    def __init__(self, spec: Spec, ordering: Ordering) -> None:
        self.spec = spec
        self.ordering: Ordering = ordering
        self.safe = [state for state in literal.states(spec) if literal.safe(spec, state)]
        self._steps: dict[literal.State, list[Step]] = {}

    def steps(self, state: literal.State) -> list[Step]:
        """The allowed steps of a state."""
        if state not in self._steps:
            self._steps[state] = [
                (state, chosen, literal.successor(self.spec, state, chosen), self.residual(state, chosen))
                for chosen in literal.allowed(self.spec, state, self.ordering)
            ]
        return self._steps[state]

    def residual(self, state: literal.State, chosen: literal.Actions) -> Goal:
        """The residual goal."""
        bodies = frozenset(literal.active(self.spec, state))
        mentioned = {action for body in bodies for action in _mentioned(self.spec.bodies[body].formula)}
        return bodies, frozenset(mentioned & chosen)

    def meets(self, goal: Goal, state: literal.State) -> bool:
        """Whether the residual goal holds."""
        return all(literal.true(self.spec.bodies[body].formula, state, goal[1]) for body in goal[0])

    def named(self, bodies: tuple[str, ...], executed: tuple[str, ...]) -> Goal | None:
        """The residual goal of a certificate; None where there is no such goal."""
        texts = [canonical_text(self.spec, rule.formula) for rule in self.spec.bodies]
        if any(text not in texts for text in bodies):
            return None
        names = [action.name for action in self.spec.actions]
        return frozenset(texts.index(text) for text in bodies), frozenset(names.index(name) for name in executed)


def _mentioned(formula: Formula) -> set[int]:
    found = {formula.action} if hasattr(formula, "action") else set()
    parts = [getattr(formula, name) for name in ("operand", "left", "right") if hasattr(formula, name)]
    for part in (*parts, *getattr(formula, "operands", ())):
        found |= _mentioned(part)
    return found


def is_proof(meaning: Meaning, certificate: Unrealizability) -> bool:
    """Whether every claim holds of a certificate that is bound to the specification."""
    match certificate.reason:
        case NoAllowedSet() as reason:
            return _no_allowed_set(meaning, reason)
        case NoPlan() as reason:
            return _no_plan(meaning, reason)
        case Conflict() as reason:
            return _conflict(meaning, reason)
        case NoRestoration():
            raise NotImplementedError("traps have an oracle of their own")
        case NoPart():
            raise NotImplementedError("of starts `tests.starts` has the truth")


def _no_allowed_set(meaning: Meaning, reason: NoAllowedSet) -> bool:
    if not literal.valid(meaning.spec, reason.state):
        return False
    if reason.cubes is None:
        return not meaning.steps(reason.state)
    for chosen in literal.sets(meaning.spec):
        mine = [cube for cube in reason.cubes if cube.executed <= chosen and not cube.idle & chosen]
        if len(mine) != 1:
            return False
    return all(not cube.executed & cube.idle and violated(meaning, reason.state, cube) for cube in reason.cubes)


def violated(meaning: Meaning, state: literal.State, cube: Cube) -> bool:
    """Whether all sets of a cube violate the condition that it names."""
    spec, given = meaning.spec, cube.violation
    still_open = set(range(len(spec.actions))) - cube.executed - cube.idle
    match given.kind:
        case "precondition":
            return (
                len(given.actions) == 1
                and given.actions[0] in cube.executed
                and not all(literal.true(rule.formula, state) for rule in spec.actions[given.actions[0]].preconditions)
            )
        case "resource" | "nominal-conflict":
            if len(set(given.actions)) != 2 or not set(given.actions) <= cube.executed:
                return False
            return given.kind in set(literal.broken(spec, state, frozenset(given.actions), "first"))
        case "reaction-rule":
            rules = [rule.formula for rule in spec.reaction_rules if canonical_text(spec, rule.formula) == given.rule]
            sets = [cube.executed | chosen for chosen in literal.sets(spec) if chosen <= still_open]
            return bool(rules) and not any(literal.true(rules[0], state, chosen) for chosen in sets)
        case "unsafe" | "falsified":
            acting = [action for action, _ in given.outcome]
            after = state
            for action, effect in given.outcome:
                if action not in cube.executed or effect not in literal.effects(spec, action):
                    return False
                after = literal.changed(after, effect)
            once = 0 < len(acting) == len(set(acting)) and (meaning.ordering == "any" or len(acting) == 1)
            if given.kind == "unsafe":
                return once and not literal.safe(spec, after)
            if not once or spec.preconditions != "throughout" or len(given.actions) != 1:
                return False
            (waiting,) = given.actions
            required = spec.actions[waiting].preconditions
            late = waiting in cube.executed and waiting not in acting
            return late and not all(literal.true(rule.formula, after) for rule in required)
        case "idle":
            may_act = [action for action in cube.executed | still_open if literal.effects(spec, action)]
            return not may_act and not literal.safe(spec, state)
        case "nominal-unsafe":
            agreed = not still_open and literal.agrees(spec, cube.executed)
            return agreed and not literal.safe(spec, literal.successor(spec, state, cube.executed))


def _no_plan(meaning: Meaning, reason: NoPlan) -> bool:
    spec, bound = meaning.spec, meaning.spec.max_plan_length
    goals = [(meaning.named(each.bodies, each.executed), each.roots) for each in reason.goals]
    if not literal.valid(spec, reason.state) or any(goal is None or not roots for goal, roots in goals):
        return False
    if any(pending not in [goal for goal, _ in goals] for _, _, _, pending in meaning.steps(reason.state)):
        return False
    for goal, roots in goals:
        layers = [{state for state in meaning.safe if reason.diagram.evaluate(root, state)} for root in roots]
        if any(after not in layers[0] for _, _, after, pending in meaning.steps(reason.state) if pending == goal):
            return False
        if goal is None or any(meaning.meets(goal, state) for layer in layers for state in layer):
            return False
        for number, layer in enumerate(layers, 1):
            if number == len(layers) and bound is not None and number >= bound:
                continue
            allowed = set().union(*layers[: number + 1])
            if any(after not in allowed for state in layer for _, _, after, _ in meaning.steps(state)):
                return False
    return True


def _conflict(meaning: Meaning, reason: Conflict) -> bool:
    spec = meaning.spec
    goals = [meaning.named(goal.bodies, goal.executed) for goal in reason.goals]
    if any(goal is None for goal in goals) or not all(literal.valid(spec, each.state) for each in reason.choices):
        return False
    for goal, named in zip(goals, reason.goals, strict=True):
        for state in meaning.safe:
            here = distance(spec, reason, named.root, state)
            if goal is not None and meaning.meets(goal, state) and here != 0:
                return False
            for _, _, after, _ in meaning.steps(state):
                if here > distance(spec, reason, named.root, after) + 1:
                    return False
    classes = [
        {goal for goal, other in zip(goals, reason.goals, strict=True) if other.root == named.root}
        for named in reason.goals
    ]
    for choice in reason.choices:
        for _, _, after, pending in meaning.steps(choice.state):
            if not any(after == end and pending in classes[goal] for end, goal in choice.options):
                return False
    clauses = [clause(spec, reason, cut) for cut in reason.cuts]
    if any(each is None for each in clauses):
        return False
    return not any(
        all(any(picked[place] == option for place, option in each) for each in clauses if each is not None)
        for picked in product(*(range(len(choice.options)) for choice in reason.choices))
    )


def distance(spec: Spec, reason: Conflict, root: int, state: literal.State) -> float:
    """`D`: null is infinite, and with a bound all from it on is the bound."""
    leaf = reason.distances.evaluate(root, state)
    far = inf if leaf is None else leaf
    return far if spec.max_plan_length is None else min(far, spec.max_plan_length)


def clause(spec: Spec, reason: Conflict, cut: Cut) -> set[Pick] | None:
    """The options of which every policy takes one; None where the cut is none."""
    root, bound = reason.goals[cut.goal].root, spec.max_plan_length
    states = [reason.choices[place].state for place in cut.states]

    def is_near(state: literal.State, steps: int) -> bool:
        far = distance(spec, reason, root, state)
        return far < inf if bound is None else steps + far <= bound

    def options(place: int) -> Iterator[tuple[int, literal.State, int]]:
        for option, (after, goal) in enumerate(reason.choices[place].options):
            yield option, after, reason.goals[goal].root

    if cut.states[0] not in reason.starts:
        return None
    found = {(cut.states[0], option) for option, _, goal in options(cut.states[0]) if goal != root}
    if cut.kind == "loop":
        for place in cut.states:
            for option, after, _ in options(place):
                outside = after not in states and is_near(after, 1)
                if outside or distance(spec, reason, root, after) == 0:
                    found.add((place, option))
        return found
    if cut.end is None or any(distance(spec, reason, root, state) == 0 for state in states[1:]):
        return None
    if is_near(cut.end, len(states)):
        return None
    for number, place in enumerate(cut.states):
        follower = [*states, cut.end][number + 1]
        found |= {(place, o) for o, after, _ in options(place) if after != follower and is_near(after, number + 1)}
    return found
