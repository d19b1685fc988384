"""Policy files."""

from __future__ import annotations

from pathlib import Path

from tumato_symbolic.policy.policy import Policy
from tumato_symbolic.policy.read import policy_fields
from tumato_symbolic.policy.saving import save_text
from tumato_symbolic.policy.write import dumps


def load(path: str) -> Policy:
    """The policy in the file at `path`, UTF-8; `-` is standard input. Raises `UserError` (TUM501 to TUM508)."""
    return Policy.load(path)


def loads(text: str, name: str = "policy") -> Policy:
    """The policy that `text` describes; `name` is what it is called in messages.

    Raises `UserError` (TUM501 to TUM508) for text that is no policy. A certificate that cannot be used is set aside
    and `Policy.certificate_problem` tells why.
    """
    return Policy(*policy_fields(text, name))


def save(policy: Policy, path: Path) -> None:
    """Write the policy to `path`, all or nothing, as `save_text` does. Raises `UserError` (TUM508, TUM510)."""
    save_text(dumps(policy), path, "policy")
