"""Small pieces of text."""

import json

import pytest

from tumato_symbolic.report.layout import Paint, count, dump, enumeration, seconds


@pytest.mark.parametrize(
    ("number", "text"), [(0, "0 states"), (1, "1 state"), (2, "2 states"), (1_048_576, "1,048,576 states")]
)
def test_counts_are_english(number: int, text: str) -> None:
    """One state, many states, thousands with commas."""
    assert count(number, "state") == text


@pytest.mark.parametrize(
    ("duration", "text"), [(0.004, "0.00 s"), (1.234, "1.23 s"), (75.4, "75 s"), (125.9, "2 min 5 s")]
)
def test_times_are_as_long_as_they_matter(duration: float, text: str) -> None:
    """Hundredths for seconds, seconds for minutes."""
    assert seconds(duration) == text


@pytest.mark.parametrize(
    ("parts", "text"), [([], ""), (["a"], "a"), (["a", "b"], "a and b"), (list("abc"), "a, b and c")]
)
def test_enumerations(parts: list[str], text: str) -> None:
    """Commas, and a word before the last."""
    assert enumeration(parts) == text


def test_json_is_plain_ascii() -> None:
    """A report for a program survives any encoding."""
    text = dump({"file": "größe"})
    assert text.isascii()
    assert json.loads(text) == {"file": "größe"}


def test_no_colour_without_a_terminal() -> None:
    """Paint adds nothing where colour is not wanted."""
    assert Paint(False).good("proved") == "proved"
    assert Paint(True).good("proved") == "\x1b[32;1mproved\x1b[0m"
