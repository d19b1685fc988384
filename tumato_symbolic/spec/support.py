"""What parts of the program do not know yet is refused, never misread."""

from __future__ import annotations

from tumato_symbolic.diagnostics import Code, Diagnostic, UserError
from tumato_symbolic.spec.specification import Spec


def require_one_step(spec: Spec, who: str) -> None:
    """Raise `UserError` where safety may take several steps to restore, and `who` does not know that yet."""
    if spec.restores_stepwise:
        setting = f"`restoration: {spec.restoration}`" if spec.restoration != "one_step" else "more than one `severity`"
        help_ = "use `restoration: one_step` and one severity for now"
        raise UserError((Diagnostic(Code.TUM313, f"{who} does not support {setting} yet", help=help_),))
