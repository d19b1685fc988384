"""Numbers with *none* among them, changed: cut off, inflated, partly null."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Sequence
from random import Random
from typing import Any, TypeAlias, TypeVar

Key = TypeVar("Key", bound=Hashable)
Numbers = dict[Key, int]
"""A number for some of the keys; the others have none."""

Change: TypeAlias = Callable[[Numbers[Key], Sequence[Key], Random], Numbers[Key]]

BESIDE_POWERS = (0, 0, 1, 2, 2, 3, 6, 6, 7, 8, 14, 14, 15, 16)
"""Beside powers of two; two less than one, where all ones are one step away, more often."""


def threshold(random: Random, numbers: Numbers[Key]) -> int:
    """Any number up to the largest; mostly one beside a power of two."""
    largest = max(numbers.values(), default=0)
    near = [number for number in BESIDE_POWERS if number <= largest]
    return random.choice(near) if random.random() < 0.8 else random.randint(0, largest)


def cut_off(numbers: Numbers[Key], keys: Sequence[Key], random: Random) -> Numbers[Key]:
    """None instead of everything that is larger than some number."""
    most = threshold(random, numbers)
    return {key: number for key, number in numbers.items() if number <= most}


def clamped(numbers: Numbers[Key], keys: Sequence[Key], random: Random) -> Numbers[Key]:
    """Some number instead of everything that is larger."""
    most = threshold(random, numbers)
    return {key: min(number, most) for key, number in numbers.items()}


def inflated(numbers: Numbers[Key], keys: Sequence[Key], random: Random) -> Numbers[Key]:
    """Everything from some number on is larger by as much."""
    least, more = threshold(random, numbers), random.choice((1, 1, 2, 3, 4, 8))
    return {key: number + more if number >= least else number for key, number in numbers.items()}


def partly_null(numbers: Numbers[Key], keys: Sequence[Key], random: Random) -> Numbers[Key]:
    """None instead of some numbers."""
    share = random.choice((0.1, 0.3, 0.6))
    return {key: number for key, number in numbers.items() if random.random() > share}


def filled(numbers: Numbers[Key], keys: Sequence[Key], random: Random) -> Numbers[Key]:
    """A number beyond the largest, or a small one, instead of none."""
    beyond = max(numbers.values(), default=0) + random.choice((1, 1, 2, 3))
    share = random.choice((0.5, 1.0))
    return {
        key: numbers.get(key, random.choice((beyond, beyond, 0)))
        for key in keys
        if key in numbers or random.random() < share
    }


def one_changed(numbers: Numbers[Key], keys: Sequence[Key], random: Random) -> Numbers[Key]:
    """One number is another one, or none."""
    changed, key = dict(numbers), random.choice(keys)
    wanted = changed.pop(key, 0) + random.choice((-1, 1, 2))
    if wanted >= 0 and random.random() < 0.8:
        changed[key] = wanted
    return changed


def unchanged(numbers: Numbers[Key], keys: Sequence[Key], random: Random) -> Numbers[Key]:
    """The numbers as they are."""
    return dict(numbers)


CHANGES: dict[str, Change[Any]] = {
    "cut off": cut_off,
    "clamped": clamped,
    "inflated": inflated,
    "partly null": partly_null,
    "filled": filled,
    "one changed": one_changed,
    "unchanged": unchanged,
}

KINDS = ("cut off", *CHANGES)
"""In turn."""
