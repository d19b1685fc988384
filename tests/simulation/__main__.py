"""`python -m tests.simulation --count N --seed S`: the policies of that many specifications, executed."""

import argparse
import sys

from tests.simulation.campaign import Tally, examine


def main() -> int:
    """Exit with 1 where something is wrong."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=200)
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    tally = Tally()
    for seed in range(options.seed, options.seed + options.count):
        examine(seed, tally)
    print(f"{options.count} policies; {tally.traces.total()} traces replayed: {dict(sorted(tally.traces.items()))}")
    print(f"the worst case of {tally.states.total()} states is as guaranteed: {dict(sorted(tally.states.items()))}")
    print(f"{tally.without} states, of which nothing is guaranteed: a decision that is not allowed may be reached")
    print("\n".join(tally.complaints) or "nothing is wrong")
    return 1 if tally.complaints else 0


if __name__ == "__main__":
    sys.exit(main())
