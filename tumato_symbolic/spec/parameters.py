"""Parameters of copies: their values, what conditions say of them, and names that hold them."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from itertools import product
from math import prod
from operator import eq, ge, gt, le, lt, ne
from typing import Final, TypeAlias

from msgspec import Struct

from tumato_symbolic.diagnostics import Code
from tumato_symbolic.diagnostics.wording import listed, quoted
from tumato_symbolic.spec.collector import Findings
from tumato_symbolic.spec.numbers import ends_of, is_right, number_of, texts_of
from tumato_symbolic.syntax import ast
from tumato_symbolic.syntax.confirming import NOT_PARAMETERS

MAX_COMBINATIONS = 1_000_000
"""The most combinations of values of parameters, before conditions, for a whole text."""

BRACES: Final = re.compile(r"\{([A-Za-z_][A-Za-z0-9_]*)([+-][0-9]+)?\}")
_NAME: Final = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
_HOLDS: Final[dict[ast.Operator, Callable[[int, int], bool]]] = {
    "<": lt,
    "<=": le,
    ">": gt,
    ">=": ge,
    "=": eq,
    "!=": ne,
}

Domain: TypeAlias = tuple[str, ...]
"""The values of a parameter, in order."""

Scope: TypeAlias = Mapping[str, Domain]
"""The parameters that may be named, with their domains."""

Binding: TypeAlias = Mapping[str, str]
"""A value for each parameter."""


class CopyError(Exception):
    """A copy cannot be made; what is wrong is reported."""


class Combinations(Struct, frozen=True):
    """What a header stands for: the domains of its parameters, and its conditions."""

    header: ast.Header
    names: tuple[str, ...]
    domains: tuple[Domain, ...]

    @property
    def size(self) -> int:
        """How many combinations there are before the conditions."""
        return prod(map(len, self.domains))


def combinations(
    header: ast.Header, scope: Scope, lists: Mapping[str, ast.NamedList], findings: Findings
) -> Combinations | None:
    """The domains of a header; None, and reports, where it is in error."""
    names: list[str] = []
    domains: list[Domain] = []
    right = True
    for parameter in header.parameters:
        name = parameter.name
        if name.text in NOT_PARAMETERS or not _NAME.fullmatch(name.text):
            message = f"{quoted(name.text)} cannot name a parameter"
            findings.add(Code.TUM205, message, name.span, "choose another name")
            right = False
        elif name.text in names or name.text in scope:
            message = f"there is a parameter {quoted(name.text)} already"
            findings.add(Code.TUM203, message, name.span, "choose another name")
            right = False
        domain = _domain(parameter, lists, findings)
        right = right and domain is not None
        names.append(name.text)
        domains.append(domain or ())
    found = Combinations(header, tuple(names), tuple(domains))
    inner = {**scope, **dict(zip(names, domains, strict=True))}
    return found if right and all([_is_condition(each, inner, findings) for each in header.conditions]) else None  # noqa: C419 - all are looked at


def _domain(parameter: ast.Parameter, lists: Mapping[str, ast.NamedList], findings: Findings) -> Domain | None:
    items = parameter.items
    if not parameter.braced and len(items) == 1 and isinstance(items[0], ast.Name) and items[0].text in lists:
        items = lists[items[0].text].items
    return domain_of(items, findings)


def domain_of(items: tuple[ast.Item, ...], findings: Findings) -> Domain | None:
    """The values that a list means; None, and a report, where it is in error."""
    found: dict[str, None] = {}
    for item in items:
        for name in (item,) if isinstance(item, ast.Name) else (item.low, item.high):
            if "{" in name.text:
                findings.add(Code.TUM316, "parameters cannot stand in a list of values of parameters", name.span)
                return None
        ends = ends_of(item, findings)
        if ends is None:
            return None
        if len(found) + ends[1] - ends[0] + 1 > MAX_COMBINATIONS:
            too_many(item, findings)
            return None
        for text in texts_of(item, ends):
            if text in found:
                findings.add(Code.TUM203, f"the value {quoted(text)} is listed twice", item.span, "remove one")
                return None
            found[text] = None
    return tuple(found)


def too_many(place: ast.Node, findings: Findings) -> None:
    """Report that there are too many combinations."""
    message = f"there are more than {MAX_COMBINATIONS:,} combinations of values of parameters"
    findings.add(Code.TUM311, message, place.span, "use fewer parameters, or fewer values")


def _is_condition(condition: ast.Condition, scope: Scope, findings: Findings) -> bool:
    """Whether both sides can be compared; reports why not."""
    for side, other in ((condition.left, condition.right), (condition.right, condition.left)):
        text = side.name.text
        if "{" in text or not is_right(side.name, findings):
            if "{" in text:
                message = "a parameter stands without braces after `where`"
                findings.add(Code.TUM316, message, side.span, f"write `{text.strip('{}')}`")
            return False
        if text in scope or number_of(text) is not None:
            continue
        domain = scope.get(other.name.text)
        if domain is None or side.offset or text not in domain:
            message = f"{quoted(text)} is neither a parameter nor a value of the other side"
            findings.add(Code.TUM201, message, side.span, _known(scope, domain))
            return False
    return True


def _known(scope: Scope, domain: Domain | None) -> str:
    if domain is not None:
        return f"the values are {listed(domain)}"
    return f"the parameters are {listed(list(scope))}"


def bindings(found: Combinations, outer: Binding, scope: Scope, findings: Findings) -> Iterator[Binding]:
    """Every combination that satisfies the conditions, the first parameter changing slowest."""
    for values in product(*found.domains):
        binding = {**outer, **dict(zip(found.names, values, strict=True))}
        if all([_holds(each, binding, scope, findings) for each in found.header.conditions]):  # noqa: C419 - all are evaluated
            yield binding


def _holds(condition: ast.Condition, binding: Binding, scope: Scope, findings: Findings) -> bool:
    left, right = _value(condition.left, binding, findings), _value(condition.right, binding, findings)
    numbers = number_of(left), number_of(right)
    holds = _HOLDS[condition.operator]
    if numbers[0] is not None and numbers[1] is not None:
        return holds(numbers[0], numbers[1])
    if condition.operator in ("=", "!="):
        return (left == right) == (condition.operator == "=")
    first, second = (scope.get(side.name.text) for side in (condition.left, condition.right))
    common = first or second
    if numbers != (None, None) or common is None or (first or common) != (second or common):
        findings.add(
            Code.TUM316,
            f"{quoted(left)} and {quoted(right)} have no order",
            condition.span,
            "numbers are compared by size, words by their places in one list of values",
        )
        raise CopyError
    return holds(common.index(left), common.index(right))


def _value(operand: ast.Operand, binding: Binding, findings: Findings) -> str:
    text = binding.get(operand.name.text, operand.name.text)
    return _shifted(text, operand.offset, operand.name, findings) if operand.offset else text


def _shifted(text: str, offset: int, place: ast.Name, findings: Findings) -> str:
    number = number_of(text)
    if number is None:
        message = f"{quoted(text)} is not a number: nothing can be added to it"
        findings.add(Code.TUM316, message, place.span, "only parameters that are numbers take `+` and `-`")
        raise CopyError
    return str(number + offset)


def filled(name: ast.Name, binding: Binding, may_be_number: bool, findings: Findings) -> str:
    """The text of a name with the values of parameters in it. Raises `CopyError` where it is not a name."""

    def value(braces: re.Match[str]) -> str:
        text = binding[braces[1]]
        return _shifted(text, int(braces[2]), name, findings) if braces[2] else text

    text = BRACES.sub(value, name.text)
    if _NAME.fullmatch(text) or (may_be_number and re.fullmatch("-?[0-9]+", text)):
        return text
    what = "neither a name nor a number" if may_be_number else "not a name"
    findings.add(Code.TUM113, f"{quoted(text)}, which {quoted(name.text)} becomes, is {what}", name.span)
    raise CopyError
