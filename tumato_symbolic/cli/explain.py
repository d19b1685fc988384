"""`tumato-sym explain`: why there is no policy, and what would change that."""

from __future__ import annotations

import sys
from pathlib import Path

from tumato_symbolic.cli.console import note, wants_colour, write, writing
from tumato_symbolic.cli.exits import NO, UNDECIDED, YES
from tumato_symbolic.cli.inputs import errors_in, read_spec, show_warnings
from tumato_symbolic.cli.parser import Options
from tumato_symbolic.cli.targets import STANDARD_OUTPUT
from tumato_symbolic.diagnostics import Source
from tumato_symbolic.explain.explain import MAX_CUBES, explain
from tumato_symbolic.explain.explanation import Explanation, NothingToExplain, Unexplained
from tumato_symbolic.limits import Context
from tumato_symbolic.policy.saving import save_text
from tumato_symbolic.report.explained import Explained, as_text
from tumato_symbolic.report.layout import dump


def run(options: Options, context: Context) -> int:
    """Exit with 1 where there is no policy: that is the answer, and the explanation belongs to it."""
    context.tell("reading the specification")
    source, spec, warnings = read_spec(options.specs[0])
    with errors_in(source):
        found = explain(
            spec,
            options.effect_ordering,
            max_cubes=MAX_CUBES if options.max_cubes is None else options.max_cubes,
            cores=options.cores,
            wanted_repairs=options.repairs,
            context=context,
        )
    written = _write(options.write, source, found) if options.write else None
    done = Explained(source, spec, found, warnings, written, options.max_cubes is not None)
    show_warnings(warnings, source, options)
    _report(done, options)
    match found:
        case NothingToExplain():
            return YES
        case Unexplained():
            return UNDECIDED
        case _:
            return NO


def _write(path: str, source: Source, found: Explanation | NothingToExplain | Unexplained) -> str | None:
    """Write the specification with the assumption of its realizable part; nothing where there is none."""
    if not isinstance(found, Explanation) or found.part is None:
        return None
    from tumato_symbolic.explain.writing import with_assumption

    text = with_assumption(source, found.part.text)
    if path == STANDARD_OUTPUT:
        write(text)
    else:
        with writing():
            save_text(text, Path(path), "specification")
    return path


def _report(done: Explained, options: Options) -> None:
    to_stderr = options.write == STANDARD_OUTPUT
    put = note if to_stderr else write
    match options.output_format:
        case "json":
            from tumato_symbolic.report.explained_data import as_json

            put(dump(as_json(done)))
        case "github":
            from tumato_symbolic.report.explained_data import as_github

            put(as_github(done))
        case "sarif":
            from tumato_symbolic import __version__
            from tumato_symbolic.report.sarif import as_sarif

            put(dump(as_sarif(done, __version__)))
        case _:
            put(as_text(done, wants_colour(sys.stderr if to_stderr else sys.stdout)))
