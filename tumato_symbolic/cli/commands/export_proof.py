"""`tumato-sym export-proof`: a policy as a theorem for Coq."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from tumato_symbolic.cli import arguments
from tumato_symbolic.cli.console import note, write, writing
from tumato_symbolic.cli.exits import YES
from tumato_symbolic.cli.options import STANDARD_OUTPUT, CommandOptions, Target
from tumato_symbolic.diagnostics import Code, Diagnostic, UserError
from tumato_symbolic.limits import Context

if TYPE_CHECKING:
    from tumato_symbolic.spec import Ordering, Restoration

ABOUT = """\
Write a policy and its specification as one Coq file: compiling it proves that the policy is sound, complete and
minimal. Nothing is checked here: for a wrong policy a theorem is written as well, and Coq rejects it. For
specifications of up to 30,000 states.
"""

EXAMPLES = """\
examples:
  tumato-sym export-proof policy.json amr.tum -o amr.v
  coqc -q -R proofs/coq Tumato amr.v             # after `make -C proofs/coq`, in a checkout of tumato-symbolic
"""


@dataclass(frozen=True, slots=True)
class Options(CommandOptions):
    """What may be typed after `export-proof`."""

    policy: str = arguments.policy()
    specs: tuple[str, ...] = arguments.specs()
    output: str = arguments.output(
        Target("theorem", example="policy.v"), "-", "where to write the theorem (default: the standard output)"
    )
    timeout: float | None = arguments.timeout()
    memory: int | None = arguments.memory()
    effect_ordering: Ordering | None = arguments.effect_ordering(
        "any where the specification writes it, else what the policy records, else any"
    )
    restoration: Restoration | None = arguments.restoration()


def run(options: Options, context: Context) -> int:
    """Exit with 0 when the theorem is written; whether it holds, Coq says."""
    from tumato_symbolic.cli.inputs import errors_in, read_spec, show_warnings
    from tumato_symbolic.export.coq import export
    from tumato_symbolic.policy import Policy
    from tumato_symbolic.policy.bind import made_for_less, restores_less
    from tumato_symbolic.policy.saving import save_text

    context.tell("reading the specification")
    source, spec, warnings = read_spec(options.specs[0], options.restoration)
    context.tell(f"reading {options.policy}")
    policy = Policy.load(options.policy)
    if options.effect_ordering is None and made_for_less(policy, spec):
        raise _made_for_less(options.policy)
    if options.restoration is None and restores_less(policy, spec):
        raise _restores_less(options.policy, policy.restoration, spec.restoration)
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


def _restores_less(path: str, made_for: Restoration, meant: Restoration) -> UserError:
    message = f"{path} was made for `restoration: {made_for}`, but the specification means {meant}"
    help_ = "synthesize it again, or say with --restoration which of them the theorem is about"
    return UserError((Diagnostic(Code.TUM511, message, help=help_),))
