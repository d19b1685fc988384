"""`python -m tests.restoration --count N --seed S`: that many seeds, every profile, restoration and ordering."""

import argparse
import sys
from typing import get_args

from tests.restoration.campaign import MOST_POLICIES, Tally, examine, specifications
from tumato_symbolic.spec import Restoration


def main() -> int:
    """Exit with 1 where something is wrong."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=50)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--profile", default="", help="only profiles that begin so")
    parser.add_argument("--restoration", choices=get_args(Restoration), help="only this one")
    parser.add_argument("--policies", type=int, default=MOST_POLICIES, help="so many at most are all tried")
    options = parser.parse_args()
    tally = Tally()
    for seed in range(options.seed, options.seed + options.count):
        for name, spec in specifications(seed):
            if not name.startswith(options.profile) or options.restoration not in (None, spec.restoration):
                continue
            for ordering in ("any", "first"):
                tally.complaints += [
                    f"{name}, {ordering}: {each}"
                    for each in examine(spec, ordering, tally, most_policies=options.policies)
                ]
    for (restoration, tiers, answer), count in sorted(tally.answers.items()):
        tried = tally.tried[restoration, tiers, answer]
        print(f"{restoration:9} {tiers} tiers  {answer:15} {count:6}, of {tried} all policies were tried")
    print("\n".join(tally.complaints) or "nothing is wrong")
    return 1 if tally.complaints else 0


if __name__ == "__main__":
    sys.exit(main())
