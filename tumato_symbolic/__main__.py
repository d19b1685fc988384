"""`python -m tumato_symbolic`, and the console script `tumato-sym`."""

from __future__ import annotations

import sys
from importlib import import_module

from tumato_symbolic.cli.exits import UNDECIDED


def entry() -> None:
    """Hand over to the command line, where it can be imported: every record is of msgspec."""
    try:
        import_module("msgspec")
    except ImportError:
        why = "msgspec is needed by every command, and cannot be imported here; install it with `pip install msgspec`"
        print(f"tumato-sym: {why}", file=sys.stderr)
        raise SystemExit(UNDECIDED) from None
    from tumato_symbolic.cli import main

    main.entry()


if __name__ == "__main__":
    entry()
