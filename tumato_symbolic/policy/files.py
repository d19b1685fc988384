"""Policy files: a policy is loaded and saved."""

from __future__ import annotations

from pathlib import Path

from tumato_symbolic.policy.decisions import as_diagram
from tumato_symbolic.policy.formats import fits_table, policy_fields, policy_text
from tumato_symbolic.policy.policy import Policy
from tumato_symbolic.policy.text import save_text


def load(path: str) -> Policy:
    """The policy in the file at `path`, UTF-8; `-` is standard input. Raises `UserError` (TUM501 to TUM508)."""
    return Policy.load(path)


def loads(text: str, name: str = "policy") -> Policy:
    """The policy that `text` describes; `name` is what it is called in messages.

    Raises `UserError` (TUM501 to TUM508) for text that is no policy. A certificate that cannot be used is set aside
    and `Policy.certificate_problem` tells why.
    """
    return Policy(*policy_fields(text, name))


def dumps(policy: Policy) -> str:
    """The policy as JSON text in ASCII, always the same for equal policies.

    A table is written as a table and a diagram as a diagram; only a table that the format cannot hold (`fits_table`)
    is written as a diagram. Raises `UserError` (TUM508) where the text would be larger than `loads` accepts.
    """
    fields = policy.fields
    return policy_text(fields if fits_table(policy.vocabulary) else fields._replace(decisions=as_diagram(policy)))


def save(policy: Policy, path: Path) -> None:
    """Write the policy to `path`, all or nothing, as `save_text` does. Raises `UserError` (TUM508, TUM510)."""
    save_text(dumps(policy), path, "policy")
