"""Small specifications by hand, without the parser: variables `x`, `y`, …, whose values are the letters of a word."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from tests.generate import NOWHERE
from tumato_symbolic.semantics import ActionSet, State
from tumato_symbolic.spec import (
    Action,
    Alternative,
    Assignment,
    ConditionalGoal,
    Executing,
    Formula,
    Goal,
    GoalList,
    Is,
    Rule,
    SimpleGoal,
    Spec,
    Variable,
)


class Build:
    """Collects the parts of a specification; `Build({"x": "abc"})` has one variable with the values a, b and c."""

    def __init__(self, variables: Mapping[str, str], resources: Sequence[str] = ()) -> None:
        self._values = dict(variables)
        self._names = list(variables)
        self._resources = tuple(resources)
        self._actions: list[Action] = []
        self._bodies: list[Formula] = []

    def atom(self, text: str) -> Is:
        """`x=a`."""
        name, value = text.split("=")
        return Is(self._names.index(name), self._values[name].index(value))

    def effect(self, text: str) -> Assignment:
        """`x=a y=b`; the empty text changes nothing."""
        atoms = [self.atom(part) for part in text.split()]
        return tuple(sorted((atom.variable, atom.value) for atom in atoms))

    def state(self, text: str) -> State:
        """One letter per variable: `ab`."""
        return tuple(self._values[name].index(value) for name, value in zip(self._names, text, strict=True))

    def action(
        self,
        nominal: str = "",
        alternatives: Sequence[str] = (),
        when: Sequence[Formula] = (),
        needs: Sequence[str] = (),
        duration: int = 0,
    ) -> Executing:
        """Add an action; the result is the atom that mentions it."""
        number = len(self._actions)
        entries = tuple(Alternative((self.effect(text),), text, NOWHERE) for text in alternatives)
        resources = frozenset(self._resources.index(name) for name in needs)
        nominal_effect = self.effect(nominal)
        self._actions.append(
            Action(f"act{number}", duration, resources, rules(*when), nominal_effect, entries, NOWHERE)
        )
        return Executing(number)

    def goal(self, body: Formula) -> SimpleGoal:
        """`goal: body`."""
        if body not in self._bodies:
            self._bodies.append(body)
        return SimpleGoal(self._bodies.index(body), str(body), NOWHERE)

    def spec(
        self,
        goals: GoalList | None = None,
        state_rules: Sequence[Formula] = (),
        reaction_rules: Sequence[Formula] = (),
        assumptions: Sequence[Formula] = (),
        bound: int | None = None,
    ) -> Spec:
        """The specification."""
        return Spec(
            variables=tuple(Variable(name, tuple(values), NOWHERE) for name, values in self._values.items()),
            resources=self._resources,
            actions=tuple(self._actions),
            reaction_rules=rules(*reaction_rules),
            state_rules=rules(*state_rules),
            assumptions=rules(*assumptions),
            goals=goals,
            bodies=rules(*self._bodies),
            max_plan_length=bound,
            effect_ordering=None,
        )


def rules(*formulas: Formula) -> tuple[Rule, ...]:
    """Each formula as a rule."""
    return tuple(Rule(formula, str(formula), NOWHERE) for formula in formulas)


def when(condition: Formula, goal: SimpleGoal | GoalList) -> ConditionalGoal:
    """`when condition then goal`."""
    return ConditionalGoal(rules(condition)[0], goal, NOWHERE)


def priority(*members: Goal) -> GoalList:
    """A goal list that stops after the first member that is entered."""
    return GoalList("priority", members, NOWHERE)


def constraint(*members: Goal) -> GoalList:
    """A goal list that tries all members."""
    return GoalList("constraint", members, NOWHERE)


def chosen(*actions: Executing) -> ActionSet:
    """The set of some actions."""
    return frozenset(atom.action for atom in actions)
