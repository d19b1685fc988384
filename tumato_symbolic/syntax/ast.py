"""What a specification says, before any name is resolved.

Every node is frozen and carries the span of text that it stands for; spans play no part in comparisons, so that two
texts with the same tree differ in layout and comments only. The printer is the inverse of the parser.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal, TypeAlias

from tumato_symbolic.diagnostics import Span

NOWHERE = Span(1, 1, 1, 1)
"""The span of a node that no text stands for."""


@dataclass(frozen=True, slots=True)
class Name:
    """A name as it is written in one place."""

    text: str
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class Truth:
    """`true` or `false`."""

    value: bool
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class Comparison:
    """`VARIABLE is VALUE`."""

    variable: Name
    value: Name
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class Execution:
    """`executing ACTION`."""

    action: Name
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class Reference:
    """An alias, by name."""

    name: Name
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class Negation:
    """`NOT p`."""

    operand: Predicate
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class Conjunction:
    """`p AND q AND …`: two operands or more."""

    operands: tuple[Predicate, ...]
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class Disjunction:
    """`p OR q OR …`: two operands or more."""

    operands: tuple[Predicate, ...]
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class Implication:
    """`IF p THEN q`."""

    condition: Predicate
    consequence: Predicate
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class Equivalence:
    """`p IFONLYIF q`."""

    left: Predicate
    right: Predicate
    span: Span = field(default=NOWHERE, compare=False)


Predicate: TypeAlias = (
    Truth | Comparison | Execution | Reference | Negation | Conjunction | Disjunction | Implication | Equivalence
)


@dataclass(frozen=True, slots=True)
class VariableDeclaration:
    """`state NAME can be VALUE, …`: one value or more."""

    name: Name
    values: tuple[Name, ...]
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class AliasDefinition:
    """`define NAME as PREDICATE`."""

    name: Name
    predicate: Predicate
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class ResourceDeclaration:
    """`resource NAME`."""

    name: Name
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class Duration:
    """`duration: N`, or `cost: N` in older files."""

    value: int
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class ControlledResources:
    """`controlled resources: R, …`; none at all is written `none`."""

    names: tuple[Name, ...]
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class Preconditions:
    """`preconditions: PREDICATE, …`; none at all is written `none`."""

    predicates: tuple[Predicate, ...]
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class NominalEffects:
    """`nominal effects: PREDICATE, …`, or `effects:` in older files; no change at all is written `none`."""

    predicates: tuple[Predicate, ...]
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class AlternativeEffects:
    """`alternative effects: PREDICATE, …`; no change at all is written `none`."""

    predicates: tuple[Predicate, ...]
    span: Span = field(default=NOWHERE, compare=False)


Field: TypeAlias = Duration | ControlledResources | Preconditions | NominalEffects | AlternativeEffects


@dataclass(frozen=True, slots=True)
class ActionDeclaration:
    """`action NAME` and its fields, as they stand."""

    name: Name
    fields: tuple[Field, ...]
    span: Span = field(default=NOWHERE, compare=False)


Declaration: TypeAlias = VariableDeclaration | AliasDefinition | ResourceDeclaration | ActionDeclaration


@dataclass(frozen=True, slots=True)
class SimpleGoal:
    """`goal: PREDICATE`."""

    predicate: Predicate
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class ConditionalGoal:
    """`when PREDICATE then` and a goal or a list of goals."""

    condition: Predicate
    goal: SimpleGoal | GoalList
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class GoalList:
    """`BEGIN GOALS goal type: … END GOALS`. The kind is None in a block that holds nothing."""

    kind: Literal["priority", "constraint"] | None
    members: tuple[Goal, ...]
    span: Span = field(default=NOWHERE, compare=False)


Goal: TypeAlias = SimpleGoal | ConditionalGoal | GoalList


@dataclass(frozen=True, slots=True)
class MaxPlanLength:
    """`max_plan_length: N`."""

    value: int
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class EffectOrdering:
    """`effect_ordering: any` or `first`."""

    value: Literal["any", "first"]
    span: Span = field(default=NOWHERE, compare=False)


Setting: TypeAlias = MaxPlanLength | EffectOrdering


@dataclass(frozen=True, slots=True)
class StateVector:
    """`BEGIN STATE VECTOR`."""

    variables: tuple[VariableDeclaration, ...]
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class Aliases:
    """`BEGIN ALIASES`."""

    definitions: tuple[AliasDefinition, ...]
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class Resources:
    """`BEGIN RESOURCES`."""

    resources: tuple[ResourceDeclaration, ...]
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class Actions:
    """`BEGIN ACTIONS`."""

    actions: tuple[ActionDeclaration, ...]
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class ReactionRules:
    """`BEGIN REACTION RULES`."""

    rules: tuple[Predicate, ...]
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class StateRules:
    """`BEGIN STATE RULES`."""

    rules: tuple[Predicate, ...]
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class Assumptions:
    """`BEGIN ASSUMPTIONS`."""

    assumptions: tuple[Predicate, ...]
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class Goals:
    """The outermost `BEGIN GOALS`."""

    goals: GoalList
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class Config:
    """`BEGIN CONFIG`."""

    settings: tuple[Setting, ...]
    span: Span = field(default=NOWHERE, compare=False)


Block: TypeAlias = (
    StateVector | Aliases | Resources | Actions | ReactionRules | StateRules | Assumptions | Goals | Config
)


@dataclass(frozen=True, slots=True)
class Specification:
    """A whole text: its blocks, in the order in which they stand."""

    blocks: tuple[Block, ...]
    span: Span = field(default=NOWHERE, compare=False)
