"""Words that may be keywords or names: what follows tells, further on than the parse table looks."""

from __future__ import annotations

from typing import Final

from tumato_symbolic.syntax.tokens import COMPARING, HARD, Token

NOT_PARAMETERS: Final = frozenset({"action", "define", "for", "in", "is", "not", "where"})
"""Words that cannot name a parameter: texts that use them as names are read as ever."""

AFTER_VALUES: Final = frozenset({"when", "then", "action", "define", "for", "end"})
"""Words that go on after `S is not`, so that `not` is the value there."""

_BEFORE_COLONS: Final = frozenset(
    {"duration", "cost", "preconditions", "effects", "rule", "severity", "assume", "goal", "start"}
    | {"max_plan_length", "effect_ordering", "restoration"}
)
"""Words that go on likewise where a colon follows them."""

_AFTER_NAMES: Final = HARD - {"NOT", "IF"} | {"is", "in", "not", "action", "for", "end", "when"}
"""Words that follow the name of a variable or of an alias, or what such a name ends; none begins a predicate."""

_TWO_WORDS: Final = frozenset({("controlled", "resources"), ("nominal", "effects"), ("alternative", "effects")})
"""Titles of fields that go on likewise."""


def denies(tokens: tuple[Token, ...], index: int) -> bool:
    """Whether `not` after `is` denies the value after it, rather than being the value."""
    value, after = _at(tokens, index + 1), _at(tokens, index + 2)
    if value.kind == "number":
        return True
    return value.kind == "word" and value.text not in HARD | AFTER_VALUES and not _begins_entry(value, after)


def begins_clause(tokens: tuple[Token, ...], index: int) -> bool:
    """Whether `when` begins a clause rather than being a name, where a list of effects may begin with either."""
    following, after = _at(tokens, index + 1), _at(tokens, index + 2)
    if following.kind != "word" or following.text in _AFTER_NAMES:
        return following.text == "("
    return not _begins_entry(following, after)


def _begins_entry(word: Token, after: Token) -> bool:
    """Whether a word and what follows it begin a field, a rule, a goal or a setting."""
    return (word.text, after.text) in _TWO_WORDS or (word.text in _BEFORE_COLONS and after.text == ":")


def begins_copies(tokens: tuple[Token, ...], index: int) -> bool:
    """Whether `for` begins copies rather than being a name."""
    return _is_parameter(tokens, index + 1)


def ends_copies(tokens: tuple[Token, ...], index: int) -> bool:
    """Whether `end` ends copies rather than being a name."""
    return _at(tokens, index + 1).text == "for"


def quantifies(tokens: tuple[Token, ...], index: int) -> bool:
    """Whether `all`, `some` or `exactly` begins a quantifier rather than being a name."""
    if tokens[index].text == "exactly":
        return _at(tokens, index + 1).text == "one" and _is_parameter(tokens, index + 2)
    return _is_parameter(tokens, index + 1)


def _is_parameter(tokens: tuple[Token, ...], index: int) -> bool:
    name = _at(tokens, index)
    named = name.kind == "word" and name.text not in NOT_PARAMETERS | HARD
    return named and _at(tokens, index + 1).text == "in"


def _at(tokens: tuple[Token, ...], index: int) -> Token:
    return tokens[min(index, len(tokens) - 1)]


def after_headers(tokens: tuple[Token, ...], index: int) -> int:
    """Where the headers of copies that begin at a `for` and follow one another are over."""
    last = len(tokens) - 1
    while index < last and tokens[index].text == "for":
        index = _after_header(tokens, index + 1)
    return min(index, last)


def _after_header(tokens: tuple[Token, ...], index: int) -> int:
    """Where the header that begins at `index` is over; anywhere near where it is not a header."""
    while True:
        if _at(tokens, index + 1).text == "in":
            index += 2
        if _at(tokens, index).text == "{":
            while index < len(tokens) - 1 and tokens[index].text != "}":
                index += 1
            index += 1
        else:
            index += 3 if _at(tokens, index + 1).text == ".." else 1
        if _at(tokens, index).text != ",":
            break
        index += 1
    if _at(tokens, index).text != "where":
        return index
    while True:
        index = _after_operand(tokens, index + 1)
        if _at(tokens, index).text in COMPARING:
            index = _after_operand(tokens, index + 1)
        if _at(tokens, index).text != ",":
            return index


def _after_operand(tokens: tuple[Token, ...], index: int) -> int:
    offset = _at(tokens, index + 1)
    return index + (2 if offset.kind == "number" and offset.text[0] in "+-" else 1)
