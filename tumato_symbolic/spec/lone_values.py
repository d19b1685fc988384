"""Values that stand alone beside a predicate about their variable: `S is a OR b`."""

from __future__ import annotations

from collections.abc import Iterable

from tumato_symbolic.diagnostics import Span
from tumato_symbolic.spec.names import Names
from tumato_symbolic.syntax import ast


def lone_values(predicates: Iterable[ast.Predicate], names: Names) -> dict[Span, str | None]:
    """What was surely meant instead of the first value that stands alone; None for those after it, which it covers."""
    found: dict[Span, str | None] = {}
    variable, denied, values = "", False, list[str]()
    lone: list[ast.Name] = []
    for each in (*predicates, None):
        if isinstance(each, ast.Reference) and _has(names, variable, each.name.text):
            lone.append(each.name)
            continue
        if lone:
            listed = ", ".join([*values, *(name.text for name in lone)])
            found.update(dict.fromkeys((name.span for name in lone[1:]), None))
            found[lone[0].span] = f"{variable} {'not ' if denied else ''}in {{{listed}}}"
        lone = []
        variable, denied, values = _said(each)
    return found


def _has(names: Names, variable: str, value: str) -> bool:
    """Whether a name that nothing else has is a value of a variable."""
    declared = names.table.get(variable)
    if declared is None or declared.kind != "state variable" or value in names.table:
        return False
    return value in names.values[declared.number]


def _said(predicate: ast.Predicate | None) -> tuple[str, bool, list[str]]:
    """The variable that a predicate is about, if it is about one, whether it denies values, and which."""
    match predicate:
        case ast.Comparison(variable, value):
            return variable.text, False, [value.text]
        case ast.Difference(variable, value) | ast.Negation(ast.Comparison(variable, value)):
            return variable.text, True, [value.text]
    return "", False, []
