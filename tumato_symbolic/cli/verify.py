"""`tumato-sym verify`: prove a policy, or a certificate that there is none, or refute it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tumato_symbolic.cli.inputs import show_warnings
from tumato_symbolic.cli.judging import ended, exit_code, judge, wanted_jobs
from tumato_symbolic.cli.output import show, show_profile
from tumato_symbolic.cli.parser import Options
from tumato_symbolic.limits import Context
from tumato_symbolic.policy.claim import load_claim
from tumato_symbolic.report import verified
from tumato_symbolic.report.folder import Folder
from tumato_symbolic.report.verified import Verified

if TYPE_CHECKING:
    from tumato_symbolic.cli.judging import Judged


def run(options: Options, context: Context) -> int:
    """Exit with 0 only when everything that was asked is proved, and the certificate passes `--strict`."""
    if not options.specs:
        from tumato_symbolic.cli.folder import run_folder

        return run_folder(options, context)
    context.tell(f"reading {options.policy}")
    claim = load_claim(options.policy)
    done = judge(claim, options.policy, options.specs[0], options, context, jobs=wanted_jobs(options))
    code = _report(done, options)
    show_profile(context, options)
    return code


def stopped(known: Judged | Folder, why: str, options: Options) -> int:
    """Report what was proved when a limit was met."""
    if isinstance(known, Folder):
        from tumato_symbolic.cli.folder import stopped_folder

        return stopped_folder(known, why, options)
    return _report(ended(known, why), options)


def _report(done: Judged, options: Options) -> int:
    show_warnings(done.warnings, done.source, options)
    if isinstance(done, Verified):
        show(verified, done, options)
    else:
        from tumato_symbolic.report import unrealizable

        show(unrealizable, done, options)
    return exit_code(done)
