"""Operators and functions that other languages have, of numbers and of time, and how it is said in this one."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

from tumato_symbolic.diagnostics import Code, Diagnostic
from tumato_symbolic.diagnostics.wording import MAX_QUOTED
from tumato_symbolic.syntax.habits import joined, listing, told, touch, unexpected
from tumato_symbolic.syntax.situation import Situation
from tumato_symbolic.syntax.tokens import HARD

_COUNTED: Final = {"+=": "+", "++": "+", "-=": "-", "--": "-"}
"""Assignments that count, and the sign of the effect that is meant."""

_COUNTING: Final = {
    **dict.fromkeys(("increase", "increment", "inc", "raise", "add"), "+"),
    **dict.fromkeys(("decrease", "decrement", "dec", "lower", "subtract"), "-"),
}
"""Words that count, in lower case."""

_EFFECT: Final = "an effect is `NAME is VALUE`, or `NAME is NAME + 1` where the value is a number"
_AFTERWARDS: Final = "an effect is of the state afterwards by itself: `NAME is VALUE`"
_ONE_STATE: Final = "a predicate is of one state: let a variable say what happened before"
_HOLDS: Final = "leave it out: a rule is to hold in every state"
_REACHED: Final = "leave it out: a goal is reached by itself in time"
_IS_GOAL: Final = "what is to be reached is a goal: `goal: PREDICATE`"
_IS_RULE: Final = "what is to hold in every state is a rule: `rule: PREDICATE`"
_ALWAYS: Final = frozenset({"G", "AG", "[]", "□", "historically", "maintain", "keep", "preserve"})
_EVENTUALLY: Final = frozenset({"F", "AF", "EF", "<>", "◇", "reach", "achieve", "attain"})
_STEPS: Final = frozenset({"X", "AX", "EX", "next", "previous", "prev", "once", "last", "old"})
_BINARY: Final = frozenset({"U", "W", "R", "S", "until", "release", "releases", "since", "before", "after"})


def _counting(here: Situation) -> Diagnostic | None:
    """`N += 1`, `N++`, `N := N + 1`, `N = N + 1`, `increase N by 1`, `toggle S`."""
    if not here.in_effects:
        return None
    token, before, after = here.token, here.at(-1), here.at(1)
    if token.text in _COUNTED and "is" in here.expected and before.kind == "word":
        number = after.text if token.text.endswith("=") and after.kind == "number" else "1"
        return unexpected(
            token.span,
            token.text,
            f"write `{before.text} is {before.text} {_COUNTED[token.text]} {number}`",
            Code.TUM104,
        )
    if token.text == ":" and "is" in here.expected and here.declares(before.text) and after.kind in ("word", "number"):
        return unexpected(token.span, ":", f"write `{before.text} is {after.text}`")
    verb, name = before.text.lower(), token.text
    if "is" not in here.expected or token.kind != "word" or here.declares(before.text) or not here.declares(name):
        return None
    if verb in _COUNTING:
        number = here.at(2).text if here.at(2).kind == "number" else "1"
        return unexpected(before.span, before.text, f"write `{name} is {name} {_COUNTING[verb]} {number}`")
    if verb in ("toggle", "flip", "invert", "switch"):
        way_out = f"write one clause for each value: `when {name} is VALUE: {name} is OTHER`"
        return unexpected(before.span, before.text, way_out)
    return None


def _assigned(here: Situation) -> Diagnostic | None:
    """`N = N + 1`, and assignments of other forms."""
    token, before, after = here.token, here.at(-1), here.at(1)
    sign, number = (token.text[0], token.text[1:] or after.text) if token.text[:1] in ("+", "-") else ("", "")
    if not here.in_effects or not number.isdecimal() or here.at(-2).text not in ("=", "==", ":="):
        return None
    name = here.at(-3).text
    if name != before.text or not here.declares(name):
        return None
    return unexpected(here.at(-2).span, here.at(-2).text, f"write `{name} is {name} {sign} {number}`")


def _arithmetic(here: Situation) -> Diagnostic | None:
    """`N * 2`, `N + M`, `N + 1 > 3`, `N % 2`, `50%`, `N >> 3`."""
    token, before, after = here.token, here.at(-1), here.at(1)
    if token.text == "%" and before.kind == "number" and touch(before, token):
        return unexpected(token.span, "%", "leave it out: numbers have no unit", Code.TUM104)
    if token.text in (">>", "<<") and "is" in here.expected:
        return unexpected(token.span, token.text, f"write `{token.text[0]}`", Code.TUM104)
    counted = before.text in ("+", "-") and token.kind == "word" and here.expected == {"NUMBER"}
    signed = token.text in ("+", "-", "*", "/", "%", "^", "**") or (token.kind == "number" and token.text[0] in "+-")
    stands_alone = here.in_effects and token.text in ("+", "-") and after.kind == "number"
    computes = signed and not stands_alone and before.kind in ("word", "number") and after.kind in ("word", "number")
    if counted or (computes and ("AND" in here.expected or "is" in here.expected) and _is_computed(here)):
        code = Code.TUM104 if token.kind == "other" else Code.TUM105
        return unexpected(token.span, token.text, _computing(here), code)
    return None


def _is_computed(here: Situation) -> bool:
    """Whether a number is computed, as in `N + 1 > 3` and `N > M - 1`, rather than two names joined by a dash."""
    return here.declares(here.at(-1).text) or here.at(-1).kind == "number"


def _computing(here: Situation) -> str:
    if here.in_effects:
        return f"{_EFFECT}; other changes are one clause for each value: `when NAME is VALUE: NAME is VALUE`"
    return "numbers are compared, not computed: list what is meant, as in `(N is 1 AND M < 3) OR (N is 2 AND M < 2)`"


def _of_time(here: Situation) -> Diagnostic | None:
    """`G (…)`, `[] p`, `F p`, `goal: reach p`, `X p` and `p U q`."""
    token, before = here.token, here.at(-1)
    if here.wants_predicate and token.text in ("[]", "<>", "□", "◇"):
        return unexpected(token.span, token.text, _way_out(here, token.text) or "", Code.TUM104)
    if token.text in _BINARY and "AND" in here.expected and "is" not in here.expected:
        return unexpected(token.span, token.text, _ONE_STATE)
    begins = "is" in here.expected and not here.declares(before.text) and before.kind == "word"
    follows = token.text == "(" or (token.kind == "word" and token.text not in HARD and here.declares(token.text))
    way_out = _way_out(here, before.text) if begins and follows else None
    return unexpected(before.span, before.text, way_out) if way_out else None


def _way_out(here: Situation, operator: str) -> str | None:
    """What is written in place of an operator of time; None where it is none."""
    entry = here.last("rule", "goal", "assume", "start", "define", "preconditions", "effects", "when")
    kind = entry.text if entry else ""
    if operator in _ALWAYS:
        return _IS_RULE if kind == "goal" else _HOLDS if kind == "rule" else _ONE_STATE
    if operator in _EVENTUALLY:
        return _REACHED if kind == "goal" else _IS_GOAL
    if operator in _STEPS:
        return _AFTERWARDS if kind == "effects" else _ONE_STATE
    return None


def function(here: Situation) -> Diagnostic | None:
    """`count(S) > 1`, `in(S, a)`: a name and a parenthesis."""
    token, name = here.token, here.at(-1)
    if token.text != "(" or "is" not in here.expected or name.kind != "word" or name.text in HARD:
        return None
    if name.text.lower() in ("count", "sum", "atmost", "at_most", "atleast", "at_least", "card", "number"):
        return unexpected(
            name.span, name.text, "count by `exactly one NAME in VALUE, VALUE: p`, or by `all` or `some` and `where`"
        )
    return unexpected(joined(name, token), f"{name.text}(", "there are no functions: write `NAME is VALUE`")


def _primed(here: Situation) -> Diagnostic | None:
    """`S' = a`."""
    token, before = here.token, here.at(-1)
    if token.text[:1] not in ("'", "′") or "is" not in here.expected or not touch(before, token):
        return None
    return unexpected(token.span, token.text, _AFTERWARDS, Code.TUM104) if here.in_effects else None


def _alternatives(here: Situation) -> Diagnostic | None:
    """`S is a or b`, and sets in other brackets than braces."""
    token, before = here.token, here.at(-1)
    if token.text in ("(", "[") and before.text == "in" and here.expected == {"{"}:
        end = here.index + 1
        while here.tokens[end].kind in ("word", "number") or here.tokens[end].text in (",", ".."):
            end += 1
        no = "not " if here.at(-2).text == "not" else ""
        shown = f"{here.at(-3 if no else -2).text} {no}in {{{listing(here.tokens[here.index + 1 : end])}}}"
        return (
            told(token.span, f"write `{shown}`", "a set of values stands in braces")
            if len(shown) <= MAX_QUOTED
            else None
        )
    if not here.or_values:
        return None
    compared = here.at(-3).text if before.kind in ("word", "number") else ""
    no = "not " if here.at(-2).text == "not" else ""
    name = here.at(-4).text if no else compared
    values = ", ".join([before.text, *here.or_values])
    return unexpected(token.span, token.text, f"write `{name} {no}in {{{values}}}`")


OPERATORS: tuple[Callable[[Situation], Diagnostic | None], ...] = (
    _counting,
    _assigned,
    _primed,
    _alternatives,
    _arithmetic,
    _of_time,
)
"""What is tried where operators of other languages stand, one after the other."""
