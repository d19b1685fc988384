"""The same specification, the same bytes: `python -m tests.repeats --count 200 --calls 10`.

Takes generated specifications in which decisions are repaired. Each is asked `--calls` times in this process, and once
in each of `--calls` fresh ones, which differ in PYTHONHASHSEED and in what they were asked before; on both backends.
Prints figures; exits with 1 where an answer differs.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import time
from collections.abc import Sequence
from itertools import count, islice
from random import Random

from tests.repeats.answers import answer, is_repaired
from tumato_symbolic.symbolic import Backend

BACKENDS: tuple[Backend, ...] = ("cudd", "autoref")
Answers = dict[str, str]
"""The digest of each answer, by seed and backend."""


def answers(seeds: Sequence[int], order: int) -> Answers:
    """All answers, asked in an order of its own."""
    asked = [(seed, backend) for seed in seeds for backend in BACKENDS]
    Random(order).shuffle(asked)
    return {f"{seed} {backend}": answer(seed, backend) for seed, backend in asked}


def in_fresh_process(seeds: Sequence[int], order: int) -> Answers:
    """The same from a new process with another hash seed."""
    command = [sys.executable, "-m", "tests.repeats", "--order", str(order), "--seeds", *map(str, seeds)]
    environment = {**os.environ, "PYTHONHASHSEED": str(order + 1)}
    found: Answers = json.loads(subprocess.run(command, env=environment, check=True, capture_output=True).stdout)
    return found


def differing(seeds: Sequence[int], calls: int, processes: int) -> set[int]:
    """The specifications that have two answers."""
    wanted = {seed: answer(seed, "cudd") for seed in seeds}
    rounds = [answers(seeds, order) for order in range(calls - 1)]
    rounds += [in_fresh_process(seeds, order) for order in range(processes)]
    return {seed for seed in seeds for told in rounds for b in BACKENDS if told[f"{seed} {b}"] != wanted[seed]}


def main(arguments: Sequence[str] | None = None) -> int:
    """Compare the answers, or give them (`--seeds`)."""
    parser = argparse.ArgumentParser(prog="python -m tests.repeats", description=__doc__)
    parser.add_argument("--count", type=int, default=200, help="how many specifications (default 200)")
    parser.add_argument("--calls", type=int, default=10, help="how many calls and processes (default 10)")
    parser.add_argument("--seed", type=int, default=0, help="the first seed (default 0)")
    parser.add_argument("--seeds", type=int, nargs="*", help="print the answers for these seeds, as JSON")
    parser.add_argument("--order", type=int, default=0, help="the order in which they are asked")
    options = parser.parse_args(arguments)
    if options.seeds is not None:
        print(json.dumps(answers(options.seeds, options.order)))
        return 0
    started = time.monotonic()
    seeds = list(islice(filter(is_repaired, count(options.seed)), options.count))
    found = differing(seeds, options.calls, options.calls)
    print(f"{len(seeds)} specifications up to seed {seeds[-1]}, {len(found)} differ: {sorted(found)}")
    print(f"{options.calls} calls and {options.calls} processes on {len(BACKENDS)} backends; ", end="")
    print(f"{time.monotonic() - started:.0f} s")
    return 1 if found else 0


if __name__ == "__main__":
    raise SystemExit(main())
