"""`tumato-sym report`: a policy, or that there is none, as a page for a browser."""

from __future__ import annotations

from typing import TYPE_CHECKING

from msgspec.structs import replace

from tumato_symbolic.cli import arguments
from tumato_symbolic.cli.console import note, write
from tumato_symbolic.cli.options import CommandOptions, Target
from tumato_symbolic.limits import Context

if TYPE_CHECKING:
    from tumato_symbolic.cli.verifying import Verdict
    from tumato_symbolic.policy import Policy
    from tumato_symbolic.policy.unrealizability import Unrealizability
    from tumato_symbolic.report.html.contents import NoPolicyPage, PolicyPage
    from tumato_symbolic.spec import Ordering, Restoration
    from tumato_symbolic.verify import ProverName

ABOUT = """\
Write a page for a browser about a policy, or about the proof that there is none.

One file, which asks nothing of any other place: what is proved, by whom; what is done where, as a table, as rules and
as a graph; for every state the goal, the run, what else may happen, and why nothing else is done; executions step by
step; the difference from another policy. Where there is no policy: which states fail, the lines to blame, and what
could be changed. The page checks decisions and runs itself, and says so (docs/report.md).
"""

EXAMPLES = """\
examples:
  tumato-sym report policy.json amr.tum                       # writes report.html
  tumato-sym report amr.unrealizable.json amr.tum -o no.html
"""


class Options(CommandOptions, frozen=True):
    """What may be typed after `report`."""

    policy: str = arguments.policy("the policy or the proof that there is none, a .json file")
    specs: tuple[str, ...] = arguments.specs()
    output: str = arguments.output(
        Target("page", example="report.html"),
        "report.html",
        "where to write the page (default: report.html here; - for the standard output)",
    )
    timeout: float | None = arguments.timeout()
    memory: int | None = arguments.memory()
    prover: ProverName = arguments.prover()
    jobs: int | None = arguments.jobs("a large proof")
    effect_ordering: Ordering | None = arguments.effect_ordering(certificates=True)
    restoration: Restoration | None = arguments.restoration()


def run(options: Options, context: Context) -> int:
    """Exit as `verify` does; the page is written whatever the verdict is."""
    from tumato_symbolic.cli.inputs import errors_in, show_warnings
    from tumato_symbolic.cli.reporting import write_page
    from tumato_symbolic.cli.verifying import Criteria, exit_code, verify_claim, wanted_jobs
    from tumato_symbolic.policy import load_claim
    from tumato_symbolic.verify.result import PROPERTIES

    context.tell(f"reading {options.policy}")
    claim = load_claim(options.policy)
    criteria = Criteria(options.effect_ordering, options.restoration, PROPERTIES, options.prover, strict=False)
    jobs, proving = wanted_jobs(options.jobs), context.within(learned=lambda _: None)
    done = verify_claim(claim, options.policy, options.specs[0], criteria, proving, jobs=jobs)
    with errors_in(done.source):
        page = _page(claim, done, context)
    show_warnings(done.warnings, done.source, options)
    write_page(page, options.output, context)
    said = f"{options.policy} is {done.verdict} against {done.source.name}. {options.output} is written."
    (note if options.report_apart else write)(said)
    return exit_code(done)


def _page(claim: Policy | Unrealizability, done: Verdict, context: Context) -> PolicyPage | NoPolicyPage:
    from tumato_symbolic.cli.reporting import rules_of, why_none
    from tumato_symbolic.policy import Policy, fitted
    from tumato_symbolic.report.html.contents import NoPolicyPage, PolicyPage
    from tumato_symbolic.report.verified import Verified

    source = done.source
    if isinstance(claim, Policy) and isinstance(done, Verified):
        proof = done.verification
        spec = replace(done.spec, restoration=proof.restoration or done.spec.restoration)
        rules = rules_of(claim, context)
        return PolicyPage(source, spec, done.policy, fitted(claim, spec), proof.ordering, proof, rules)
    assert not isinstance(done, Verified)
    found = done.found
    explained = why_none(source, done.spec, found.ordering, context)
    return NoPolicyPage(source, done.spec, done.certificate, found.ordering, found, explained)
