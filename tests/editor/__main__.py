"""The layout of many generated texts: `python -m tests.editor 5000`."""

from __future__ import annotations

import sys

from tests.editor.formatted import complaint_of


def main(count: int) -> int:
    """Tell every complaint; 1 where there is one."""
    found = {seed: wrong for seed in range(count) if (wrong := complaint_of(seed)) is not None}
    for seed, wrong in found.items():
        print(f"seed {seed}: {wrong}")
    print(f"{count} texts, {len(found)} complaints")
    return int(bool(found))


if __name__ == "__main__":
    sys.exit(main(int(sys.argv[1]) if len(sys.argv) > 1 else 5000))
