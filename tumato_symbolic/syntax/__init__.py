"""Text to tree and back; the only room that knows lark."""

from tumato_symbolic.diagnostics import Source
from tumato_symbolic.syntax.parsed import Parsed
from tumato_symbolic.syntax.reading import read_source


def parse(source: Source) -> Parsed:
    """The tree of a text, and every mistake in its syntax. Never raises for a mistake of the user."""
    from tumato_symbolic.syntax.parser import parse_text

    return parse_text(source)
