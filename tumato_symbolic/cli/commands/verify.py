"""`tumato-sym verify`: prove a policy, or a certificate that there is none, or refute it."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from tumato_symbolic.cli import arguments
from tumato_symbolic.cli.options import CommandOptions, OutputFormat, Target, argument, is_folder
from tumato_symbolic.limits import Context

if TYPE_CHECKING:
    from tumato_symbolic.cli.verifying import Verdict
    from tumato_symbolic.report.folder import Folder
    from tumato_symbolic.spec import Ordering, Restoration
    from tumato_symbolic.verify import ProverName

PROPERTIES = ("total", "safe", "restoring", "goals", "minimal")

ABOUT = """\
Prove a policy, whatever its origin, against a specification.

For all valid states at once: total (there is a decision), safe (every outcome keeps the rules, in any order of
effects), restoring (where that may take several steps: safety is restored), goals (the nominal run reaches the active
goals), minimal (no cheaper set of actions would restore safety as well). A property that does not hold is refuted by a
state and a step-by-step counterexample.

Given a folder, every NAME.policy.json and NAME.unrealizable.json in it is verified against NAME.tum, which is looked
for in the folders given with --specs, beside it, and in ../examples; where there is no such name, against the
specification there that it was made for. The exit code is that of the worst file: 2, then 1, then 3, then 0.
"""

EXAMPLES = """\
examples:
  tumato-sym verify policy.json amr.tum
  tumato-sym verify policy.json amr.tum --properties total,safe,goals
  tumato-sym verify policy.json amr.tum --guarantees             # what holds when effects deviate
  tumato-sym verify proofs/ --specs robots/ --strict             # all policies of a repository, in its CI
"""


def _properties(text: str) -> tuple[str, ...]:
    asked = tuple(dict.fromkeys(part.strip() for part in text.split(",")))
    wrong = next((name for name in asked if name not in PROPERTIES), None)
    if wrong is not None:
        raise argparse.ArgumentTypeError(f"{wrong!r} is not a property; choose from {', '.join(PROPERTIES)}")
    return asked


class Options(CommandOptions, frozen=True):
    """What may be typed after `verify`."""

    policy: str = arguments.policy("the policy or the proof that there is none, a .json file, or a folder of them")
    specs: tuple[str, ...] = arguments.specs("*", "the specification, a .tum file; none for a folder")
    spec_folders: tuple[str, ...] = argument(
        "--specs",
        metavar="DIR",
        action="append",
        default=[],
        help="where the specifications of a folder of policies are looked for first; may be given several times",
    )
    timeout: float | None = arguments.timeout()
    memory: int | None = arguments.memory()
    prover: ProverName = arguments.prover()
    jobs: int | None = arguments.jobs("a large proof, or a folder")
    profile: bool = arguments.profile()
    strict: bool = argument(
        "--strict",
        action="store_true",
        help="fail as well (exit 1) where the certificate is wrong, or stale: made for another specification",
    )
    effect_ordering: Ordering | None = arguments.effect_ordering(certificates=True)
    restoration: Restoration | None = arguments.restoration()
    require_all: bool = argument(
        "--require-all",
        action="store_true",
        help="fail as well (exit 1) where a specification has neither a policy nor a certificate in the folder: one of "
        "those in the folders given with --specs, else of those in the folder itself and in ../examples",
    )
    properties: tuple[str, ...] = argument(
        "--properties",
        type=_properties,
        default=PROPERTIES,
        metavar="LIST",
        help=f"what to prove, separated by commas (default: {','.join(PROPERTIES)})",
    )
    guarantees: bool = argument(
        "--guarantees",
        action="store_true",
        help="say as well what a proved policy guarantees beyond nominal runs: with how many deviations from the "
        "nominal effects the goal is met, whether it is met once they stop, or whatever happens",
    )
    guarantees_file: str | None = argument(
        "--write-guarantees",
        metavar="FILE",
        help="write a certificate of what is guaranteed, for proofs/checker.py; implies --guarantees",
        writes=Target("certificate", "--write-guarantees", "guarantees.json"),
    )
    output_format: OutputFormat = arguments.output_format("json", "github", "sarif")

    @property
    def wants_guarantees(self) -> bool:
        """Whether guarantees are asked for."""
        return self.guarantees or self.guarantees_file is not None

    def mistake(self) -> str | None:
        """A policy needs one specification, a folder looks for its own; a certificate is judged with safe and goals.

        And with restoring, which is added where it is asked for at all.
        """
        if len(self.specs) > 1 or not (self.specs or is_folder(self.policy)):
            return "give a policy and its specification, or a folder of policies"
        if self.specs and self.spec_folders:
            return "give either the specification, or --specs DIR for a folder of policies"
        if self.specs and self.require_all:
            return "--require-all is for a folder of policies"
        if self.strict and not {"safe", "goals"} <= set(self.properties):
            return "--strict is about the certificate, and needs safe and goals among the properties"
        if self.wants_guarantees and not self.specs:
            return "--guarantees is for one policy and its specification"
        if self.wants_guarantees and not {"total", "safe", "goals"} <= set(self.properties):
            return "--guarantees builds on total, safe and goals, and needs them among the properties"
        return None


def run(options: Options, context: Context) -> int:
    """Exit with 0 only when everything that was asked is proved, and the certificate passes `--strict`."""
    from tumato_symbolic.cli.output import show_profile
    from tumato_symbolic.cli.verifying import Criteria, verify_claim, wanted_jobs
    from tumato_symbolic.policy import load_claim

    criteria = Criteria(
        options.effect_ordering,
        options.restoration,
        options.properties,
        options.prover,
        options.strict,
        options.wants_guarantees,
        options.guarantees_file,
    )
    jobs = wanted_jobs(options.jobs)
    if options.specs:
        context.tell(f"reading {options.policy}")
        claim = load_claim(options.policy)
        code = _report(verify_claim(claim, options.policy, options.specs[0], criteria, context, jobs=jobs), options)
    else:
        from tumato_symbolic.cli.folder import verify_folder
        from tumato_symbolic.cli.matching import Specifications

        specs = Specifications(options.policy, options.spec_folders)
        found = verify_folder(options.policy, specs, criteria, context, jobs=jobs, require_all=options.require_all)
        code = _report_folder(found, options)
    if options.profile:
        show_profile(context)
    return code


def stopped(known: Verdict | Folder, why: str, options: Options) -> int:
    """Report what was proved when a limit was met."""
    from tumato_symbolic.cli.verifying import ended
    from tumato_symbolic.report.folder import Folder

    if isinstance(known, Folder):
        from tumato_symbolic.cli.folder import ended_folder

        return _report_folder(ended_folder(known, why), options)
    return _report(ended(known, why), options)


def _report(done: Verdict, options: Options) -> int:
    from tumato_symbolic.cli.inputs import show_warnings
    from tumato_symbolic.cli.output import show
    from tumato_symbolic.cli.verifying import exit_code
    from tumato_symbolic.report.verified import Verified

    show_warnings(done.warnings, done.source, options)
    if isinstance(done, Verified):
        from tumato_symbolic.report import verified

        show(verified, done, options)
    else:
        from tumato_symbolic.report import unrealizable

        show(unrealizable, done, options)
    return exit_code(done)


def _report_folder(done: Folder, options: Options) -> int:
    from tumato_symbolic.cli.folder import folder_code
    from tumato_symbolic.cli.inputs import show_warnings
    from tumato_symbolic.cli.output import show
    from tumato_symbolic.report import folder

    for entry in done.entries:
        if entry.done is not None:
            show_warnings(entry.done.warnings, entry.done.source, options)
    show(folder, done, options)
    return folder_code(done)
