"""Generated specifications: `Spec` records made from a seed, and their text in the user's syntax."""

from __future__ import annotations

from collections.abc import Callable
from itertools import product
from math import prod
from random import Random
from typing import Literal

from msgspec.structs import replace

from tests.printing import formula_text, print_spec
from tests.profiles import ALL_PROFILES, MIXED, PROFILES, Profile, Range
from tumato_symbolic.diagnostics import Span
from tumato_symbolic.semantics import all_states, holds, is_valid
from tumato_symbolic.spec import (
    FALSE,
    TRUE,
    Action,
    Alternative,
    And,
    Assignment,
    ConditionalGoal,
    Executing,
    Formula,
    Goal,
    GoalList,
    Iff,
    Is,
    Not,
    Or,
    Rule,
    SimpleGoal,
    Spec,
    Variable,
    variables_of,
)

__all__ = ["ALL_PROFILES", "NOWHERE", "PROFILES", "Profile", "denoted", "random_spec", "random_text"]

NOWHERE = Span(1, 1, 1, 1)


def random_spec(seed: int, profile: Profile = MIXED) -> Spec:
    """The specification of a seed; it has at least one valid state and no error."""
    return _Maker(Random(seed), profile).spec()


def random_text(seed: int, profile: Profile = MIXED) -> str:
    """The same specification as a user would write it."""
    return print_spec(random_spec(seed, profile), Random(seed), profile.aliases)


class _Maker:
    """Draws the parts of one specification from one source of randomness."""

    def __init__(self, random: Random, profile: Profile) -> None:
        self.random = random
        self.profile = profile
        self.sizes = self._sizes()
        self.names = [(f"S_{letter}", tuple(f"v{n}" for n in range(size))) for letter, size in self._lettered()]
        self.action_count = self._count(profile.actions)
        self.bodies: list[Formula] = []
        self.written: list[Is] = []

    def _lettered(self) -> list[tuple[str, int]]:
        return list(zip("ABCDEFGHIJKLM", self.sizes, strict=False))

    def _count(self, bounds: Range) -> int:
        return self.random.randint(*bounds)

    def _chance(self, probability: float) -> bool:
        return self.random.random() < probability

    def _sizes(self) -> list[int]:
        least, most = self.profile.states
        while True:
            sizes = [self._count(self.profile.values) for _ in range(self._count(self.profile.variables))]
            if least <= prod(sizes) <= most:
                return sizes

    def spec(self) -> Spec:
        """A whole specification."""
        profile = self.profile
        resources = tuple(f"r{number}" for number in range(self._count(profile.resources)))
        goals = None if self._chance(profile.no_goals) else self._goal_list(self._count(profile.goals), 2)
        spec = Spec(
            variables=tuple(Variable(name, values, NOWHERE) for name, values in self.names),
            resources=resources,
            actions=tuple(self._action(number, len(resources)) for number in range(self.action_count)),
            reaction_rules=self._rules(profile.reaction_rules, self._reaction),
            state_rules=self._rules(profile.state_rules, self._clause),
            assumptions=self._rules(profile.assumptions, self._clause),
            goals=goals,
            bodies=tuple(self._rule(body) for body in self.bodies),
            max_plan_length=self._count(profile.bound) if self._chance(profile.bounded) else None,
            effect_ordering=self.random.choice((None, None, "any", "first")),
            preconditions="throughout" if profile.throughout and self._chance(profile.throughout) else "at_start",
        )
        return spec if any(is_valid(spec, state) for state in all_states(spec)) else replace(spec, assumptions=())

    def _rules(self, bounds: Range, make: Callable[[], Formula]) -> tuple[Rule, ...]:
        return tuple(self._rule(make()) for _ in range(self._count(bounds)))

    def _rule(self, formula: Formula) -> Rule:
        return Rule(formula, formula_text(formula, self.names), NOWHERE)

    def _atom(self) -> Is:
        """An atom; variables with a single value are drawn rarely, for they decide nothing."""
        variable = self.random.randrange(len(self.sizes))
        if self.sizes[variable] == 1:
            variable = self.random.randrange(len(self.sizes))
        return Is(variable, self.random.randrange(self.sizes[variable]))

    def _literal(self) -> Formula:
        atom = self._atom()
        return Not(atom) if self._chance(0.3) else atom

    def _several(self, kind: type[And] | type[Or], count: int) -> Formula:
        parts = tuple(dict.fromkeys(self._literal() for _ in range(count)))
        return kind(parts) if len(parts) > 1 else parts[0]

    def _predicate(self) -> Formula:
        """Any predicate over the state."""
        draw = self.random.random()
        if draw < 0.55:
            return self._literal()
        if draw < 0.72:
            return self._several(And, 2)
        if draw < 0.86:
            return self._several(Or, 2)
        if draw < 0.91:
            return Or((Not(self._literal()), self._several(And, 2)))
        if draw < 0.95:
            return Iff(self._literal(), self._several(Or, 2))
        if draw < 0.98:
            return Not(self._several(Or, 2))
        return self.random.choice((TRUE, TRUE, FALSE))

    def _clause(self) -> Formula:
        """A rule that most states keep."""
        if self.profile.collisions and self._chance(self.profile.collisions):
            first, second = (
                self.random.sample(self.written, 2) if len(self.written) > 1 else (self._atom(), self._atom())
            )
            if first.variable != second.variable:
                return Not(And((first, second)))
        draw = self.random.random()
        if draw < 0.5:
            first, second = self._atom(), self._atom()
            return Not(And((first, second))) if first.variable != second.variable else Not(first)
        if draw < 0.75:
            return Or((Not(self._several(And, 2)), self._literal()))
        if draw < 0.9:
            return Or((self._literal(), self._literal(), self._literal()))
        return Not(self._atom())

    def _reaction(self) -> Formula:
        action = Executing(self.random.randrange(self.action_count))
        other = Executing(self.random.randrange(self.action_count))
        if self.profile.together and self._chance(self.profile.together):
            return Iff(action, other)
        if self._chance(self.profile.forcing):
            return Or((Not(self._several(And, 2)), self.random.choice((action, Or((action, other))))))
        draw = self.random.random()
        if draw < 0.5:
            return Or((Not(self._several(And, 2)), Not(action)))
        if draw < 0.7:
            return Not(And((action, other)))
        if draw < 0.85:
            return Or((Not(action), other))
        return Not(And((action, self._literal())))

    def _action(self, number: int, resource_count: int) -> Action:
        effectless = self.profile.effectless > 0 and self._chance(self.profile.effectless)
        strong = not effectless and self._chance(self.profile.helpers)
        alternatives: tuple[Alternative, ...] = ()
        if not strong and not effectless and self._chance(self.profile.alternatives):
            alternatives = tuple(self._alternative() for _ in range(self.random.choice((1, 1, 2, 3))))
        return Action(
            name=f"act{number}",
            duration=self._count(self.profile.durations),
            resources=frozenset(held for held in range(resource_count) if self._chance(self.profile.owns)),
            preconditions=() if strong else self._rules(self.profile.preconditions, self._predicate),
            nominal=self._assignment(0 if effectless else 1 if strong else self.random.choice((0, 1, 1, 1, 1, 2, 2))),
            alternatives=alternatives,
            span=NOWHERE,
        )

    def _assignment(self, count: int) -> Assignment:
        atoms = [self._atom() for _ in range(count)]
        self.written += atoms
        return tuple(sorted({atom.variable: atom.value for atom in atoms}.items()))

    def _alternative(self) -> Alternative:
        """One entry; where it denotes several assignments, they are in the order of the states."""
        if not self._chance(self.profile.wide):
            assignment = self._assignment(self.random.choice((0, 1, 1, 2)))
            parts: list[Formula] = [Is(variable, value) for variable, value in assignment]
        else:
            parts = [self._several(Or, 2)] if self._chance(0.7) else [Not(self._atom())]
        outcomes = denoted(parts, self.sizes) or ((),)
        text = ", ".join(formula_text(part, self.names) for part in parts) if outcomes != ((),) else "none"
        return Alternative(outcomes, text, NOWHERE)

    def _goal_list(self, count: int, depth: int) -> GoalList:
        kind: Literal["priority", "constraint"] = self.random.choice(("priority", "priority", "constraint"))
        return GoalList(kind, tuple(self._goal(depth) for _ in range(count)), NOWHERE)

    def _goal(self, depth: int) -> Goal:
        nested = depth > 0 and self._chance(self.profile.nested)
        goal = self._goal_list(self.random.choice((1, 1, 2, 2, 3)), depth - 1) if nested else self._simple_goal()
        if not self._chance(self.profile.conditional):
            return goal
        condition = self._literal() if self._chance(0.7) else self._predicate()
        return ConditionalGoal(self._rule(condition), goal, NOWHERE)

    def _simple_goal(self) -> SimpleGoal:
        if self.bodies and self.profile.repeated and self._chance(self.profile.repeated):
            return self._goal_of(self.random.randrange(len(self.bodies)))
        body = self._executing_body() if self._chance(self.profile.executing) else self._predicate()
        if body not in self.bodies:
            self.bodies.append(body)
        return self._goal_of(self.bodies.index(body))

    def _goal_of(self, body: int) -> SimpleGoal:
        return SimpleGoal(body, formula_text(self.bodies[body], self.names), NOWHERE)

    def _executing_body(self) -> Formula:
        action = Executing(self.random.randrange(self.action_count))
        if self.profile.together and self._chance(self.profile.together):
            return And((action, Executing(self.random.randrange(self.action_count))))
        shapes: tuple[Formula, ...] = (
            action,
            Not(action),
            And((action, self._literal())),
            Or((self._literal(), action)),
            Or((Not(action), self._literal())),
            And((self._literal(), Not(action))),
        )
        return self.random.choice(shapes)


def denoted(parts: list[Formula], sizes: list[int]) -> tuple[Assignment, ...]:
    """The assignments to the mentioned variables that satisfy every part, in the order of the states."""
    mentioned = sorted(frozenset[int]().union(*(variables_of(part) for part in parts)))
    found: list[Assignment] = []
    for values in product(*(range(sizes[variable]) for variable in mentioned)):
        state = [0] * len(sizes)
        for variable, value in zip(mentioned, values, strict=True):
            state[variable] = value
        if all(holds(part, tuple(state)) for part in parts):
            found.append(tuple(zip(mentioned, values, strict=True)))
    return tuple(found)
