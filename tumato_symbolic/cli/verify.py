"""`tumato-sym verify`: prove a policy or refute it."""

from __future__ import annotations

import sys
import time

from tumato_symbolic.cli.console import Progress, wants_colour, write
from tumato_symbolic.cli.exits import NO, UNDECIDED, YES
from tumato_symbolic.cli.inputs import errors_in, read_spec, show_warnings
from tumato_symbolic.cli.parser import Options
from tumato_symbolic.policy import Policy
from tumato_symbolic.report.layout import dump
from tumato_symbolic.report.verified import Verified, as_github, as_json, as_text
from tumato_symbolic.verify import verify


def run(options: Options) -> int:
    """Exit with 0 only when everything that was asked is proved."""
    source, spec, warnings = read_spec(options.specs[0])
    policy = Policy.load(options.policy)
    started = time.perf_counter()
    with errors_in(source), Progress() as progress:
        verification = verify(
            policy, spec, ordering=options.effect_ordering, properties=options.properties, progress=progress
        )
    done = Verified(source, spec, options.policy, verification, warnings, time.perf_counter() - started)
    show_warnings(warnings, source, options)
    match options.output_format:
        case "json":
            write(dump(as_json(done)))
        case "github":
            write(as_github(done))
        case _:
            write(as_text(done, wants_colour(sys.stdout)))
    return {"proved": YES, "refuted": NO, "undecided": UNDECIDED}[verification.verdict]
