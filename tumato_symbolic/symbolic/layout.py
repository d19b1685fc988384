"""States and sets of actions as bit vectors.

A state variable takes the bits that number its values. Actions that can never run together form a *group*, and a
group takes the bits that number its choices: idle, or one of its actions. A group's bits stand just above those of the
first variable that it writes, so that independent parts of a robot stay apart in the order.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from functools import cached_property, lru_cache

from msgspec import Struct

from tumato_symbolic.limits import Context
from tumato_symbolic.semantics import ActionSet, State, exclusive_groups
from tumato_symbolic.spec import (
    Assignment,
    Connectives,
    Executing,
    Formula,
    Is,
    Spec,
    fold,
    goal_parameters,
    variables_of,
)
from tumato_symbolic.symbolic.manager import Backend, Bdd, Manager
from tumato_symbolic.symbolic.order import variable_order


class Group(Struct, frozen=True):
    """Mutually exclusive actions and the bits that choose among them; choice 0 is idle."""

    actions: tuple[int, ...]
    bits: tuple[str, ...]


class GoalBits(Struct, frozen=True):
    """The bits that tell residual goals apart where there are many: which bodies are active, what is executed first.

    A state or a pair does not set them: they stand for the goal of a run, wherever that is by now.
    """

    bodies: Mapping[int, str]
    actions: Mapping[int, str]


class Layout(Struct, frozen=True, dict=True):
    """The bits that stand for states and for sets of actions, whatever the actions do and the rules say.

    Specifications that have the same variables, and actions of the same groups, can share one.
    """

    manager: Manager
    sizes: tuple[int, ...]
    """How many values each state variable has."""
    state_bits: tuple[tuple[str, ...], ...]
    groups: tuple[Group, ...]
    order: tuple[int, ...]
    """State variables as their bits are ordered."""
    choice_of: Mapping[int, tuple[int, int]]
    """For every action, its group and its choice number there."""
    goal_bits: GoalBits | None
    """None where there are few residual goals, which are looked at one by one."""

    @cached_property
    def all_state_bits(self) -> tuple[str, ...]:
        """The bits of all state variables."""
        return tuple(bit for bits in self.state_bits for bit in bits)

    @cached_property
    def all_choice_bits(self) -> tuple[str, ...]:
        """The bits of all groups."""
        return tuple(bit for group in self.groups for bit in group.bits)

    def assignment_bits(self, assignment: Assignment) -> Mapping[str, bool]:
        """An effect as constants for bits."""
        if len(assignment) == 1:
            variable, number = assignment[0]
            return number_bits(self.state_bits[variable], number)
        return {
            bit: value
            for variable, number in assignment
            for bit, value in number_bits(self.state_bits[variable], number).items()
        }

    def state_cube(self, state: State) -> Bdd:
        """One state as a set."""
        return self.manager.cube(self.assignment_bits(tuple(enumerate(state))))

    def value(self, variable: int, number: int) -> Bdd:
        """The states where a variable has a value."""
        return self.manager.cube(number_bits(self.state_bits[variable], number))

    def idle_bits(self, group: Group) -> dict[str, bool]:
        """The choice of no action in a group, as constants for its bits."""
        return dict.fromkeys(group.bits, False)

    def action_bits(self, action: int) -> Mapping[str, bool]:
        """The choice of an action, as constants for its group's bits."""
        group, choice = self.choice_of[action]
        return number_bits(self.groups[group].bits, choice)

    def executing(self, action: int) -> Bdd:
        """The choices that contain an action."""
        return self._executing[action]

    def executing_any(self, actions: Iterable[int]) -> Bdd:
        """The choices that contain one of some actions."""
        return self.manager.union(map(self.executing, actions))

    @cached_property
    def _executing(self) -> list[Bdd]:
        return [self.manager.cube(self.action_bits(action)) for action in range(len(self.choice_of))]

    def idle(self, group: Group) -> Bdd:
        """The choices without an action of a group."""
        return self.manager.cube(self.idle_bits(group))

    def choices_cube(self, chosen: ActionSet) -> Bdd:
        """One set of actions as a set of choices."""
        bits = {bit: value for group in self.groups for bit, value in self.idle_bits(group).items()}
        for action in chosen:
            bits |= self.action_bits(action)
        return self.manager.cube(bits)

    def formula(self, formula: Formula) -> Bdd:
        """The pairs of state and choice in which a formula holds."""

        def atom(atom: Is | Executing) -> Bdd:
            return self.value(atom.variable, atom.value) if isinstance(atom, Is) else self.executing(atom.action)

        return fold(formula, atom, self.connectives)

    @cached_property
    def connectives(self) -> Connectives[Bdd]:
        """What the connectives of formulas are among sets."""
        manager = self.manager
        return Connectives(
            constant=lambda value: manager.true if value else manager.false,
            negation=lambda p: ~p,
            conjunction=manager.intersection,
            disjunction=manager.union,
            equivalence=lambda p, q: (p & q) | ~(p | q),
        )

    def all_of(self, formulas: Iterable[Formula]) -> Bdd:
        """The pairs in which every formula holds."""
        return self.manager.intersection(self.formula(formula) for formula in formulas)

    def domain(self) -> Bdd:
        """The bit vectors that stand for states."""
        return self.states_where(())

    def states_where(self, formulas: Iterable[Formula]) -> Bdd:
        """The bit vectors that stand for states in which every formula holds."""
        values = (
            self.manager.union(self.value(variable, value) for value in range(size))
            for variable, size in enumerate(self.sizes)
        )
        return self.manager.intersection([*values, *map(self.formula, formulas)])

    def choice_domain(self) -> Bdd:
        """The bit vectors that stand for sets of actions, exclusive within each group."""
        return self.manager.intersection(
            self.manager.union([self.idle(group), *(self.executing(action) for action in group.actions)])
            for group in self.groups
        )

    def first_state(self, states: Bdd) -> State:
        """The first state of a non-empty set."""
        return next(self.states_in(states))

    def states_in(self, states: Bdd) -> Iterator[State]:
        """Every state of a set, in the order of declaration, the last variable changing fastest."""
        rests: dict[tuple[int, Bdd], list[tuple[int, Bdd]]] = {}
        stack: list[tuple[State, Bdd]] = [] if states == self.manager.false else [((), states)]
        while stack:
            state, rest = stack.pop()
            if len(state) == len(self.state_bits):
                yield state
                continue
            key = len(state), rest
            if key not in rests:
                rests[key] = [*self._rests(*key)]
            stack += [((*state, number), part) for number, part in rests[key]]

    def _rests(self, variable: int, states: Bdd) -> Iterator[tuple[int, Bdd]]:
        """What is left of a set for the values that a variable has in it, the last value first."""
        bits = self.state_bits[variable]
        for number in reversed(range(self.sizes[variable])):
            rest = self.manager.cofactor(states, number_bits(bits, number))
            if rest != self.manager.false:
                yield number, rest

    def first_set(self, choices: Bdd) -> ActionSet:
        """Some set of actions of a non-empty set of choices (the only one, where there is one): first actions first."""
        found = set()
        for action in range(len(self.choice_of)):
            rest = choices & self.executing(action)
            if rest != self.manager.false:
                found.add(action)
                choices = rest
        return frozenset(found)

    def at(self, relation: Bdd, state: State) -> Bdd:
        """What a relation says of one state: the choices related to it; true or false for a set of states."""
        return self.manager.cofactor(relation, self.assignment_bits(tuple(enumerate(state))))

    def contains(self, states: Bdd, state: State) -> bool:
        """Whether a state is in a set of states."""
        return self.at(states, state) == self.manager.true

    def count_states(self, states: Bdd) -> int:
        """The exact number of states in a set."""
        return self.manager.count(states, self.all_state_bits)


@lru_cache(maxsize=4096)
def number_bits(bits: tuple[str, ...], number: int) -> Mapping[str, bool]:
    """A number in binary, most significant bit first."""
    return {bit: bool(number >> (len(bits) - 1 - position) & 1) for position, bit in enumerate(bits)}


def lay_out(spec: Spec, backend: Backend, context: Context | None = None) -> Layout:
    """A layout for a specification in a new manager, whose operations keep the limits of `context`."""
    groups = [
        Group(actions, tuple(f"g{number}.{bit}" for bit in range(len(actions).bit_length())))
        for number, actions in enumerate(exclusive_groups(spec))
    ]
    state_bits = tuple(
        tuple(f"v{number}.{bit}" for bit in range((len(variable.values) - 1).bit_length()))
        for number, variable in enumerate(spec.variables)
    )
    order = variable_order(spec)
    place = {variable: number for number, variable in enumerate(order)}
    above: dict[int, list[Group]] = {}
    for group in groups:
        written = (place[v] for action in group.actions for effect in spec.actions[action].effects for v, _ in effect)
        above.setdefault(min(written, default=0), []).append(group)
    goal_bits = _goal_bits(spec)
    of_goals: dict[int, list[str]] = {}
    for body, bit in goal_bits.bodies.items() if goal_bits else ():
        first = min((place[v] for v in variables_of(spec.bodies[body].formula)), default=0)
        of_goals.setdefault(first, []).append(bit)
    bits: list[str] = list(goal_bits.actions.values()) if goal_bits else []
    for number, variable in enumerate(order):
        bits += [bit for group in above.get(number, ()) for bit in group.bits]
        bits += of_goals.get(number, ())
        bits += state_bits[variable]
    choice_of = {
        action: (number, choice)
        for number, group in enumerate(groups)
        for choice, action in enumerate(group.actions, start=1)
    }
    sizes = tuple(len(variable.values) for variable in spec.variables)
    return Layout(Manager(bits, backend, context), sizes, state_bits, tuple(groups), order, choice_of, goal_bits)


def _goal_bits(spec: Spec) -> GoalBits | None:
    told_by = goal_parameters(spec)
    if told_by is None:
        return None
    return GoalBits(
        {body: f"active{body}" for body in told_by.bodies}, {action: f"first{action}" for action in told_by.actions}
    )
