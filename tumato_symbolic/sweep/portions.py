"""Which variants are solved next, and how many by one batch."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import Future
from contextlib import AbstractContextManager
from math import ceil
from typing import Final, TypeAlias

from msgspec import Struct

from tumato_symbolic.sweep.tasks import Reply
from tumato_symbolic.sweep.variants import Variant

_AHEAD: Final = 2
"""So many batches are handed over for each who works: one to work on, and one to go on with."""

_LEAST: Final = 0.1
"""No batch is made smaller than this part of one that takes as long as it should."""


class Workers(Struct, frozen=True):
    """Who works: `submit` takes a batch, of which `hands()` are worked on at a time, as far as is known now.

    A batch should take so many `seconds`, which is much longer than handing it over takes. Its future raises
    `LostError` where there is no reply. `hands` is asked while there is none, and raises `UserError` where nobody is
    left who could reply.
    """

    submit: Callable[[str], Future[str]]
    hands: Callable[[], int]
    seconds: float

    @property
    def enough(self) -> float:
        """After so many seconds, a batch that takes longer than expected leaves the rest to others."""
        return 2 * self.seconds


Hired: TypeAlias = AbstractContextManager[Workers]


class LostError(Exception):
    """A batch without a reply, because those who worked on it were killed again and again."""


class Portion(Struct, frozen=True):
    """Variants for one batch. `alone`: one variant, while nothing else is under way."""

    variants: Sequence[Variant]
    alone: bool = False


class Portions:
    """Variants divided by guided self-scheduling, as it is known meanwhile how long they take.

    A portion takes as long as a batch should if it goes on at the pace of the latest reply. But it is no more than each
    one's share of half of what is left: so all end at about the same time. Of a portion that is lost, each variant is
    asked for again by itself, when nothing else is under way that could be to blame: so only one that kills every
    worker stays without an answer.
    """

    def __init__(self, variants: Iterable[Variant], workers: Workers) -> None:
        self._waiting = deque(variants)
        self._suspects: deque[Variant] = deque()
        self._workers = workers
        self._pace = 0.0

    def next(self, under_way: int) -> Portion | None:
        """The next portion, where so many are under way; None where nothing can be done but wait, or all is done."""
        if self._waiting:
            if under_way < _AHEAD * self._workers.hands():
                return Portion([self._waiting.popleft() for _ in range(self._size())])
        elif self._suspects and not under_way:
            return Portion([self._suspects.popleft()], alone=True)
        return None

    def replied(self, portion: Portion, reply: Reply) -> None:
        """What has no answer is asked for again, soon."""
        self._pace = len(reply.answers) / max(reply.seconds, 0.001)
        self._waiting.extendleft(reversed(portion.variants[len(reply.answers) :]))

    def lost(self, portion: Portion) -> None:
        """There is no reply."""
        self._suspects.extend(portion.variants)

    def _size(self) -> int:
        wanted = self._pace * self._workers.seconds
        share = ceil(len(self._waiting) / (2 * self._workers.hands()))
        return min(len(self._waiting), max(1, int(_LEAST * wanted), min(int(wanted), share)))
