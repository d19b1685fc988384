"""Trees for property tests: everything that the parser can yield, and nothing else."""

from __future__ import annotations

from typing import Literal, TypeVar

from hypothesis import strategies as st

from tumato_symbolic.syntax import ast
from tumato_symbolic.syntax.confirming import AFTER_VALUES
from tumato_symbolic.syntax.tokens import HARD

SOFT = [
    "goal", "on", "is", "can", "be", "as", "state", "action", "effects", "cost", "when", "then", "rule", "GOALS",
    "duration", "nominal", "controlled", "alternative", "preconditions", "resources", "STATE", "type", "any", "assume",
    "start",    "not", "in",
]  # fmt: skip
RESERVED = frozenset({"true", "false", "none", "executing"})

Part = TypeVar("Part")

PRECONDITIONS: tuple[Literal["at_start", "throughout"], ...] = ("at_start", "throughout")
RESTORATIONS: tuple[Literal["one_step", "bounded", "fair"], ...] = ("one_step", "bounded", "fair")
ORDERINGS: tuple[Literal["any", "first"], ...] = ("any", "first")

words = st.one_of(st.sampled_from(SOFT), st.from_regex(r"[A-Za-z_][A-Za-z0-9_]{0,8}", fullmatch=True))
values = words.filter(lambda word: word not in HARD).map(ast.Name)
names = words.filter(lambda word: word not in HARD | RESERVED).map(ast.Name)

numbers = st.integers(-(10**17), 10**17).map(str).map(ast.Name)
settled = values | numbers
items = settled | st.builds(ast.Range, settled, settled)
OPERATORS: tuple[ast.Operator, ...] = ("<", "<=", ">", ">=", "=", "!=")

atoms = st.one_of(
    st.booleans().map(ast.Truth),
    st.builds(ast.Comparison, names, settled),
    st.builds(ast.Difference, names, settled.filter(lambda each: each.text not in AFTER_VALUES)),
    st.builds(ast.Membership, names, st.lists(items, min_size=1, max_size=3).map(tuple), st.booleans()),
    st.builds(ast.Ordering, names, st.sampled_from(OPERATORS), settled),
    st.builds(ast.Execution, values),
    names.map(ast.Reference),
)


def _larger(parts: st.SearchStrategy[ast.Predicate]) -> st.SearchStrategy[ast.Predicate]:
    several = st.lists(parts, min_size=2, max_size=3).map(tuple)
    return st.one_of(
        st.builds(ast.Negation, parts),
        st.builds(ast.Conjunction, several),
        st.builds(ast.Disjunction, several),
        st.builds(ast.Implication, parts, parts),
        st.builds(ast.Equivalence, parts, parts),
    )


predicates: st.SearchStrategy[ast.Predicate] = st.recursive(atoms, _larger, max_leaves=8)


def _some(parts: st.SearchStrategy[Part], least: int = 0) -> st.SearchStrategy[tuple[Part, ...]]:
    return st.lists(parts, min_size=least, max_size=3).map(tuple)


fields = st.one_of(
    st.integers(-(10**9), 10**9).map(ast.Duration),
    _some(names).map(ast.ControlledResources),
    _some(predicates).map(ast.Preconditions),
    _some(predicates).map(ast.NominalEffects),
    _some(predicates).map(ast.AlternativeEffects),
)
simple_goals = predicates.map(ast.SimpleGoal)
goal_lists: st.SearchStrategy[ast.GoalList] = st.deferred(
    lambda: st.one_of(
        st.just(ast.GoalList(None, ())),
        st.builds(ast.GoalList, st.sampled_from(["priority", "constraint"]), _some(goals)),
    )
)
goals: st.SearchStrategy[ast.Goal] = st.deferred(
    lambda: st.one_of(simple_goals, st.builds(ast.ConditionalGoal, predicates, simple_goals | goal_lists), goal_lists)
)
blocks = st.one_of(
    _some(st.builds(ast.VariableDeclaration, names, _some(items, 1))).map(ast.StateVector),
    _some(st.builds(ast.AliasDefinition, names, predicates)).map(ast.Aliases),
    _some(names.map(ast.ResourceDeclaration)).map(ast.Resources),
    _some(st.builds(ast.ActionDeclaration, names, _some(fields))).map(ast.Actions),
    _some(predicates).map(ast.ReactionRules),
    _some(predicates | st.integers(-5, 10**6).map(ast.Severity)).map(ast.StateRules),
    _some(predicates).map(ast.Assumptions),
    _some(predicates).map(ast.Start),
    goal_lists.map(ast.Goals),
    _some(
        st.integers(-5, 10**6).map(ast.MaxPlanLength)
        | st.sampled_from(ORDERINGS).map(ast.EffectOrdering)
        | st.sampled_from(RESTORATIONS).map(ast.Restoration)
        | st.sampled_from(PRECONDITIONS).map(ast.PreconditionsHold)
    ).map(ast.Config),
)
specifications = st.lists(blocks, max_size=4).map(lambda each: ast.Specification(tuple(each)))
