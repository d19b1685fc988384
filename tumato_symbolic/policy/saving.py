"""Texts to files. A file is either the old one or the new one, never half of one."""

from __future__ import annotations

import os
import stat
from contextlib import suppress
from pathlib import Path

from tumato_symbolic.diagnostics import Code, Source
from tumato_symbolic.policy.problems import fault

_MOST_LINKS = 40
"""Symbolic links that are followed one after the other."""


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


def open_file(path: Path) -> int | None:
    """The open file of this process that a name such as `/dev/stdout` or `/dev/fd/63` stands for, by its number.

    Raises `OSError` or `RuntimeError` for names that lead nowhere.
    """
    ours = (Path("/dev/fd"), Path(f"/proc/{os.getpid()}/fd"))
    for _ in range(_MOST_LINKS):
        if path.name.isdecimal() and path.parent.resolve() in ours:
            return int(path.name)
        if not path.is_symlink():
            return None
        path = path.parent / path.readlink()
    return None


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
    try:
        with temporary.open("xb") as file:
            if old is not None:
                _resemble(temporary, old)
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        temporary.replace(target)
    except BaseException:
        temporary.unlink(missing_ok=True)
        raise


def _resemble(new: Path, old: os.stat_result) -> None:
    """Give a file the mode of another and, as far as we may, its owner."""
    if hasattr(os, "chown"):
        with suppress(OSError):
            os.chown(new, old.st_uid, old.st_gid)
    new.chmod(stat.S_IMODE(old.st_mode))
