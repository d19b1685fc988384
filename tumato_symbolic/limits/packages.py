"""Packages that an installation may do without, and what is said where one is needed."""

from __future__ import annotations

from importlib import import_module

from tumato_symbolic.limits.context import LimitReachedError


class MissingPackageError(LimitReachedError):
    """There is no answer without a package that cannot be imported; the message says what it is needed for."""

    def __init__(self, name: str, distribution: str, purpose: str) -> None:
        way_out = f"install it with `pip install {distribution}`"
        super().__init__(f"{name} is needed to {purpose}, and cannot be imported here; {way_out}")


def has_z3() -> bool:
    """Whether Z3 can be imported; it is loaded then."""
    try:
        import_module("z3")
    except Exception:  # noqa: BLE001 - a wheel for another machine raises what it likes
        return False
    return True


def need_z3(purpose: str) -> None:
    """Raise `MissingPackageError` where Z3 cannot be imported."""
    if not has_z3():
        raise MissingPackageError("Z3", "z3-solver", purpose)


def need(module: str, extra: str, purpose: str) -> None:
    """Raise `MissingPackageError` where a module of a package, which an extra of ours brings, cannot be imported."""
    try:
        import_module(module)
    except ImportError:
        raise MissingPackageError(module.partition(".")[0], f"'tumato-symbolic[{extra}]'", purpose) from None
