"""Damaged files through both readers, and what they make of them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable
from pathlib import Path

from msgspec import Struct, field

from tests.readers.claims import claim_by_checker, claim_by_package
from tests.readers.files import damaged as damaged_file
from tests.readers.meaning import (
    NO_VERDICT,
    REFUSED,
    deep,
    differences,
    meaning_by_checker,
    meaning_by_package,
    read_by_checker,
    read_by_package,
)
from tests.readers.texts import damaged as damaged_text
from tumato_symbolic.spec import Spec


class Tally(Struct):
    """How many files there were of which kind, and where the readers differ."""

    kinds: Counter[str] = field(default_factory=Counter)
    complaints: list[str] = field(default_factory=list)

    def add(self, other: Tally) -> None:
        """Count in what another one counted."""
        self.kinds += other.kinds
        self.complaints += other.complaints


def examine_text(seed: int, folder: Path) -> Tally:
    """One specification."""
    path = folder / "spec.tum"
    path.write_bytes(damaged_text(seed))
    one, other = read_by_package(path), read_by_checker(path)
    if other == NO_VERDICT:
        return Tally(Counter({f"text: {NO_VERDICT}": 1}))
    if isinstance(one, str) or isinstance(other, str):
        alike = one == other
        return _tally("text: refused", f"text {seed}", [] if alike else [f"{_short(one)}, {_short(other)}"])
    with deep():
        found = differences(meaning_by_package(one), meaning_by_checker(other))
    return _tally("text: read", f"text {seed}", found)


def examine_file(seed: int, folder: Path) -> Tally:
    """One policy or certificate."""
    path, text = folder / "claim.json", folder / "spec.tum"
    data, spec_text = damaged_file(seed)
    path.write_bytes(data)
    text.write_text(spec_text, encoding="utf-8")
    spec = read_by_package(text)
    assert isinstance(spec, Spec)
    one, other = claim_by_package(path, spec), claim_by_checker(path, text)
    if isinstance(one, str) or isinstance(other, str):
        alike = one == other
        return _tally(f"file: {_short(one)}", f"file {seed}", [] if alike else [f"{_short(one)}, {_short(other)}"])
    return _tally("file: policy", f"file {seed}", differences(one, other))


def run(examine: Callable[[int, Path], Tally], seeds: Iterable[int], folder: Path) -> Tally:
    """Many of a kind."""
    total = Tally()
    for seed in seeds:
        total.add(examine(seed, folder))
    return total


def _short(found: object) -> str:
    return found if isinstance(found, str) else "read"


def _tally(kind: str, what: str, found: list[str]) -> Tally:
    return Tally(Counter({kind: 1}), [f"{what}: {each}" for each in found])


__all__ = ["REFUSED", "Tally", "examine_file", "examine_text", "run"]
