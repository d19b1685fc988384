"""How the objects of a JSON text are kept: rows of a table in little space, everything else as it is."""

from __future__ import annotations

from typing import Any, NamedTuple

ACTIONS = "Actions"
"""The key of a row under which its actions stand."""


class Row(NamedTuple):
    """An object that may be a row of a table: texts by name, in the order in which they stand, and a list of texts.

    A number is kept as the text that a specification has for it.

    Equal rows share names, texts and lists, so that a table takes a small part of the space of its text.
    """

    names: tuple[str, ...]
    texts: tuple[str, ...]
    actions: list[str]

    def as_dict(self) -> dict[str, Any]:
        """The object that it was made from."""
        return {**dict(zip(self.names, self.texts, strict=True)), ACTIONS: self.actions}


class RepeatedKeyError(ValueError):
    """A key that an object has twice."""

    def __init__(self, key: str) -> None:
        super().__init__(key)
        self.key = key


class Objects:
    """Makes the objects of one text from their pairs, and remembers what they can share."""

    def __init__(self) -> None:
        self._names: dict[tuple[str, ...], tuple[str, ...] | None] = {}
        self._texts: dict[str, str] = {}
        self._numbers: dict[tuple[type, Any], str] = {}
        self._lists: dict[tuple[str, ...], list[str]] = {}

    def __call__(self, pairs: list[tuple[str, Any]]) -> dict[str, Any] | Row:
        """The object that has these pairs. Raises `RepeatedKeyError` where two have the same key."""
        if not pairs:
            return {}
        keys, values = zip(*pairs, strict=True)
        if keys not in self._names:
            self._names[keys] = _names(keys)
        names = self._names[keys]
        if names is not None:
            at = keys.index(ACTIONS)
            texts, actions = values[:at] + values[at + 1 :], values[at]
            if type(actions) is list:
                try:
                    known, numbers = self._texts, self._numbers
                    row = [known[each] if type(each) is str else numbers[type(each), each] for each in texts]
                    return Row(names, tuple(row), self._lists[tuple(actions)])
                except (KeyError, TypeError):
                    if self._remember(texts, actions):
                        return self(pairs)
        return dict(pairs)

    def _remember(self, texts: tuple[object, ...], actions: list[Any]) -> bool:
        """Know the texts and the list of a row; False where they are not what a row holds."""
        if not all(type(each) in (str, int) for each in texts) or not all(type(each) is str for each in actions):
            return False
        self._texts.update((text, text) for text in texts if type(text) is str)
        self._numbers.update(((int, number), str(number)) for number in texts if type(number) is int)
        self._lists.setdefault(tuple(actions), actions)
        return True


def _names(keys: tuple[str, ...]) -> tuple[str, ...] | None:
    """The names of a row with these keys; None where an object with them is no row."""
    if len(set(keys)) < len(keys):
        raise RepeatedKeyError(next(key for place, key in enumerate(keys) if key in keys[:place]))
    return tuple(key for key in keys if key != ACTIONS) if ACTIONS in keys else None
