"""Lists of goals and copies as people write them who know other languages, and how they are written in this one."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

from tumato_symbolic.diagnostics import Code, Diagnostic, Note
from tumato_symbolic.diagnostics.wording import quoted
from tumato_symbolic.syntax.habits import joined, told, unexpected
from tumato_symbolic.syntax.situation import Situation
from tumato_symbolic.syntax.tokens import HARD

_SEQUENCE: Final = frozenset({"sequence", "sequential", "ordered", "order", "steps", "seq", "list", "mission"})


def _goal_type(here: Situation) -> Diagnostic | None:
    if here.expected != {"priority", "constraint"} or here.token.kind != "word" or here.in_another_case:
        return None
    way_out = "`priority`: the first goal whose condition holds; `constraint`: all goals whose conditions hold at once"
    if here.token.text.lower() in _SEQUENCE:
        way_out = "write `goal type: priority`, with `when NOT p then goal: p` before `when NOT q then goal: q`"
    elif here.misspelled:
        return None
    return told(here.token.span, way_out, f"there is no goal type {quoted(here.token.text)}")


def _conditional_goal(here: Situation) -> Diagnostic | None:
    """`when p: goal: q`, `when p goal: q`, `when p then q` and `goal: when p then q`."""
    token = here.token
    form = "write `when PREDICATE then goal: PREDICATE`"
    if "then" in here.expected and token.text in (":", "goal", "do", "reach", ","):
        return told(token.span, form, f"unexpected {quoted(token.text)} where `then` is expected")
    if (
        here.expected == {"BEGIN", "goal"}
        and token.kind == "word"
        and token.text not in HARD
        and not here.in_another_case
    ):
        return None if token.text == "when" else unexpected(token.span, token.text, "write `goal:` after `then`")
    if token.text == "when" and here.wants_predicate and here.at(-1).text == ":" and here.at(-2).text == "goal":
        return unexpected(token.span, "when", form)
    return None


def _copies(here: Situation) -> Diagnostic | None:
    """Headers of copies as in other languages, and copies that are not closed."""
    token, before = here.token, here.at(-1)
    start = here.last("for")
    if start is None:
        return None
    if token.text == ":" and "where" in here.expected:
        return unexpected(token.span, ":", "leave it out")
    if token.text in ("=", "from", "of", "∈") and here.expected == {"in"}:
        return unexpected(token.span, token.text, "write `in`")
    if before.text in ("each", "all", "every") and here.expected == {"in"}:
        return unexpected(before.span, before.text, f"leave it out: `for {token.text} in VALUE, VALUE`")
    if token.text in ("if", "IF", "when") and "where" in here.expected:
        return unexpected(token.span, token.text, "write `where`")
    if token.text == "END" and here.at(1).text.upper() == "FOR" and "end" in here.expected:
        return unexpected(joined(token, here.at(1)), f"END {here.at(1).text}", "write `end for`", Code.TUM111)
    if (token.text == "END" and "end" in here.expected) or (before.text == "end" and here.expected == {"for"}):
        notes = (Note("they begin here", start.span),)
        place = token.span if before.text != "end" else before.span
        return Diagnostic(Code.TUM107, "these copies are not closed", place, "write `end for`", notes)
    return None


LISTS: tuple[Callable[[Situation], Diagnostic | None], ...] = (_copies, _goal_type, _conditional_goal)
"""What is tried in lists of goals and in copies, one after the other."""
