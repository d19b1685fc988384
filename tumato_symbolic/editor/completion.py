"""Completion: which names and keywords may stand at a place in a text, and in which order they are offered."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Literal, NamedTuple, TypeAlias

from tumato_symbolic.diagnostics import Source
from tumato_symbolic.editor.mentions import Index, SymbolKind
from tumato_symbolic.syntax.parser import Expected, expected_at
from tumato_symbolic.syntax.tokens import BLOCKS, COMPARING

CompletionKind: TypeAlias = SymbolKind | Literal["keyword"]

_CLASSES = frozenset({"NAME", "NUMBER", "OFFSET", "$END"})
_DECLARING = frozenset({"state", "define", "resource", "action"})
_PREDICATE = frozenset({"NAME", "(", "executing", "true", "false"})

_TITLED = {
    "controlled": "controlled resources: ",
    "nominal": "nominal effects: ",
    "alternative": "alternative effects: ",
    "exactly": "exactly one ",
}
"""Words that only ever go on in one way."""

_OLDER = frozenset({"cost", "effects"})
"""What older files write for `duration` and `nominal effects`."""

_WITH_COLON = frozenset(
    {"duration", "cost", "preconditions", "effects", "rule", "severity", "assume", "start", "goal"}
    | {"max_plan_length", "effect_ordering", "restoration"}
)


class Completion(NamedTuple):
    """A text that may be typed, and what it is."""

    text: str
    kind: CompletionKind


def completions(source: Source, known: Index, line: int, column: int) -> list[Completion]:
    """What may stand at a line and column: first names, in the order of their declarations, then keywords.

    `known` is what is declared, perhaps in an earlier version of the text.
    """
    expected = expected_at(source, line, column)
    found = [*_names(expected, known), *_keywords(expected)]
    return list(dict.fromkeys(found))


def _names(expected: Expected, known: Index) -> Iterator[Completion]:
    """The names that fit."""
    before = [token.text for token in expected.before]
    last = before[-1] if before else ""
    variable = _compared(before)
    if variable is not None:
        yield from _completions(known.values(variable), "value")
        if last in COMPARING:
            numeric = (name for name in known.named("state variable") if _has_numbers(known, name))
            yield from _completions(numeric, "state variable")
        return
    if "NAME" not in expected.terminals or last in _DECLARING:
        return
    opened = [token.text for token in expected.open]
    if last == "executing":
        yield from _completions(known.named("action"), "action")
    elif last == "in":
        yield from _completions(known.named("named list"), "named list")
    elif opened and next((each for each in reversed(opened) if each in ("resources", "can", "in")), "") == "resources":
        yield from _completions(known.named("resource"), "resource")
    elif expected.terminals >= _PREDICATE:
        yield from _completions(known.named("state variable"), "state variable")
        yield from _completions(known.named("alias"), "alias")


def _has_numbers(known: Index, variable: str) -> bool:
    return all(value.lstrip("-").isdecimal() for value in known.values(variable))


def _compared(before: list[str]) -> str | None:
    """The variable whose value comes next: after `S is`, `S is not`, `S <` and in `S in {`."""
    place = len(before) - 1
    while place >= 0 and (before[place] in (",", "..") or (place > 0 and before[place - 1] in ("{", ",", ".."))):
        place -= 1  # other values of a set
    words = before[: place + 1]
    if words[-1:] == ["{"]:
        words = words[:-1]
        return words[-3 if words[-2:] == ["not", "in"] else -2] if words[-1:] == ["in"] and len(words) > 2 else None
    if place != len(before) - 1:
        return None
    if words[-2:] == ["is", "not"] and len(words) > 2:
        return words[-3]
    return words[-2] if len(words) > 1 and (words[-1] == "is" or words[-1] in COMPARING) else None


def _completions(names: Iterable[str], kind: CompletionKind) -> Iterator[Completion]:
    return (Completion(name, kind) for name in names)


def _keywords(expected: Expected) -> Iterator[Completion]:
    """The words of the language that fit, each with what has to follow it."""
    last = expected.before[-1].text if expected.before else ""
    if last == "BEGIN" and "STATE" in expected.terminals:
        yield from _completions((" ".join(title) for title in BLOCKS), "keyword")
        return
    older = frozenset() if last in ("nominal", "alternative") else _OLDER
    for word in sorted(each for each in expected.terminals - _CLASSES - older if each.isidentifier()):
        if word == "BEGIN":
            goals_only = any(each.text == "BEGIN" for each in expected.open)
            titles = [("GOALS",)] if goals_only else BLOCKS
            yield from _completions((f"BEGIN {' '.join(title)}" for title in titles), "keyword")
        elif word == "END":
            yield Completion(" ".join(["END", *_open_title(expected)]), "keyword")
        elif word == "end":
            yield Completion("end for", "keyword")
        elif word == "goal" and last == "GOALS":
            yield from _completions(("goal type: priority", "goal type: constraint"), "keyword")
        elif word in _WITH_COLON:
            yield Completion(f"{word}: ", "keyword")
        else:
            yield Completion(_TITLED.get(word, word), "keyword")


def _open_title(expected: Expected) -> tuple[str, ...]:
    """The title of the innermost open block."""
    opened = [token.text for token in expected.open]
    begins = [place for place, text in enumerate(opened) if text == "BEGIN"]
    words = tuple(opened[begins[-1] + 1 :]) if begins else ()
    return next((title for title in BLOCKS if words[: len(title)] == title), ())
