"""Which terminal of the grammar a token is: where a word is a keyword, and where a name.

Keywords are soft: whether a word is one is decided by what the parser can take next, and by the words after it.
"""

from __future__ import annotations

from collections.abc import Set

from tumato_symbolic.syntax.confirming import (
    after_headers,
    begins_clause,
    begins_copies,
    denies,
    ends_copies,
    quantifies,
)
from tumato_symbolic.syntax.stack import Row
from tumato_symbolic.syntax.tokens import HARD, Token

_LOOKED_AT = 3
"""So many words in a row may be needed to tell that the first is a keyword: `exactly one R` and `in`."""

FOLLOWED_BY = {
    "duration": (":",),
    "cost": (":",),
    "controlled": ("resources",),
    "preconditions": (":",),
    "nominal": ("effects",),
    "effects": (":",),
    "alternative": ("effects",),
}
"""What shows that a word is the keyword, where it could be the name of a variable or an alias as well."""

_CONFIRMED = {
    "not": denies,
    "when": begins_clause,
    "for": begins_copies,
    "end": ends_copies,
    "all": quantifies,
    "some": quantifies,
    "exactly": quantifies,
}
"""Further words that may be names, and what shows that they are keywords."""


class Terminals:
    """The terminals that the tokens of a text are.

    `eager`: where it takes words after the last one to tell, a word is taken for the keyword.
    """

    def __init__(self, tokens: tuple[Token, ...], keywords: Set[str], eager: bool) -> None:
        self._tokens = tokens
        self._keywords = keywords
        self._eager = eager
        self._headers = (0, 0)
        self.among_actions = False
        """Whether a block of actions is open."""

    def terminal(self, index: int, row: Row) -> str:
        """The terminal that a token is, in a state with this row of the parse table."""
        token = self._tokens[index]
        if token.kind == "word":
            if token.text not in self._keywords:
                return "NAME" if "{" not in token.text or "NAME" in row else "NUMBER"
            if token.text == "for" and ("FOR_ACTIONS" in row or "FOR_CLAUSES" in row):
                return self._for(index, row)
            if token.text in HARD:
                return token.text
            possible = token.text in row
            if "NAME" in row and (possible or "(" in row):
                possible = self._confirmed(index, possible)
            return token.text if possible else "NAME"
        if token.kind == "symbol":
            return token.text
        if token.kind == "number" and token.text[0] in "+-":
            if "OFFSET" in row and token.text[1] != "0":
                return "OFFSET"
            return "NUMBER" if token.text[0] == "-" else "OTHER"
        if token.text in ("+", "-") and token.text in row:
            return token.text
        return {"number": "NUMBER", "end": "$END"}.get(token.kind, "OTHER")

    def _for(self, index: int, row: Row) -> str:
        """What `for` begins where actions or clauses may be copied, and perhaps fields of the last action."""
        if "NAME" in row and not self._confirmed(index, True):
            return "NAME"
        if "for" not in row and "FOR_CLAUSES" not in row:
            return "FOR_ACTIONS"
        start, end = self._headers
        if not start <= index < end:
            end = after_headers(self._tokens, index)
            self._headers = index, end
        special = {"action": "FOR_ACTIONS", "when": "FOR_CLAUSES" if self.among_actions else "for"}
        return special.get(self._tokens[end].text, "for")

    def _confirmed(self, index: int, possible: bool) -> bool:
        """Whether a word that may be a keyword or a name is the keyword; `possible`: it fits here as a keyword."""
        text, following = self._tokens[index].text, self._tokens[index + 1]
        if self._eager and index >= len(self._tokens) - 1 - _LOOKED_AT:
            return possible
        if text in FOLLOWED_BY:
            return following.text in FOLLOWED_BY[text]
        if text in _CONFIRMED:
            return possible and _CONFIRMED[text](self._tokens, index)
        if text == "action":
            return possible and following.kind == "word" and following.text not in HARD | {"is"}
        return possible
