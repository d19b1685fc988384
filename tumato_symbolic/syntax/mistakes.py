"""What is wrong where a token does not fit, in the user's terms, and the way out."""

from __future__ import annotations

import re
from collections.abc import Callable

from tumato_symbolic.diagnostics import Code, Diagnostic, Note
from tumato_symbolic.diagnostics.wording import MAX_QUOTED, listed, quoted
from tumato_symbolic.syntax.block_mistakes import BOUNDS
from tumato_symbolic.syntax.entry_habits import ENTRIES
from tumato_symbolic.syntax.habits import PREDICATES
from tumato_symbolic.syntax.operator_habits import OPERATORS, function
from tumato_symbolic.syntax.situation import Situation
from tumato_symbolic.syntax.tokens import COMPARING, HARD, MAX_DIGITS, Token

_OPERATORS = ("AND", "OR", "IFONLYIF", "THEN")
_FORMS = {
    "state": "write `state NAME can be VALUE, VALUE`, or `state NAME can be 0..3`",
    "define": "write `define NAME as PREDICATE`",
    "resource": "write `resource NAME`",
    "controlled": "write `controlled resources: NAME, NAME`",
    "duration": "write `duration: 10`",
    "cost": "write `cost: 10`",
    "rule": "write `rule: PREDICATE`",
    "assume": "write `assume: PREDICATE`",
    "start": "write `start: PREDICATE`",
    "when": "write `when PREDICATE then goal: PREDICATE`",
    "max_plan_length": "write `max_plan_length: 5`",
    "effect_ordering": "write `effect_ordering: any` or `effect_ordering: first`",
    "restoration": "write `restoration: one_step`, `restoration: bounded` or `restoration: fair`",
    "severity": "write `severity: 1`",
}
_SYMBOLS = {"==": "is", "&": "AND", "&&": "AND", "|": "OR", "||": "OR", "!": "NOT", "->": "IF … THEN …"}
_SYMBOLS |= {"=>": "IF … THEN …", "<->": "IFONLYIF", "<=>": "IFONLYIF", "!==": "!=", ";": ","}
_AFTER = {
    "is": "a value",
    "be": "a value",
    "executing": "the name of an action",
    "state": "the name of a state variable",
    "action": "the name of an action",
    "resource": "the name of a resource",
    "resources": "the name of a resource",
    "define": "the name of an alias",
}


def explain(here: Situation) -> Diagnostic:
    """The mistake, told as precisely as the detectors below know it."""
    found = (detector(here) for detector in _DETECTORS)
    return next((each for each in found if each is not None), None) or _unexpected(here)


def _character(here: Situation) -> Diagnostic | None:
    token = here.token
    for_colon = here.expected == {":"} and token.text in COMPARING
    if token.kind != "other" and not for_colon:
        return None
    meant = ":" if here.expected == {":"} else _SYMBOLS.get(token.text)
    way_out = f"write `{meant}`" if meant else _FIRST if here.index == 0 else None
    if not token.text.isprintable() or token.text.isspace():
        way_out = "remove it, or write a plain space"
    if re.match(r"\w", token.text):
        return Diagnostic(Code.TUM113, f"{quoted(token.text)} is not a name", token.span, help=_NAME_HELP)
    return Diagnostic(Code.TUM104, f"unexpected {quoted(token.text)}", token.span, help=way_out)


_FIRST = "a specification is a text of blocks, such as `BEGIN STATE VECTOR` … `END STATE VECTOR`"
_NAME_HELP = "a name is a letter (A-Z, a-z) or `_`, then letters, digits and `_`"


def _malformed(here: Situation) -> Diagnostic | None:
    token = here.token
    if token.kind not in ("malformed", "number"):
        return None
    like_a_number = re.fullmatch(r"[+-]?[0-9.]+", token.text) is not None
    if "NUMBER" in here.expected and (like_a_number or "NAME" not in here.expected):
        return Diagnostic(
            Code.TUM114, f"{quoted(token.text)} is not a whole number in range", token.span, help=_number_help(token)
        )
    if "NAME" in here.expected:
        return Diagnostic(Code.TUM113, f"{quoted(token.text)} is not a name", token.span, help=_NAME_HELP)
    return None


def _number_help(token: Token) -> str:
    if len(token.text.lstrip("+-")) > MAX_DIGITS:
        return f"numbers have at most {MAX_DIGITS} digits"
    meant = re.fullmatch(r"\+?(-?)0*([0-9]+)", token.text)
    return f"write a whole number, such as `{int(''.join(meant.groups())) if meant else 10}`"


def _wrong_case(here: Situation) -> Diagnostic | None:
    if here.in_another_case is not None:
        return _case(here.token, here.in_another_case)
    before = here.previous
    earlier = {"not": "NOT", "if": "IF", "executing": "executing"}
    if before is not None and before.kind == "word" and before.text.lower() in earlier:
        meant = earlier[before.text.lower()]
        if before.text != meant:
            return _case(before, meant)
    return None


def _case(token: Token, meant: str) -> Diagnostic:
    return Diagnostic(
        Code.TUM111, f"unexpected {quoted(token.text)}", token.span, help=f"did you mean `{meant}`? Case matters"
    )


def _when_when(here: Situation) -> Diagnostic | None:
    if here.token.text != "when" or here.previous is None or here.previous.text != "then":
        return None
    return Diagnostic(
        Code.TUM112,
        "`when` cannot follow `then`",
        here.token.span,
        help="join the two conditions: `when p AND q then goal: …`",
    )


def _implication(here: Situation) -> Diagnostic | None:
    text = here.token.text
    if text == "IFONLYIF":
        first = here.last("IFONLYIF", "(", ":", "THEN", "IF")
        if first is not None and first.text == "IFONLYIF":
            return Diagnostic(
                Code.TUM109,
                "`IFONLYIF` cannot be chained",
                here.token.span,
                help="say which belongs together: `(p IFONLYIF q) IFONLYIF r`",
                notes=(Note("the first one is here", first.span),),
            )
        if first is not None and first.text == "IF":
            return _parentheses(here, "p IFONLYIF q")
    if text == "IF" and "NAME" in here.expected and "(" in here.expected:
        return _parentheses(here, "IF p THEN q")
    return None


def _parentheses(here: Situation, form: str) -> Diagnostic:
    return Diagnostic(
        Code.TUM110,
        f"`{here.token.text}` needs parentheses here",
        here.token.span,
        help=f"write `({form})`",
    )


def _goal_type(here: Situation) -> Diagnostic | None:
    if not here.lacks_goal_type:
        return None
    return Diagnostic(
        Code.TUM105,
        "a list of goals begins with its type",
        here.token.span,
        help="write `goal type: priority` or `goal type: constraint` first",
    )


def _missing_colon(here: Situation) -> Diagnostic | None:
    if here.expected != {":"} or here.previous is None:
        return None
    return Diagnostic(
        Code.TUM105,
        f"{_shown(here.token)} where `:` is expected",
        here.token.span,
        help=f"write `{here.previous.text}:`",
    )


def _missing_is(here: Situation) -> Diagnostic | None:
    if "is" not in here.expected or here.token.kind != "word" or here.token.text in HARD or here.previous is None:
        return None
    return Diagnostic(
        Code.TUM105,
        f"{_shown(here.token)} where `is` or an operator is expected",
        here.token.span,
        help=f"write `{here.previous.text} is {here.token.text}`" if len(here.token.text) <= MAX_QUOTED else None,
    )


def _misspelled(here: Situation) -> Diagnostic | None:
    near = here.misspelled
    if near is None:
        return None
    return Diagnostic(
        Code.TUM105, f"unexpected {quoted(here.token.text)}", here.token.span, help=f"did you mean `{near}`?"
    )


def _comma(here: Situation) -> Diagnostic | None:
    if here.token.text != "," or "AND" not in here.expected:
        return None
    listed_values = here.at(-2).text in ("is", "not") and here.at(2).text not in ("is", "in", "not", *COMPARING)
    if listed_values and here.at(1).kind in ("word", "number"):
        name, no = (here.at(-4).text, "not ") if here.at(-2).text == "not" else (here.at(-3).text, "")
        form = f"{name} {no}in {{{here.at(-1).text}, {here.at(1).text}}}"
        return Diagnostic(Code.TUM105, "unexpected `,`", here.token.span, help=f"write `{form}`")
    return Diagnostic(
        Code.TUM105,
        "a comma joins predicates in the fields of actions only",
        here.token.span,
        help="write `AND`",
    )


def _clause(here: Situation) -> Diagnostic | None:
    """What does not fit in a clause of effects, or in a relative effect."""
    if here.title != ("ACTIONS",):
        return None
    text, before = here.token.text, here.previous
    latest = here.last("when", "action", "preconditions", "nominal", "effects", "alternative")
    help_ = None
    if text == "then" and latest is not None and latest.text == "when":
        help_ = "write `when CONDITION: EFFECT`"
    elif text in ("+", "-") and here.tokens[here.index + 1].kind == "number":
        help_ = "a relative effect stands alone among the effects, as in `S_Level is S_Level - 1, S_Place is dock`"
    elif text in ("AND", "OR") and before is not None and before.kind == "number" and "," in here.expected:
        help_ = "write a comma: a relative effect stands alone among the effects"
    if help_ is None:
        return None
    return Diagnostic(Code.TUM105, f"unexpected {quoted(text)}", here.token.span, help=help_)


def _unexpected(here: Situation) -> Diagnostic:
    opened = here.last("(") if ")" in here.expected else None
    needless = here.token.text == ")" and "AND" in here.expected
    return Diagnostic(
        Code.TUM105,
        f"{_shown(here.token)} where {_wanted(here)} is expected",
        here.token.span,
        help="write `)` before this" if opened else "leave it out: no parenthesis is open" if needless else _form(here),
        notes=(Note("this parenthesis is open", opened.span),) if opened else (),
    )


def _form(here: Situation) -> str | None:
    """The form of the item that is half read, unless it is a predicate in it that is wrong."""
    if here.expected == {"at_start", "throughout"}:
        return "write `preconditions: at_start` or `preconditions: throughout`"
    latest = here.last(*_FORMS)
    in_predicate = here.wants_predicate or here.expected & {"AND", ")"}
    after = here.previous.text if here.previous else ""
    return None if latest is None or in_predicate or after in ("is", "executing") else _FORMS[latest.text]


def _wanted(here: Situation) -> str:
    if here.wants_predicate:
        return "a predicate"
    if here.expected == {"$END", "BEGIN"}:
        return "`BEGIN` and the name of a block"
    before = here.previous.text if here.previous else ""
    rank = {text: place for place, text in enumerate((":", ",", *_OPERATORS, ")"))}
    texts = sorted(here.expected, key=lambda text: (rank.get(text, len(rank)), text))
    shown = {
        "NAME": _AFTER.get(before, "a name"),
        "NUMBER": "a number",
        "OFFSET": "an offset",
        "$END": "the end of the text",
    }
    return listed([shown.get(text, f"`{text}`") for text in texts], "or", plain=True)


def _shown(token: Token) -> str:
    return "the text ends" if token.kind == "end" else f"unexpected {quoted(token.text)}"


_DETECTORS: tuple[Callable[[Situation], Diagnostic | None], ...] = (
    *OPERATORS,
    _clause,
    *BOUNDS,
    *ENTRIES,
    *PREDICATES,
    _character,
    _malformed,
    _wrong_case,
    _when_when,
    _implication,
    _goal_type,
    _missing_colon,
    _misspelled,
    _comma,
    _missing_is,
    function,
)
"""Who is asked, one after the other, what is wrong where a token does not fit: the first that knows tells it."""
