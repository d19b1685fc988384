"""Generated texts with white space and comments anywhere that tokens may be separated."""

from __future__ import annotations

from itertools import pairwise
from random import Random

from tests.clauses.generate import random_pair
from tests.generate import random_text
from tests.profiles import ALL_PROFILES
from tests.shorthand import shorthand
from tumato_symbolic.diagnostics import Source, allowed_on
from tumato_symbolic.editor.gaps import gaps
from tumato_symbolic.syntax.grammar import grammar
from tumato_symbolic.syntax.tokens import Token, tokenize

_LINE = ("// note", "//", "// allow TUM323", "// x allow TUM341, TUM342", "//rule: a AND b  ", "// 𝒮 ∀ /* no */ //")
_INLINE = ("/* a */", "/**/", "/* // allow TUM324 */", "/* AND ) , */")
_SEVERAL = ("/* one\n   two */", "/*\n// allow TUM323 */", "/* // allow TUM321\n*/", "/*\n\n * three\n */")


def plain_text(seed: int) -> str:
    """A specification without comments: ordinary, with clauses, or with copies."""
    profiles = list(ALL_PROFILES.values())
    kinds = (
        lambda: random_text(seed, profiles[seed // 3 % len(profiles)]),
        lambda: random_pair(seed).text,
        lambda: shorthand(seed)[0],
    )
    return kinds[seed % 3]()


def commented(text: str, seed: int) -> str:
    """The same tokens, separated by other white space, comments and ends of lines."""
    random = Random(f"comments {seed}")
    often = random.choice((0.0, 0.02, 0.1, 0.4))
    parts = [_separator(random, often, must=False)]
    found = tokens(text)
    for token, after in pairwise(found):
        must = (token.text[-1:] + after.text[:1]).isascii() and not (token.text in "(:" or after.text in "),:")
        parts += [token.text, _separator(random, often, must=must)]
    return "".join(parts)


def _separator(random: Random, often: float, must: bool) -> str:
    found = random.choice(("", " ", " ", " ", "\n", "\n  ", "\t", "\n\n", "\n\n\n    "))
    while random.random() < often:
        kind = random.random()
        if kind < 0.5:
            found += random.choice(_LINE) + random.choice(("\n", "\n  ", "\n\n", "\n      "))
        else:
            found += random.choice(_INLINE if kind < 0.85 else _SEVERAL) + random.choice(("", " ", "\n", "\n\n", "\n "))
    return found if found or not must else " "


def tokens(text: str) -> tuple[Token, ...]:
    """The tokens of a text, the last being its end."""
    return tokenize(Source("text", text), grammar().token_pattern).tokens


def comments(text: str) -> list[str]:
    """The comments of a text; blanks at the end of a line are no part of one."""
    found = gaps(Source("text", text), tokens(text), grammar().token_pattern)
    return [comment.text for gap in found for comment in gap.comments]


def allowances(text: str) -> list[tuple[str, frozenset[str]]]:
    """Every character of a token, with the codes that are allowed where it stands."""
    lines = text.split("\n")
    return [(each, allowed_on(lines, token.line - 1)) for token in tokens(text) for each in token.text]
