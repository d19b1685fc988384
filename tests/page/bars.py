"""Pages of every example and of large specifications in Chromium: `python -m tests.page.bars`.

Prints what is seen of each; exits with 1 where a page has an error, asks for something, is too large or too slow.
"""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from benchmarks.families import FAMILIES
from tests.page.in_browser import missing, seen
from tests.repo.documents import ROOT
from tumato_symbolic.cli.main import main as tumato_sym

FAMILY_SIZES = (("amr", 1, False), ("uav", 1, True), ("uav", 1, False), ("plant", 10, True), ("plant", 10, False))
LARGEST = {"amr": 80_000, "plant10": 1_000_000}
SLOWEST = 2_000
"""Milliseconds until a page of 221,184 states is painted first."""


def texts() -> Iterator[tuple[str, str]]:
    """The specifications, with names."""
    for path in sorted((ROOT / "examples").glob("*.tum")):
        yield path.stem, path.read_text(encoding="utf-8")
    for family, size, realizable in FAMILY_SIZES:
        yield f"{family}{size}{'' if realizable else '_twin'}", FAMILIES[family].text(size, realizable)


def edited(policy: Path) -> Path:
    """The policy with one decision changed, or the decisions on two actions exchanged."""
    document = json.loads(policy.read_text(encoding="utf-8"))
    if document["Type"] == "policy":
        row = document["Policy"][-1]
        row["Actions"] = [] if row["Actions"] else document["Actions"][:1]
    else:
        roots = document["Diagram"]["Roots"]
        one, other = list(roots)[:2]
        roots[one], roots[other] = roots[other], roots[one]
    changed = policy.with_suffix(".edited.json")
    changed.write_text(json.dumps(document), encoding="utf-8")
    return changed


def problems(name: str, size: int, found: dict[str, Any], policy: bool) -> Iterator[str]:
    """What does not meet a bar."""
    yield from (f"error: {each}" for each in found["errors"])
    yield from (f"request: {each}" for each in found["requests"])
    if size > LARGEST.get(name, size):
        yield f"{size:,} bytes"
    if name == "uav1" and found["painted"] > SLOWEST:
        yield f"painted after {found['painted']:.0f} ms"
    if policy and ("nothing wrong" not in found["check"] or "otherwise" not in found["compared"]):
        yield "it finds something wrong, or no difference"


def main() -> int:
    """Make the pages, open them, and say how they do."""
    parser = argparse.ArgumentParser(prog="python -m tests.page.bars", description=__doc__)
    parser.add_argument("names", nargs="*", help="which of them (default: all)")
    names = parser.parse_args().names
    if (lacking := missing()) is not None:
        sys.exit(lacking)
    complaints = 0
    with tempfile.TemporaryDirectory() as folder:
        for name, text in ((name, text) for name, text in texts() if not names or name in names):
            spec, policy, page = (Path(folder, f"{name}.{suffix}") for suffix in ("tum", "json", "html"))
            spec.write_text(text, encoding="utf-8")
            tumato_sym(["synth", str(spec), "-o", str(policy), "--html", str(page)])
            (found,) = seen([(page, edited(policy) if policy.exists() else spec)])
            size = page.stat().st_size
            print(f"{name}: {size:,} bytes, painted after {found['painted']:.0f} ms. {found['title']}", file=sys.stderr)
            print(f"  {found['check']}\n  {found.get('compared', '')[:90]}", file=sys.stderr)
            for problem in problems(name, size, found, policy.exists()):
                complaints += 1
                print(f"  PROBLEM {problem}", file=sys.stderr)
    return 1 if complaints else 0


if __name__ == "__main__":
    raise SystemExit(main())
