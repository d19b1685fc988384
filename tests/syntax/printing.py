"""Whole specifications as text, the inverse of the parser: for trees that no text stands for yet."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from tumato_symbolic.syntax import ast
from tumato_symbolic.syntax.printer import print_effect, print_header, print_items, print_number, print_predicate


def print_specification(tree: ast.Specification) -> str:
    """A text whose tree is `tree`, one item per line."""
    return "\n".join(line for block in tree.blocks for line in (*_block(block), "")) if tree.blocks else ""


def _block(block: ast.Block) -> Iterator[str]:
    match block:
        case ast.StateVector(variables):
            yield from _framed("STATE VECTOR", variables)
        case ast.Aliases(definitions):
            yield from _framed("ALIASES", definitions)
        case ast.Resources(resources):
            yield from _framed("RESOURCES", resources)
        case ast.Actions(actions):
            yield from _framed("ACTIONS", actions)
        case ast.ReactionRules(rules):
            yield from _framed("REACTION RULES", rules)
        case ast.StateRules(rules):
            yield from _framed("STATE RULES", rules)
        case ast.Assumptions(assumptions):
            yield from _framed("ASSUMPTIONS", assumptions, "assume")
        case ast.Start(conditions):
            yield from _framed("START", conditions, "start")
        case ast.Goals(goals):
            yield from _goal(goals)
        case ast.Config(settings):
            yield from _framed("CONFIG", settings)


def _framed(title: str, entries: Iterable[ast.Entry], keyword: str = "rule") -> Iterator[str]:
    yield f"BEGIN {title}"
    for each in entries:
        yield from _entry(each, keyword)
    yield f"END {title}"


def _entry(entry: ast.Entry, keyword: str) -> Iterator[str]:
    """What a block holds; `keyword` is what stands before a predicate."""
    match entry:
        case ast.Copies(header, entries):
            yield f"for {print_header(header)}"
            for each in entries:
                yield from (f"  {line}" for line in _entry(each, keyword))
            yield "end for"
        case ast.VariableDeclaration(name, values):
            yield f"state {name.text} can be {print_items(values)}"
        case ast.AliasDefinition(name, predicate):
            yield f"define {name.text} as {print_predicate(predicate)}"
        case ast.NamedList(name, items):
            yield f"define {name.text} as {{ {print_items(items)} }}"
        case ast.ResourceDeclaration(name):
            yield f"resource {name.text}"
        case ast.ActionDeclaration(name, fields):
            yield f"action {name.text}"
            for field in fields:
                yield from (f"  {line}" for line in _entry(field, keyword))
        case ast.SimpleGoal() | ast.ConditionalGoal() | ast.GoalList():
            yield from _goal(entry)
        case ast.Duration() | ast.ControlledResources() | ast.Preconditions():
            yield _field(entry)
        case ast.NominalEffects() | ast.AlternativeEffects() | ast.Clause():
            yield from _effect_set(entry)
        case ast.Severity(value):
            yield f"severity: {print_number(value)}"
        case ast.MaxPlanLength() | ast.EffectOrdering() | ast.Restoration() | ast.PreconditionsHold():
            yield _setting(entry)
        case _:
            yield f"{keyword}: {print_predicate(entry)}"


def _effect_set(effects: ast.NominalEffects | ast.AlternativeEffects | ast.Clause) -> Iterator[str]:
    if isinstance(effects, ast.Clause):
        yield f"when {print_predicate(effects.condition)}: {_effects(effects.effects)}"
        return
    kind = "nominal" if isinstance(effects, ast.NominalEffects) else "alternative"
    yield f"{kind} effects: {_effects(effects.effects)}"
    for clause in effects.clauses:
        yield from (f"  {line}" for line in _entry(clause, "when"))


def _names(names: tuple[ast.Name, ...]) -> str:
    return ", ".join(each.text for each in names) or "none"


def _predicates(predicates: tuple[ast.Predicate, ...]) -> str:
    return ", ".join(print_predicate(each) for each in predicates) or "none"


def _effects(effects: tuple[ast.Effect, ...]) -> str:
    return ", ".join(print_effect(each) for each in effects) or "none"


def _field(field: ast.Duration | ast.ControlledResources | ast.Preconditions) -> str:
    match field:
        case ast.Duration(value):
            return f"duration: {print_number(value)}"
        case ast.ControlledResources(names):
            return f"controlled resources: {_names(names)}"
        case ast.Preconditions(predicates):
            return f"preconditions: {_predicates(predicates)}"


def _goal(goal: ast.Goal | ast.Copies, indent: str = "") -> Iterator[str]:
    match goal:
        case ast.Copies(header, entries):
            yield f"{indent}for {print_header(header)}"
            for each in entries:
                assert isinstance(each, ast.SimpleGoal | ast.ConditionalGoal | ast.GoalList | ast.Copies)
                yield from _goal(each, indent + "  ")
            yield f"{indent}end for"
        case ast.SimpleGoal(predicate):
            yield f"{indent}goal: {print_predicate(predicate)}"
        case ast.ConditionalGoal(condition, inner):
            yield f"{indent}when {print_predicate(condition)} then"
            yield from _goal(inner, indent + "  ")
        case ast.GoalList(kind, members):
            yield f"{indent}BEGIN GOALS"
            if kind is not None:
                yield f"{indent}goal type: {kind}"
            for each in members:
                yield from _goal(each, indent if not indent and not isinstance(each, ast.GoalList) else indent + "  ")
            yield f"{indent}END GOALS"


def _setting(setting: ast.Setting) -> str:
    match setting:
        case ast.MaxPlanLength(value):
            return f"max_plan_length: {print_number(value)}"
        case ast.EffectOrdering(value):
            return f"effect_ordering: {value}"
        case ast.Restoration(value):
            return f"restoration: {value}"
        case ast.PreconditionsHold(value):
            return f"preconditions: {value}"
