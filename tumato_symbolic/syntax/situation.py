"""What surrounds a token that does not fit."""

from __future__ import annotations

from dataclasses import dataclass
from difflib import get_close_matches

from tumato_symbolic.diagnostics.wording import MAX_QUOTED
from tumato_symbolic.syntax.tokens import BLOCKS, HARD, Token

_PREDICATE = frozenset({"NAME", "(", "executing", "true", "false"})


@dataclass(frozen=True, slots=True)
class Situation:
    """A token that does not fit.

    `expected` is what could stand there: words and symbols as they are written, or NAME, NUMBER, $END. `open` holds
    the keywords and symbols that are read and not yet part of something complete. `unclosed` tells that the token
    begins a block although another is open.
    """

    tokens: tuple[Token, ...]
    index: int
    expected: frozenset[str]
    open: tuple[Token, ...]
    unclosed: bool = False

    @property
    def token(self) -> Token:
        """The token that does not fit."""
        return self.tokens[self.index]

    @property
    def previous(self) -> Token | None:
        """The token before it."""
        return self.tokens[self.index - 1] if self.index else None

    @property
    def begin(self) -> int | None:
        """The position in `open` of the innermost BEGIN."""
        return max((place for place, token in enumerate(self.open) if token.text == "BEGIN"), default=None)

    @property
    def title(self) -> tuple[str, ...]:
        """The title of the innermost open block; empty where there is none."""
        if self.begin is None:
            return ()
        words = tuple(token.text for token in self.open[self.begin + 1 : self.begin + 3])
        return next((title for title in BLOCKS if words[: len(title)] == title), ())

    @property
    def end_words(self) -> tuple[Token, ...]:
        """The words of the END that is half read; empty where there is none."""
        since = self.open[(self.begin or 0) + 1 :]
        ends = [place for place, token in enumerate(since) if token.text == "END"]
        return since[ends[-1] :] if ends else ()

    @property
    def block_is_unclosed(self) -> bool:
        """Whether the END of the open block is missing."""
        return self.unclosed or ("END" in self.expected and (self.token.kind == "end" or self.token.text == "BEGIN"))

    @property
    def lacks_goal_type(self) -> bool:
        """Whether a list of goals begins with a goal rather than with its type."""
        recent = [token.text for token in self.open[-3:]]
        return recent == ["BEGIN", "GOALS", "goal"] or (
            recent[-2:] == ["BEGIN", "GOALS"] and self.expected == {"goal", "END"}
        )

    @property
    def wants_predicate(self) -> bool:
        """Whether a predicate could begin here."""
        return self.expected >= _PREDICATE

    @property
    def in_another_case(self) -> str | None:
        """The keyword that the token would be in upper or lower case."""
        keywords = {each.lower(): each for each in self._keywords()}
        return keywords.get(self.token.text.lower()) if self.token.kind == "word" else None

    @property
    def misspelled(self) -> str | None:
        """The keyword that the token resembles, where no name can stand."""
        if self.token.kind != "word" or "NAME" in self.expected or len(self.token.text) > MAX_QUOTED:
            return None
        return next(iter(get_close_matches(self.token.text, self._keywords(), n=1, cutoff=0.7)), None)

    @property
    def meant_title(self) -> tuple[str, ...] | None:
        """The title that was probably meant, where a block begins with none."""
        start = self.title_start
        if start is None:
            return None
        for length in (2, 1):
            written = self.tokens[start : start + length]
            titles = {" ".join(title): title for title in BLOCKS if len(title) == length}
            if any(token.kind != "word" or token.text in HARD for token in written):
                continue
            text = " ".join(token.text for token in written).upper()
            near = get_close_matches(text, titles, n=1, cutoff=0.7) if len(text) <= MAX_QUOTED else []
            read = self.index - start
            if near and [token.text for token in written[:read]] == list(titles[near[0]][:read]):
                return titles[near[0]]
        return None

    @property
    def meant_title_rest(self) -> tuple[str, ...]:
        """Those words of the title that was probably meant that the token and what follows it stand for."""
        start = self.title_start
        return () if start is None or self.meant_title is None else self.meant_title[self.index - start :]

    @property
    def title_start(self) -> int | None:
        """Where the title begins that the token should be part of; None where it should not."""
        before = [token.text for token in self.open[-2:]]
        if before[-1:] == ["BEGIN"]:
            return self.index
        return self.index - 1 if before in (["BEGIN", "STATE"], ["BEGIN", "REACTION"]) else None

    def _keywords(self) -> list[str]:
        return sorted(
            each for each in self.expected if each.isidentifier() and each not in ("NAME", "NUMBER", "OFFSET")
        )

    def last(self, *texts: str) -> Token | None:
        """The latest open token that is one of `texts`."""
        return next((token for token in reversed(self.open) if token.text in texts), None)
