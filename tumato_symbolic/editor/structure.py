"""Which tokens begin a line of a well-formed text, and how far lines are indented."""

from __future__ import annotations

from collections.abc import Sequence

from msgspec import Struct

from tumato_symbolic.syntax.tokens import Token

STEP = 2
"""The columns by which what belongs to a line is indented more than it."""

_FIELDS = frozenset({"duration", "cost", "controlled", "preconditions", "nominal", "effects", "alternative"})
_FOR = frozenset({"for", "FOR_ACTIONS", "FOR_CLAUSES"})
_ENTRIES = frozenset(
    {"state", "define", "resource", "action", "rule", "severity", "assume", "start", "goal", "when", "end", "BEGIN"}
    | {"END", "max_plan_length", "effect_ordering", "restoration"}
    | _FIELDS
    | _FOR
)
"""Terminals with which a line begins."""

_INSIDE = {"for": ("end",), "effects": ("nominal", "alternative")}
"""Where such a terminal goes on with a line: after these."""


class Start(Struct, frozen=True):
    """The first token of a line. `inner` is the indentation of a comment before it that is about what it closes."""

    indent: int
    opens: bool = False
    closes: bool = False
    inner: int = 0


class _Frame(Struct):
    """A block, or copies: the indentation of its own lines, and of entries, fields and clauses in it."""

    indent: int
    entry: int
    field: int
    clause: int
    is_actions: bool


def starts(tokens: Sequence[Token], terminals: Sequence[str]) -> dict[int, Start]:
    """The places of the tokens with which lines begin."""
    found = dict[int, Start]()
    open_ = [_Frame(0, 0, 0, 0, False)]
    conditional = 0
    for place, terminal in enumerate(terminals):
        before = terminals[place - 1] if place else ""
        if terminal not in _ENTRIES or before in _INSIDE.get(terminal, ()):
            continue
        top = open_[-1]
        after_then = STEP if before == "then" else 0
        if terminal in ("END", "end"):
            open_.pop()
            found[place] = Start(top.indent, closes=True, inner=top.entry)
        elif terminal == "BEGIN":
            indent = conditional + STEP if after_then else top.entry + (STEP if len(open_) > 1 else 0)
            actions = tokens[place + 1].text == "ACTIONS"
            open_.append(_Frame(indent, indent, indent + STEP, indent + 2 * STEP, actions))
            found[place] = Start(indent, opens=True)
        elif terminal in _FOR:
            inner = _copies(top, terminal)
            open_.append(inner)
            found[place] = Start(inner.indent, opens=True)
        else:
            indent = top.entry
            if top.is_actions and terminal != "action":
                indent = top.clause if terminal == "when" else top.field
            found[place] = Start(conditional + STEP if after_then else indent)
            conditional = indent
    return found


def _copies(frame: _Frame, terminal: str) -> _Frame:
    """The frame of copies that begin in another: of actions, of clauses, or of what stands there otherwise."""
    if not frame.is_actions or terminal == "FOR_ACTIONS":
        indent = frame.entry
        return _Frame(indent, indent + STEP, indent + 2 * STEP, indent + 3 * STEP, frame.is_actions)
    indent = frame.clause if terminal == "FOR_CLAUSES" else frame.field
    inner = indent + STEP
    clause = inner if terminal == "FOR_CLAUSES" else inner + STEP
    return _Frame(indent, inner, inner, clause, True)
