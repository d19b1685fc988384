"""`tumato-sym explain`: why there is no policy, and what would change that."""

from __future__ import annotations

import sys
import time
from dataclasses import dataclass, replace
from pathlib import Path

from tumato_symbolic.cli.console import note, wants_colour, write, writing
from tumato_symbolic.cli.exits import NO, UNDECIDED, YES
from tumato_symbolic.cli.inputs import errors_in, read_spec, show_warnings
from tumato_symbolic.cli.parser import Options
from tumato_symbolic.cli.targets import STANDARD_OUTPUT
from tumato_symbolic.diagnostics import Source
from tumato_symbolic.explain.explain import MAX_CUBES, explained
from tumato_symbolic.explain.explanation import Explanation, NothingToExplain, Unexplained
from tumato_symbolic.explain.explanation import stopped as what_is_known
from tumato_symbolic.limits import Context
from tumato_symbolic.policy.saving import save_text
from tumato_symbolic.report.explained import Explained, pieces
from tumato_symbolic.report.layout import dump

_BETWEEN = 0.5
"""Seconds between two records of what is known, where nothing is written."""


@dataclass(frozen=True, slots=True)
class _Known:
    """What is known by now, how many pieces of its text are written, and when that was recorded."""

    done: Explained
    written: int = 0
    recorded: float = 0.0


def run(options: Options, context: Context) -> int:
    """Exit with 1 where there is no policy: that is the answer, and the explanation belongs to it."""
    context.tell("reading the specification")
    source, spec, warnings = read_spec(options.specs[0])
    show_warnings(warnings, source, options)
    every_cube = options.max_cubes is not None
    known = _Known(Explained(source, spec, Unexplained(), warnings, None, every_cube))
    known = _learned(known, options, context)
    with errors_in(source):
        for found in explained(
            spec,
            options.effect_ordering,
            max_cubes=MAX_CUBES if options.max_cubes is None else options.max_cubes,
            cores=options.cores,
            wanted_repairs=options.repairs,
            context=context,
        ):
            done = replace(known.done, found=found)
            if options.write and done.written is None and isinstance(found, Explanation) and found.part is not None:
                _write(options.write, source, found.part.text)
                done = replace(done, written=options.write)
            known = _learned(replace(known, done=done), options, context)
    return _ended(known, options)


def stopped(known: _Known, why: str, options: Options) -> int:
    """Report what is known, or what of it is not written yet, when work has to end."""
    return _ended(replace(known, done=replace(known.done, found=what_is_known(known.done.found, why))), options)


def _learned(known: _Known, options: Options, context: Context) -> _Known:
    """Write the text of what is new, and record what is known; the other formats wait for the end."""
    before, now = known.written, time.monotonic()
    if options.output_format == "text":
        known = _written(known, options)
    if known.written > before or now - known.recorded >= _BETWEEN:
        known = replace(known, recorded=now)
        context.learn(known)
    return known


def _written(known: _Known, options: Options) -> _Known:
    to_stderr = options.write == STANDARD_OUTPUT
    found = pieces(known.done, wants_colour(sys.stderr if to_stderr else sys.stdout))
    if len(found) > known.written:
        (note if to_stderr else write)("\n".join(found[known.written :]))
    return replace(known, written=len(found))


def _ended(known: _Known, options: Options) -> int:
    """Write what is not written yet, and give the exit code."""
    done, put = known.done, note if options.write == STANDARD_OUTPUT else write
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
            _written(known, options)
    match done.found:
        case NothingToExplain():
            return YES
        case Unexplained():
            return UNDECIDED
        case _:
            return NO


def _write(path: str, source: Source, assumption: str) -> None:
    """Write the specification with the assumption of its realizable part."""
    from tumato_symbolic.explain.writing import with_assumption

    text = with_assumption(source, assumption)
    if path == STANDARD_OUTPUT:
        write(text)
    else:
        with writing():
            save_text(text, Path(path), "specification")
