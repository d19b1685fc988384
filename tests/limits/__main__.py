"""`python -m tests.limits`: large inputs with short limits, as many as wanted; see `campaign`."""

from __future__ import annotations

import argparse
import sys
import tempfile
from pathlib import Path

from tests.limits.campaign import campaign, on_files


def main() -> int:
    """Print what is wrong, and how long the commands took; exit with 1 where something is wrong."""
    parser = argparse.ArgumentParser(prog="python -m tests.limits", description=__doc__)
    parser.add_argument("--count", type=int, default=42, help="how many generated specifications")
    parser.add_argument("--seed", type=int, default=0, help="the number of the first one")
    parser.add_argument("--limits", type=float, nargs="+", default=[1.0], help="the time limits, which take turns")
    parser.add_argument("--files", type=Path, nargs="+", help="these instead: every command with every limit")
    options = parser.parse_args()
    limits, worst, wrong, total = tuple(options.limits), 0.0, 0, 0
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder)
        found = (
            on_files(iter(options.files), limits, place)
            if options.files
            else campaign(options.count, options.seed, limits, place)
        )
        for ran in found:
            total += 1
            problems = (*ran.problems, *(["it is late"] if ran.is_late else []))
            wrong += bool(problems)
            worst = max(worst, ran.seconds)
            print(f"{ran.seconds:6.2f} s  exit {ran.code}  {ran.command}", *problems, sep="\n    ", flush=True)
    print(f"{total} commands, {wrong} with problems; the longest took {worst:.2f} s")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
