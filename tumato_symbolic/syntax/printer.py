"""Tree to text: the inverse of the parser."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from tumato_symbolic.syntax import ast

_EQUIVALENCE, _IMPLICATION, _DISJUNCTION, _CONJUNCTION, _NEGATION, _BASIC = range(6)
"""How tightly each form binds."""


def print_specification(tree: ast.Specification) -> str:
    """A text whose tree is `tree`, one item per line."""
    return "\n".join(line for block in tree.blocks for line in (*_block(block), "")) if tree.blocks else ""


def print_predicate(predicate: ast.Predicate, tightness: int = _EQUIVALENCE) -> str:
    """A predicate, in parentheses where what is around it binds as tightly as `tightness`."""
    own, text = _predicate(predicate)
    return text if own >= tightness else f"({text})"


def _predicate(predicate: ast.Predicate) -> tuple[int, str]:
    match predicate:
        case ast.Equivalence(left, right):
            return (
                _EQUIVALENCE,
                f"{print_predicate(left, _IMPLICATION)} IFONLYIF {print_predicate(right, _DISJUNCTION)}",
            )
        case ast.Implication(condition, consequence):
            sides = print_predicate(condition, _DISJUNCTION), print_predicate(consequence, _DISJUNCTION)
            return _IMPLICATION, f"IF {sides[0]} THEN {sides[1]}"
        case ast.Disjunction(operands):
            return _DISJUNCTION, " OR ".join([print_predicate(each, _CONJUNCTION) for each in operands])
        case ast.Conjunction(operands):
            return _CONJUNCTION, " AND ".join([print_predicate(each, _NEGATION) for each in operands])
        case ast.Negation(operand):
            return _NEGATION, f"NOT {print_predicate(operand, _NEGATION)}"
        case _:
            return _BASIC, _basic(predicate)


def _basic(
    predicate: ast.Truth
    | ast.Comparison
    | ast.Difference
    | ast.Membership
    | ast.Ordering
    | ast.Execution
    | ast.Reference,
) -> str:
    match predicate:
        case ast.Comparison(variable, value):
            return f"{variable.text} is {value.text}"
        case ast.Difference(variable, value):
            return f"{variable.text} is not {value.text}"
        case ast.Membership(variable, items, negated):
            return f"{variable.text} {'not in' if negated else 'in'} {{{_items(items)}}}"
        case ast.Ordering(variable, operator, other):
            return f"{variable.text} {operator} {other.text}"
        case ast.Execution(action):
            return f"executing {action.text}"
        case ast.Reference(name):
            return name.text
        case ast.Truth(value):
            return "true" if value else "false"


def _block(block: ast.Block) -> Iterator[str]:
    match block:
        case ast.StateVector(variables):
            yield from _framed(
                "STATE VECTOR", (f"state {each.name.text} can be {_items(each.values)}" for each in variables)
            )
        case ast.Aliases(definitions):
            lines = (f"define {each.name.text} as {print_predicate(each.predicate)}" for each in definitions)
            yield from _framed("ALIASES", lines)
        case ast.Resources(resources):
            yield from _framed("RESOURCES", (f"resource {each.name.text}" for each in resources))
        case ast.Actions(actions):
            yield from _framed("ACTIONS", (line for each in actions for line in _action(each)))
        case ast.ReactionRules(rules):
            yield from _framed("REACTION RULES", (f"rule: {print_predicate(each)}" for each in rules))
        case ast.StateRules(rules):
            yield from _framed("STATE RULES", (_state_rule(each) for each in rules))
        case ast.Assumptions(assumptions):
            yield from _framed("ASSUMPTIONS", (f"assume: {print_predicate(each)}" for each in assumptions))
        case ast.Goals(goals):
            yield from _goal(goals)
        case ast.Config(settings):
            yield from _framed("CONFIG", (_setting(each) for each in settings))


def _state_rule(rule: ast.Predicate | ast.Severity) -> str:
    return f"severity: {rule.value}" if isinstance(rule, ast.Severity) else f"rule: {print_predicate(rule)}"


def _framed(title: str, lines: Iterable[str]) -> Iterator[str]:
    yield f"BEGIN {title}"
    yield from lines
    yield f"END {title}"


def _names(names: tuple[ast.Name, ...]) -> str:
    return ", ".join(each.text for each in names) or "none"


def _items(items: tuple[ast.Item, ...]) -> str:
    texts = (each.text if isinstance(each, ast.Name) else f"{each.low.text}..{each.high.text}" for each in items)
    return ", ".join(texts)


def _predicates(predicates: tuple[ast.Predicate, ...]) -> str:
    return ", ".join(print_predicate(each) for each in predicates) or "none"


def _action(action: ast.ActionDeclaration) -> Iterator[str]:
    yield f"action {action.name.text}"
    for each in action.fields:
        yield f"  {_field(each)}"


def _field(field: ast.Field) -> str:
    match field:
        case ast.Duration(value):
            return f"duration: {value}"
        case ast.ControlledResources(names):
            return f"controlled resources: {_names(names)}"
        case ast.Preconditions(predicates):
            return f"preconditions: {_predicates(predicates)}"
        case ast.NominalEffects(predicates):
            return f"nominal effects: {_predicates(predicates)}"
        case ast.AlternativeEffects(predicates):
            return f"alternative effects: {_predicates(predicates)}"


def _goal(goal: ast.Goal, indent: str = "") -> Iterator[str]:
    match goal:
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
            return f"max_plan_length: {value}"
        case ast.EffectOrdering(value):
            return f"effect_ordering: {value}"
        case ast.Restoration(value):
            return f"restoration: {value}"
        case ast.PreconditionsHold(value):
            return f"preconditions: {value}"
