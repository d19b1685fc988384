"""The playground against its bars, in Chromium: `python -m tests.playground`. Exits with 1 where one is missed."""

from __future__ import annotations

import argparse
import sys
import tempfile
from pathlib import Path

from tests.playground.in_browser import missing, used

READY, WARM = 6_000, 500
"""Milliseconds until a text can be synthesized, and until the policy of the AMR is found and proved, once warm."""


def main() -> int:
    """Measure, and say what was measured."""
    parser = argparse.ArgumentParser(prog="python -m tests.playground", description=__doc__)
    parser.add_argument("--pictures", type=Path, help="a folder for pictures, light and dark")
    options = parser.parse_args()
    if (lacking := missing()) is not None:
        sys.exit(lacking)
    if options.pictures is not None:
        options.pictures.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        found = used(Path(folder), options.pictures)
    print(f"ready after {found['ready']:.0f} ms; the AMR takes {found['cold']} ms, then {found['warm']} ms")
    print("\n".join([*found["errors"], *found["requests"]]) or "no error, no request to another host")
    met = found["ready"] <= READY and max(found["warm"]) <= WARM and not found["errors"] and not found["requests"]
    return 0 if met else 1


if __name__ == "__main__":
    raise SystemExit(main())
