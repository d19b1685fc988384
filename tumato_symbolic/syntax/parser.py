"""Tokens to a tree, going on after a mistake so that one run reports them all."""

from __future__ import annotations

from typing import TYPE_CHECKING

from msgspec import Struct

from tumato_symbolic.diagnostics import Code, Diagnostic, Source, Span
from tumato_symbolic.syntax import ast
from tumato_symbolic.syntax.grammar import Grammar, grammar
from tumato_symbolic.syntax.nesting import MAX_NESTING, deepest
from tumato_symbolic.syntax.parsed import Parsed
from tumato_symbolic.syntax.stack import Stack
from tumato_symbolic.syntax.terminals import FOLLOWED_BY, Terminals
from tumato_symbolic.syntax.tokens import BLOCKS, TITLES, Token, tokenize

if TYPE_CHECKING:
    from tumato_symbolic.syntax.situation import Situation

MAX_SYNTAX_ERRORS = 100
"""Reading stops after so many mistakes in the syntax."""

_RESTARTS = frozenset(
    {"BEGIN", "END", "state", "define", "resource", "action", "rule", "assume", "goal", "when", "for", "end"}
    | {"severity", "max_plan_length", "effect_ordering", "restoration", *FOLLOWED_BY}
)
"""Words at which reading can go on after a mistake."""


def parse_text(source: Source) -> Parsed:
    """Parse a whole text. The tree is what could be read; `lost` holds the words that were passed over."""
    return read_terminals(source)[0]


def read_terminals(source: Source) -> tuple[Parsed, tuple[Token, ...], tuple[str, ...]]:
    """What `parse_text` yields, the tokens, and, where there is no mistake, what each of them was read as."""
    compiled = grammar()
    text = tokenize(source, compiled.token_pattern)
    run = _Run(compiled, text.tokens)
    tree = run.read()
    found = run.found
    if text.unclosed_comment is not None:
        end = text.tokens[-1].span
        found = [*(each for each in found if each.span != end), text.unclosed_comment]
    found = [*found, *text.misleading[:MAX_SYNTAX_ERRORS]]
    return Parsed(tree, tuple(found), frozenset(run.lost)), text.tokens, tuple(run.terminals)


class Expected(Struct, frozen=True):
    """What may stand at a place: terminals of the grammar.

    `before` are the tokens before it, `open` those of them that are keywords and symbols of what is half read.
    """

    terminals: frozenset[str]
    before: tuple[Token, ...]
    open: tuple[Token, ...]


def expected_at(source: Source, line: int, column: int) -> Expected:
    """What may stand at a line and column in place of the word that ends there, whatever follows in the text."""
    compiled = grammar()
    tokens = tokenize(source, compiled.token_pattern).tokens
    before = tuple(each for each in tokens[:-1] if _is_before(each, line, column))
    read = (*before, Token("end", "", line, column))
    found = frozenset[str]()
    opened: tuple[Token, ...] = ()
    for eager in (False, True):
        run = _Run(compiled, read, stop=len(before), eager=eager)
        run.read()
        found |= run.stack.accepted()
        opened = _without_closed(_open_tokens(run.stack.values))
    return Expected(found, before, opened)


def _is_before(token: Token, line: int, column: int) -> bool:
    """Whether a token is over before a place; a word may be being typed as long as nothing follows it."""
    end = (token.line, token.column + len(token.text))
    return end < (line, column) or (end == (line, column) and token.kind not in ("word", "number", "malformed"))


class _Run:
    """One pass over the tokens of a text, up to the one at `stop`.

    `eager`: where it takes words after the last one to tell, a word is taken for the keyword.
    """

    def __init__(
        self, compiled: Grammar, tokens: tuple[Token, ...], stop: int | None = None, eager: bool = False
    ) -> None:
        self.stop = len(tokens) if stop is None else stop
        self.tokens = tokens
        self.words = Terminals(tokens, compiled.keywords, eager)
        self.stack = Stack(compiled.table)
        self.index = 0
        self.found: list[Diagnostic] = []
        self.lost: set[str] = set()
        self.terminals: list[str] = []
        self.open: list[Token] = []
        self.denials = 0
        self.blocks = 0

    def read(self) -> ast.Specification | None:
        """Feed every token, recovering where one does not fit. None where reading had to be given up."""
        while len(self.found) <= MAX_SYNTAX_ERRORS:
            if self.index >= self.stop:
                return None
            token = self.tokens[self.index]
            terminal = self.words.terminal(self.index, self.stack.row())
            if self._too_deep(token):
                return None
            if not self.stack.fits(terminal):
                self._recover()
                continue
            result = self.stack.feed(terminal, token)
            self.terminals.append(terminal)
            if token.kind == "end":
                return self._checked(result)
            self.index += 1
        self.found[-1] = Diagnostic(Code.TUM116, "too many mistakes; the rest was left unread", token.span)
        return None

    def _checked(self, tree: ast.Specification) -> ast.Specification | None:
        deep = deepest(tree)
        if deep is None:
            return tree
        self._give_up_nesting(deep)
        return None

    def _too_deep(self, token: Token) -> bool:
        """Keep the books of open parentheses, of `NOT` in a row and of blocks; report what goes too deep."""
        if token.text == "(":
            self.open.append(token)
        elif token.text == ")" and self.open:
            self.open.pop()
        elif token.text in ("BEGIN", "END"):
            self.open.clear()
            self.words.among_actions = self.tokens[self.index + 1].text == "ACTIONS"
            self.blocks = max(0, self.blocks + (1 if token.text == "BEGIN" else -1))
        self.denials = self.denials + 1 if token.text == "NOT" else 0
        if max(len(self.open), self.denials, self.blocks) <= MAX_NESTING:
            return False
        self._give_up_nesting(token.span)
        return True

    def _give_up_nesting(self, span: Span) -> None:
        self.found.append(
            Diagnostic(
                Code.TUM115,
                f"nested more than {MAX_NESTING} levels deep",
                span,
                help="give parts of it names in the ALIASES block" if not self.found else None,
            )
        )

    def _recover(self) -> None:
        """Report the token at `index`, and make the parser ready to go on with the token at the new `index`."""
        from tumato_symbolic.syntax.mending import mending
        from tumato_symbolic.syntax.mistakes import explain

        if self._ends_lost_copies():
            self.index += 2
            return
        if self._ends_block_of_action():
            return
        situation = self._situation()
        found = explain(situation)
        self.found.append(found)
        meant = mending(situation, found)
        if meant is not None and self._supply(*meant.words):
            self.index += meant.passed
        else:
            self._panic()

    def _ends_block_of_action(self) -> bool:
        """Go on after `END ACTION`, where `BEGIN ACTION` was read as `action` and is reported."""
        begun = zip(self.tokens, self.tokens[1 : self.index], strict=False)
        here = self.tokens[self.index - 1].text, self.tokens[self.index].text.upper()
        if here != ("END", "ACTION") or ("BEGIN", "ACTION") not in {(one.text, two.text.upper()) for one, two in begun}:
            return False
        self.stack.cut(len(self.stack.values) - 1)
        self.index += 1
        self.words.among_actions = True
        self.blocks += 1
        return True

    def _ends_lost_copies(self) -> bool:
        """Whether `end for` stands here and its `for` was passed over after a mistake."""
        if self.tokens[self.index].text != "end" or self.tokens[self.index + 1].text != "for" or "for" not in self.lost:
            return False
        self.lost.discard("for")
        return True

    def _situation(self) -> Situation:
        """What surrounds the token at `index`, or the one before it where that was taken for something else.

        A keyword that was taken for a name is put back, and so is the BEGIN of a block that begins while a list of
        goals is open: it was taken for a nested list.
        """
        from tumato_symbolic.syntax.situation import Situation

        if self._was_keyword():
            self.stack.cut(len(self.stack.values) - 1)
            self.index -= 1
        opened = _without_closed(_open_tokens(self.stack.values))
        text = self.tokens[self.index].text
        begins = sum(token.text == "BEGIN" for token in opened)
        unclosed = begins > 1 and opened[-1].text == "BEGIN" and text in TITLES and text != "GOALS"
        if unclosed:
            self.stack.cut(len(self.stack.values) - 1)
            opened = opened[:-1]
            self.index -= 1
        return Situation(self.tokens, self.index, self.stack.accepted(), opened, unclosed)

    def _was_keyword(self) -> bool:
        """Whether the token before `index` was taken for a name, but something complete can begin with it."""
        top = self.stack.values[-1] if self.stack.values else None
        before = self.index - 1
        if not isinstance(top, ast.Name) or top.span != self.tokens[before].span or top.text not in _RESTARTS:
            return False
        return any(self._can_restart(depth, before) for depth in self.stack.topmost())

    def _supply(self, *words: str) -> bool:
        """Feed words that are missing from the text, as far as they fit; whether they all do."""
        here = self.tokens[self.index]
        for word in words:
            if not self.stack.fits(word):
                return False
            self.stack.feed(word, Token("word", word, here.line, here.column))
        return True

    def _panic(self) -> None:
        """Drop what is half read, and pass over text up to a word with which something complete can begin."""
        depths = self.stack.topmost()
        for index in range(self.index, len(self.tokens)):
            if self.tokens[index].text in _RESTARTS and self.tokens[index].kind == "word":
                depth = next((depth for depth in depths if self._can_restart(depth, index)), None)
                if depth is not None:
                    self._drop(depth, index)
                    return
        self._drop(self.stack.outermost(), len(self.tokens) - 1)

    def _can_restart(self, depth: int, index: int) -> bool:
        """Whether the two tokens at `index` fit with the stack cut to `depth`, where nothing lies half read on it."""
        first = self.words.terminal(index, self.stack.row(depth))
        after = self.stack.after(first, depth) if first != "NAME" else None
        if after is None or self.words.terminal(index + 1, after) not in after:
            return False
        return self.stack.shifts(first, depth) or self.stack.ends_field(depth)

    def _drop(self, depth: int, index: int) -> None:
        """Cut the stack to `depth` and go on at `index`; remember every word that this loses."""
        start = self.stack.cut(depth)
        first = self.index
        while start is not None and first > 0 and (self.tokens[first - 1].line, self.tokens[first - 1].column) >= start:
            first -= 1
        self.lost.update(token.text for token in self.tokens[first:index])
        self.index = index
        self.open.clear()


def _open_tokens(values: list[object]) -> tuple[Token, ...]:
    """The tokens that are read and not yet part of something complete."""
    return tuple(value for value in values if isinstance(value, Token))


def _without_closed(opened: tuple[Token, ...]) -> tuple[Token, ...]:
    """Leave out a last block that is closed, though the parser has not put it together yet."""
    for title in BLOCKS:
        end = len(opened) - len(title) - 1
        if tuple(token.text for token in opened[max(end, 0) :]) == ("END", *title):
            begin = max(place for place, token in enumerate(opened) if token.text == "BEGIN")
            return opened[:begin]
    return opened
