"""What a specification says, before any name is resolved.

Every node is frozen and carries the span of text that it stands for; spans play no part in comparisons, so that two
texts with the same tree differ in layout and comments only.

Longer than 300 lines because it has one small record for every sentence of the language, and nothing else.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Literal, TypeAlias, TypeVar

from msgspec import Struct

from tumato_symbolic.diagnostics import Span

One = TypeVar("One")

NOWHERE = Span(1, 1, 1, 1)
"""The span of a node that no text stands for."""


class Node(Struct, frozen=True, eq=False, kw_only=True):
    """What all nodes share: their span, how they compare and how they are shown."""

    span: Span = NOWHERE

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Node) and type(self) is type(other) and self._values() == other._values()

    def __hash__(self) -> int:
        return hash(self._values())

    def __repr__(self) -> str:
        return f"{type(self).__name__}({', '.join(map(repr, self._values()))})"

    def _values(self) -> tuple[object, ...]:
        return tuple(getattr(self, name) for name in self.__struct_fields__ if name != "span")


def number(value: int | Name) -> int:
    """A number where copies are written out: it is no name with parameters in it."""
    assert isinstance(value, int), "copies are written out before names are resolved"
    return value


def one_by_one(entries: Iterable[One | Copies]) -> Iterator[One]:
    """Entries where copies are written out: there are none among them, and none would be passed over."""
    for each in entries:
        assert not isinstance(each, Copies), "copies are written out before names are resolved"
        yield each


class Name(Node, frozen=True):
    """A name as it is written in one place."""

    text: str


class Range(Node, frozen=True):
    """`LOW..HIGH`: all whole numbers from one to the other."""

    low: Name
    high: Name


Item: TypeAlias = Name | Range
"""What stands in a list of values: one, by name or as a number, or a range of numbers."""


class Truth(Node, frozen=True):
    """`true` or `false`."""

    value: bool


class Comparison(Node, frozen=True):
    """`VARIABLE is VALUE`."""

    variable: Name
    value: Name


class Difference(Node, frozen=True):
    """`VARIABLE is not VALUE`."""

    variable: Name
    value: Name


class Membership(Node, frozen=True):
    """`VARIABLE in {VALUE, …}`, or `not in`."""

    variable: Name
    items: tuple[Item, ...]
    negated: bool


Operator: TypeAlias = Literal["<", "<=", ">", ">=", "=", "!="]


class Ordering(Node, frozen=True):
    """`VARIABLE < NUMBER` or `VARIABLE < VARIABLE`, with this operator or another; `sign` is where that stands."""

    variable: Name
    operator: Operator
    other: Name
    sign: Span = NOWHERE

    def _values(self) -> tuple[object, ...]:
        return self.variable, self.operator, self.other


class Parameter(Node, frozen=True):
    """`NAME in VALUE, …`, or `NAME in {VALUE, …}`."""

    name: Name
    items: tuple[Item, ...]
    braced: bool


class Operand(Node, frozen=True):
    """A side of a condition: a parameter, a word or a number, and what is added to it."""

    name: Name
    offset: int = 0


class Condition(Node, frozen=True):
    """`OPERAND < OPERAND` after `where`, with this operator or another."""

    left: Operand
    operator: Operator
    right: Operand


class Header(Node, frozen=True):
    """The parameters of copies and the conditions that they have to satisfy."""

    parameters: tuple[Parameter, ...]
    conditions: tuple[Condition, ...]


class Quantifier(Node, frozen=True):
    """`all`, `some` or `exactly one`, a header, and a predicate about it."""

    kind: Literal["all", "some", "exactly one"]
    header: Header
    body: Predicate


class Copies(Node, frozen=True):
    """`for`, a header, what is copied, and `end for`."""

    header: Header
    entries: tuple[Entry, ...]


class Execution(Node, frozen=True):
    """`executing ACTION`."""

    action: Name


class Reference(Node, frozen=True):
    """An alias, by name."""

    name: Name


class Negation(Node, frozen=True):
    """`NOT p`."""

    operand: Predicate


class Conjunction(Node, frozen=True):
    """`p AND q AND …`: two operands or more."""

    operands: tuple[Predicate, ...]


class Disjunction(Node, frozen=True):
    """`p OR q OR …`: two operands or more."""

    operands: tuple[Predicate, ...]


class Implication(Node, frozen=True):
    """`IF p THEN q`."""

    condition: Predicate
    consequence: Predicate


class Equivalence(Node, frozen=True):
    """`p IFONLYIF q`."""

    left: Predicate
    right: Predicate


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


class VariableDeclaration(Node, frozen=True):
    """`state NAME can be VALUE, …`: one value or more."""

    name: Name
    values: tuple[Item, ...]


class AliasDefinition(Node, frozen=True):
    """`define NAME as PREDICATE`."""

    name: Name
    predicate: Predicate


class NamedList(Node, frozen=True):
    """`define NAME as {VALUE, …}`."""

    name: Name
    items: tuple[Item, ...]


class ResourceDeclaration(Node, frozen=True):
    """`resource NAME`."""

    name: Name


class Duration(Node, frozen=True):
    """`duration: N`, or `cost: N` in older files. Among copies, the number may be a name with parameters in it."""

    value: int | Name


class ControlledResources(Node, frozen=True):
    """`controlled resources: R, …`; none at all is written `none`."""

    names: tuple[Name, ...]


class Preconditions(Node, frozen=True):
    """`preconditions: PREDICATE, …`; none at all is written `none`."""

    predicates: tuple[Predicate, ...]


class Change(Node, frozen=True):
    """`VARIABLE is VARIABLE + NUMBER`, or `-`. Among copies, the number may be a name with parameters in it."""

    variable: Name
    origin: Name
    sign: Literal["+", "-"]
    value: int | Name


Effect: TypeAlias = Predicate | Change


class Clause(Node, frozen=True):
    """`when PREDICATE: EFFECT, …` in a set of effects."""

    condition: Predicate
    effects: tuple[Effect, ...]


class NominalEffects(Node, frozen=True):
    """`nominal effects: EFFECT, …`, or `effects:` in older files, and clauses; no change at all is written `none`."""

    effects: tuple[Effect, ...]
    clauses: tuple[Clause | Copies, ...] = ()


class AlternativeEffects(Node, frozen=True):
    """`alternative effects: EFFECT, …` and clauses; no change at all is written `none`."""

    effects: tuple[Effect, ...]
    clauses: tuple[Clause | Copies, ...] = ()


Field: TypeAlias = Duration | ControlledResources | Preconditions | NominalEffects | AlternativeEffects


class ActionDeclaration(Node, frozen=True):
    """`action NAME` and its fields, as they stand."""

    name: Name
    fields: tuple[Field | Copies, ...]


Declaration: TypeAlias = VariableDeclaration | AliasDefinition | NamedList | ResourceDeclaration | ActionDeclaration


class SimpleGoal(Node, frozen=True):
    """`goal: PREDICATE`."""

    predicate: Predicate


class ConditionalGoal(Node, frozen=True):
    """`when PREDICATE then` and a goal or a list of goals."""

    condition: Predicate
    goal: SimpleGoal | GoalList


class GoalList(Node, frozen=True):
    """`BEGIN GOALS goal type: … END GOALS`. The kind is None in a block that holds nothing."""

    kind: Literal["priority", "constraint"] | None
    members: tuple[Goal | Copies, ...]


Goal: TypeAlias = SimpleGoal | ConditionalGoal | GoalList


class MaxPlanLength(Node, frozen=True):
    """`max_plan_length: N`. Among copies, the number may be a name with parameters in it."""

    value: int | Name


class EffectOrdering(Node, frozen=True):
    """`effect_ordering: any` or `first`."""

    value: Literal["any", "first"]


class Restoration(Node, frozen=True):
    """`restoration: one_step`, `bounded` or `fair`."""

    value: Literal["one_step", "bounded", "fair"]


class PreconditionsHold(Node, frozen=True):
    """`preconditions: at_start` or `throughout`."""

    value: Literal["at_start", "throughout"]


Setting: TypeAlias = MaxPlanLength | EffectOrdering | Restoration | PreconditionsHold


class StateVector(Node, frozen=True):
    """`BEGIN STATE VECTOR`."""

    variables: tuple[VariableDeclaration | Copies, ...]


class Aliases(Node, frozen=True):
    """`BEGIN ALIASES`."""

    definitions: tuple[AliasDefinition | NamedList | Copies, ...]


class Resources(Node, frozen=True):
    """`BEGIN RESOURCES`."""

    resources: tuple[ResourceDeclaration | Copies, ...]


class Actions(Node, frozen=True):
    """`BEGIN ACTIONS`."""

    actions: tuple[ActionDeclaration | Copies, ...]


class ReactionRules(Node, frozen=True):
    """`BEGIN REACTION RULES`."""

    rules: tuple[Predicate | Copies, ...]


class Severity(Node, frozen=True):
    """`severity: N`: how severe the state rules after it are."""

    value: int | Name


class StateRules(Node, frozen=True):
    """`BEGIN STATE RULES`."""

    rules: tuple[Predicate | Severity | Copies, ...]


class Assumptions(Node, frozen=True):
    """`BEGIN ASSUMPTIONS`."""

    assumptions: tuple[Predicate | Copies, ...]


class Start(Node, frozen=True):
    """`BEGIN START`."""

    conditions: tuple[Predicate | Copies, ...]


class Goals(Node, frozen=True):
    """The outermost `BEGIN GOALS`."""

    goals: GoalList


class Config(Node, frozen=True):
    """`BEGIN CONFIG`."""

    settings: tuple[Setting | Copies, ...]


Entry: TypeAlias = Declaration | Field | Clause | Predicate | Severity | Goal | Setting | Copies
"""What copies are made of."""

Block: TypeAlias = (
    StateVector | Aliases | Resources | Actions | ReactionRules | StateRules | Assumptions | Start | Goals | Config
)


class Specification(Node, frozen=True):
    """A whole text: its blocks, in the order in which they stand."""

    blocks: tuple[Block, ...]
