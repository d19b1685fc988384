"""The rim of the program: every way in and every way out, with its exit code."""

from __future__ import annotations

import gc
import os
import sys
from collections.abc import Sequence

from tumato_symbolic.cli.console import close_quietly, flush, note, prepare_streams
from tumato_symbolic.cli.exits import BROKEN_PIPE, BUG, INTERRUPTED, UNDECIDED, USAGE
from tumato_symbolic.cli.parser import WRITING, Options, parse
from tumato_symbolic.diagnostics import UserError, render
from tumato_symbolic.limits import LimitReachedError

_REPORT_THIS = (
    "tumato-sym: this is a bug in tumato-sym, not a verdict on your input. "
    "Please report it with the traceback above, the command and the input files."
)

_OBJECTS_BETWEEN_COLLECTIONS = 100_000
"""Python looks for garbage after so many new objects rather than after 700: hardly any of ours is in a cycle."""


def entry() -> None:
    """The console script `tumato-sym`.

    It ends without tearing down the interpreter and the solvers in it, which would take as long as a small synthesis.
    """
    gc.set_threshold(_OBJECTS_BETWEEN_COLLECTIONS)
    code = BUG
    try:
        code = main()
    finally:
        os._exit(code)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command and return its exit code; no exception leaves this function."""
    prepare_streams()
    try:
        code = _run(arguments)
        flush()
    except KeyboardInterrupt:
        note("tumato-sym: interrupted")
        return INTERRUPTED
    except BrokenPipeError:
        close_quietly()
        return BROKEN_PIPE
    except MemoryError as error:
        note(f"tumato-sym: undecided: {str(error) or 'out of memory'}")
        return UNDECIDED
    except Exception:  # whatever comes here is our bug, and must not exit with 1
        import traceback

        note(f"{traceback.format_exc()}{_REPORT_THIS}")
        return BUG
    return code


def _run(arguments: Sequence[str] | None) -> int:
    try:
        options = parse(arguments)
    except SystemExit as done:  # argparse has printed its help, the version or what is wrong with the usage
        return done.code if isinstance(done.code, int) else USAGE
    except UserError as error:
        note(render(error.diagnostics, None))
        return USAGE
    try:
        if options.command in WRITING:
            from tumato_symbolic.cli.targets import settled

            options = settled(options)
        return _command(options)
    except UserError as error:
        from tumato_symbolic.cli.failure import show_user_error
        from tumato_symbolic.cli.mixups import recognized

        show_user_error(recognized(error, options, sys.argv[1:] if arguments is None else arguments), options)
        return USAGE
    except LimitReachedError as limit:
        note(f"tumato-sym: undecided: {limit}")
        return UNDECIDED


def _command(options: Options) -> int:
    """Hand over to the command; each imports only what it needs, because start-up is measured."""
    match options.command:
        case "synth":
            from tumato_symbolic.cli.synth import run
        case "verify":
            from tumato_symbolic.cli.verify import run
        case "explain":
            from tumato_symbolic.cli.explain import run
        case "export-proof":
            from tumato_symbolic.cli.export import run
        case "decide":
            from tumato_symbolic.cli.decide import run
        case "rules":
            from tumato_symbolic.cli.rules import run
        case "why":
            from tumato_symbolic.cli.why import run
        case _:
            from tumato_symbolic.cli.check import run
    return run(options)
