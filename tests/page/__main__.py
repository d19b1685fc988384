"""Many changed policies before both judges: `python -m tests.page --count 500`. Exits with 1 where they differ."""

from __future__ import annotations

import argparse
from itertools import count

from tests.page.judged import Tally, asked, compare


def main() -> int:
    """Run the campaign."""
    parser = argparse.ArgumentParser(prog="python -m tests.page", description=__doc__)
    parser.add_argument("--count", type=int, default=500, help="how many policies (default 500)")
    parser.add_argument("--seed", type=int, default=0, help="the first seed (default 0)")
    parser.add_argument("--each", type=int, default=3, help="how many of one specification (default 3)")
    options = parser.parse_args()
    tally = Tally()
    for seed in count(options.seed):
        compare([*asked(seed, options.each)], tally)
        if tally.judged >= options.count:
            break
    print("\n".join(tally.complaints) or "the judges agree")
    print(f"{tally.judged} policies, {tally.wrong} of them wrong: {dict(sorted(tally.faults.items()))}")
    return 1 if tally.complaints else 0


if __name__ == "__main__":
    raise SystemExit(main())
