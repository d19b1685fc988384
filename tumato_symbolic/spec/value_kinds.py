"""Values as JSON and Python have them: numbers where they are numbers, and otherwise names."""

from __future__ import annotations

import re
from functools import lru_cache
from typing import TypeAlias

Value: TypeAlias = str | int
"""A value outside specifications."""

_NUMBER = re.compile(r"0|-?[1-9][0-9]{0,17}")


@lru_cache(maxsize=20_000)
def value_of(text: str) -> Value:
    """A value from how a specification writes it."""
    return int(text) if _NUMBER.fullmatch(text) else text


def text_of(value: object) -> object:
    """A value as a specification writes it; what is neither a name nor a number is left as it is."""
    return str(value) if type(value) is int else value
