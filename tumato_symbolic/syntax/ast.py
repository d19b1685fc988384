"""What a specification says, before any name is resolved.

Every node is frozen and carries the span of text that it stands for; spans play no part in comparisons, so that two
texts with the same tree differ in layout and comments only. The printer is the inverse of the parser.

Longer than 300 lines because it has one small record for every sentence of the language, and nothing else.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Literal, TypeAlias, TypeVar

from tumato_symbolic.diagnostics import Span

One = TypeVar("One")

NOWHERE = Span(1, 1, 1, 1)
"""The span of a node that no text stands for."""


class Node:
    """What all nodes share: how they compare and how they are shown.

    One method for all nodes, because generating one for each of thirty classes slows down every start.
    """

    __slots__: tuple[str, ...] = ()

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Node) and type(self) is type(other) and self._values() == other._values()

    def __hash__(self) -> int:
        return hash(self._values())

    def __repr__(self) -> str:
        return f"{type(self).__name__}({', '.join(map(repr, self._values()))})"

    def _values(self) -> tuple[object, ...]:
        return tuple(getattr(self, name) for name in self.__slots__ if name != "span")


def number(value: int | Name) -> int:
    """A number where copies are written out: it is no name with parameters in it."""
    assert isinstance(value, int), "copies are written out before names are resolved"
    return value


def one_by_one(entries: Iterable[One | Copies]) -> Iterator[One]:
    """Entries where copies are written out: there are none among them, and none would be passed over."""
    for each in entries:
        assert not isinstance(each, Copies), "copies are written out before names are resolved"
        yield each


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Name(Node):
    """A name as it is written in one place."""

    text: str
    span: Span = NOWHERE


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Range(Node):
    """`LOW..HIGH`: all whole numbers from one to the other."""

    low: Name
    high: Name
    span: Span = NOWHERE


Item: TypeAlias = Name | Range
"""What stands in a list of values: one, by name or as a number, or a range of numbers."""


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Truth(Node):
    """`true` or `false`."""

    value: bool
    span: Span = NOWHERE


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Comparison(Node):
    """`VARIABLE is VALUE`."""

    variable: Name
    value: Name
    span: Span = NOWHERE


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Difference(Node):
    """`VARIABLE is not VALUE`."""

    variable: Name
    value: Name
    span: Span = NOWHERE


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Membership(Node):
    """`VARIABLE in {VALUE, …}`, or `not in`."""

    variable: Name
    items: tuple[Item, ...]
    negated: bool
    span: Span = NOWHERE


Operator: TypeAlias = Literal["<", "<=", ">", ">=", "=", "!="]


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Ordering(Node):
    """`VARIABLE < NUMBER` or `VARIABLE < VARIABLE`, with this operator or another; `sign` is where that stands."""

    variable: Name
    operator: Operator
    other: Name
    sign: Span = NOWHERE
    span: Span = NOWHERE

    def _values(self) -> tuple[object, ...]:
        return self.variable, self.operator, self.other


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Parameter(Node):
    """`NAME in VALUE, …`, or `NAME in {VALUE, …}`."""

    name: Name
    items: tuple[Item, ...]
    braced: bool
    span: Span = NOWHERE


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Operand(Node):
    """A side of a condition: a parameter, a word or a number, and what is added to it."""

    name: Name
    offset: int = 0
    span: Span = NOWHERE


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Condition(Node):
    """`OPERAND < OPERAND` after `where`, with this operator or another."""

    left: Operand
    operator: Operator
    right: Operand
    span: Span = NOWHERE


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Header(Node):
    """The parameters of copies and the conditions that they have to satisfy."""

    parameters: tuple[Parameter, ...]
    conditions: tuple[Condition, ...]
    span: Span = NOWHERE


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Quantifier(Node):
    """`all`, `some` or `exactly one`, a header, and a predicate about it."""

    kind: Literal["all", "some", "exactly one"]
    header: Header
    body: Predicate
    span: Span = NOWHERE


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Copies(Node):
    """`for`, a header, what is copied, and `end for`."""

    header: Header
    entries: tuple[Entry, ...]
    span: Span = NOWHERE


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Execution(Node):
    """`executing ACTION`."""

    action: Name
    span: Span = NOWHERE


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Reference(Node):
    """An alias, by name."""

    name: Name
    span: Span = NOWHERE


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Negation(Node):
    """`NOT p`."""

    operand: Predicate
    span: Span = NOWHERE


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Conjunction(Node):
    """`p AND q AND …`: two operands or more."""

    operands: tuple[Predicate, ...]
    span: Span = NOWHERE


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Disjunction(Node):
    """`p OR q OR …`: two operands or more."""

    operands: tuple[Predicate, ...]
    span: Span = NOWHERE


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Implication(Node):
    """`IF p THEN q`."""

    condition: Predicate
    consequence: Predicate
    span: Span = NOWHERE


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Equivalence(Node):
    """`p IFONLYIF q`."""

    left: Predicate
    right: Predicate
    span: Span = NOWHERE


Predicate: TypeAlias = (
    Truth
    | Comparison
    | Difference
    | Membership
    | Ordering
    | Quantifier
    | Execution
    | Reference
    | Negation
    | Conjunction
    | Disjunction
    | Implication
    | Equivalence
)


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class VariableDeclaration(Node):
    """`state NAME can be VALUE, …`: one value or more."""

    name: Name
    values: tuple[Item, ...]
    span: Span = NOWHERE


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class AliasDefinition(Node):
    """`define NAME as PREDICATE`."""

    name: Name
    predicate: Predicate
    span: Span = NOWHERE


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class NamedList(Node):
    """`define NAME as {VALUE, …}`."""

    name: Name
    items: tuple[Item, ...]
    span: Span = NOWHERE


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class ResourceDeclaration(Node):
    """`resource NAME`."""

    name: Name
    span: Span = NOWHERE


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Duration(Node):
    """`duration: N`, or `cost: N` in older files. Among copies, the number may be a name with parameters in it."""

    value: int | Name
    span: Span = NOWHERE


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class ControlledResources(Node):
    """`controlled resources: R, …`; none at all is written `none`."""

    names: tuple[Name, ...]
    span: Span = NOWHERE


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Preconditions(Node):
    """`preconditions: PREDICATE, …`; none at all is written `none`."""

    predicates: tuple[Predicate, ...]
    span: Span = NOWHERE


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Change(Node):
    """`VARIABLE is VARIABLE + NUMBER`, or `-`. Among copies, the number may be a name with parameters in it."""

    variable: Name
    origin: Name
    sign: Literal["+", "-"]
    value: int | Name
    span: Span = NOWHERE


Effect: TypeAlias = Predicate | Change


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Clause(Node):
    """`when PREDICATE: EFFECT, …` in a set of effects."""

    condition: Predicate
    effects: tuple[Effect, ...]
    span: Span = NOWHERE


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class NominalEffects(Node):
    """`nominal effects: EFFECT, …`, or `effects:` in older files, and clauses; no change at all is written `none`."""

    effects: tuple[Effect, ...]
    clauses: tuple[Clause | Copies, ...] = ()
    span: Span = NOWHERE


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class AlternativeEffects(Node):
    """`alternative effects: EFFECT, …` and clauses; no change at all is written `none`."""

    effects: tuple[Effect, ...]
    clauses: tuple[Clause | Copies, ...] = ()
    span: Span = NOWHERE


Field: TypeAlias = Duration | ControlledResources | Preconditions | NominalEffects | AlternativeEffects


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class ActionDeclaration(Node):
    """`action NAME` and its fields, as they stand."""

    name: Name
    fields: tuple[Field | Copies, ...]
    span: Span = NOWHERE


Declaration: TypeAlias = VariableDeclaration | AliasDefinition | NamedList | ResourceDeclaration | ActionDeclaration


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class SimpleGoal(Node):
    """`goal: PREDICATE`."""

    predicate: Predicate
    span: Span = NOWHERE


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class ConditionalGoal(Node):
    """`when PREDICATE then` and a goal or a list of goals."""

    condition: Predicate
    goal: SimpleGoal | GoalList
    span: Span = NOWHERE


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class GoalList(Node):
    """`BEGIN GOALS goal type: … END GOALS`. The kind is None in a block that holds nothing."""

    kind: Literal["priority", "constraint"] | None
    members: tuple[Goal | Copies, ...]
    span: Span = NOWHERE


Goal: TypeAlias = SimpleGoal | ConditionalGoal | GoalList


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class MaxPlanLength(Node):
    """`max_plan_length: N`. Among copies, the number may be a name with parameters in it."""

    value: int | Name
    span: Span = NOWHERE


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class EffectOrdering(Node):
    """`effect_ordering: any` or `first`."""

    value: Literal["any", "first"]
    span: Span = NOWHERE


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Restoration(Node):
    """`restoration: one_step`, `bounded` or `fair`."""

    value: Literal["one_step", "bounded", "fair"]
    span: Span = NOWHERE


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class PreconditionsHold(Node):
    """`preconditions: at_start` or `throughout`."""

    value: Literal["at_start", "throughout"]
    span: Span = NOWHERE


Setting: TypeAlias = MaxPlanLength | EffectOrdering | Restoration | PreconditionsHold


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class StateVector(Node):
    """`BEGIN STATE VECTOR`."""

    variables: tuple[VariableDeclaration | Copies, ...]
    span: Span = NOWHERE


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Aliases(Node):
    """`BEGIN ALIASES`."""

    definitions: tuple[AliasDefinition | NamedList | Copies, ...]
    span: Span = NOWHERE


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Resources(Node):
    """`BEGIN RESOURCES`."""

    resources: tuple[ResourceDeclaration | Copies, ...]
    span: Span = NOWHERE


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Actions(Node):
    """`BEGIN ACTIONS`."""

    actions: tuple[ActionDeclaration | Copies, ...]
    span: Span = NOWHERE


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class ReactionRules(Node):
    """`BEGIN REACTION RULES`."""

    rules: tuple[Predicate | Copies, ...]
    span: Span = NOWHERE


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Severity(Node):
    """`severity: N`: how severe the state rules after it are."""

    value: int | Name
    span: Span = NOWHERE


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class StateRules(Node):
    """`BEGIN STATE RULES`."""

    rules: tuple[Predicate | Severity | Copies, ...]
    span: Span = NOWHERE


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Assumptions(Node):
    """`BEGIN ASSUMPTIONS`."""

    assumptions: tuple[Predicate | Copies, ...]
    span: Span = NOWHERE


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Start(Node):
    """`BEGIN START`."""

    conditions: tuple[Predicate | Copies, ...]
    span: Span = NOWHERE


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Goals(Node):
    """The outermost `BEGIN GOALS`."""

    goals: GoalList
    span: Span = NOWHERE


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Config(Node):
    """`BEGIN CONFIG`."""

    settings: tuple[Setting | Copies, ...]
    span: Span = NOWHERE


Entry: TypeAlias = Declaration | Field | Clause | Predicate | Severity | Goal | Setting | Copies
"""What copies are made of."""

Block: TypeAlias = (
    StateVector | Aliases | Resources | Actions | ReactionRules | StateRules | Assumptions | Start | Goals | Config
)


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Specification(Node):
    """A whole text: its blocks, in the order in which they stand."""

    blocks: tuple[Block, ...]
    span: Span = NOWHERE
