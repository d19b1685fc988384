"""What is wrong where blocks begin and end, and the way out."""

from __future__ import annotations

from collections.abc import Callable

from tumato_symbolic.diagnostics import Code, Diagnostic, Note
from tumato_symbolic.diagnostics.wording import listed, quoted
from tumato_symbolic.syntax.habits import joined
from tumato_symbolic.syntax.situation import Situation
from tumato_symbolic.syntax.tokens import BLOCKS, HARD


def _wrong_end(here: Situation) -> Diagnostic | None:
    if not here.end_words or not here.title or here.begin is None:
        return None
    rest = here.tokens[here.index : here.index + 2]
    same_line = [each.text for each in rest if each.kind == "word" and each.line == here.end_words[0].line]
    written = " ".join([*(each.text for each in here.end_words), *same_line])
    title = " ".join(here.title)
    return Diagnostic(
        Code.TUM108,
        f"{quoted(written)} does not close `BEGIN {title}`",
        joined(here.end_words[0], rest[len(same_line) - 1] if same_line else here.end_words[-1]),
        help=f"write `END {title}`",
        notes=(Note("the block begins here", here.open[here.begin].span),),
    )


def _block_of_action(here: Situation) -> Diagnostic | None:
    if not here.begins_block_of_action:
        return None
    span = joined(here.token, here.at(1))
    way_out = "write `action NAME`: an action ends where the next one begins"
    return Diagnostic(Code.TUM105, f"unexpected {quoted(f'BEGIN {here.at(1).text}')}", span, way_out)


def _unclosed_block(here: Situation) -> Diagnostic | None:
    if not here.block_is_unclosed or here.begin is None:
        return None
    title = " ".join(here.title)
    return Diagnostic(
        Code.TUM107,
        f"the block `BEGIN {title}` is not closed",
        here.token.span,
        help=f"write `END {title}` before this",
        notes=(Note("the block begins here", here.open[here.begin].span),),
    )


def _block_title(here: Situation) -> Diagnostic | None:
    start = here.title_start
    if start is None:
        return None
    length = 2 if here.tokens[start].text in ("STATE", "REACTION") else 1
    words = [each.text for each in here.tokens[start : start + length] if each.kind == "word" and each.text not in HARD]
    titles = [" ".join(title) for title in BLOCKS]
    return Diagnostic(
        Code.TUM105,
        f"there is no block named {quoted(' '.join(words))}" if words else "`BEGIN` needs the name of a block",
        here.token.span,
        help="did you mean `BEGIN STATE RULES` or `BEGIN REACTION RULES`?"
        if words == ["RULES"]
        else "did you mean `BEGIN START`?"
        if words[:1] in (["INIT"], ["INITIAL"])
        else f"did you mean `BEGIN {' '.join(here.meant_title)}`?"
        if here.meant_title
        else f"the blocks are {listed(titles)}",
    )


BOUNDS: tuple[Callable[[Situation], Diagnostic | None], ...] = (
    _wrong_end,
    _block_of_action,
    _unclosed_block,
    _block_title,
)
"""What is tried where blocks begin and end, one after the other."""
