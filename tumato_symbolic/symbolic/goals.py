"""Active and residual goals as sets (`docs/semantics.md`, section 4)."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from msgspec import Struct, field

from tumato_symbolic.semantics import ActionSet, ActiveGoals, Residual, residual_goal
from tumato_symbolic.spec import (
    FORMULAS,
    ConditionalGoal,
    Constant,
    Executing,
    Formula,
    Goal,
    Is,
    SimpleGoal,
    active_bodies,
    executing_atoms,
    fold,
)
from tumato_symbolic.spec.many_goals import MOST_APART
from tumato_symbolic.symbolic.encoding import Encoding
from tumato_symbolic.symbolic.manager import Bdd
from tumato_symbolic.symbolic.steps import Steps

Regions = dict[ActiveGoals, Bdd]


class Target(Struct, frozen=True):
    """The safe states that satisfy a residual goal, and the steps after which it is pending.

    `states` are the safe states that satisfy the residual goal; `pending` are the allowed pairs `(s, A)` with that
    residual goal; `residuals` lists the residual goals that share this target, each with its own pairs.

    Where there are many residual goals one target stands for all of them. Its `states`, and whatever is computed from
    them, speak of the goal bits too: a state is in the set with the bits of each residual goal for which it is.
    `meaning` has what the goal bits are in a pair `(s, A)`, so that putting it in their place makes of such a set what
    it says of the pair's own goal; `residuals` is empty then, and otherwise `meaning` is.
    """

    states: Bdd
    pending: Bdd
    residuals: tuple[tuple[Residual, Bdd], ...]
    meaning: Mapping[str, Bdd] = field(default_factory=dict)


def regions(encoding: Encoding, valid: Bdd) -> Regions:
    """The valid states by their active goals; the regions partition `valid`."""
    goals = encoding.spec.goals
    if goals is None:
        return {frozenset(): valid}
    found = _walk(encoding, goals, valid, None)[1]
    return {active: states for active, states in found.items() if states != encoding.manager.false}


def regions_apart(encoding: Encoding, valid: Bdd) -> Regions | None:
    """`regions`; None where that are so many that their goals had better be looked at together."""
    if encoding.goal_bits is None or encoding.spec.goals is None:
        return regions(encoding, valid)
    try:
        found = _walk(encoding, encoding.spec.goals, valid, MOST_APART)[1]
    except _TooManyError:
        return None
    return {active: states for active, states in found.items() if states != encoding.manager.false}


def never_entered(encoding: Encoding, valid: Bdd) -> list[Goal]:
    """The goals that no valid state enters; those inside another such goal are left out."""
    return [] if encoding.spec.goals is None else _entered(encoding, encoding.spec.goals, valid)[1]


def _entered(encoding: Encoding, goal: Goal, here: Bdd) -> tuple[Bdd, list[Goal]]:
    """Where in `here` the goal is entered, and the goals in it that never are."""
    false = encoding.manager.false
    entered = here & encoding.formula(goal.condition.formula) if isinstance(goal, ConditionalGoal) else here
    if entered == false:
        return false, [goal]
    if isinstance(goal, SimpleGoal):
        return entered, []
    if isinstance(goal, ConditionalGoal):
        return entered, _entered(encoding, goal.goal, entered)[1]
    idle: list[Goal] = []
    for member in goal.members:
        taken, inside = _entered(encoding, member, here)
        idle += inside
        here = here & ~taken if goal.kind == "priority" else here
    return entered, idle


class _TooManyError(Exception):
    """There are more regions than asked for."""


def _walk(encoding: Encoding, goal: Goal, here: Bdd, most: int | None) -> tuple[Bdd, Regions]:
    """Where in `here` the goal is entered, and those states by what it makes active there.

    Raises `_TooManyError` where that is more than `most` different things.
    """
    false = encoding.manager.false
    entered = here & encoding.formula(goal.condition.formula) if isinstance(goal, ConditionalGoal) else here
    if entered == false:
        return false, {}
    if isinstance(goal, SimpleGoal):
        return entered, {frozenset((goal.body,)): entered}
    if isinstance(goal, ConditionalGoal):
        return entered, _walk(encoding, goal.goal, entered, most)[1]
    found: Regions = {frozenset(): here}
    if goal.kind == "priority":
        found, rest = {}, here
        for member in goal.members:
            entered, parts = _walk(encoding, member, rest, most)
            _add(found, parts, false)
            rest = rest & ~entered
        _add(found, {frozenset(): rest}, false)
        return here, found
    for member in goal.members:
        entered, parts = _walk(encoding, member, here, most)
        combined: Regions = {}
        for active, states in found.items():
            _add(combined, {active: states & ~entered}, false)
            for more, others in parts.items():
                _add(combined, {active | more: states & others}, false)
        if most is not None and len(combined) > most:
            raise _TooManyError
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


def together(steps: Steps) -> Target:
    """One target for all residual goals, told apart by the goal bits."""
    encoding, manager = steps.encoding, steps.encoding.manager
    bits, spec = encoding.goal_bits, encoding.spec
    assert bits is not None, "residual goals that are many have bits"

    def atom(atom: Is | Executing) -> Bdd:
        if isinstance(atom, Is):
            return encoding.value(atom.variable, atom.value)
        return manager.cube({bits.actions[atom.action]: True}) if atom.action in bits.actions else manager.false

    states = steps.safe
    for body, bit in bits.bodies.items():
        reached = fold(spec.bodies[body].formula, atom, encoding.connectives)
        states = states & (manager.cube({bit: False}) | reached)
    active = active_bodies(spec.goals, encoding.formula, encoding.connectives)
    meaning = {bit: active.get(body, manager.false) for body, bit in bits.bodies.items()}
    meaning |= {bit: encoding.executing_any(spec.cases_from(action)) for action, bit in bits.actions.items()}
    return Target(states, steps.allowed, (), meaning)


def with_own_bits(encoding: Encoding, target: Target) -> Bdd:
    """Every state with the bits of the goals that are active in it."""
    manager, bits = encoding.manager, encoding.goal_bits
    each = [] if bits is None else bits.bodies.values()
    return manager.intersection(
        encoding.connectives.equivalence(manager.cube({bit: True}), target.meaning[bit]) for bit in each
    )


def one_by_one(encoding: Encoding, target: Target, pairs: Bdd) -> Iterator[tuple[Target, Mapping[str, bool]]]:
    """The residual goals of some pairs as targets of their own, each with its bits; the target itself has none."""
    if not target.meaning:
        yield target, {}
        return
    pairs = pairs & target.pending
    while pairs != encoding.manager.false:
        state = encoding.first_state(encoding.manager.exists(encoding.all_choice_bits, pairs))
        chosen = encoding.first_set(encoding.at(pairs, state))
        single, bits = _alone(encoding, target, residual_goal(encoding.spec, state, chosen))
        yield single, bits
        pairs = pairs & ~single.pending


def _alone(encoding: Encoding, target: Target, goal: Residual) -> tuple[Target, Mapping[str, bool]]:
    """What a target says of one of the residual goals for which it stands, and the bits of that."""
    manager, bits, spec = encoding.manager, encoding.goal_bits, encoding.spec
    assert bits is not None, "residual goals that are many have bits"
    mentioned = frozenset[int]().union(*(executing_atoms(spec.bodies[body].formula) for body in goal.bodies))
    values = {bit: body in goal.bodies for body, bit in bits.bodies.items()}
    values |= {bit: a in goal.executed for a, bit in bits.actions.items() if a in spec.as_actions(mentioned)}
    pending = target.pending
    for bit, value in values.items():
        pending = pending & (target.meaning[bit] if value else ~target.meaning[bit])
    return Target(manager.cofactor(target.states, values), pending, ((goal, pending),)), values


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
