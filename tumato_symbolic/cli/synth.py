"""`tumato-sym synth`: synthesize, prove, write, report."""

from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING

from tumato_symbolic.cli.console import Progress, write
from tumato_symbolic.cli.exits import NO, UNDECIDED, YES
from tumato_symbolic.cli.inputs import errors_in, read_spec, show_warnings
from tumato_symbolic.cli.output import show, show_profile
from tumato_symbolic.cli.parser import Options
from tumato_symbolic.cli.targets import STANDARD_OUTPUT, certificate_path
from tumato_symbolic.diagnostics import Code, UserError
from tumato_symbolic.limits import Context, Limits
from tumato_symbolic.policy import dumps, save
from tumato_symbolic.report import synthesized
from tumato_symbolic.report.synthesized import Synthesized
from tumato_symbolic.spec import Ordering, Spec
from tumato_symbolic.synthesis import Realizable, Unrealizable, synthesize

if TYPE_CHECKING:
    from tumato_symbolic.policy.unrealizable import Unrealizability
    from tumato_symbolic.verify import UnrealizabilityVerdict, Verification


def run(options: Options) -> int:
    """Exit with 0 only when there is a policy, it is proved (unless that was declined), and it is written."""
    proof = disproof = certificate = None
    with Progress() as progress:
        context = Context(Limits(options.timeout, options.memory), progress)
        context.tell("reading the specification")
        source, spec, warnings = read_spec(options.specs[0])
        started = time.perf_counter()
        with errors_in(source):
            outcome = synthesize(
                spec,
                options.effect_ordering,
                policy_format=options.policy_format,
                context=context,
            )
            solved = time.perf_counter()
            if isinstance(outcome, Realizable) and options.prove:
                proof = _prove(outcome, spec, options, context)
            if isinstance(outcome, Unrealizable) and outcome.certificate is not None and options.prove:
                disproof = _disprove(outcome.certificate, outcome.statistics.ordering, spec, context)
    proved = time.perf_counter()
    written = isinstance(outcome, Realizable) and (proof is None or proof.verdict == "proved")
    if isinstance(outcome, Unrealizable):
        certificate = _write_certificate(outcome, options.output)
    done = Synthesized(
        source=source,
        spec=spec,
        outcome=outcome,
        proof=proof,
        disproof=disproof,
        certificate=certificate,
        warnings=(*warnings, *outcome.warnings),
        output=options.output,
        written=written,
        solved_in=solved - started,
        proved_in=proved - solved,
    )
    if isinstance(outcome, Realizable) and written:
        _write_policy(outcome, options.output)
    show_warnings(done.warnings, source, options)
    show(synthesized, done, options, to_stderr=options.output == STANDARD_OUTPUT)
    show_profile(progress, options)
    if written:
        return YES
    return NO if isinstance(outcome, Unrealizable) else UNDECIDED


def _prove(outcome: Realizable, spec: Spec, options: Options, context: Context) -> Verification:
    """The verdict on our own policy. A refutation would be a bug of this program, and must not pass as a verdict."""
    from tumato_symbolic.cli.judging import wanted_jobs
    from tumato_symbolic.verify import verify

    proof = verify(
        outcome.policy,
        spec,
        ordering=outcome.statistics.ordering,
        prover=options.prover,
        jobs=wanted_jobs(options),
        context=context,
    )
    if proof.verdict == "refuted":
        raise AssertionError(f"the synthesized policy is refuted: {proof}")
    return proof


def _disprove(certificate: Unrealizability, ordering: Ordering, spec: Spec, context: Context) -> UnrealizabilityVerdict:
    """The verdict on our own certificate. A refutation would be a bug of this program."""
    from tumato_symbolic.verify import verify_unrealizable

    found = verify_unrealizable(certificate, spec, ordering=ordering, context=context)
    if found.verdict == "refuted":
        raise AssertionError(f"the certificate that there is no policy is refuted: {found}")
    return found


def _write_certificate(outcome: Unrealizable, output: str) -> str | None:
    """Where the certificate was written; None where there is none or no place for it, or it is too large."""
    from tumato_symbolic.policy.unrealizable_file import save as save_certificate

    path = certificate_path(output)
    if path is None or outcome.certificate is None:
        return None
    try:
        save_certificate(outcome.certificate, path)
    except UserError as error:
        if error.diagnostics[0].code is not Code.TUM508:
            raise
        return None
    return str(path)


def _write_policy(outcome: Realizable, output: str) -> None:
    if output == STANDARD_OUTPUT:
        write(dumps(outcome.policy))
    else:
        save(outcome.policy, Path(output))
