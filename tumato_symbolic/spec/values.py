"""The values that declarations of state variables list, and how many there may be."""

from __future__ import annotations

from collections.abc import Sequence

from msgspec import Struct

from tumato_symbolic.diagnostics import Code, Note, Span
from tumato_symbolic.diagnostics.wording import quoted
from tumato_symbolic.spec.collector import Findings
from tumato_symbolic.spec.numbers import ends_of, texts_of
from tumato_symbolic.syntax import ast

MAX_VALUES = 10_000
"""The most values of one state variable."""

MAX_VALUES_IN_ALL = 1_000_000
"""The most values of all state variables together."""


class Values(Struct, frozen=True):
    """The values of one variable in order, each once; `complete` where no mistake keeps some of them unknown."""

    texts: tuple[str, ...]
    complete: bool


def declared_values(declarations: Sequence[ast.VariableDeclaration], findings: Findings) -> list[Values]:
    """The values of each variable; too many are reported before they are made."""
    found: list[Values] = []
    made = 0
    for declaration in declarations:
        values = _values(declaration, made, findings)
        before, made = made, made + len(values.texts)
        if before <= MAX_VALUES_IN_ALL < made:
            _too_many(
                f"there are more than {MAX_VALUES_IN_ALL:,} values of all state variables", declaration.name, findings
            )
        found.append(values)
    return found


def _values(declaration: ast.VariableDeclaration, made: int, findings: Findings) -> Values:
    places: dict[str, Span] = {}
    reported: set[str] = set()
    complete = True
    listed = 0
    for item in declaration.values:
        ends = ends_of(item, findings)
        if ends is None:
            complete = False
            continue
        before, listed = listed, listed + ends[1] - ends[0] + 1
        if before <= MAX_VALUES < listed:
            _too_many(f"there are more than {MAX_VALUES:,} values of one state variable", item, findings)
        if isinstance(item, ast.Range) and (listed > MAX_VALUES or made > MAX_VALUES_IN_ALL):
            complete = False
            continue
        for value in texts_of(item, ends):
            if value not in places:
                places[value] = item.span
            elif value not in reported:
                reported.add(value)
                _twice(declaration, value, item, places[value], findings)
    return Values(tuple(places), complete)


def _twice(declaration: ast.VariableDeclaration, value: str, item: ast.Item, first: Span, findings: Findings) -> None:
    findings.add(
        Code.TUM203,
        f"{quoted(declaration.name.text)} lists the value {quoted(value)} twice",
        item.span,
        "remove one",
        (Note("it is listed first here", first),),
    )


def _too_many(message: str, place: ast.Item, findings: Findings) -> None:
    findings.add(Code.TUM311, message, place.span, "split the specification")
