"""`tumato-sym verify`: prove a policy, or a certificate that there is none, or refute it."""

from __future__ import annotations

from tumato_symbolic.cli.console import Progress
from tumato_symbolic.cli.inputs import show_warnings
from tumato_symbolic.cli.judging import exit_code, judge, wanted_jobs
from tumato_symbolic.cli.output import show, show_profile
from tumato_symbolic.cli.parser import Options
from tumato_symbolic.limits import Context
from tumato_symbolic.policy.claim import load_claim
from tumato_symbolic.report import verified
from tumato_symbolic.report.verified import Verified


def run(options: Options) -> int:
    """Exit with 0 only when everything that was asked is proved, and the certificate passes `--strict`."""
    if not options.specs:
        from tumato_symbolic.cli.folder import run_folder

        return run_folder(options)
    with Progress() as progress:
        context = Context(progress=progress)
        context.tell(f"reading {options.policy}")
        claim = load_claim(options.policy)
        done = judge(claim, options.policy, options.specs[0], options, context, jobs=wanted_jobs(options))
    show_warnings(done.warnings, done.source, options)
    if isinstance(done, Verified):
        show(verified, done, options)
    else:
        from tumato_symbolic.report import unrealizable

        show(unrealizable, done, options)
    show_profile(progress, options)
    return exit_code(done)
