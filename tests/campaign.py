"""Many generated specifications through the whole tool: `python -m tests.campaign --count 2000 --seed 0`.

Prints a summary table; exits with 1 if anything disagrees with the explicit meaning. Not part of the test suite.
"""

from __future__ import annotations

import argparse
import time
import traceback
from collections import Counter
from collections.abc import Iterable, Sequence
from multiprocessing import Pool
from pathlib import Path

from tests.differential import Case, Report, examine
from tests.profiles import ALL_PROFILES
from tumato_symbolic.spec import Ordering

Job = tuple[Case, int]

ROTATION = ("mixed", "interacting", "restoring", "interacting", "concurrent", "interacting")
"""The profiles in turn; goals that interact are rare, so that their profile comes more often."""


def run(job: Job) -> Report:
    """One case; an exception is a complaint."""
    case, mutants = job
    try:
        return examine(case, mutants)
    except Exception:
        return Report(case, "crashed", complaints=[traceback.format_exc()])


def cases(count: int, seed: int, orderings: Sequence[Ordering], profiles: Sequence[str]) -> Iterable[Case]:
    """`count` specifications, the profiles in turn, each under every ordering."""
    for number in range(seed, seed + count):
        for ordering in orderings:
            yield Case(profiles[number % len(profiles)], number, ordering)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the campaign."""
    parser = argparse.ArgumentParser(prog="python -m tests.campaign", description=__doc__)
    parser.add_argument("--count", type=int, default=2000, help="how many specifications (default 2000)")
    parser.add_argument("--seed", type=int, default=0, help="the first seed (default 0)")
    parser.add_argument("--ordering", choices=("any", "first", "both"), default="both")
    parser.add_argument("--profile", choices=(*ALL_PROFILES, "all"), default="all")
    parser.add_argument("--mutants", type=int, default=3, help="changed policies per realizable case (default 3)")
    parser.add_argument("--processes", type=int, default=2)
    parser.add_argument("--failures", type=Path, help="a file for the cases that disagree")
    options = parser.parse_args(arguments)
    orderings: tuple[Ordering, ...] = ("any", "first") if options.ordering == "both" else (options.ordering,)
    profiles = ROTATION if options.profile == "all" else (options.profile,)
    jobs = [(case, options.mutants) for case in cases(options.count, options.seed, orderings, profiles)]
    started, totals, bad = time.monotonic(), Counter[tuple[str, str]](), 0
    interacting: set[int] = set()
    with Pool(options.processes) as pool:
        for done, report in enumerate(pool.imap_unordered(run, jobs, chunksize=4), 1):
            bad += bool(report.complaints)
            interacting |= {report.case.seed} if report.interacting else set()
            _count(totals, report)
            _tell(report, options.failures)
            if done % 200 == 0:
                print(f"{done} of {len(jobs)} in {time.monotonic() - started:.0f} s, {bad} disagree", flush=True)
    print(_table(totals, tuple(dict.fromkeys(profiles))))
    print(f"{options.count} specifications, in {len(interacting)} of them goals interact")
    print(f"{len(jobs)} cases, {bad} disagree, {time.monotonic() - started:.0f} s")
    return 1 if bad else 0


def _count(totals: Counter[tuple[str, str]], report: Report) -> None:
    profile = report.case.profile
    totals[profile, "cases"] += 1
    totals[profile, report.kind] += 1
    totals[profile, "interacting"] += report.interacting
    totals[profile, "referenced"] += report.referenced
    totals[profile, "right policies"] += report.right_policies
    totals[profile, "wrong policies"] += report.wrong_policies
    totals[profile, "disagree"] += bool(report.complaints)


def _tell(report: Report, failures: Path | None) -> None:
    if not report.complaints:
        return
    text = "\n".join((str(report.case), *(f"  {complaint}" for complaint in report.complaints)))
    print(text, flush=True)
    if failures is not None:
        with failures.open("a", encoding="utf-8") as file:
            file.write(text + "\n")


def _table(totals: Counter[tuple[str, str]], profiles: Sequence[str]) -> str:
    rows = (
        *("cases", "realizable", "interacting", "failing", "conflict", "crashed", "referenced"),
        *("right policies", "wrong policies", "disagree"),
    )
    lines = ["".join((f"{'':16}", *(f"{profile:>13}" for profile in (*profiles, "all"))))]
    for row in rows:
        counts = [totals[profile, row] for profile in profiles]
        lines.append("".join((f"{row:16}", *(f"{count:13}" for count in (*counts, sum(counts))))))
    return "\n".join(lines)


if __name__ == "__main__":
    raise SystemExit(main())
