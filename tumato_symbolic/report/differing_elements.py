"""What differs in meaning between two specifications, element by element, for a person and for a program."""

from __future__ import annotations

from collections.abc import Iterator

from tumato_symbolic.report.layout import Paint
from tumato_symbolic.views import Altered

_SIGNS = {"added": "+", "removed": "-", "changed": "~"}


def element_lines(element: Altered, place: str, paint: Paint) -> Iterator[str]:
    """The element with what became of it, and where it stands; its details below."""
    colours = {"added": paint.good, "removed": paint.bad, "changed": paint.doubt}
    yield f"  {colours[element.how](_SIGNS[element.how])} {_text(element)}{place}"
    yield from (f"      {line}" for line in _details(element))


def element_message(element: Altered) -> str:
    """The same where it is told at its line."""
    return "\n".join((f"{element.how}: {_text(element)}", *_details(element)))


def _details(element: Altered) -> Iterator[str]:
    for each in element.details if element.name else ():
        if each.before is None or each.after is None:
            sign, text = ("+", each.after) if each.before is None else ("-", each.before)
            yield f"{each.what}: {sign} {text}"
        else:
            yield f"{each.what}: {each.before} → {each.after}"


def _text(element: Altered) -> str:
    if element.name:
        between = ": " if element.kind not in ("variable", "action", "goal") else " "
        return element.name if element.kind == "goal" else f"{element.kind}{between}{element.name}"
    return "".join((element.kind, *(f": {each.before or 'none'} → {each.after or 'none'}" for each in element.details)))


def element_json(element: Altered) -> dict[str, object]:
    """The element, what became of it, and its lines in both files."""
    return {
        "kind": element.kind,
        "name": element.name or None,
        "how": element.how,
        "old_line": None if element.old is None else element.old.line,
        "new_line": None if element.new is None else element.new.line,
        "details": [
            {"what": each.what or None, "before": each.before, "after": each.after} for each in element.details
        ],
    }
