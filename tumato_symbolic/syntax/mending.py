"""How reading goes on after a mistake where it is plain what was meant."""

from __future__ import annotations

from msgspec import Struct

from tumato_symbolic.diagnostics import Diagnostic
from tumato_symbolic.syntax.situation import Situation
from tumato_symbolic.syntax.tokens import COMPARING, TITLES


class Mending(Struct, frozen=True):
    """Tokens that are passed over, so many of them, and words that are read in their place."""

    passed: int
    words: tuple[str, ...] = ()


def mending(here: Situation, found: Diagnostic) -> Mending | None:
    """What was surely meant, as far as the mistake that was found proposes it; None where nothing is."""
    return _of_block(here) or _of_character(here) or _of_copies(here) or _of_words(here, found) or _of_colon(here)


def _of_block(here: Situation) -> Mending | None:
    if here.begins_block_of_action:
        return Mending(2, ("action",))
    if here.end_words and here.title:
        return Mending(here.words_on_line(here.end_words[0].line), here.title[len(here.end_words) - 1 :])
    if here.block_is_unclosed and here.title:
        return Mending(0, ("END", *here.title))
    if cased := here.block_in_another_case:
        return Mending(len(cased), cased)
    if rest := here.meant_title_rest:
        return Mending(len(rest), rest)
    return None


def _of_character(here: Situation) -> Mending | None:
    token = here.token
    if here.begins_comment:
        return Mending(here.tokens_on_line)
    if token.text == ";":
        return Mending(1, (here.goes_on,) if here.goes_on else ())
    if here.says_initial_value:
        return Mending(2)
    if here.lacks_comma:
        return Mending(0 if here.begins_value else 1, (",",))
    needless = (token.text in ("{", "}") and "nominal" in here.expected) or (
        token.text == ":" and here.at(-1).text in TITLES
    )
    return Mending(1) if needless else None


def _of_copies(here: Situation) -> Mending | None:
    token = here.token
    if token.text.lower() == "for" and here.wants_predicate and here.at(1).text in ("all", "each", "every"):
        return Mending(2, ("all",))
    if here.last("for") is None:
        return None
    if token.text == ":" and "where" in here.expected:
        return Mending(1)
    if token.text in ("=", "from", "of") and here.expected == {"in"}:
        return Mending(1, ("in",))
    if token.text in ("if", "IF", "when") and "where" in here.expected:
        return Mending(1, ("where",))
    if token.text == "END" and "end" in here.expected:
        return Mending(2 if here.at(1).text.upper() == "FOR" else 0, ("end", "for"))
    if here.at(-1).text == "end" and here.expected == {"for"}:
        return Mending(0, ("for",))
    return None


def _of_words(here: Situation, found: Diagnostic) -> Mending | None:
    if here.or_values:
        return Mending(2 * len(here.or_values))
    meant = here.in_another_case or here.misspelled
    if meant is not None and f"did you mean `{meant}`" in (found.help or ""):
        return Mending(1, (meant,))
    if here.expected == {"priority", "constraint"} and here.token.kind == "word":
        return Mending(1, ("priority",))
    return None


def _of_colon(here: Situation) -> Mending | None:
    token = here.token
    if here.expected == {":"} and not here.lacks_goal_type:
        if here.at(1).text == ":" and here.at(-1).text == "rule":
            return Mending(1)
        return Mending(int(token.kind == "other" or token.text in COMPARING), (":",))
    if here.lacks_goal_type and token.text == "when":
        return Mending(0, ("goal", "type", ":", "priority"))
    if here.lacks_goal_type and token.text == ":":
        return Mending(-1, ("type", ":", "priority"))
    return None
