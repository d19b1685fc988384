"""`tumato-sym check`: read specifications and report what is wrong with them."""

from __future__ import annotations

import sys
from collections.abc import Sequence

from tumato_symbolic.cli.console import note, wants_colour, write
from tumato_symbolic.cli.exits import UNDECIDED, USAGE, YES
from tumato_symbolic.cli.parser import Options
from tumato_symbolic.diagnostics import UserError
from tumato_symbolic.limits import Context
from tumato_symbolic.report.checked import Checked, as_github, as_json, as_text
from tumato_symbolic.report.layout import dump
from tumato_symbolic.semantics.suspicions import suspicions
from tumato_symbolic.spec import load
from tumato_symbolic.syntax import read_source


def run(options: Options, context: Context) -> int:
    """Check every file; one that cannot be used does not keep the others from being checked."""
    files: list[Checked] = []
    for path in options.specs:
        context.tell(f"reading {path}")
        files.append(_check(path))
        context.learn(tuple(files))
    return _report(files, options)


def stopped(known: tuple[Checked, ...], why: str, options: Options) -> int:
    """Report the files that were checked by then."""
    left = len(options.specs) - len(known)
    code = _report(known, options, f"{left} of {len(options.specs)} specifications were not checked: {why}")
    return code if code == USAGE else UNDECIDED


def _report(files: Sequence[Checked], options: Options, undecided: str | None = None) -> int:
    match options.output_format:
        case "json":
            more = {} if undecided is None else {"verdict": "undecided", "limit": undecided}
            write(dump({**as_json(files), **more}))
        case "github":
            write(as_github(files))
        case _:
            write(as_text(files, wants_colour(sys.stdout)))
    if undecided is not None:
        note(f"tumato-sym: {undecided}")
    return USAGE if any(file.failed for file in files) else YES


def _check(path: str) -> Checked:
    try:
        source = read_source(path)
    except UserError as error:
        return Checked(path, error.source, None, error.diagnostics)
    loaded = load(source)
    if loaded.spec is None:
        from tumato_symbolic.cli.mixups import misplaced

        other = misplaced(path)
        return Checked(path, source, None, loaded.diagnostics if other is None else (other,))
    return Checked(path, source, loaded.spec, (*loaded.diagnostics, *suspicions(loaded.spec)))
