"""Explanations of many generated specifications against the explicit meaning: `python -m tests.explain.campaign`.

Prints what was checked; exits with 1 if anything is wrong. Not part of the test suite.
"""

from __future__ import annotations

import argparse
import time
import traceback
from collections import Counter
from collections.abc import Sequence
from multiprocessing import Pool

from tests.explain.oracle import complaints
from tests.generate import PROFILES, random_spec
from tumato_symbolic.explain.explain import explain
from tumato_symbolic.explain.explanation import Explanation
from tumato_symbolic.spec import Ordering

Job = tuple[str, int, Ordering, int]
ROTATION = ("mixed", "interacting", "restoring", "interacting", "concurrent", "mixed")


def examine(job: Job) -> tuple[Job, Counter[str], list[str]]:
    """One specification: what was checked, and what is wrong."""
    profile, seed, ordering, cores = job
    counts: Counter[str] = Counter()
    try:
        explanation = explain(random_spec(seed, PROFILES[profile]), ordering, cores=cores)
        if not isinstance(explanation, Explanation):
            return job, Counter({"realizable": 1}), []
        counts["unrealizable"] += 1
        for reason in explanation.reasons:
            counts[f"reasons: {reason.kind}"] += 1
            counts["cubes"] += len(reason.cubes)
            counts[f"cores of {reason.kind}"] += len(reason.cores)
            counts["empty cores"] += sum(not core for core in reason.cores)
        for repair in explanation.repairs:
            counts["repairs that add"] += bool(repair.additions)
            counts["repairs that drop lines"] += repair.drops
            counts["repairs that change lines"] += any(change.text is not None for change in repair.changes)
            counts["repairs that give up safety"] += repair.gives_up_safety
        counts["unavoidable"] += explanation.unavoidable is not None
        counts["realizable parts"] += explanation.part is not None
        counts["parts with a choice"] += explanation.part is not None and not explanation.part.unique
        return job, counts, list(complaints(explanation))
    except Exception:
        return job, counts, [traceback.format_exc()]


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the campaign."""
    parser = argparse.ArgumentParser(prog="python -m tests.explain.campaign", description=__doc__)
    parser.add_argument("--count", type=int, default=2000, help="how many specifications (default 2000)")
    parser.add_argument("--seed", type=int, default=0, help="the first seed (default 0)")
    parser.add_argument("--cores", type=int, default=2, help="how many cores for each reason (default 2)")
    parser.add_argument("--processes", type=int, default=2)
    parser.add_argument("--unrealizable", type=int, help="stop after so many unrealizable ones")
    options = parser.parse_args(arguments)
    orderings: tuple[Ordering, ...] = ("any", "first")
    jobs = [
        (ROTATION[seed % len(ROTATION)], seed, orderings[seed // len(ROTATION) % 2], options.cores)
        for seed in range(options.seed, options.seed + options.count)
    ]
    started, totals, bad = time.monotonic(), Counter[str](), 0
    with Pool(options.processes) as pool:
        for job, counts, wrong in pool.imap_unordered(examine, jobs, chunksize=2):
            totals += counts
            bad += bool(wrong)
            for complaint in wrong:
                print(job, complaint, flush=True)
            if options.unrealizable and totals["unrealizable"] >= options.unrealizable:
                pool.terminate()
                break
    for what, number in sorted(totals.items()):
        print(f"{what:32}{number:8}")
    print(f"{bad} wrong, {time.monotonic() - started:.0f} s")
    return 1 if bad else 0


if __name__ == "__main__":
    raise SystemExit(main())
