"""`python -m tests.starts --count N --seed S`: that many seeds, every profile, both orderings."""

import argparse
import sys
import tempfile
from pathlib import Path

from tests.starts.campaign import Tally, examine, specifications


def main() -> int:
    """Exit with 1 where something is wrong."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=50)
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    tally, count = Tally(), 0
    with tempfile.TemporaryDirectory() as folder:
        for seed in range(options.seed, options.seed + options.count):
            for name, spec in specifications(seed):
                for ordering in ("any", "first"):
                    count += 1
                    tally.complaints += [
                        f"{name}, {ordering}: {each}"
                        for each in examine(spec, ordering, tally, Path(folder), seed=seed)
                    ]
    print(f"{count} specifications: {dict(sorted(tally.answers.items()))}")
    print(f"of {tally.tried} every closed set and policy was tried; {tally.parts} policies decide only a part")
    print(f"certificates that there is no policy: {dict(sorted(tally.certificates.items()))}")
    print(f"{tally.changed.total()} of them changed, and {tally.changed[True]} still proofs")
    print(f"{tally.judged} policies judged, rejected: {dict(sorted(tally.rejected.items()))}")
    print("\n".join(tally.complaints) or "nothing is wrong")
    return 1 if tally.complaints else 0


if __name__ == "__main__":
    sys.exit(main())
