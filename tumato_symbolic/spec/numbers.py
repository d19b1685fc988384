"""Values that are whole numbers, and ranges of them: how they are written, and what is wrong with them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from tumato_symbolic.diagnostics import Code
from tumato_symbolic.diagnostics.wording import quoted
from tumato_symbolic.spec.collector import Findings
from tumato_symbolic.spec.value_kinds import value_of
from tumato_symbolic.syntax import ast


def number_of(text: str) -> int | None:
    """The number that a value is, None where it is a name."""
    value = value_of(text)
    return value if isinstance(value, int) else None


def numbers_of(values: Iterable[str]) -> list[int] | None:
    """The numbers that values are, None where one of them is a name."""
    found = [number_of(each) for each in values]
    numbers = [each for each in found if each is not None]
    return numbers if len(numbers) == len(found) else None


def is_right(value: ast.Name, findings: Findings) -> bool:
    """Whether a value is a name, or a number as numbers are written; reports what is not."""
    text = value.text
    if not text.lstrip("-").isdigit() or number_of(text) is not None:
        return True
    message = f"{quoted(text)} is not how this number is written"
    findings.add(Code.TUM114, message, value.span, f"write `{int(text)}`")
    return False


def bounds(item: ast.Range, findings: Findings) -> tuple[int, int] | None:
    """The ends of a range of numbers; None, and a report, where it is none."""
    if not (is_right(item.low, findings) and is_right(item.high, findings)):
        return None
    for end in (item.low, item.high):
        if number_of(end.text) is None:
            findings.add(
                Code.TUM314, f"{quoted(end.text)} is not a number", end.span, "a range goes from one number to another"
            )
            return None
    low, high = int(item.low.text), int(item.high.text)
    if low > high:
        message = f"the range {quoted(f'{low}..{high}')} is empty"
        findings.add(Code.TUM314, message, item.span, f"write `{high}..{low}`")
        return None
    return low, high


def ends_of(item: ast.Item, findings: Findings) -> tuple[int, int] | None:
    """From which to which number an item goes, any number for a name; None, and a report, where it is in error."""
    if isinstance(item, ast.Range):
        return bounds(item, findings)
    return (0, 0) if is_right(item, findings) else None


def texts_of(item: ast.Item, ends: tuple[int, int]) -> Iterable[str]:
    """The values that an item lists, which goes from one number to the other."""
    return (item.text,) if isinstance(item, ast.Name) else map(str, range(ends[0], ends[1] + 1))


def chosen(items: Sequence[ast.Item], values: Mapping[str, int], findings: Findings) -> list[tuple[ast.Item, set[int]]]:
    """Which values each item of a set means, by their positions; what is written wrongly is left out and reported."""
    found: list[tuple[ast.Item, set[int]]] = []
    by_number: dict[int, int] | None = None
    for item in items:
        if isinstance(item, ast.Name):
            if is_right(item, findings):
                found.append((item, {values[item.text]} if item.text in values else set()))
            continue
        ends = bounds(item, findings)
        if ends is None:
            continue
        if by_number is None:
            numbers = ((number_of(text), place) for text, place in values.items())
            by_number = {number: place for number, place in numbers if number is not None}
        low, high = ends
        found.append((item, {place for number, place in by_number.items() if low <= number <= high}))
    return found
