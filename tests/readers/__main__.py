"""Many damaged files through both readers: `python -m tests.readers --texts 20000 --files 5000 --seed 0`.

Prints figures; exits with 1 where one reader accepts what the other refuses, or reads another meaning in it.
"""

from __future__ import annotations

import argparse
import tempfile
import time
import traceback
from collections.abc import Callable, Sequence
from multiprocessing import Pool
from pathlib import Path

from tests.readers.campaign import Tally, examine_file, examine_text

KINDS: dict[str, Callable[[int, Path], Tally]] = {"texts": examine_text, "files": examine_file}
TOGETHER = 50
"""So many seeds are one job."""


def work(job: tuple[str, int, int]) -> Tally:
    """Some seeds; an exception is a complaint."""
    kind, first, count = job
    total = Tally()
    with tempfile.TemporaryDirectory() as folder:
        for seed in range(first, first + count):
            try:
                total.add(KINDS[kind](seed, Path(folder)))
            except Exception:
                total.complaints.append(f"{kind} {seed}: {traceback.format_exc()}")
    return total


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the campaign."""
    parser = argparse.ArgumentParser(prog="python -m tests.readers", description=__doc__)
    parser.add_argument("--texts", type=int, default=20_000, help="how many specifications (default 20000)")
    parser.add_argument("--files", type=int, default=5_000, help="how many policies and certificates (default 5000)")
    parser.add_argument("--seed", type=int, default=0, help="the first seed (default 0)")
    parser.add_argument("--processes", type=int, default=2)
    options = parser.parse_args(arguments)
    jobs = []
    for kind, count in (("texts", options.texts), ("files", options.files)):
        firsts = range(options.seed, options.seed + count, TOGETHER)
        jobs += [(kind, first, min(TOGETHER, options.seed + count - first)) for first in firsts]
    total, started = Tally(), time.monotonic()
    with Pool(options.processes) as pool:
        for tally in pool.imap_unordered(work, jobs):
            total.add(tally)
            for complaint in tally.complaints:
                print(complaint, flush=True)
    for kind, count in sorted(total.kinds.items()):
        print(f"  {kind}: {count}")
    done = sum(total.kinds.values())
    print(f"{done} files, the readers differ on {len(total.complaints)}; {time.monotonic() - started:.0f} s")
    return 1 if total.complaints else 0


if __name__ == "__main__":
    raise SystemExit(main())
