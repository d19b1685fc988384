"""Everything around predicates as people write it who know other languages, and how it is written in this one."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Final

from tumato_symbolic.diagnostics import Code, Diagnostic
from tumato_symbolic.diagnostics.wording import listed, quoted
from tumato_symbolic.syntax.habits import joined, told, touch, unexpected
from tumato_symbolic.syntax.list_habits import LISTS
from tumato_symbolic.syntax.situation import Situation
from tumato_symbolic.syntax.tokens import BLOCKS, HARD, TITLES

_FIELDS: Final = ("duration:", "controlled resources:", "preconditions:", "nominal effects:", "alternative effects:")
_MEANT_FIELDS: Final = {
    **dict.fromkeys(("time", "delay", "period"), "write `duration: 10`"),
    "timeout": "time is not watched: say what may happen instead, such as `alternative effects: none`",
    **dict.fromkeys(("resources", "resource", "uses", "requires_resources"), "write `controlled resources: NAME`"),
    **dict.fromkeys(
        ("requires", "require", "needs", "pre", "guard", "condition", "conditions", "precond", "prerequisites"),
        "write `preconditions: PREDICATE`",
    ),
    **dict.fromkeys(
        ("post", "postcondition", "postconditions", "result", "results", "ensures", "outcome", "add"),
        "write `nominal effects: PREDICATE`",
    ),
    **dict.fromkeys(
        ("failure", "failures", "fails", "fail", "otherwise", "error", "on_failure", "alternative", "alternatives"),
        "write `alternative effects: PREDICATE`, or `alternative effects: none` where nothing changes",
    ),
    **dict.fromkeys(
        ("probability", "prob", "chance"),
        "there are no probabilities: every one of the `alternative effects:` may happen",
    ),
}
"""Fields of actions that people write, and the way out."""

_SETTINGS: Final = ("max_plan_length:", "effect_ordering:", "restoration:", "preconditions:")
_ENTRIES: Final = {
    "rule": "write `rule: PREDICATE`",
    "assume": "write `assume: PREDICATE`",
    "start": "write `start: PREDICATE`",
    "define": "write `define NAME as PREDICATE`",
    "resource": "write `resource NAME`",
    "state": "write `state NAME can be VALUE, VALUE`",
    "action": "write `action NAME`",
    "goal": "write `goal: PREDICATE`, or `when PREDICATE then goal: PREDICATE`",
}
"""With what the entries of a block begin, and their form."""

_HOMES: Final = {
    "state": "STATE VECTOR",
    "define": "ALIASES",
    "resource": "RESOURCES",
    "action": "ACTIONS",
    "rule": "STATE RULES",
    "severity": "STATE RULES",
    "assume": "ASSUMPTIONS",
    "start": "START",
    "goal": "GOALS",
    "when": "GOALS",
    **dict.fromkeys(("max_plan_length", "effect_ordering", "restoration", "preconditions"), "CONFIG"),
}
"""The blocks of entries."""

_COPIED: Final = {
    "state": "for N in {0} state NAME_{{N}} can be VALUE, VALUE end for",
    "resource": "for N in {0} resource NAME_{{N}} end for",
    "action": "for N in {0} action NAME_{{N}} end for",
    "executing": "some N in {0}: executing NAME_{{N}}",
    "resources": "controlled resources: NAME_1, NAME_2",
}
"""Where a name stands, and how several of a kind are written."""


def _character(here: Situation) -> Diagnostic | None:
    """`#`, `;`, quotes and brackets: what other languages have, and this one has not."""
    token, before, after = here.token, here.at(-1), here.at(1)
    text, character = token.text, Code.TUM104
    if here.begins_comment:
        return unexpected(token.span, text, "a comment begins with `//`", character)
    if text == ";":
        way_out = "leave it out: nothing ends a line" if not here.goes_on else f"write `{here.goes_on}`"
        return unexpected(token.span, text, way_out, character)
    if text in ("'", '"', "`", "“", "”", "‘", "’"):
        return unexpected(token.span, text, "leave the quotes out: names and values have none", character)
    if text in ("[", "]") and (here.wants_predicate or ")" in here.expected):
        return unexpected(token.span, text, f"write `{'(' if text == '[' else ')'}`", character)
    if text in ("[", "]", "(", ")") and {"NUMBER", "NAME"} & here.expected and before.text in ("be", ":"):
        one = "write one number" if "NAME" not in here.expected else "leave it out: nothing stands around a list"
        return unexpected(token.span, text, one, Code.TUM104 if token.kind == "other" else Code.TUM105)
    if text == "." and touch(before, token) and not touch(token, after):
        return unexpected(token.span, text, "leave it out: nothing ends a line", character)
    if text in (".", "-") and before.kind == "word" and touch(before, token) and touch(token, after):
        return told(token.span, f"write `{before.text}_{after.text}`", f"a name has no {quoted(text)} in it", character)
    return None


def _range(here: Situation) -> Diagnostic | None:
    """`1..3` where a name must be, and ranges in other spellings."""
    token, before, after = here.token, here.at(-1), here.at(1)
    offset = here.at(2) if token.text == "{" else token
    if re.fullmatch("[+-]0[0-9]*", offset.text) and ("OFFSET" in here.expected or offset is not token):
        number = int(offset.text[1:])
        way_out = f"write `{offset.text[0]}{number}`" if number else "leave it out"
        return told(offset.span, way_out, f"{quoted(offset.text)} is not how this number is written", Code.TUM114)
    if token.text == "." and before.text == ".." and after.kind == "number":
        return unexpected(joined(before, token), "...", "write `..`", Code.TUM104)
    signed = token.kind == "number" and token.text[0] in "+-" and "OFFSET" not in here.expected
    if signed and touch(before, token) and before.kind in ("word", "number"):
        ranged = before.kind == "number" and ".." in here.expected
        form = f"{before.text}..{token.text[1:]}" if ranged else f"{before.text}_{token.text[1:]}"
        return unexpected(token.span, token.text, f"write `{form}`")
    if token.text == "to" and before.kind == "number" and after.kind == "number" and ".." in here.expected:
        return unexpected(token.span, "to", f"write `{before.text}..{after.text}`")
    return _names(here)


def _names(here: Situation) -> Diagnostic | None:
    """`1..3` or `R_1..3` where one name must be."""
    first = 0 if here.token.kind == "number" and here.at(1).text == ".." and "NAME" in here.expected else -1
    last = here.at(first + 2)
    if here.at(first + 1).text != ".." or last.kind not in ("number", "word"):
        return None
    place = here.at(first - 1).text if here.at(first - 1).text != ":" else here.at(first - 2).text
    if first and place not in _COPIED:
        return None
    digits = re.search(r"[0-9]*$", here.at(first).text)
    numbers = f"{(digits and digits[0]) or 1}..{last.text if last.kind == 'number' else 3}"
    form = _COPIED.get(place, "NAME in {{{0}}}").format(numbers)
    message = f"{quoted(f'{here.at(first).text}..{last.text}')} is not a name"
    return told(joined(here.at(first), last), f"write `{form}`", message, Code.TUM113)


def _constant(here: Situation) -> Diagnostic | None:
    """`define N as 2`."""
    token = here.token
    if token.kind != "number" or [here.at(-1).text, here.at(-3).text] != ["as", "define"]:
        return None
    list_of_one = f"define {here.at(-2).text} as {{{token.text}}}"
    way_out = f"write a predicate, such as `S is {token.text}`, or a list of values: `{list_of_one}`"
    return told(token.span, way_out, "an alias stands for a predicate", Code.TUM113)


def _field(here: Situation) -> Diagnostic | None:
    """A field that actions do not have, or a setting that there is not."""
    if here.token.kind != "word" or here.at(1).text not in (":", "="):
        return None
    span, text = here.token.span, here.token.text
    if "nominal" in here.expected:
        way_out = _MEANT_FIELDS.get(text.lower())
        if way_out is None and here.misspelled:
            return None
        fields = f"the fields of an action are {listed(_FIELDS)}"
        return told(span, way_out or fields, f"an action has no field {quoted(text)}")
    if "max_plan_length" in here.expected and not here.misspelled:
        settings = f"the settings are {listed(_SETTINGS)}"
        way_out = "a run is limited on the command line: `--timeout 10`" if text == "timeout" else settings
        return told(span, way_out, f"there is no setting {quoted(text)}")
    return None


def _none(here: Situation) -> Diagnostic | None:
    """`none, S is a`."""
    if here.token.text != "," or here.at(-1).text != "none" or "," in here.expected:
        return None
    return told(here.at(-1).span, none_alone(here.in_alternatives), "`none` stands alone")


def none_alone(alternative: bool) -> str:
    """The way out where `none` is one of several."""
    if alternative:
        return "an alternative without change is a line of its own: `alternative effects: none`"
    return "leave it out"


def _entry(here: Situation) -> Diagnostic | None:
    """Something at the start of an entry with which none of its block begins."""
    word = next((each for each in _ENTRIES if each in here.expected), None)
    token, after = here.token, here.at(1)
    if word is None or "," in here.expected or here.lacks_goal_type or here.expected == {"BEGIN", "goal"}:
        return None
    if here.at(-2).text == ":" and here.at(-3).text in ("duration", "cost") and token.kind == "word":
        return unexpected(token.span, token.text, "leave it out: durations are numbers of a unit of your choice")
    if here.misspelled and after.text not in ("is", "in") and token.text != "goals":
        return None
    way_out = _ENTRIES[word]
    if here.declares(token.text) and {"AND", "is"} & here.expected == {"AND"} and word in ("rule", "assume", "start"):
        return unexpected(token.span, token.text, f"write `AND` before it, or `{word}:` where it is one more")
    begins = token.text in ("NOT", "IF", "(", "executing", "true", "false") or token.kind == "word"
    if not begins or token.text in HARD - {"NOT", "IF"} or here.in_another_case or "AND" in here.expected:
        return None
    if word == "goal" and token.text.lower() == "if":
        way_out = "write `when PREDICATE then goal: PREDICATE`"
    if token.text.lower() == "never" and after.text == ":" and word == "rule":
        way_out = "write `rule: NOT (PREDICATE)`"
    return unexpected(token.span, token.text, way_out)


def _list(here: Situation) -> Diagnostic | None:
    """Values in other lists than with commas."""
    token = here.token
    if token.text == "{" and here.at(-1).text == "be":
        return unexpected(token.span, "{", "leave the braces out: `can be VALUE, VALUE`")
    if not here.lacks_comma:
        return None
    if here.says_initial_value:
        return unexpected(token.span, token.text, "leave it out: with which values runs begin is said in `BEGIN START`")
    way_out = "write `,` before it" if here.begins_value else "write `,`"
    return unexpected(token.span, token.text, way_out, Code.TUM104 if token.kind == "other" else Code.TUM105)


def _case(here: Situation) -> Diagnostic | None:
    """`begin state vector`."""
    cased = here.block_in_another_case
    if not cased:
        return None
    last = here.at(len(cased) - 1)
    written = " ".join(here.at(place).text for place in range(len(cased)))
    way_out = f"did you mean `{' '.join(cased)}`? Case matters"
    return unexpected(joined(here.token, last), written, way_out, Code.TUM111)


def _outside(here: Situation) -> Diagnostic | None:
    """Entries and titles outside blocks, and an END too many."""
    token = here.token
    if not here.expected <= {"$END", "BEGIN"} or token.kind != "word":
        return None
    title = next((each for each in BLOCKS if (token.text, here.at(1).text)[: len(each)] == each), None)
    if title is not None:
        return unexpected(token.span, token.text, f"write `BEGIN {' '.join(title)}`")
    if token.text in _HOMES:
        home = _HOMES[token.text]
        return unexpected(token.span, token.text, f"it belongs in a block: `BEGIN {home}` … `END {home}`")
    return unexpected(token.span, "END", "leave it out: no block is open here") if token.text == "END" else None


def _declaration(here: Situation) -> Diagnostic | None:
    """A colon after a name, a title or a header; braces around an action; a number for a name."""
    token, before = here.token, here.at(-1)
    if (
        token.text == ":"
        and here.at(-2).text in ("action", "resource")
        and ("action" in here.expected or "resource" in here.expected)
    ):
        return unexpected(token.span, ":", f"leave it out: `{here.at(-2).text} {before.text}`")
    if token.text == ":" and before.text in TITLES:
        return unexpected(token.span, ":", "leave it out")
    if token.text in ("{", "}") and "nominal" in here.expected:
        return unexpected(token.span, token.text, "leave it out: an action ends where the next one begins")
    if (
        here.expected == {":"}
        and before.text == "rule"
        and (token.kind in ("word", "number"))
        and here.at(1).text == ":"
    ):
        return unexpected(token.span, token.text, "leave it out: rules have no names")
    return None


ENTRIES: tuple[Callable[[Situation], Diagnostic | None], ...] = (
    _case,
    _outside,
    _range,
    _character,
    *LISTS,
    _constant,
    _field,
    _none,
    _declaration,
    _list,
    _entry,
)
"""What is tried around predicates, one after the other."""
