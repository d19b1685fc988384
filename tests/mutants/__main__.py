"""Many mutants: `python -m tests.mutants --count 20000`, with `--restoration` of restoring in several steps alone.

Prints figures; exits with 1 where a tier takes a right one for wrong or a wrong one for right.
"""

from __future__ import annotations

import argparse
import tempfile
import time
import traceback
from collections.abc import Iterator, Sequence
from itertools import count, islice
from multiprocessing import Pool
from pathlib import Path

from tests.conformance.by_coq import compiled
from tests.mutants.campaign import CLAUSES, Tally, examine
from tests.mutants.stepwise import examine_stepwise
from tests.mutants.unrealizable import examine_conflict, examine_unrealizable
from tests.profiles import ALL_PROFILES

CONFLICT, RESTORATION = "conflict", "restoration"
Job = tuple[str, int, int, bool]


def run(job: Job) -> Tally:
    """The mutants of one specification; an exception is a complaint."""
    profile, seed, each, coq = job
    try:
        with tempfile.TemporaryDirectory() as folder:
            if profile == CONFLICT:
                return examine_conflict(seed, each, Path(folder))
            if profile == RESTORATION:
                return examine_stepwise(seed, each, Path(folder), coq=coq)
            tally = examine(profile, seed, each, Path(folder))
            if profile != CLAUSES:
                tally.add(examine_unrealizable(profile, seed, each // 4, Path(folder)))
            return tally
    except Exception:
        return Tally(complaints=[f"{profile} {seed}: {traceback.format_exc()}"])


def jobs(first: int, each: int, profiles: Sequence[str], coq: bool) -> Iterator[Job]:
    """The profiles in turn, without end."""
    return ((profile, seed, each, coq) for seed in count(first) for profile in profiles)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the campaign."""
    parser = argparse.ArgumentParser(prog="python -m tests.mutants", description=__doc__)
    parser.add_argument("--count", type=int, default=20_000, help="how many mutants (default 20000)")
    parser.add_argument("--each", type=int, default=24, help="how many of one specification (default 24)")
    parser.add_argument("--seed", type=int, default=0, help="the first seed (default 0)")
    parser.add_argument("--processes", type=int, default=2)
    parser.add_argument("--restoration", action="store_true", help="only of restoring safety in several steps")
    parser.add_argument("--coq", action="store_true", help="the checker in Coq judges those of restoring as well")
    options = parser.parse_args(arguments)
    profiles = (RESTORATION,) if options.restoration else (*ALL_PROFILES, CLAUSES, CONFLICT, RESTORATION)
    total, started, told = Tally(), time.monotonic(), 0
    if options.coq:
        compiled()  # once for all processes
    with Pool(options.processes) as pool:
        everything = jobs(options.seed, options.each, profiles, options.coq)
        while total.mutants < options.count:
            for tally in pool.imap_unordered(run, islice(everything, 4 * options.processes)):
                total.add(tally)
                for complaint in tally.complaints:
                    print(complaint, flush=True)
            if total.mutants >= told + 500:
                told = total.mutants
                print(_figures(total, started), flush=True)
    for kind in sorted({kind for kind, _ in total.kinds}):
        print(f"  {kind}: {total.kinds[kind, True]} right, {total.kinds[kind, False]} wrong")
    for mode, mutants in sorted(total.modes.items()):
        print(f"  {mode}: {mutants} mutants")
    for kind, mutants in sorted(total.by_coq.items()):
        print(f"  coq: {kind}: {mutants}")
    print(f"  undecided: {dict(total.undecided)}")
    print(_figures(total, started))
    return 1 if total.complaints else 0


def _figures(total: Tally, started: float) -> str:
    wrong, took = total.mutants - total.right - total.unreadable, time.monotonic() - started
    return (
        f"{total.mutants} mutants: {total.right} right, {wrong} wrong, {total.unreadable} unreadable; "
        f"{total.forms['policy-diagram']} diagrams, {total.forms['unrealizable']} certificates of no; "
        f"{len(total.complaints)} misjudged, tiers disagree on {total.disagreements}; {took:.0f} s"
    )


if __name__ == "__main__":
    raise SystemExit(main())
