"""`tumato-sym export-proof`: a policy as a theorem for Coq."""

from __future__ import annotations

from pathlib import Path

from tumato_symbolic.cli.console import note, write, writing
from tumato_symbolic.cli.exits import YES
from tumato_symbolic.cli.inputs import errors_in, read_spec, show_warnings
from tumato_symbolic.cli.parser import Options
from tumato_symbolic.cli.targets import STANDARD_OUTPUT
from tumato_symbolic.diagnostics import Code, Diagnostic, UserError
from tumato_symbolic.export.coq import export
from tumato_symbolic.limits import Context
from tumato_symbolic.policy import Policy
from tumato_symbolic.policy.bind import made_for_less
from tumato_symbolic.policy.saving import save_text


def run(options: Options, context: Context) -> int:
    """Exit with 0 when the theorem is written; whether it holds, Coq says."""
    context.tell("reading the specification")
    source, spec, warnings = read_spec(options.specs[0])
    context.tell(f"reading {options.policy}")
    policy = Policy.load(options.policy)
    if options.effect_ordering is None and made_for_less(policy, spec):
        raise _made_for_less(options.policy)
    ordering = options.effect_ordering or spec.ordering
    context.tell("writing the theorem")
    with errors_in(source):
        text = export(policy, spec, ordering)
    show_warnings(warnings, source, options)
    if options.output == STANDARD_OUTPUT:
        write(text)
    else:
        with writing():
            save_text(text, Path(options.output), "theorem")
        note(
            f"{options.output} is written, for effects in the ordering {ordering}; it is a proof when Coq compiles it."
        )
    return YES


def _made_for_less(path: str) -> UserError:
    message = f"{path} was made for the effect ordering first, but the specification means any"
    help_ = "synthesize it again, or say with --effect-ordering which of them the theorem is about"
    return UserError((Diagnostic(Code.TUM511, message, help=help_),))
