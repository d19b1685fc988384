"""Many policies through the checker of `proofs/coq`: `python -m tests.export.campaign --policies 500 --theorems 20`.

Prints how many were right and wrong; exits with 1 if Coq and the explicit meaning disagree. Not part of the test suite.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Iterator, Sequence
from itertools import count, islice

from tests.checker.stepwise import MODES
from tests.export.cases import generated, is_right, stepwise
from tests.export.compiler import Case, Library
from tests.profiles import ALL_PROFILES


def cases(first_seed: int, policies: int = 12) -> Iterator[Case]:
    """The profiles in turn, so many policies of each, and the ways to restore safety, without end."""
    for seed in count(first_seed):
        for profile in ALL_PROFILES:
            yield from generated(profile, seed, policies)
        for restoration, tiers in MODES:
            yield from stepwise(seed, restoration, tiers)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the campaign."""
    parser = argparse.ArgumentParser(prog="python -m tests.export.campaign", description=__doc__)
    parser.add_argument("--policies", type=int, default=500, help="how many are checked, many per file (default 500)")
    parser.add_argument("--theorems", type=int, default=20, help="of how many the theorem is compiled (default 20)")
    parser.add_argument("--seed", type=int, default=0, help="the first seed (default 0)")
    options = parser.parse_args(arguments)
    return _run(Library.shared(), options.policies, options.theorems, options.seed)


def _run(library: Library, policies: int, theorems: int, seed: int) -> int:
    started, right, bad = time.monotonic(), 0, 0
    taken = list(islice(cases(seed), policies))
    for start in range(0, policies, 50):
        some = taken[start : start + 50]
        expected = [is_right(case) for case in some]
        right += sum(expected)
        bad += sum(one != other for one, other in zip(library.checks(some), expected, strict=True))
    print(f"{policies} policies, {right} right, {policies - right} wrong, {bad} disagree", flush=True)
    chosen = list(islice((case for case in taken if is_right(case)), theorems))
    proved = sum("Closed under the global context" in library.compile(case.text).stdout for case in chosen)
    print(f"{len(chosen)} theorems, {proved} compiled; {time.monotonic() - started:.0f} s")
    return 1 if bad or proved < len(chosen) else 0


if __name__ == "__main__":
    raise SystemExit(main())
