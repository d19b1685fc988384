"""The results of a sweep as lines of JSON, and the file to which they are added."""

from __future__ import annotations

import json
import os
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import IO, Any, NoReturn

from msgspec import Struct, field

from tumato_symbolic.diagnostics import Code, Diagnostic, UserError
from tumato_symbolic.diagnostics.wording import quoted
from tumato_symbolic.policy import save_text
from tumato_symbolic.sweep.tasks import NOTHING

_FAREWELL = 1.0
"""Seconds in which a sweep that was killed has let go of its file."""

Line = dict[str, Any]
"""The result of a variant: its `variant`, a number, its `changes`, and what was found."""


def written(line: Mapping[str, object]) -> str:
    """A line as it stands in a file, the same for the same content."""
    return json.dumps(line, ensure_ascii=False)


class Results(Struct):
    """What is known by now: a line for each variant that is done, by its number."""

    header: Mapping[str, object]
    lines: dict[int, Line] = field(default_factory=dict)
    _file: IO[str] | None = None

    @property
    def total(self) -> int:
        """How many lines there will be."""
        return int(str(self.header["variants"]))

    def add(self, lines: Sequence[Line]) -> None:
        """Variants are done: their lines are on the disk when this returns. Raises `UserError` where they cannot be."""
        self.lines |= {each["variant"]: each for each in lines}
        if self._file is None:
            return
        try:
            self._file.write("".join(f"{written(each)}\n" for each in lines))
            self._file.flush()
            os.fsync(self._file.fileno())
        except OSError as error:
            _unwritable(Path(self._file.name), error)

    def in_order(self) -> tuple[Line, ...]:
        """The lines by the numbers of their variants."""
        return tuple(self.lines[number] for number in sorted(self.lines))

    def text(self) -> str:
        """The file where all lines stand in order."""
        return "".join(f"{written(each)}\n" for each in (self.header, *self.in_order()))


@contextmanager
def kept(path: str | None, header: Mapping[str, object]) -> Iterator[Results]:
    """Results that are kept in a file, with those that it has already; put in order when all are there.

    Raises `UserError` where the file is of another sweep, of a program that still adds to it, or cannot be used.
    """
    if path is None:
        yield Results(header)
        return
    file = Path(path)
    try:
        stream = file.open("a+", encoding="utf-8", newline="\n")
    except OSError as error:
        _unwritable(file, error)
    with stream:
        _alone(stream, path)
        results = Results(header, _read(stream, path, header), stream)
        yield results
        complete = len(results.lines) == results.total
        if complete and file.read_text(encoding="utf-8") != results.text():
            save_text(results.text(), file, "results")


def _alone(stream: IO[str], path: str) -> None:
    """Raise `UserError` where another program adds to the file; one that was killed may take a moment to end."""
    try:
        import fcntl
    except ImportError:
        return
    latest = time.monotonic() + _FAREWELL
    while True:
        try:
            fcntl.flock(stream, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            if time.monotonic() > latest:
                _refuse(f"another sweep is writing its results to {quoted(path)}", "wait for it, or name another file")
            time.sleep(0.05)
        else:
            return


def _read(stream: IO[str], path: str, header: Mapping[str, object]) -> dict[int, Line]:
    """The lines of a file; a last one that was not finished is taken away, and an empty file gets its header."""
    stream.seek(0)
    try:
        text = stream.read()
    except (OSError, UnicodeDecodeError):
        _no_results(path)
    whole = text[: text.rindex("\n") + 1] if "\n" in text else ""
    first, *others = whole.splitlines() or [""]
    if text and not whole and not written(header).startswith(text):
        _no_results(path)
    if first:
        _check_header(first, path, header)
    found = [_line(each, place, path, header) for place, each in enumerate(others, 2)]
    if whole != text:
        os.ftruncate(stream.fileno(), len(whole.encode()))
    if not first:
        stream.write(f"{written(header)}\n")
        stream.flush()
    return {each["variant"]: each for each in found}


def _check_header(first: str, path: str, header: Mapping[str, object]) -> None:
    try:
        there = json.loads(first)
    except ValueError:
        _no_results(path)
    if not isinstance(there, dict) or "sweep" not in there:
        _no_results(path)
    for key, value in header.items():
        if there.get(key) != value:
            what = _SAID.get(key, "the options are others")
            if key == "options":
                what = f"the options are others: {_options(there.get(key), value)}"
            _refuse(
                f"{quoted(path)} has the results of another sweep: {what}",
                "name another file with -o FILE, or remove this one",
            )


_SAID = {
    "sweep": "it varies something else",
    "specification": "the specification has another name",
    "text": "the text of the specification has changed",
    "variants": "the number of variants is another",
    "version": "it was made by another version of tumato-symbolic",
}


def _options(there: object, here: object) -> str:
    assert isinstance(here, dict), "these are our own"
    one: dict[str, object] = there if isinstance(there, dict) else {}
    names = [name for name in {**one, **here} if one.get(name) != here.get(name)]
    return ", ".join(f"{name} {_shown(one.get(name))} there, {_shown(here.get(name))} here" for name in names)


def _shown(value: object) -> str:
    return quoted(value if isinstance(value, str) else json.dumps(value, ensure_ascii=False))[1:-1]


def _line(text: str, place: int, path: str, header: Mapping[str, object]) -> Line:
    with suppress(ValueError, TypeError, AttributeError):
        found: Line = json.loads(text)
        if found.keys() == LINE_KEYS and 0 <= found["variant"] < int(str(header["variants"])):
            return found
    raise _refusal(
        f"line {place} of {quoted(path)} is no result", "name another file with -o FILE, or remove that line"
    )


LINE_KEYS = frozenset({"variant", "changes", *NOTHING, "differs"})
"""What every line has."""


def _no_results(path: str) -> NoReturn:
    _refuse(f"{quoted(path)} is not a file of results of `sweep`", "name another file with -o FILE")


def _refuse(message: str, help_: str) -> NoReturn:
    raise _refusal(message, help_)


def _refusal(message: str, help_: str) -> UserError:
    return UserError((Diagnostic(Code.TUM120, message, help=help_),))


def _unwritable(file: Path, error: OSError) -> NoReturn:
    reason = error.strerror or str(error)
    message = f"the results cannot be written to {quoted(str(file))}: {reason[:1].lower()}{reason[1:]}"
    raise UserError((Diagnostic(Code.TUM510, message, help="name another file with -o FILE"),)) from error
