"""Smallest sets that have an element in common with each of some sets, by search, where there is no Z3."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence


class SearchedHittingSets:
    """What `HittingSets` asks of Z3, with the same answers.

    A smallest set that is allowed has an element of each required set, and none that it could do without: where a
    required set is not hit yet, one of its elements is in it.
    """

    def __init__(self, penalties: Sequence[int], seconds_left: Callable[[], float | None] = lambda: None) -> None:
        self._penalties, self._seconds_left = list(penalties), seconds_left
        self._required: list[frozenset[int]] = []
        self._excluded: list[frozenset[int]] = []
        self._least = 0
        self._too_small = False

    def require(self, numbers: Sequence[int]) -> None:
        """One of these numbers must be chosen."""
        self._required.append(frozenset(numbers))

    def exclude(self, numbers: Sequence[int]) -> None:
        """Not all of these numbers may be chosen."""
        self._excluded.append(frozenset(numbers))

    def penalize(self, numbers: Iterable[int], more: int) -> None:
        """Add to the penalties of some numbers."""
        for number in numbers:
            self._penalties[number] += more

    def smallest(self) -> frozenset[int] | None:
        """A set of the smallest size; None where there is none. Sizes never fall from one answer to the next."""
        while True:
            self._too_small = False
            found = min(self._allowed(frozenset(), frozenset()), key=self._preference, default=None)
            if found is not None or not self._too_small:
                return found
            self._least += 1

    def _preference(self, chosen: frozenset[int]) -> tuple[int, list[int]]:
        return sum(self._penalties[number] for number in chosen), sorted(chosen)

    def _allowed(self, chosen: frozenset[int], barred: frozenset[int]) -> Iterator[frozenset[int]]:
        """Allowed sets of the size of now that hold what is chosen and nothing that is barred, each once."""
        self._seconds_left()
        if any(each <= chosen for each in self._excluded):
            return
        open_ = (each - barred for each in self._required if not each & chosen)
        missed = min(open_, key=lambda each: (len(each), sorted(each)), default=None)
        if missed is None:
            yield chosen
            return
        if len(chosen) == self._least:
            self._too_small = True
            return
        for number in sorted(missed):
            yield from self._allowed(chosen | {number}, barred)
            barred |= {number}
