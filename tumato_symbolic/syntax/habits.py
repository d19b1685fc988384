"""Predicates as people write them who know other languages, and how they are written in this one."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

from tumato_symbolic.diagnostics import Code, Diagnostic, Span
from tumato_symbolic.diagnostics.wording import MAX_QUOTED, quoted
from tumato_symbolic.syntax.situation import Situation
from tumato_symbolic.syntax.tokens import COMPARING, HARD, Token

CONDITIONAL_EFFECT: Final = "write `when CONDITION: EFFECT` after the effects that always happen"
"""How an effect is written that depends on the state in which its action starts."""

_IMPLIES: Final = "write `IF p THEN q`"
_CONDITIONS: Final = frozenset({"if", "when", "whenever", "while"})
_BEFORE: Final = {
    **dict.fromkeys(("when", "whenever", "while"), "write `IF p THEN q`; `when` conditions goals"),
    **dict.fromkeys(
        ("always", "globally", "must", "ensure", "require"), "leave it out: a rule is to hold in every state"
    ),
    **dict.fromkeys(("never", "forbid", "avoid"), "write `NOT (PREDICATE)`"),
    **dict.fromkeys(("eventually", "finally"), "what is to be reached is a goal: `goal: PREDICATE`"),
    **dict.fromkeys(("forall", "each", "every"), "write `all NAME in VALUE, VALUE: PREDICATE`"),
    **dict.fromkeys(("exists", "any"), "write `some NAME in VALUE, VALUE: PREDICATE`"),
    "one": "write `exactly one NAME in VALUE, VALUE: PREDICATE`",
    "none": "write `NOT some NAME in VALUE, VALUE: PREDICATE`",
    "no": "write `NOT some NAME in VALUE, VALUE: PREDICATE`",
    "at": "write `all A in VALUE, VALUE, B in VALUE, VALUE where A < B: NOT (p AND q)`, where `p` is of A and `q` of B",
    **dict.fromkeys(("execute", "executes", "run", "running", "do", "perform", "start"), "write `executing ACTION`"),
    **dict.fromkeys(("set", "assign", "let"), "write `NAME is VALUE`"),
}
"""Words that people write before a predicate, in lower case, and the way out."""

_BETWEEN: Final = {
    **dict.fromkeys(("implies", "->", "==>", "-->"), _IMPLIES),
    "=>": _IMPLIES,
    **dict.fromkeys(("iff", "<->", "<=>"), "write `IFONLYIF`"),
    "xor": "write `NOT (p IFONLYIF q)`",
    "unless": "for `q unless p` write `IF NOT (p) THEN q`",
    **dict.fromkeys(("else", "otherwise", "elseif", "elif"), "write `(IF p THEN q) AND (IF NOT (p) THEN r)`"),
    "then": "begin with `IF`: `IF p THEN q`",
    **dict.fromkeys(_CONDITIONS, "write the condition first: `IF p THEN q`"),
}
"""Words and symbols that people write after a predicate, in lower case, and the way out."""

_WORDED: Final = {
    **dict.fromkeys(("either", "one", "any"), "{} in {{VALUE, VALUE}}"),
    "neither": "{} not in {{VALUE, VALUE}}",
    "between": "{} in {{1..3}}",
    **dict.fromkeys(("greater", "more", "above"), "{} > {}"),
    **dict.fromkeys(("less", "fewer", "below"), "{} < {}"),
    "at": "{0} >= {1}` or `{0} <= {1}",
    "at least": "{} >= {}",
    "at most": "{} <= {}",
}
"""What people write after `is`, and the form that says it."""

_VERBS: Final = frozenset({"are", "equals", "equal", "be", "becomes", "was", "has", "to", "="})
"""What people write for `is`."""

_MIRRORED: Final = {"<": ">", "<=": ">=", ">": "<", ">=": "<=", "=": "=", "!=": "!="}
_OPPOSITE: Final = {"<": ">=", "<=": ">", ">": "<=", ">=": "<", "=": "!=", "!=": "="}
_SPELLED: Final = {"=>": ">=", "=<": "<=", "<>": "is not", "===": "is", "!==": "is not"}


def told(span: Span, way_out: str, message: str, code: Code = Code.TUM105) -> Diagnostic:
    """A mistake and its way out."""
    return Diagnostic(code, message, span, way_out)


def unexpected(span: Span, text: str, way_out: str, code: Code = Code.TUM105) -> Diagnostic:
    """A piece of text that does not fit, and the way out."""
    return told(span, way_out, f"unexpected {quoted(text)}", code)


def joined(first: Token, last: Token) -> Span:
    """The range from one token to another."""
    return Span(first.line, first.column, last.span.end_line, last.span.end_column)


def touch(first: Token, second: Token) -> bool:
    """Whether nothing stands between two tokens."""
    return first.line == second.line and first.span.end_column == second.column


def listing(tokens: tuple[Token, ...]) -> str:
    """Values as they are written, one space after each comma."""
    return "".join(", " if each.text == "," else each.text for each in tokens)


def _conditional_effect(here: Situation) -> Diagnostic | None:
    """A condition before or after an effect; after it there is one only where the predicate is over."""
    before, token = here.at(-1), here.token
    if token.text == "when" and before.text == "," and here.in_effects_or_clause:
        return _comma_before_clause(before)
    if here.in_condition_of_effect and ":" in here.expected:
        return unexpected(token.span, token.text, CONDITIONAL_EFFECT)
    if not here.in_effects:
        return None
    if token.text.lower() in _CONDITIONS and "AND" in here.expected:
        return unexpected(token.span, token.text, CONDITIONAL_EFFECT)
    if "is" in here.expected and before.text.lower() in _CONDITIONS and not here.declares(before.text):
        comma = here.at(-2)
        if before.text == "when" and comma.text == ",":
            return _comma_before_clause(comma)
        return unexpected(before.span, before.text, CONDITIONAL_EFFECT)
    return None


def _comma_before_clause(comma: Token) -> Diagnostic:
    return unexpected(comma.span, ",", "leave it out: `when` begins a clause, which needs no comma before it")


def _before_predicate(here: Situation) -> Diagnostic | None:
    """A word of another language with which a predicate begins: it was taken for a name."""
    word = here.at(-1)
    way_out = _BEFORE.get(word.text.lower())
    follows = here.token.kind == "word" and here.token.text not in HARD
    if way_out is None or "is" not in here.expected or here.declares(word.text):
        return None
    if not follows and (here.token.text != "(" or word.text.lower() not in ("always", "never", "when", "whenever")):
        return None
    name, value = here.token.text, here.at(2)
    if f"{word.text} {name}" == "no change" and here.in_effects:
        return unexpected(joined(word, here.token), "no change", "write `none`")
    if "executing" in way_out:
        way_out = f"write `executing {name}`"
    if word.text.lower() in ("set", "assign", "let") and value.kind in ("word", "number"):
        way_out = f"write `{name} is {value.text}`"
    return unexpected(word.span, word.text, way_out)


def _after_predicate(here: Situation) -> Diagnostic | None:
    """A word or symbol of another language with which a predicate goes on."""
    way_out = _BETWEEN.get(here.token.text.lower())
    if way_out is None or "AND" not in here.expected or "is" in here.expected:
        return None
    if here.token.text == "IF" and here.at(-1).text in ("THEN", "AND", "OR", "IFONLYIF", "NOT"):
        return None
    if here.token.text.lower() == "then" and ({"THEN", "then"} & here.expected):
        return None
    code = Code.TUM104 if here.token.kind == "other" else Code.TUM105
    return unexpected(here.token.span, here.token.text, way_out, code)


def _quantifier(here: Situation) -> Diagnostic | None:
    """`for all R in …` and `exactly 1 R in …`."""
    token, after = here.token, here.at(1)
    if token.text.lower() == "for" and here.wants_predicate and after.text in ("all", "each", "every"):
        return unexpected(joined(token, after), f"{token.text} {after.text}", _BEFORE["forall"])
    if here.at(-1).text == "exactly" and token.text == "1" and "is" in here.expected:
        return unexpected(token.span, token.text, "write `exactly one NAME in VALUE, VALUE: PREDICATE`")
    return None


def _worded(here: Situation) -> Diagnostic | None:
    """`S is either a or b`, `S is in {a}`, `S is {a}`, `N is 1..3`: the predicate was over before the token."""
    found = here.compared()
    if found is None:
        return None
    name, denied, start = found
    word = here.tokens[start]
    no = "not " if denied else ""
    if word.text.lower() in _WORDED and start < here.index and not denied and here.token.text not in (":", ".."):
        number = next((each.text for each in here.tokens[start + 1 : start + 4] if each.kind == "number"), "3")
        words = f"{word.text} {here.token.text}".lower()
        form = _WORDED.get(words) or _WORDED[word.text.lower()]
        return unexpected(word.span, word.text, f"write `{form.format(name, number)}`")
    if here.token.text == "NOT" and start == here.index and here.at(1).text == "in":
        return unexpected(here.token.span, "NOT", f"write `{name} not in {{VALUE, VALUE}}`")
    if here.token.text == "{" and (start == here.index or word.text == "in"):
        shown = f"{name} {no}in {listing(here.tokens[here.index : here.closing_brace()])}"
        return unexpected(word.span, word.text, f"write `{shown}`") if len(shown) <= MAX_QUOTED else None
    if here.token.text == ".." and start == here.index - 1 and here.at(1).kind == "number":
        shown = f"{word.text}..{here.at(1).text}"
        return unexpected(joined(word, here.at(1)), shown, f"write `{name} {no}in {{{shown}}}`")
    return None


def _braces(here: Situation) -> Diagnostic | None:
    """`S in a, b` and `N in 1..3`."""
    if here.expected != {"{"} or here.at(-1).text != "in" or here.token.kind not in ("word", "number"):
        return None
    end = here.index + 1
    name = here.at(-3 if here.at(-2).text == "not" else -2).text
    while here.tokens[end].text in ("..", ",") and here.tokens[end + 1].kind in ("word", "number"):
        listed = here.tokens[end].text == ","
        if listed and here.tokens[end + 2].text in {"is", "in", "not", *COMPARING}:
            break
        end += 2
    no = "not " if here.at(-2).text == "not" else ""
    if here.lists(here.token.text):
        shown = f"{'all' if no else 'some'} V in {here.token.text}: {name} is {no}{{V}}"
        return told(here.token.span, f"write `{shown}`", f"{quoted(here.token.text)} is a list of values")
    shown = f"{name} {no}in {{{listing(here.tokens[here.index : end])}}}"
    if len(shown) > MAX_QUOTED:
        shown = f"{name} {no}in {{VALUE, VALUE}}"
    return told(joined(here.token, here.tokens[end - 1]), f"write `{shown}`", "the values after `in` stand in braces")


def _comparison(here: Situation) -> Diagnostic | None:
    """Comparisons in another order, with a word too much, or in another spelling."""
    token, before, after = here.token, here.at(-1), here.at(1)
    if token.text in COMPARING and before.text in ("is", "not") and after.kind in ("word", "number"):
        denied = before.text == "not"
        name, sign = here.at(-3 if denied else -2).text, _OPPOSITE[token.text] if denied else token.text
        return unexpected(token.span, token.text, f"write `{name} {sign} {after.text}`")
    if token.kind == "number" and here.wants_predicate and after.text in COMPARING and here.at(2).kind == "word":
        name, form = here.at(2).text, f"{here.at(2).text} {_MIRRORED[after.text]} {token.text}"
        if here.at(3).text in COMPARING and here.at(4).kind == "number":
            form = f"{form} AND {name} {here.at(3).text} {here.at(4).text}"
        return told(token.span, f"write `{form}`", "a comparison begins with a variable")
    if (
        token.text in COMPARING
        and here.wants_predicate
        and before.text in ("AND", "OR")
        and here.at(-3).text in COMPARING
    ):
        return unexpected(token.span, token.text, f"write `{here.at(-4).text} {token.text} {after.text}`")
    if token.text in COMPARING and "AND" in here.expected and "is" not in here.expected:
        return unexpected(token.span, token.text, f"a variable stands before `{token.text}`, and a number after it")
    if {"is", ">="} <= here.expected:
        if token.text == "==" and here.declares(after.text):
            return unexpected(token.span, token.text, "write `=`", Code.TUM104)
        if token.text in _SPELLED:
            return unexpected(token.span, token.text, f"write `{_SPELLED[token.text]}`", Code.TUM104)
        if token.text == ":" and after.text == "=" and touch(token, after):
            return unexpected(joined(token, after), ":=", "write `is`", Code.TUM104)
    if token.text == "-" and before.text == "<" and touch(before, token):
        return unexpected(joined(before, token), "<-", "write `is`", Code.TUM104)
    return None


def _verb(here: Situation) -> Diagnostic | None:
    """`S equals a`, `S isn't a`."""
    token = here.token
    if "is" not in here.expected or token.kind != "word":
        return None
    if token.text in ("isn", "isnt", "aren", "arent"):
        return unexpected(token.span, token.text, "write `is not`")
    if token.text.lower() in _VERBS and here.at(1).kind in ("word", "number") and here.at(1).text not in HARD:
        name = here.at(-1).text
        return unexpected(token.span, token.text, f"write `{name} is {here.at(1).text}`")
    return None


def _called(here: Situation) -> Diagnostic | None:
    """`executing(go)`."""
    if here.token.text != "(" or here.at(-1).text != "executing" or here.at(1).kind != "word":
        return None
    return unexpected(here.token.span, "(", f"write `executing {here.at(1).text}`")


PREDICATES: tuple[Callable[[Situation], Diagnostic | None], ...] = (
    _conditional_effect,
    _quantifier,
    _before_predicate,
    _worded,
    _braces,
    _comparison,
    _after_predicate,
    _verb,
    _called,
)
"""What is tried in and between predicates, one after the other."""
