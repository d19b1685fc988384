"""A specification with every name resolved: the one record that all later rooms read."""

from __future__ import annotations

from functools import cached_property
from typing import Literal, TypeAlias

from msgspec import Struct
from msgspec.structs import replace

from tumato_symbolic.diagnostics import Span
from tumato_symbolic.spec.formula import TRUE, Formula, Or

Ordering: TypeAlias = Literal["any", "first"]

Restoration: TypeAlias = Literal["one_step", "bounded", "fair"]
"""How safety is restored: in one step; in several, whatever happens; or in several, where nominal effects recur."""

PreconditionsHold: TypeAlias = Literal["at_start", "throughout"]
"""When the preconditions of an action have to hold: when it starts, or also until it takes effect."""

Assignment: TypeAlias = tuple[tuple[int, int], ...]
"""What an effect writes: pairs (variable, value), sorted by variable, each variable once. Empty: no change."""


class Variable(Struct, frozen=True):
    """A state variable and its values, in the order of declaration."""

    name: str
    values: tuple[str, ...]
    span: Span


class Rule(Struct, frozen=True):
    """A predicate that the user wrote: a rule, an assumption, or one comma-separated part of a precondition.

    `severity` is that of a state rule: 1, or more where it is milder; only the order of the numbers counts.
    """

    formula: Formula
    text: str
    span: Span
    severity: int = 1


class Alternative(Struct, frozen=True):
    """One `alternative effects:` entry: all assignments that it denotes, one or more."""

    outcomes: tuple[Assignment, ...]
    text: str
    span: Span


class EffectSet(Struct, frozen=True):
    """A set of effects with clauses, as it is written: `clauses` are pairs of a condition and the effects under it.

    A relative effect is one clause for each value of its variable.
    """

    effects: tuple[Formula, ...]
    clauses: tuple[tuple[Formula, tuple[Formula, ...]], ...]


class Action(Struct, frozen=True, dict=True):
    """An action, or one case of an action with clauses. `resources` are resource numbers; preconditions a conjunction.

    `resource_span` is where the resources are listed, None where the text has no such field.

    The cases of an action have its name. `guard` tells in which states one is meant, None where it is all; the guards
    of an action exclude each other. `written` are the sets of effects of an action with clauses, the nominal one first.
    """

    name: str
    duration: int
    resources: frozenset[int]
    preconditions: tuple[Rule, ...]
    nominal: Assignment
    alternatives: tuple[Alternative, ...]
    span: Span
    resource_span: Span | None = None
    guard: Rule | None = None
    written: tuple[EffectSet, ...] = ()

    @cached_property
    def effects(self) -> tuple[Assignment, ...]:
        """The nominal assignment, then every alternative one; each once.

        It is empty for an action without effects, none of whose effects mentions a variable: it never takes effect.
        """
        found = [self.nominal, *(outcome for entry in self.alternatives for outcome in entry.outcomes)]
        return tuple(dict.fromkeys(found)) if any(found) else ()

    @property
    def conditions(self) -> tuple[Rule, ...]:
        """What holds wherever it starts: its preconditions, and the guard of a case."""
        return self.preconditions if self.guard is None else (*self.preconditions, self.guard)


class SimpleGoal(Struct, frozen=True):
    """`goal: PREDICATE`; `body` indexes `Spec.bodies`, where another text of the same structure may stand first."""

    body: int
    text: str
    span: Span


class ConditionalGoal(Struct, frozen=True):
    """`when PREDICATE then …`."""

    condition: Rule
    goal: SimpleGoal | GoalList
    span: Span


class GoalList(Struct, frozen=True):
    """`BEGIN GOALS goal type: … END GOALS`."""

    kind: Literal["priority", "constraint"]
    members: tuple[Goal, ...]
    span: Span


Goal: TypeAlias = SimpleGoal | ConditionalGoal | GoalList


class Spec(Struct, frozen=True, dict=True):
    """A whole specification.

    Variables, resources and actions are known by their position. `bodies` holds the goal bodies, each structure
    once (aliases expanded), so that two goals are the same exactly when their body numbers are. `max_plan_length`
    is None where plans are unbounded, `effect_ordering` is None where the text does not say. `bound_span` is where the
    plan bound is set. `restoration` is how safety is to be restored: what the text says, or the command line in its
    place. `preconditions` is when those of actions have to hold. A valid state that satisfies one of `starts` is a
    start; where there are none, every valid state is one. `part` is what a policy from the starts decides, where only
    that is looked at (`within`): one more thing that valid states satisfy.
    """

    variables: tuple[Variable, ...]
    resources: tuple[str, ...]
    actions: tuple[Action, ...]
    reaction_rules: tuple[Rule, ...]
    state_rules: tuple[Rule, ...]
    assumptions: tuple[Rule, ...]
    goals: GoalList | None
    bodies: tuple[Rule, ...]
    max_plan_length: int | None
    effect_ordering: Ordering | None
    bound_span: Span | None = None
    restoration: Restoration = "one_step"
    preconditions: PreconditionsHold = "at_start"
    starts: tuple[Rule, ...] = ()
    part: Rule | None = None

    @cached_property
    def tiers(self) -> tuple[tuple[Rule, ...], ...]:
        """The state rules by severity, the most severe first; one tier at least."""
        severities = sorted({rule.severity for rule in self.state_rules}) or [1]
        return tuple(tuple(rule for rule in self.state_rules if rule.severity == each) for each in severities)

    @cached_property
    def cases(self) -> tuple[range, ...]:
        """For every action the numbers of its cases: one, its own, for an action without clauses.

        They follow one another in `actions`.
        """
        names = [action.name for action in self.actions]
        starts = [number for number, name in enumerate(names) if number == 0 or names[number - 1] != name]
        return tuple(map(range, starts, [*starts[1:], len(names)]))

    @cached_property
    def first_case(self) -> tuple[int, ...]:
        """For every case, the first case of the same action."""
        return tuple(cases[0] for cases in self.cases for _ in cases)

    @cached_property
    def _action_at(self) -> dict[int, int]:
        return {cases[0]: number for number, cases in enumerate(self.cases)}

    @property
    def validity(self) -> tuple[Rule, ...]:
        """What valid states satisfy: the assumptions, and where only a part is looked at, that they are in it."""
        return (*self.assumptions, *self.in_part)

    @property
    def in_part(self) -> tuple[Rule, ...]:
        """That a state is in the part, where only a part is looked at."""
        return () if self.part is None else (self.part,)

    def within(self, part: Formula) -> Spec:
        """The same where only the valid states of a part are looked at: those that a policy from the starts decides."""
        return replace(self, part=Rule(part, "the policy decides it", Span(1, 1, 1, 1)))

    @property
    def whole(self) -> Spec:
        """The same with every valid state."""
        return self if self.part is None else replace(self, part=None)

    @property
    def start(self) -> Formula:
        """Where a valid state is a start."""
        formulas = tuple(rule.formula for rule in self.starts)
        return Or(formulas) if len(formulas) > 1 else formulas[0] if formulas else TRUE

    @property
    def has_cases(self) -> bool:
        """Whether some action has more than one case."""
        return len(self.cases) < len(self.actions)

    def as_actions(self, chosen: frozenset[int]) -> frozenset[int]:
        """The first case of each action in a set: by it, residual goals name the action."""
        return frozenset(map(self.first_case.__getitem__, chosen)) if self.has_cases else chosen

    def cases_from(self, first: int) -> range:
        """All cases of an action, from the first one."""
        return self.cases[self._action_at[first]]

    def action_of(self, case: int) -> int:
        """The number, in the order of declaration, of the action that has a case."""
        return self._action_at[self.first_case[case]]

    @property
    def action_names(self) -> tuple[str, ...]:
        """The names of the actions, each once."""
        return tuple(self.actions[cases[0]].name for cases in self.cases)

    @property
    def environment(self) -> frozenset[int]:
        """The variables that no effect of any action writes: they change without the robot, if at all."""
        effects = (effect for action in self.actions for effect in action.effects)
        return frozenset(range(len(self.variables))) - {variable for effect in effects for variable, _ in effect}

    @property
    def restores_stepwise(self) -> bool:
        """Whether the way back to safety may take more than one step: decisions in unsafe states then serve runs."""
        return self.restoration != "one_step" or len(self.tiers) > 1

    @property
    def in_one_step(self) -> Spec:
        """The same with safety restored in one step and a single severity: what it says of safe states is the same."""
        rules = tuple(replace(rule, severity=1) for rule in self.state_rules)
        return replace(self, restoration="one_step", state_rules=rules) if self.restores_stepwise else self

    def as_written(self, goal: SimpleGoal) -> Rule:
        """The body of a goal with the text and the place that this one has."""
        return replace(self.bodies[goal.body], text=goal.text, span=goal.span)

    @property
    def ordering(self) -> Ordering:
        """The effect ordering that the text means: `any` where it does not say."""
        return self.effect_ordering or "any"
