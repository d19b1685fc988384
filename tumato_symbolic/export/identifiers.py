"""Names and values as identifiers of other languages (`-3`: `m3`): never a word of the language, never two alike."""

from __future__ import annotations

import hashlib
import re
from collections import Counter
from collections.abc import Collection, Hashable, Mapping
from typing import TypeVar

Key = TypeVar("Key", bound=Hashable)


def identifier(text: str) -> str:
    """A text as letters, digits and `_`, a letter first: what is no such character becomes one."""
    text = re.sub(r"[^A-Za-z0-9_]", "_", text.replace("-", "m"))
    return text if text[:1].isalpha() else f"x{text}"


def distinct(wanted: Mapping[Key, str], reserved: Collection[str] = (), *, case_matters: bool = True) -> dict[Key, str]:
    """Identifiers that are all different, and none of them `reserved`: the wanted ones wherever that is possible.

    Where several want the same, each gets an ending that depends on its key alone, so that a name stays what it is when
    others are declared before it.
    """

    def folded(text: str) -> str:
        return text if case_matters else text.lower()

    taken = {folded(each) for each in reserved}
    names = {key: f"{name}_" if folded(name) in taken else name for key, name in wanted.items()}
    length = 0
    while True:
        counts = Counter(folded(name) for name in names.values())
        alike = [key for key, name in names.items() if counts[folded(name)] > 1 or folded(name) in taken]
        if not alike:
            return names
        length += 6
        for key in alike:
            names[key] = f"{wanted[key]}_{hashlib.sha256(repr(key).encode()).hexdigest()[:length]}"
