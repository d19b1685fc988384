"""What `verify` is given: a policy, or a certificate that there is none, as the file says."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tumato_symbolic.diagnostics import Source, UserError
from tumato_symbolic.policy.formats import UNREALIZABLE, fields_of
from tumato_symbolic.policy.policy import Policy
from tumato_symbolic.policy.text import as_object, parse_json, read_text

if TYPE_CHECKING:
    from tumato_symbolic.policy.unrealizability import Unrealizability


def load_claim(path: str) -> Policy | Unrealizability:
    """The policy in the file at `path` (`-` is standard input), or the certificate that there is none.

    Raises `UserError` (TUM501 to TUM508).
    """
    text, name = read_text(path)
    try:
        document = as_object(parse_json(text, name), "the file")
        if document.get("Type") != UNREALIZABLE:
            return Policy(*fields_of(document))
        from tumato_symbolic.policy.unrealizability import unrealizability_of

        return unrealizability_of(document)
    except UserError as error:
        raise UserError(error.diagnostics, error.source or Source(name, "")) from None
