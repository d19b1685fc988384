"""`tumato-sym verify` for a certificate that there is no policy."""

from __future__ import annotations

import sys
import time

from tumato_symbolic.cli.console import Progress, wants_colour, write
from tumato_symbolic.cli.exits import NO, UNDECIDED, YES
from tumato_symbolic.cli.inputs import errors_in, read_spec, show_warnings
from tumato_symbolic.cli.parser import Options
from tumato_symbolic.policy.unrealizable import Unrealizability
from tumato_symbolic.report.layout import dump
from tumato_symbolic.report.unrealizable import Disproved, as_github, as_json, as_text


def run_certificate(certificate: Unrealizability, options: Options) -> int:
    """Exit with 0 only when it is proved that there is no policy, and the certificate passes `--strict`."""
    with Progress() as progress:
        done = judge_certificate(certificate, options.policy, options.specs[0], options, progress)
    show_warnings(done.warnings, done.source, options)
    match options.output_format:
        case "json":
            write(dump(as_json(done)))
        case "github":
            write(as_github(done))
        case _:
            write(as_text(done, wants_colour(sys.stdout)))
    return certificate_exit_code(done)


def judge_certificate(
    certificate: Unrealizability, path: str, spec_path: str, options: Options, progress: Progress
) -> Disproved:
    """The certificate read from `path` against the specification at `spec_path`.

    Raises `UserError` where the specification cannot be used, or the certificate does not fit it.
    """
    from tumato_symbolic.verify import verify_unrealizable  # loads Z3, which --prover walk does without

    source, spec, warnings = read_spec(spec_path)
    started = time.perf_counter()
    with errors_in(source):
        found = verify_unrealizable(certificate, spec, ordering=options.effect_ordering, progress=progress)
    took = time.perf_counter() - started
    return Disproved(source, spec, path, found, warnings, took, options.strict)


def certificate_exit_code(done: Disproved) -> int:
    """What a script may conclude."""
    if done.not_accepted:
        return NO
    return {"proved": YES, "refuted": NO, "undecided": UNDECIDED}[done.found.verdict]
