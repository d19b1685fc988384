"""Parts of a tree as text: predicates, effects, and what they are made of."""

from __future__ import annotations

from tumato_symbolic.syntax import ast

_EQUIVALENCE, _IMPLICATION, _DISJUNCTION, _CONJUNCTION, _NEGATION, _BASIC = range(6)
"""How tightly each form binds."""


def print_predicate(predicate: ast.Predicate, tightness: int = -1) -> str:
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
        case ast.Quantifier(kind, header, body):
            return _EQUIVALENCE - 1, f"{kind} {print_header(header)}: {print_predicate(body)}"
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
            return f"{variable.text} {'not in' if negated else 'in'} {{{print_items(items)}}}"
        case ast.Ordering(variable, operator, other):
            return f"{variable.text} {operator} {other.text}"
        case ast.Execution(action):
            return f"executing {action.text}"
        case ast.Reference(name):
            return name.text
        case ast.Truth(value):
            return "true" if value else "false"


def print_header(header: ast.Header) -> str:
    """The parameters of copies or of a quantifier, and their conditions."""
    parameters = [
        f"{each.name.text} in {f'{{ {print_items(each.items)} }}' if each.braced else print_items(each.items)}"
        for each in header.parameters
    ]
    conditions = [f"{_operand(each.left)} {each.operator} {_operand(each.right)}" for each in header.conditions]
    return ", ".join(parameters) + (f" where {', '.join(conditions)}" if conditions else "")


def _operand(operand: ast.Operand) -> str:
    return f"{operand.name.text}{operand.offset:+d}" if operand.offset else operand.name.text


def print_number(value: int | ast.Name) -> str:
    """A number, or the name with parameters that stands for one."""
    return value.text if isinstance(value, ast.Name) else str(value)


def print_items(items: tuple[ast.Item, ...]) -> str:
    """The entries of a list of values."""
    texts = (each.text if isinstance(each, ast.Name) else f"{each.low.text}..{each.high.text}" for each in items)
    return ", ".join(texts)


def print_effect(effect: ast.Effect) -> str:
    """A predicate, or a change of a value by a number."""
    if not isinstance(effect, ast.Change):
        return print_predicate(effect)
    return f"{effect.variable.text} is {effect.origin.text} {effect.sign} {print_number(effect.value)}"
