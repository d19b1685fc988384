"""Texts from files and from standard input."""

from __future__ import annotations

from tumato_symbolic.diagnostics import Code, Source
from tumato_symbolic.policy.text.messages import fault
from tumato_symbolic.policy.text.strict_json import MAX_BYTES, too_large
from tumato_symbolic.syntax.reading import content


def read_text(path: str) -> tuple[str, str]:
    """The text of the file at `path` (`-` is standard input), and what it is called in messages.

    Raises `UserError` (TUM501, TUM508).
    """
    name = "<stdin>" if path == "-" else path
    try:
        data = content(path, MAX_BYTES + 1)
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
