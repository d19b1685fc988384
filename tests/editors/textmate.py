"""A small engine for TextMate grammars: enough for ours, whose patterns are read as Python reads them."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import Any


class Highlighter:
    """A grammar whose patterns stand in one list, one after the other."""

    def __init__(self, grammar: Mapping[str, Any]) -> None:
        self._patterns = [(re.compile(each.get("match") or each["begin"]), each) for each in grammar["patterns"]]

    def scopes(self, text: str) -> Iterator[dict[int, str]]:
        """For each line, the scope of each column that has one."""
        open_: re.Pattern[str] | None = None
        for line in text.split("\n"):
            found: dict[int, str] = {}
            place = 0
            while place < len(line):
                if open_ is not None:
                    end = open_.search(line, place)
                    stop = end.end() if end else len(line)
                    found.update(dict.fromkeys(range(place, stop), "comment"))
                    open_, place = (None if end else open_), stop
                    continue
                match, pattern = self._next(line, place)
                if match is None:
                    break
                if "begin" in pattern:
                    open_, place = re.compile(pattern["end"]), match.end()
                    found.update(dict.fromkeys(range(match.start(), match.end()), "comment"))
                    continue
                if "name" in pattern:
                    found.update(dict.fromkeys(range(*match.span()), pattern["name"]))
                for number, capture in pattern.get("captures", {}).items():
                    found.update(dict.fromkeys(range(*match.span(int(number))), capture["name"]))
                place = max(match.end(), place + 1)
            yield found

    def _next(self, line: str, place: int) -> tuple[re.Match[str] | None, Mapping[str, Any]]:
        """The match that begins first; of several, that of the first pattern."""
        best: tuple[re.Match[str] | None, Mapping[str, Any]] = None, {}
        for pattern, each in self._patterns:
            match = pattern.search(line, place)
            if (
                match is not None
                and match.end() > match.start()
                and (best[0] is None or match.start() < best[0].start())
            ):
                best = match, each
        return best
