"""Active and residual goals as sets (`docs/semantics.md`, section 4)."""

from __future__ import annotations

from dataclasses import dataclass

from tumato_symbolic.semantics import ActionSet, ActiveGoals, Residual
from tumato_symbolic.spec import (
    FORMULAS,
    ConditionalGoal,
    Constant,
    Executing,
    Formula,
    Goal,
    Is,
    SimpleGoal,
    executing_atoms,
    fold,
)
from tumato_symbolic.symbolic.encoding import Encoding
from tumato_symbolic.symbolic.manager import Bdd
from tumato_symbolic.symbolic.steps import Steps

Regions = dict[ActiveGoals, Bdd]


@dataclass(frozen=True)
class Target:
    """The safe states that satisfy a residual goal, and the steps after which it is pending.

    `states` are the safe states that satisfy the residual goal; `pending` are the allowed pairs `(s, A)` with that
    residual goal; `residuals` lists the residual goals that share this target, each with its own pairs.
    """

    states: Bdd
    pending: Bdd
    residuals: tuple[tuple[Residual, Bdd], ...]


def regions(encoding: Encoding, valid: Bdd) -> Regions:
    """The valid states by their active goals; the regions partition `valid`."""
    goals = encoding.spec.goals
    if goals is None:
        return {frozenset(): valid}
    found = _walk(encoding, goals, valid, [])[1]
    return {active: states for active, states in found.items() if states != encoding.manager.false}


def never_entered(encoding: Encoding, valid: Bdd) -> list[Goal]:
    """The goals that no valid state enters; those inside another such goal are left out."""
    idle: list[Goal] = []
    if encoding.spec.goals is not None:
        _walk(encoding, encoding.spec.goals, valid, idle)
    return idle


def _walk(encoding: Encoding, goal: Goal, here: Bdd, idle: list[Goal]) -> tuple[Bdd, Regions]:
    """Where in `here` the goal is entered, and those states by what it makes active there.

    A goal that is entered nowhere is noted in `idle` and not looked into.
    """
    false = encoding.manager.false
    entered = here & encoding.formula(goal.condition.formula) if isinstance(goal, ConditionalGoal) else here
    if entered == false:
        idle.append(goal)
        return false, {}
    if isinstance(goal, SimpleGoal):
        return entered, {frozenset((goal.body,)): entered}
    if isinstance(goal, ConditionalGoal):
        return entered, _walk(encoding, goal.goal, entered, idle)[1]
    found: Regions = {frozenset(): here}
    if goal.kind == "priority":
        found, rest = {}, here
        for member in goal.members:
            entered, parts = _walk(encoding, member, rest, idle)
            _add(found, parts, false)
            rest = rest & ~entered
        _add(found, {frozenset(): rest}, false)
        return here, found
    for member in goal.members:
        entered, parts = _walk(encoding, member, here, idle)
        combined: Regions = {}
        for active, states in found.items():
            _add(combined, {active: states & ~entered}, false)
            for more, others in parts.items():
                _add(combined, {active | more: states & others}, false)
        found = combined
    return here, found


def _add(found: Regions, parts: Regions, false: Bdd) -> None:
    for active, states in parts.items():
        if states != false:
            found[active] = found.get(active, false) | states


def targets(steps: Steps, active_regions: Regions) -> list[Target]:
    """The target of every allowed pair; their `pending` pairs partition the allowed pairs."""
    encoding, false = steps.encoding, steps.encoding.manager.false
    by_states: dict[Bdd, list[tuple[Residual, Bdd]]] = {}
    for active, region in active_regions.items():
        bodies = [encoding.spec.bodies[body].formula for body in sorted(active)]
        mentioned = sorted(encoding.spec.as_actions(frozenset[int]().union(*map(executing_atoms, bodies))))
        for executed, pairs in _split(encoding, mentioned, steps.allowed & region):
            goal = encoding.all_of(settle(body, executed) for body in bodies)
            by_states.setdefault(goal & steps.safe, []).append((Residual(active, executed), pairs))
    found = [
        Target(states, encoding.manager.union(pairs for _, pairs in residuals), tuple(residuals))
        for states, residuals in by_states.items()
    ]
    return [target for target in found if target.pending != false]


def _split(encoding: Encoding, atoms: list[int], pairs: Bdd) -> list[tuple[ActionSet, Bdd]]:
    """Pairs by which of the given actions (by their first cases) they execute; empty parts are left out."""
    parts: list[tuple[ActionSet, Bdd]] = [(frozenset(), pairs)]
    for action in atoms:
        runs = encoding.executing_any(encoding.spec.cases_from(action))
        parts = [
            (executed | extra, part)
            for executed, whole in parts
            for extra, part in ((frozenset((action,)), whole & runs), (frozenset[int](), whole & ~runs))
        ]
        parts = [(executed, part) for executed, part in parts if part != encoding.manager.false]
    return parts


def settle(formula: Formula, executed: ActionSet) -> Formula:
    """A goal body with its `executing` atoms replaced by their truth values for the first set."""

    def atom(atom: Is | Executing) -> Formula:
        return atom if isinstance(atom, Is) else Constant(atom.action in executed)

    return fold(formula, atom, FORMULAS)
