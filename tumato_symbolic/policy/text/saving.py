"""Texts to files, all or nothing.

A file is either the old one or the new one, never half of one.
"""

from __future__ import annotations

import os
import signal
import stat
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from types import FrameType

from tumato_symbolic.diagnostics import Code, Source
from tumato_symbolic.limits.processes import open_file
from tumato_symbolic.policy.text.messages import fault

_ENDING = tuple(getattr(signal, name) for name in ("SIGTERM", "SIGHUP") if hasattr(signal, name))
"""What ends a process from outside, where nothing else is said; Windows has no SIGHUP."""


def save_text(text: str, path: Path, what: str) -> None:
    """Write a text to `path`, all or nothing; `what` is what it is called in messages. Raises `UserError` (TUM510).

    A regular file is replaced as a whole, once the new text is safely on the disk, and keeps its mode; a link stays
    and its target is replaced. A device, a pipe or an open file (`/dev/fd/3`) is written to.
    """
    try:
        _put(path, text.encode())
    except (OSError, ValueError, RuntimeError) as error:
        reason = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
        raise fault(Code.TUM510, f"the {what} cannot be written: {reason}", None, Source(str(path), "")) from None


def _put(path: Path, data: bytes) -> None:
    number = open_file(path)
    if number is not None:
        with open(number, "wb", closefd=False) as file:
            file.write(data)
        return
    try:
        found = path.stat()
    except FileNotFoundError:
        found = None
    if found is None or stat.S_ISREG(found.st_mode):
        _replace(path.resolve(), data, found)
    else:
        with path.open("wb") as file:
            file.write(data)


def _replace(target: Path, data: bytes, old: os.stat_result | None) -> None:
    temporary = target.with_name(f".tumato-{os.urandom(8).hex()}.tmp")
    with _removed_if_ended(temporary):
        with temporary.open("xb") as file:
            if old is not None:
                _resemble(temporary, old)
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        temporary.replace(target)


@contextmanager
def _removed_if_ended(temporary: Path) -> Iterator[None]:
    """Leave no such file behind after an error, Ctrl-C, or a signal that ends the process, which it does all the same.

    Only the main thread may say what signals do, and a signal for which somebody has said it is theirs.
    """

    def end(number: int, _: FrameType | None) -> None:
        temporary.unlink(missing_ok=True)
        signal.signal(number, signal.SIG_DFL)
        signal.raise_signal(number)

    ours = _ENDING if threading.current_thread() is threading.main_thread() else ()
    ours = tuple(number for number in ours if signal.getsignal(number) is signal.SIG_DFL)
    try:
        for number in ours:
            signal.signal(number, end)
        yield
    except BaseException:
        temporary.unlink(missing_ok=True)
        raise
    finally:
        for number in ours:
            signal.signal(number, signal.SIG_DFL)


def _resemble(new: Path, old: os.stat_result) -> None:
    """Give a file the mode of another and, as far as we may, its owner."""
    if hasattr(os, "chown"):
        with suppress(OSError):
            os.chown(new, old.st_uid, old.st_gid)
    new.chmod(stat.S_IMODE(old.st_mode))
