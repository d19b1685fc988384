"""Faults planted in the trusted base: `python -m tests.mutants_code --sample 300 --seed 1`.

Every module's share is drawn; the tests that are meant for a module run against each of its faults. Prints the faults
that no test noticed and that are not listed as harmless, with the lines where they were planted, and how many died.
Exits with 1 where fewer than 95 of 100 that are not harmless die. A fault dies where a test fails, where the tests take
many times the processor time that they take without it, or where they wait for ever; how many of which is told. A
fault with which a module cannot be loaded does not count; an error of pytest itself is no death.

Why no library: what there is starts an interpreter and the whole test run for every fault (two seconds before the first
test), or changes functions only and needs one run of all tests to learn which test meets which function. Here a fault
is one fork, with the tests that are named in `covering.py`. They also know nothing of forgotten conjuncts.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections import Counter
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from random import Random

from tests.mutants_code.covering import Covered, covered
from tests.mutants_code.harmless import harmless
from tests.mutants_code.run import Ending, load_what_tests_need, run_tests
from tests.mutants_code.sites import Site, sites

ROOT = Path(__file__).parents[2]
TIMES = 3
"""So many times the processor time that its tests take without a fault, a fault may take."""
LEAST = 2
"""So many faults of every module at least, where it has as many places."""


def drawn(everything: dict[str, list[Site]], count: int, seed: int) -> list[tuple[str, Site]]:
    """About `count` faults, of every module its share."""
    total = sum(map(len, everything.values()))
    found = []
    for module, places in everything.items():
        share = max(LEAST, round(count * len(places) / total))
        found += [(module, site) for site in Random(f"{seed} {module}").sample(places, min(share, len(places)))]
    return found


def is_within(module: str, wanted: str | None) -> bool:
    """Whether a module is the one that is wanted, or in the package that is; `tumato_symbolic.` may be left out."""
    names = (wanted, f"tumato_symbolic.{wanted}")
    return wanted is None or any(f"{module}.".startswith(f"{name}.") for name in names)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the campaign."""
    parser = argparse.ArgumentParser(prog="python -m tests.mutants_code", description=__doc__)
    parser.add_argument("--sample", type=int, default=300, help="how many faults (default 300)")
    parser.add_argument("--seed", type=int, default=0, help="which ones are drawn (default 0)")
    parser.add_argument("--module", help="only this module, or this package with all in it")
    parser.add_argument("--named", default="", help="only faults with this in their names, all of them")
    parser.add_argument("--jobs", type=int, default=2, help="so many faults at a time (default 2)")
    parser.add_argument("--limit", type=float, help="seconds of the processor for a fault; not measured first")
    parser.add_argument("--list", action="store_true", help="only list the faults")
    options = parser.parse_args(arguments)
    modules = {each.module: each for each in covered(ROOT) if is_within(each.module, options.module)}
    if not modules:
        parser.error(f"there is no module {options.module} in the trusted base")
    everything = {module: sites(ROOT / each.path, module) for module, each in modules.items()}
    known = harmless()
    if options.named:
        chosen = [
            (module, site) for module, all_of in everything.items() for site in all_of if options.named in site.name
        ]
    else:
        chosen = drawn(everything, options.sample, options.seed)
    if options.list:
        print(*(f"{site.line}: {site.name}" for _, site in chosen), sep="\n")
        return 0
    load_what_tests_need()
    tests = sorted({modules[module].tests for module, _ in chosen})
    limits = dict.fromkeys(tests, options.limit) if options.limit else _limits(tests, options.jobs)
    return _campaign(chosen, modules, limits, known, options.jobs)


def _limits(lists: list[tuple[str, ...]], jobs: int) -> dict[tuple[str, ...], float]:
    """How many seconds of the processor each list of tests may take: a multiple of what it takes without a fault."""
    with ThreadPoolExecutor(jobs) as pool:
        endings = pool.map(lambda tests: run_tests(tests, None, "", 0, 600), lists)
    limits = {}
    for tests, ending in zip(lists, endings, strict=True):
        if ending.how != "survived":
            raise SystemExit(f"without a fault these tests fail ({ending.how}): {' '.join(tests)}")
        limits[tests] = TIMES * ending.seconds + 2
        print(f"{ending.seconds:.1f} s: {' '.join(tests)}", flush=True)
    return limits


def _campaign(
    chosen: list[tuple[str, Site]],
    modules: dict[str, Covered],
    limits: dict[tuple[str, ...], float],
    known: dict[str, str],
    jobs: int,
) -> int:
    started = time.monotonic()
    ends: Counter[str] = Counter()
    left_out: Counter[str] = Counter()
    seconds = 0.0
    mine: Counter[str] = Counter()
    died: Counter[str] = Counter()

    def run(item: tuple[str, Site]) -> Ending:
        module, site = item
        each = modules[module]
        return run_tests(each.tests, ROOT / each.path, module, site.number, limits[each.tests])

    with ThreadPoolExecutor(jobs) as pool:
        for (module, site), ending in zip(chosen, pool.map(run, chosen), strict=True):
            seconds += ending.seconds
            if ending.killed and site.name in known:
                print(f"KILLED, and listed as harmless: {site.name}", flush=True)
            if ending.how == "not loaded" or (not ending.killed and site.name in known):
                left_out["harmless" if site.name in known else ending.how] += 1
                continue
            ends[ending.how] += 1
            mine[module] += 1
            died[module] += ending.killed
            if not ending.killed:
                print(f"{ending.how.upper()} line {site.line}: {site.name}", flush=True)
    for module in sorted(mine):
        print(f"{died[module]:4} of {mine[module]:4}  {module}")
    total, killed = sum(mine.values()), sum(died.values())
    share = 100 * killed / max(1, total)
    print(f"{len(chosen)} faults; left out: {dict(left_out)}")
    print(f"{killed} of {total} others died ({share:.1f} %): {dict(ends)}")
    print(f"{seconds:.0f} s of the processor, {time.monotonic() - started:.0f} s")
    return 0 if share >= 95 else 1


if __name__ == "__main__":
    sys.exit(main())
