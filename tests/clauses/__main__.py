"""Many specifications with clauses against the same written out: `python -m tests.clauses --seeds 1000 --seed 0`.

Prints figures; exits with 1 where something differs.
"""

from __future__ import annotations

import argparse
import tempfile
import traceback
from collections import Counter
from collections.abc import Sequence
from pathlib import Path

from tests.clauses.compare import examine


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the campaign."""
    parser = argparse.ArgumentParser(prog="python -m tests.clauses", description=__doc__)
    parser.add_argument("--seeds", type=int, default=1_000, help="how many specifications (default 1000)")
    parser.add_argument("--seed", type=int, default=0, help="the first seed (default 0)")
    options = parser.parse_args(arguments)
    kinds, policies, different = Counter[str](), 0, 0
    with tempfile.TemporaryDirectory() as folder:
        for seed in range(options.seed, options.seed + options.seeds):
            try:
                report = examine(seed, Path(folder))
            except Exception:
                different += 1
                print(f"{seed}: {traceback.format_exc()}", flush=True)
                continue
            kinds[report.kind] += 1
            policies += report.judged
            different += len(report.differences)
            for each in report.differences:
                print(each, flush=True)
    for kind, count in sorted(kinds.items()):
        print(f"  {kind}: {count}")
    print(f"{options.seeds} specifications, {policies} policies, {different} differences")
    return 1 if different else 0


if __name__ == "__main__":
    raise SystemExit(main())
