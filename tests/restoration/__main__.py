"""`python -m tests.restoration --count N --seed S`: that many seeds, every profile, restoration and ordering."""

import argparse
import sys

from tests.restoration.campaign import Tally, examine, specifications


def main() -> int:
    """Exit with 1 where something is wrong."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=50)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--profile", default="", help="only profiles that begin so")
    options = parser.parse_args()
    tally = Tally()
    for seed in range(options.seed, options.seed + options.count):
        for name, spec in specifications(seed):
            if not name.startswith(options.profile):
                continue
            for ordering in ("any", "first"):
                tally.complaints += [f"{name}, {ordering}: {each}" for each in examine(spec, ordering, tally)]
    for (restoration, answer), count in sorted(tally.answers.items()):
        print(f"{restoration:9} {answer:15} {count}")
    print("\n".join(tally.complaints) or "nothing is wrong")
    return 1 if tally.complaints else 0


if __name__ == "__main__":
    sys.exit(main())
