"""What surrounds a token that does not fit: open blocks, what was expected, and what was probably meant."""

from __future__ import annotations

from difflib import get_close_matches

from msgspec import Struct

from tumato_symbolic.diagnostics.wording import MAX_QUOTED
from tumato_symbolic.syntax.tokens import BLOCKS, COMPARING, HARD, Token

_PREDICATE = frozenset({"NAME", "(", "executing", "true", "false"})


class Situation(Struct, frozen=True):
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

    def at(self, offset: int) -> Token:
        """The token so many further on; the last one, which is the end, where there is none."""
        place = self.index + offset
        return self.tokens[place if 0 <= place < len(self.tokens) else -1]

    def declares(self, name: str) -> bool:
        """Whether the text declares a state variable of this name."""
        pairs = zip(self.tokens, self.tokens[1:], strict=False)
        return any(first.text == "state" and second.text == name for first, second in pairs)

    def lists(self, name: str) -> bool:
        """Whether the text gives a list of values this name."""
        rows = zip(self.tokens, self.tokens[1:], self.tokens[3:], strict=False)
        return any((first.text, second.text, third.text) == ("define", name, "{") for first, second, third in rows)

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
    def begins_block_of_action(self) -> bool:
        """Whether a block begins here that would hold one action: `BEGIN ACTION go`."""
        return self.title == ("ACTIONS",) and [self.token.text, self.at(1).text.upper()] == ["BEGIN", "ACTION"]

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
    def in_effects(self) -> bool:
        """Whether a list of effects is half read."""
        field = self.last("effects", "preconditions", "resources", "rule", "assume", "goal", "when", "define")
        return field is not None and field.text == "effects"

    @property
    def in_effects_or_clause(self) -> bool:
        """Whether a list of effects, or a clause after one, is half read."""
        field = self.last("effects", "preconditions", "resources", "rule", "assume", "goal", "define")
        return field is not None and field.text == "effects"

    @property
    def in_condition_of_effect(self) -> bool:
        """Whether the condition after `when` among effects is half read."""
        latest = self.last("when", ":")
        return self.title == ("ACTIONS",) and latest is not None and latest.text == "when"

    @property
    def in_alternatives(self) -> bool:
        """Whether a list of alternative effects is half read."""
        field = self.last("alternative", "nominal", "preconditions", "resources")
        return field is not None and field.text == "alternative"

    @property
    def begins_comment(self) -> bool:
        """Whether the token begins a comment in another language, rather than a text that is no specification."""
        begins = self.token.kind == "other" and (self.token.text[0] in "#%" or self.token.text == "--")
        before, touches = self.at(-1), self.token.column == self.at(-1).span.end_column
        operator = (touches and self.token.text in ("%", "--")) or (
            self.token.text == "%" and self.declares(before.text)
        )
        if operator and self.token.line == before.line:
            return False
        return begins and (self.index > 0 or any(each.text == "BEGIN" for each in self.tokens))

    @property
    def goes_on(self) -> str | None:
        """What joins the token's line to what follows on it; None where the token ends an entry."""
        after = self.at(1)
        if after.line != self.token.line or after.kind not in ("word", "number") or after.text in ("BEGIN", "END"):
            return None
        if "AND" in self.expected:
            return (
                ("," if "," in self.expected else "AND") if self.at(2).text in ("is", "in", "not", *COMPARING) else None
            )
        return "," if "," in self.expected and (self.at(2).text in (",", ";") or self.at(2).text in HARD) else None

    def compared(self) -> tuple[str, bool, int] | None:
        """Of `S is not …` just before the token: the variable, whether `not` stands there, and where `…` begins."""
        for length in (0, 1):
            first, second = self.at(-1 - length), self.at(-2 - length)
            if first.text == "not" and second.text == "is":
                return self.at(-3 - length).text, True, self.index - length
            if first.text == "is":
                return second.text, False, self.index - length
        return None

    @property
    def or_values(self) -> tuple[str, ...]:
        """The values that stand alone after `or`, in `S is a or b or c` from the first `or` on; most often none."""
        follows = self.at(-2).text == "is" or (self.at(-2).text == "not" and self.at(-3).text == "is")
        values: list[str] = []
        while follows and self.at(2 * len(values)).text in ("or", "Or"):
            value, after = self.at(2 * len(values) + 1), self.at(2 * len(values) + 2)
            if value.kind not in ("word", "number") or value.text in HARD or self.declares(value.text):
                break
            if after.text in ("is", "in", "not", *COMPARING):
                break
            values.append(value.text)
        return tuple(values)

    def closing_brace(self) -> int:
        """The place after the brace that closes the set with which the token begins."""
        end = self.index + 1
        while self.tokens[end].text != "}" and self.tokens[end].kind in ("word", "number", "symbol"):
            end += 1
        return end + 1 if self.tokens[end].text == "}" else end

    def words_on_line(self, line: int) -> int:
        """How many words follow one another from the token on, on this line."""
        end = self.index
        while self.tokens[end].kind == "word" and self.tokens[end].line == line:
            end += 1
        return end - self.index

    @property
    def tokens_on_line(self) -> int:
        """How many tokens the token's line has from it on."""
        following = self.tokens[self.index :]
        return next(place for place, each in enumerate(following) if each.line > self.token.line or each.kind == "end")

    @property
    def block_in_another_case(self) -> tuple[str, ...]:
        """`BEGIN` or `END` and the title, where the token begins both and the title is in another case."""
        begin = self.token.text.upper()
        if begin not in ("BEGIN", "END") or begin not in self.expected:
            return ()
        titles = [self.title] if begin == "END" else BLOCKS
        for title in titles:
            written = tuple(self.at(1 + place).text for place in range(len(title)))
            if title and written != title and tuple(each.upper() for each in written) == title:
                return (begin, *title)
        return ()

    @property
    def lacks_comma(self) -> bool:
        """Whether something else stands between values that a comma should."""
        if "," not in self.expected or "state" not in self.expected or "AND" in self.expected:
            return False
        return self.token.text.lower() in ("or", "and", "|", "||", "/") or self.begins_value

    @property
    def says_initial_value(self) -> bool:
        """Whether the token begins what a variable is at first, after the list of its values."""
        return self.lacks_comma and self.token.text in ("default", "init", "initial", "initially")

    @property
    def begins_value(self) -> bool:
        """Whether the token is a value in a list, and no comma before it."""
        is_value = self.token.kind in ("word", "number") and self.token.text not in HARD | {"or", "and", "to"}
        signed = self.token.kind == "number" and self.token.text[0] in "+-"
        return is_value and not signed and not (self.in_another_case or self.misspelled) and self.at(1).text != "can"

    @property
    def in_another_case(self) -> str | None:
        """The keyword that the token would be in upper or lower case."""
        if self.token.text.lower() == "end" and self.at(1).text == "for":
            return None
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
