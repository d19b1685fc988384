"""`tumato-sym synth`: synthesize, prove, write, report."""

from __future__ import annotations

import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING

from tumato_symbolic.cli.console import Progress, note, wants_colour, write
from tumato_symbolic.cli.exits import NO, UNDECIDED, YES
from tumato_symbolic.cli.inputs import errors_in, read_spec, show_warnings
from tumato_symbolic.cli.output import check_writable
from tumato_symbolic.cli.parser import Options
from tumato_symbolic.policy import dumps, save
from tumato_symbolic.report.layout import dump
from tumato_symbolic.report.synthesized import Synthesized, as_github, as_json, as_text
from tumato_symbolic.spec import Ordering, Spec
from tumato_symbolic.synthesis import Realizable, Unrealizable, synthesize

if TYPE_CHECKING:
    from tumato_symbolic.verify import Verification

TO_STANDARD_OUTPUT = "-"


def run(options: Options) -> int:
    """Exit with 0 only when there is a policy, it is proved (unless that was declined), and it is written."""
    check_writable(options.output)
    source, spec, warnings = read_spec(options.specs[0])
    proof = None
    started = time.perf_counter()
    with errors_in(source), Progress() as progress:
        outcome = synthesize(spec, options.effect_ordering, policy_format=options.policy_format, progress=progress)
        solved = time.perf_counter()
        if isinstance(outcome, Realizable) and options.prove:
            proof = _prove(outcome, spec, outcome.statistics.ordering, progress)
    proved = time.perf_counter()
    written = isinstance(outcome, Realizable) and (proof is None or proof.verdict == "proved")
    done = Synthesized(
        source=source,
        spec=spec,
        outcome=outcome,
        proof=proof,
        warnings=(*warnings, *outcome.warnings),
        output=options.output,
        written=written,
        solved_in=solved - started,
        proved_in=proved - solved,
    )
    if isinstance(outcome, Realizable) and written:
        _write_policy(outcome, options.output)
    show_warnings(done.warnings, source, options)
    _report(done, options)
    if written:
        return YES
    return NO if isinstance(outcome, Unrealizable) else UNDECIDED


def _prove(outcome: Realizable, spec: Spec, ordering: Ordering, progress: Progress) -> Verification:
    """The verdict on our own policy. A refutation would be a bug of this program, and must not pass as a verdict."""
    from tumato_symbolic.verify import verify

    proof = verify(outcome.policy, spec, ordering=ordering, progress=progress)
    if proof.verdict == "refuted":
        raise AssertionError(f"the synthesized policy is refuted: {proof}")
    return proof


def _write_policy(outcome: Realizable, output: str) -> None:
    if output == TO_STANDARD_OUTPUT:
        write(dumps(outcome.policy))
    else:
        save(outcome.policy, Path(output))


def _report(done: Synthesized, options: Options) -> None:
    """On the standard output, or beside it where the policy is written there."""
    to_stderr = options.output == TO_STANDARD_OUTPUT
    match options.output_format:
        case "json":
            text = dump(as_json(done))
        case "github":
            text = as_github(done)
        case _:
            text = as_text(done, wants_colour(sys.stderr if to_stderr else sys.stdout))
    (note if to_stderr else write)(text)
