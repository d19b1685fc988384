"""Many changed certificates: `python -m tests.ranks --count 5000`.

Prints figures; exits with 1 where a judge says anything else than the explicit meaning.
"""

from __future__ import annotations

import argparse
import tempfile
import time
import traceback
from collections.abc import Callable, Sequence
from functools import partial
from itertools import count, islice
from multiprocessing import Pool
from pathlib import Path

from tests.ranks import campaign, unrealizable
from tests.ranks.campaign import Tally

Examine = Callable[[int, int, Path], Tally]


def run(examine: Examine, each: int, seed: int) -> Tally:
    """The cases of one seed; an exception is a complaint."""
    try:
        with tempfile.TemporaryDirectory() as folder:
            return examine(seed, each, Path(folder))
    except Exception:
        return Tally(complaints=[f"{seed}: {traceback.format_exc()}"])


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the campaign."""
    parser = argparse.ArgumentParser(prog="python -m tests.ranks", description=__doc__)
    parser.add_argument("--count", type=int, default=5000, help="how many certificates (default 5000)")
    parser.add_argument("--each", type=int, default=6, help="how many beside one policy (default 6)")
    parser.add_argument("--seed", type=int, default=0, help="the first seed (default 0)")
    parser.add_argument("--answer", choices=("policy", "no"), default="policy", help="certificates of which answer")
    parser.add_argument("--processes", type=int, default=1)
    options = parser.parse_args(arguments)
    examine: Examine = campaign.examine if options.answer == "policy" else unrealizable.examine
    total, started = Tally(), time.monotonic()
    with Pool(options.processes) as pool:
        seeds = count(options.seed)
        while total.cases < options.count:
            batch = list(islice(seeds, 8 * options.processes))
            for tally in pool.imap_unordered(partial(run, examine, options.each), batch):
                total.add(tally)
                for complaint in tally.complaints:
                    print(complaint, flush=True)
            print(f"to seed {batch[-1]}: {_figures(total, started)}", flush=True)
    for of, what, holds in sorted(total.kinds):
        print(f"  {of} {what} {'holds' if holds else 'fails'}: {total.kinds[of, what, holds]}")
    print(_figures(total, started))
    return 1 if total.complaints else 0


def _figures(total: Tally, started: float) -> str:
    return f"{total.cases} certificates, {len(total.complaints)} complaints; {time.monotonic() - started:.0f} s"


if __name__ == "__main__":
    raise SystemExit(main())
