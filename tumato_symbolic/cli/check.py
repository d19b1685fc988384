"""`tumato-sym check`: read specifications and report what is wrong with them."""

from __future__ import annotations

import sys

from tumato_symbolic.cli.console import wants_colour, write
from tumato_symbolic.cli.exits import USAGE, YES
from tumato_symbolic.cli.parser import Options
from tumato_symbolic.diagnostics import UserError
from tumato_symbolic.report.checked import Checked, as_github, as_json, as_text
from tumato_symbolic.report.layout import dump
from tumato_symbolic.spec import load
from tumato_symbolic.syntax import read_source


def run(options: Options) -> int:
    """Check every file; one that cannot be used does not keep the others from being checked."""
    files = [_check(path) for path in options.specs]
    match options.output_format:
        case "json":
            write(dump(as_json(files)))
        case "github":
            write(as_github(files))
        case _:
            write(as_text(files, wants_colour(sys.stdout)))
    return USAGE if any(file.failed for file in files) else YES


def _check(path: str) -> Checked:
    try:
        source = read_source(path)
    except UserError as error:
        return Checked(path, error.source, None, error.diagnostics)
    loaded = load(source)
    return Checked(path, source, loaded.spec, loaded.diagnostics)
