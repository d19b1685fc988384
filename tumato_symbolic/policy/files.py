"""Policy files. A file is either the old one or the new one, never half of one."""

from __future__ import annotations

import os
import sys
from pathlib import Path

from tumato_symbolic.diagnostics import Code, Source
from tumato_symbolic.policy.model import Policy
from tumato_symbolic.policy.problems import fault
from tumato_symbolic.policy.read import loads
from tumato_symbolic.policy.shape import MAX_BYTES, too_large
from tumato_symbolic.policy.write import dumps


def load(path: str) -> Policy:
    """The policy in the file at `path`, UTF-8; `-` is standard input. Raises `UserError` (TUM501 to TUM508)."""
    return loads(*read_text(path))


def read_text(path: str) -> tuple[str, str]:
    """The text of the file at `path` (`-` is standard input), and what it is called in messages.

    Raises `UserError` (TUM501, TUM508).
    """
    name = "<stdin>" if path == "-" else path
    try:
        if path == "-":
            data = sys.stdin.buffer.read(MAX_BYTES + 1)
        else:
            with Path(path).open("rb") as file:
                data = file.read(MAX_BYTES + 1)
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
        raise fault(Code.TUM501, f"the policy cannot be read: {reason}", None, Source(name, "")) from None
    if len(data) > MAX_BYTES:
        raise too_large(name)
    try:
        return data.decode(), name
    except UnicodeDecodeError as error:
        message = f"the policy is not UTF-8 text (byte {error.start})"
        raise fault(Code.TUM501, message, None, Source(name, "")) from None


def save(policy: Policy, path: Path) -> None:
    """Write the policy to `path`, all or nothing. Raises `UserError` (TUM508, TUM510).

    A regular file is replaced as a whole, once the new text is safely on the disk; a device or pipe is written to.
    """
    save_text(dumps(policy), path, "policy")


def save_text(text: str, path: Path, what: str) -> None:
    """Write a text to `path` as `save` does; `what` is what it is called in messages. Raises `UserError` (TUM510)."""
    data = text.encode()
    try:
        target = path.resolve()
        if target.is_dir():
            raise IsADirectoryError("it is a directory")
        if target.exists() and not target.is_file():
            target.write_bytes(data)
        else:
            _replace(target, data)
    except (OSError, ValueError, RuntimeError) as error:
        reason = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
        raise fault(Code.TUM510, f"the {what} cannot be written: {reason}", None, Source(str(path), "")) from None


def _replace(target: Path, data: bytes) -> None:
    temporary = target.with_name(f".tumato-{os.urandom(8).hex()}.tmp")
    try:
        with temporary.open("xb") as file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        temporary.replace(target)
    except BaseException:
        temporary.unlink(missing_ok=True)
        raise
