"""Many mutants: `python -m tests.mutants --count 20000`.

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

from tests.mutants.campaign import Tally, examine
from tests.mutants.refusals import examine_conflict, examine_refusal
from tests.profiles import ALL_PROFILES

CONFLICT = "conflict"
Job = tuple[str, int, int]


def run(job: Job) -> Tally:
    """The mutants of one specification; an exception is a complaint."""
    profile, seed, each = job
    try:
        with tempfile.TemporaryDirectory() as folder:
            if profile == CONFLICT:
                return examine_conflict(seed, each, Path(folder))
            tally = examine(profile, seed, each, Path(folder))
            tally.add(examine_refusal(profile, seed, each // 4, Path(folder)))
            return tally
    except Exception:
        return Tally(complaints=[f"{profile} {seed}: {traceback.format_exc()}"])


def jobs(first: int, each: int) -> Iterator[Job]:
    """The profiles in turn, without end, and a conflict after each round."""
    return ((profile, seed, each) for seed in count(first) for profile in (*ALL_PROFILES, CONFLICT))


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the campaign."""
    parser = argparse.ArgumentParser(prog="python -m tests.mutants", description=__doc__)
    parser.add_argument("--count", type=int, default=20_000, help="how many mutants (default 20000)")
    parser.add_argument("--each", type=int, default=24, help="how many of one specification (default 24)")
    parser.add_argument("--seed", type=int, default=0, help="the first seed (default 0)")
    parser.add_argument("--processes", type=int, default=2)
    options = parser.parse_args(arguments)
    total, started, told = Tally(), time.monotonic(), 0
    with Pool(options.processes) as pool:
        everything = jobs(options.seed, options.each)
        while total.mutants < options.count:
            for tally in pool.imap_unordered(run, islice(everything, 16 * options.processes)):
                total.add(tally)
                for complaint in tally.complaints:
                    print(complaint, flush=True)
            if total.mutants >= told + 500:
                told = total.mutants
                print(_figures(total, started), flush=True)
    for kind in sorted({kind for kind, _ in total.kinds}):
        print(f"  {kind}: {total.kinds[kind, True]} right, {total.kinds[kind, False]} wrong")
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
