"""Obligations from a specification and a policy, proved by Z3 for all states. See `docs/certificate.md`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from tumato_symbolic.verify.result import (
    PROPERTIES,
    CertificateUse,
    PropertyName,
    PropertyResult,
    Refutation,
    Verdict,
    Verification,
)

if TYPE_CHECKING:
    from tumato_symbolic.verify.prove import verify

__all__ = [
    "PROPERTIES",
    "CertificateUse",
    "PropertyName",
    "PropertyResult",
    "Refutation",
    "Verdict",
    "Verification",
    "verify",
]


def __getattr__(name: str) -> Any:  # noqa: ANN401 - the one lazy name: it loads z3
    if name != "verify":
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from tumato_symbolic.verify.prove import verify

    return verify
