"""Whatever is typed, an editor gets an answer."""

from itertools import islice
from random import Random

import pytest

from tests.editor.texts import plain_text
from tests.syntax.mutations import mutations
from tumato_symbolic.diagnostics import Source, UserError
from tumato_symbolic.editor import checking, completion, format, hover, mentions, outline, renaming
from tumato_symbolic.editor.positions import Positions


@pytest.mark.parametrize("seed", range(6))
def test_damaged_texts(seed: int) -> None:
    """Every function takes every text, and places survive the way to the editor and back."""
    random = Random(seed)
    for text in islice(mutations(plain_text(seed)[:2000], seed), 4):
        source = Source("text", text)
        known = mentions.index(source)
        checking.findings(source)
        outline.outline(source)
        lines, positions = source.text.split("\n"), Positions(source, text)
        for _ in range(3):
            line = random.randrange(len(lines)) + 1
            column = random.randrange(len(lines[line - 1]) + 1) + 1
            assert positions.place(positions.position(line, column)) == (line, column)
            hover.hover(known, line, column)
            completion.completions(source, known, line, column)
            try:
                renaming.rename(known, line, column, "other")
            except renaming.CannotRenameError as error:
                assert str(error)
        try:
            format.format_text(source)
        except UserError as error:
            assert error.diagnostics
