"""The rim of the program: every way in and every way out, with its exit code."""

from __future__ import annotations

import gc
import os
import sys
from collections.abc import Callable, Sequence
from functools import partial
from importlib import import_module
from typing import Any

from tumato_symbolic.cli.console import close_quietly, flush, note, prepare_streams
from tumato_symbolic.cli.exits import BROKEN_PIPE, BUG, INTERRUPTED, TERMINATED, UNDECIDED, USAGE
from tumato_symbolic.cli.parser import WRITING, Options, parse
from tumato_symbolic.diagnostics import UserError, render
from tumato_symbolic.limits import NO_LIMITS, Context, LimitReachedError, Limits
from tumato_symbolic.limits.processes import age, can_fork

_REPORT_THIS = (
    "tumato-sym: this is a bug in tumato-sym, not a verdict on your input. "
    "Please report it with the traceback above, the command and the input files."
)

_OWN_SECONDS = {"explain": 58.0, "rules": 58.0}
"""How long a command looks at most where nothing else is asked for, so that its report is there within a minute."""

_SHORT = ("check", "decide")
"""Commands that show no progress."""

_OBJECTS_BETWEEN_COLLECTIONS = 100_000
"""Python looks for garbage after so many new objects rather than after 700: hardly any of ours is in a cycle."""


def entry() -> None:
    """The console script `tumato-sym`.

    It ends without tearing down the interpreter and the solvers in it, which would take as long as a small synthesis.
    """
    gc.set_threshold(_OBJECTS_BETWEEN_COLLECTIONS)
    code = BUG
    try:
        code = main(may_fork=True)
    finally:
        os._exit(code)


def main(arguments: Sequence[str] | None = None, *, may_fork: bool = False) -> int:
    """Run one command and return its exit code; no exception leaves this function.

    With `may_fork` a command that has limits is done by a child process, so that they hold whatever it is at.
    """
    prepare_streams()
    return _guarded(partial(_run, arguments, may_fork))


def _guarded(work: Callable[[], int]) -> int:
    """The exit code of some work, whatever it raises."""
    try:
        code = work()
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


def _run(arguments: Sequence[str] | None, may_fork: bool) -> int:
    typed = sys.argv[1:] if arguments is None else arguments
    try:
        options = parse(typed)
    except SystemExit as done:  # argparse has printed its help, the version or what is wrong with the usage
        return done.code if isinstance(done.code, int) else USAGE
    except UserError as error:
        note(render(error.diagnostics, None))
        return USAGE
    try:
        if options.command in WRITING:
            from tumato_symbolic.cli.targets import settled

            options = settled(options)
    except UserError as error:
        return _unusable(error, options, typed)
    limits = Limits(options.timeout or _OWN_SECONDS.get(options.command), options.memory)
    context = Context(limits, spent=age() if may_fork and limits != NO_LIMITS else 0.0)
    work = partial(_command, options, context, typed)
    if may_fork and can_fork() and _is_watched(context, options):
        return _supervised(work, options, context)
    return work()


def _is_watched(context: Context, options: Options) -> bool:
    """Whether there is something to keep watch over: limits, or a terminal that shows how long work gets on."""
    shown = options.command not in _SHORT and sys.stderr is not None and sys.stderr.isatty()
    return shown or context.limits != NO_LIMITS


def _supervised(work: Callable[[], int], options: Options, context: Context) -> int:
    """Have a child do the command, and report what it knew when it had to be ended."""
    from tumato_symbolic.cli.supervise import EndedError, TerminatedError, supervised

    _module(options)  # both processes need it: one to work, the other to report
    try:
        return supervised(partial(_guarded, work), context)
    except EndedError as ended:
        return _stopped(context.known, str(ended), options)
    except KeyboardInterrupt:
        _report_interrupted(context.known, options)
        raise
    except TerminatedError as ended:
        return TERMINATED + ended.number


def _command(options: Options, context: Context, typed: Sequence[str]) -> int:
    """Hand over to the command."""
    try:
        code: int = _module(options).run(options, context)
    except UserError as error:
        return _unusable(error, options, typed)
    except LimitReachedError as limit:
        return _stopped(context.known, str(limit), options)
    except KeyboardInterrupt:
        _report_interrupted(context.known, options)
        raise
    return code


def _unusable(error: UserError, options: Options, typed: Sequence[str]) -> int:
    from tumato_symbolic.cli.failure import show_user_error
    from tumato_symbolic.cli.mixups import recognized

    show_user_error(recognized(error, options, typed), options)
    return USAGE


def _stopped(known: object, why: str, options: Options) -> int:
    """Report what was known when a command had to end, and why it had to."""
    if known is None:
        from tumato_symbolic.cli.failure import show_undecided

        show_undecided(why, options)
        return UNDECIDED
    code: int = _module(options).stopped(known, why, options)
    return code


def _report_interrupted(known: object, options: Options) -> None:
    """After Ctrl-C an explanation says what it has found; nothing else is worth half."""
    if known is not None and options.command == "explain":
        _stopped(known, "it was interrupted", options)


def _module(options: Options) -> Any:  # noqa: ANN401 - a module with `run`, and with `stopped` where it learns
    """The module of a command; each imports only what it needs, because start-up is measured."""
    name = "export" if options.command == "export-proof" else options.command
    return import_module(f"tumato_symbolic.cli.{name}")
