"""Obligations from a specification and a policy, proved for all states. See `docs/certificate.md`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from tumato_symbolic.verify.result import (
    PROPERTIES,
    CertificateUse,
    PropertyName,
    PropertyResult,
    ProverName,
    Refutation,
    UnrealizabilityVerdict,
    Verification,
)

if TYPE_CHECKING:
    from tumato_symbolic.verify.prove import verify
    from tumato_symbolic.verify.unrealizability.verdict import verify_unrealizable


def __getattr__(name: str) -> Any:  # noqa: ANN401 - the two lazy names: they may load z3
    if name == "verify":
        from tumato_symbolic.verify.prove import verify

        return verify
    if name == "verify_unrealizable":
        from tumato_symbolic.verify.unrealizability.verdict import verify_unrealizable

        return verify_unrealizable
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
