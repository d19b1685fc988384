"""Places as editors count them."""

from random import Random

import pytest

from tumato_symbolic.diagnostics import Source, Span
from tumato_symbolic.editor.positions import Encoding, Position, Positions


@pytest.mark.parametrize(
    ("encoding", "codec", "size"), [("utf-8", "utf-8", 1), ("utf-16", "utf-16-le", 2), ("utf-32", "utf-32-le", 4)]
)
def test_places_are_those_of_the_encoded_line(encoding: Encoding, codec: str, size: int) -> None:
    """For random texts with characters of one to four bytes: what is before a place, encoded, has that length."""
    random = Random(encoding)
    for _ in range(50):
        lines = ["".join(random.choices("aé∀𝒮 ", k=random.randint(0, 9))) for _ in range(3)]
        positions = Positions(Source("text", "\n".join(lines)), "", encoding)
        for number, line in enumerate(lines):
            for column in range(len(line) + 1):
                position = Position(number, len(line[:column].encode(codec)) // size)
                assert positions.position(number + 1, column + 1) == position
                assert positions.place(position) == (number + 1, column + 1)


def test_odd_places() -> None:
    """Beyond the text, within a pair of surrogates, and after a byte-order mark, which editors count."""
    positions = Positions(Source("text", "a𝒮b\nc"))
    assert positions.place(Position(9, 9)) == (2, 2)
    assert positions.place(Position(0, 99)) == (1, 4)
    assert positions.place(Position(0, 2)) == (1, 2)
    assert positions.range(Span(1, 2, 1, 3)) == ((0, 1), (0, 3))
    marked = Positions(Source("text", "\ufeffab\nc"), "\ufeffab\nc")
    assert marked.position(1, 1) == (0, 1)
    assert marked.place(Position(0, 2)) == (1, 2)
    assert marked.position(2, 1) == (1, 0)
