"""Predicates about the values of state variables, written out as `VARIABLE is VALUE` (`docs/language.md`)."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Callable
from typing import Final

from msgspec import Struct

from tumato_symbolic.diagnostics import Code, CopySpan, Note
from tumato_symbolic.diagnostics.wording import listed, quoted
from tumato_symbolic.spec.collector import Findings
from tumato_symbolic.spec.formula import FALSE, TRUE, And, Formula, Is, Not, Or
from tumato_symbolic.spec.names import Declared, Kind, Names
from tumato_symbolic.spec.numbers import chosen, is_right, number_of, numbers_of
from tumato_symbolic.syntax import ast

_MIRRORED: Final[dict[ast.Operator, ast.Operator]] = {"<": ">", "<=": ">=", ">": "<", ">=": "<="}
"""`a < b` is `b > a`."""

ValuePredicate = ast.Comparison | ast.Difference | ast.Membership | ast.Ordering
"""What says something about the value of a variable."""


class Written(Struct, frozen=True):
    """A predicate written out, with its size and depth."""

    formula: Formula
    terms: int
    depth: int


class Comparisons:
    """Writes predicates about values out, each of them once.

    `named` finds a state variable, or reports that there is none; `lost` holds words that may have been declared.
    `room` is the most terms that one predicate may have: a larger one is reported before it is made.
    """

    def __init__(
        self,
        names: Names,
        named: Callable[[ast.Name, Kind], Declared | None],
        findings: Findings,
        lost: frozenset[str],
        room: int,
    ) -> None:
        self._names = names
        self._named = named
        self._findings = findings
        self._lost = lost
        self._room = room
        self._numbers: dict[int, _Numbers | None] = {}
        self._orderings: dict[tuple[int, ast.Operator, int | None, int], Written] = {}

    def written(self, predicate: ValuePredicate) -> Written | None:
        """The predicate written out; None, and a report, where it is in error."""
        declared = self._named(predicate.variable, "state variable")
        if declared is None or declared.number in self._names.unsettled:
            return None
        match predicate:
            case ast.Comparison(_, value):
                return self._is(declared, value)
            case ast.Difference(_, value):
                return _denied(self._is(declared, value))
            case ast.Membership(_, items, negated):
                found = self._in(declared, items)
                return _denied(found) if negated else found
            case ast.Ordering():
                return self._ordering(declared, predicate)

    def _is(self, declared: Declared, value: ast.Name) -> Written | None:
        if not is_right(value, self._findings):
            return None
        number = self._names.values[declared.number].get(value.text)
        if number is not None:
            return Written(Is(declared.number, number), 1, 1)
        self._no_value(declared, value)
        return None

    def _no_value(self, declared: Declared, item: ast.Item) -> None:
        text = item.text if isinstance(item, ast.Name) else f"{item.low.text}..{item.high.text}"
        if text in self._lost:
            return
        name = self._names.variables[declared.number].name
        self._findings.add(
            Code.TUM202,
            f"{quoted(name)} has no value {quoted(text)}",
            item.span,
            self._instead_of(text, item, declared),
            (Note(f"{quoted(name)} is declared here", declared.span),),
        )

    def _instead_of(self, text: str, item: ast.Item, declared: Declared) -> str:
        """The way out where a variable has no such value."""
        known = self._names.table.get(text)
        if known is not None and known.kind == "named list":
            name = self._names.variables[declared.number].name
            return f"{quoted(text)} is a list of values: write `some V in {text}: {name} is {{V}}`"
        if isinstance(item.span, CopySpan) and text in dict(item.span.parameters):
            return f"write `{{{text}}}`: parameters stand in braces"
        values = list(self._names.values[declared.number])
        near = None if number_of(text) is not None else self._findings.similar(text, values)
        return f"did you mean `{near}`?" if near else f"its values are {listed(values)}"

    def _in(self, declared: Declared, items: tuple[ast.Item, ...]) -> Written | None:
        found = chosen(items, self._names.values[declared.number], self._findings)
        for item, places in found:
            if not places:
                self._no_value(declared, item)
        if len(found) < len(items) or not all(places for _, places in found):
            return None
        wanted = set[int]().union(*(places for _, places in found))
        return _any_of([Is(declared.number, place) for place in sorted(wanted)])

    def _ordering(self, declared: Declared, predicate: ast.Ordering) -> Written | None:
        other = predicate.other
        if not is_right(other, self._findings):
            return None
        limit = number_of(other.text)
        if not self._is_numeric(declared, predicate.variable, predicate):
            return None
        if limit is not None:
            if predicate.operator in ("=", "!="):
                found = self._is(declared, other)
                return _denied(found) if predicate.operator == "!=" else found
            return self._cached(declared.number, predicate.operator, None, limit)
        second = self._named(other, "state variable")
        if second is None or second.number in self._names.unsettled or not self._is_numeric(second, other, predicate):
            return None
        terms = self._terms(declared.number, predicate.operator, second.number)
        if terms > self._room:
            self._findings.add(
                Code.TUM308,
                f"written out, this comparison has more than {self._room:,} terms",
                predicate.span,
                "give the variables fewer values",
            )
            return None
        return self._cached(declared.number, predicate.operator, second.number, 0)

    def _is_numeric(self, declared: Declared, name: ast.Name, predicate: ast.Ordering) -> bool:
        if self._of(declared.number) is not None:
            return True
        values = self._names.variables[declared.number].values
        other = predicate.other
        help_ = f"only numbers are compared; the values of `{name.text}` are {listed(values)}"
        if name is predicate.variable and other.text in values and predicate.operator in ("=", "!="):
            help_ = f"write `{name.text} is {'' if predicate.operator == '=' else 'not '}{other.text}`"
        message = f"{quoted(predicate.operator)} between values that are not numbers"
        notes = (Note(f"{quoted(name.text)} is declared here", declared.span),)
        self._findings.add(Code.TUM315, message, predicate.sign, help_, notes)
        return False

    def _of(self, variable: int) -> _Numbers | None:
        if variable not in self._numbers:
            numbers = numbers_of(self._names.variables[variable].values)
            self._numbers[variable] = None if numbers is None else _Numbers(variable, numbers)
        return self._numbers[variable]

    def _cached(self, variable: int, sign: ast.Operator, second: int | None, limit: int) -> Written:
        key = (variable, sign, second, limit)
        if key not in self._orderings:
            first, other = self._of(variable), None if second is None else self._of(second)
            assert first is not None, "only variables with numbers are compared"
            self._orderings[key] = (
                first.against(sign, limit)
                if other is None
                else _equalities(first, other, sign == "=")
                if sign in ("=", "!=")
                else _either(_orderings(first, sign, other))
            )
        return self._orderings[key]

    def _terms(self, variable: int, sign: ast.Operator, second: int) -> int:
        """At most so many terms has a comparison of two variables."""
        first, other = self._of(variable), self._of(second)
        if first is None or other is None or sign in ("=", "!="):
            return 1 + 4 * len(first.numbers if first else ())
        fits = [other.how_many(_MIRRORED[sign], number) for number in first.numbers]
        return 1 + sum(3 + each for each in fits if each)


class _Numbers:
    """The values of a numeric variable: in the order of declaration, and by size."""

    def __init__(self, variable: int, numbers: list[int]) -> None:
        self.numbers = numbers
        self.atoms = [Is(variable, place) for place in range(len(numbers))]
        self._places = sorted(range(len(numbers)), key=numbers.__getitem__)
        self._sorted = [numbers[place] for place in self._places]

    def how_many(self, sign: ast.Operator, limit: int) -> int:
        """How many values stand in this relation to a number."""
        low, high = self._slice(sign, limit)
        return high - low

    def against(self, sign: ast.Operator, limit: int) -> Written:
        """`VARIABLE < NUMBER`."""
        low, high = self._slice(sign, limit)
        if high - low in (0, len(self.numbers)):
            return Written(TRUE if high > low else FALSE, 1, 1)
        return self.one_of(sorted(self._places[low:high]))

    def one_of(self, places: list[int]) -> Written:
        """That the variable has one of these values."""
        return _any_of([self.atoms[place] for place in places])

    def _slice(self, sign: ast.Operator, limit: int) -> tuple[int, int]:
        below, upto = bisect_left(self._sorted, limit), bisect_right(self._sorted, limit)
        everything = len(self._sorted)
        match sign:
            case "<":
                return 0, below
            case "<=":
                return 0, upto
            case ">":
                return upto, everything
            case _:
                return below, everything


def _orderings(first: _Numbers, sign: ast.Operator, second: _Numbers) -> list[Written]:
    """For each value of the first variable, that and what it takes of the second."""
    parts: list[Written] = []
    for number, atom in zip(first.numbers, first.atoms, strict=True):
        fits = second.how_many(_MIRRORED[sign], number)
        here = Written(atom, 1, 1)
        if fits == len(second.numbers):
            parts.append(here)
        elif fits:
            parts.append(_both(here, second.against(_MIRRORED[sign], number)))
    return parts


def _equalities(first: _Numbers, second: _Numbers, equal: bool) -> Written:
    """The same for `=` and `!=`."""
    others = dict(zip(second.numbers, second.atoms, strict=True))
    parts: list[Written] = []
    for number, atom in zip(first.numbers, first.atoms, strict=True):
        here, there = Written(atom, 1, 1), others.get(number)
        if there is None or len(others) == 1:
            if (there is not None) == equal:
                parts.append(here)
        else:
            parts.append(_both(here, Written(there, 1, 1) if equal else Written(Not(there), 2, 2)))
    return _either(parts)


def _any_of(atoms: list[Is]) -> Written:
    if len(atoms) == 1:
        return Written(atoms[0], 1, 1)
    return Written(Or(tuple(atoms)), 1 + len(atoms), 2)


def _either(parts: list[Written]) -> Written:
    if len(parts) < 2:
        return parts[0] if parts else Written(FALSE, 1, 1)
    formula = Or(tuple(each.formula for each in parts))
    return Written(formula, 1 + sum(each.terms for each in parts), 1 + max(each.depth for each in parts))


def _both(left: Written, right: Written) -> Written:
    return Written(And((left.formula, right.formula)), 1 + left.terms + right.terms, 1 + max(left.depth, right.depth))


def _denied(found: Written | None) -> Written | None:
    return None if found is None else Written(Not(found.formula), found.terms + 1, found.depth + 1)
