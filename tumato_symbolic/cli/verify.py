"""`tumato-sym verify`: prove a policy, or a certificate that there is none, or refute it."""

from __future__ import annotations

import sys
import time

from tumato_symbolic.cli.console import Progress, wants_colour, write
from tumato_symbolic.cli.exits import NO, UNDECIDED, YES
from tumato_symbolic.cli.inputs import errors_in, read_spec, show_warnings
from tumato_symbolic.cli.parser import Options
from tumato_symbolic.policy import Policy
from tumato_symbolic.policy.claim import load_claim
from tumato_symbolic.report.layout import dump
from tumato_symbolic.report.verified import Verified, as_github, as_json, as_text
from tumato_symbolic.verify import verify
from tumato_symbolic.verify.children import cores


def run(options: Options) -> int:
    """Exit with 0 only when everything that was asked is proved, and the certificate passes `--strict`."""
    if not options.specs:
        from tumato_symbolic.cli.folder import run_folder

        return run_folder(options)
    claim = load_claim(options.policy)
    if not isinstance(claim, Policy):
        from tumato_symbolic.cli.certificate import run_certificate

        return run_certificate(claim, options)
    with Progress() as progress:
        done = judge(claim, options.policy, options.specs[0], options, progress, jobs=wanted_jobs(options))
    show_warnings(done.warnings, done.source, options)
    match options.output_format:
        case "json":
            write(dump(as_json(done)))
        case "github":
            write(as_github(done))
        case _:
            write(as_text(done, wants_colour(sys.stdout)))
    return exit_code(done)


def wanted_jobs(options: Options) -> int:
    """How many processes may work at a time: as many as the user says, else one on every processor."""
    return options.jobs or cores()


def judge(policy: Policy, path: str, spec_path: str, options: Options, progress: Progress, *, jobs: int) -> Verified:
    """The policy read from `path` against the specification at `spec_path`.

    Raises `UserError` where the specification cannot be used, or the policy does not fit it.
    """
    source, spec, warnings = read_spec(spec_path)
    started = time.perf_counter()
    with errors_in(source):
        verification = verify(
            policy,
            spec,
            ordering=options.effect_ordering,
            properties=options.properties,
            prover=options.prover,
            jobs=jobs,
            progress=progress,
        )
    took = time.perf_counter() - started
    return Verified(source, spec, path, verification, warnings, took, options.strict)


def exit_code(done: Verified) -> int:
    """What a script may conclude."""
    if done.certificate_fails:
        return NO
    return {"proved": YES, "refuted": NO, "undecided": UNDECIDED}[done.verification.verdict]
