"""The rim of the program: every way in and out, exceptions, Ctrl-C and limits, each with its exit code."""

from __future__ import annotations

import gc
import os
import sys
from collections.abc import Callable, Sequence
from functools import partial

from tumato_symbolic.cli.command_line import CommandLine, parse
from tumato_symbolic.cli.console import close_quietly, flush, note, prepare_streams
from tumato_symbolic.cli.exits import BROKEN_PIPE, BUG, INTERRUPTED, TERMINATED, UNDECIDED, USAGE
from tumato_symbolic.cli.options import CommandOptions
from tumato_symbolic.diagnostics import UserError, render
from tumato_symbolic.limits import NO_LIMITS, Context, LimitReachedError, Limits
from tumato_symbolic.limits.processes import age, can_fork

_REPORT_THIS = (
    "tumato-sym: this is a bug in tumato-sym, not a verdict on your input. "
    "Please report it with the traceback above, the command and the input files."
)

_OBJECTS_BETWEEN_COLLECTIONS = 100_000
"""Python looks for garbage after so many new objects rather than after 700: hardly any of ours is in a cycle."""


def entry() -> None:
    """What the console script `tumato-sym` does once it has what it needs (`tumato_symbolic/__main__.py`).

    It ends without tearing down the interpreter and the solvers in it, which would take as long as a small synthesis.
    """
    gc.set_threshold(_OBJECTS_BETWEEN_COLLECTIONS)
    code = BUG
    try:
        code = main(may_fork=True)
    except KeyboardInterrupt:  # a second one, while the first was reported
        code = INTERRUPTED
    finally:
        os._exit(code)


def main(arguments: Sequence[str] | None = None, *, may_fork: bool = False) -> int:
    """Run one command and return its exit code; no exception leaves this function.

    With `may_fork` a command that has limits, or may take long, is done by a child process, so that its limits and
    Ctrl-C end it whatever it is at.
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
    except Exception:  # noqa: BLE001 - whatever comes here is our bug, and must not exit with 1
        import traceback

        note(f"{traceback.format_exc()}{_REPORT_THIS}")
        return BUG
    return code


def _run(arguments: Sequence[str] | None, may_fork: bool) -> int:
    try:
        line = parse(sys.argv[1:] if arguments is None else arguments)
    except SystemExit as done:  # argparse has printed its help, the version or what is wrong with the usage
        return done.code if isinstance(done.code, int) else USAGE
    except UserError as error:
        note(render(error.diagnostics, None))
        return USAGE
    try:
        line = _settled(line)
    except UserError as error:
        return _unusable(error, line)
    limits = Limits(line.options.timeout or line.options.own_seconds, line.options.memory)
    context = Context(limits, spent=age() if may_fork and limits != NO_LIMITS else 0.0)
    work = partial(_command, line, context)
    if may_fork and can_fork() and _is_watched(context, line.options):
        return _supervised(work, line, context)
    return work()


def _settled(line: CommandLine) -> CommandLine:
    """With the names of the files to write settled. Raises `UserError` where one cannot be written."""
    if not line.options.outputs():
        return line
    from tumato_symbolic.cli.targets import settled

    return line._replace(options=settled(line.options))


def _is_watched(context: Context, options: CommandOptions) -> bool:
    """Whether there is something to keep watch over: limits, or work in which Ctrl-C may have to wait for a solver."""
    return options.may_take_long or context.limits != NO_LIMITS


def _supervised(work: Callable[[], int], line: CommandLine, context: Context) -> int:
    """Have a child do the command, and report what it knew when it had to be ended."""
    from tumato_symbolic.cli.supervise import EndedError, TerminatedError, supervised

    try:
        return supervised(partial(_guarded, work), context)
    except EndedError as ended:
        return _stopped(context.known, str(ended), line)
    except KeyboardInterrupt:
        _report_interrupted(context.known, line)
        raise
    except TerminatedError as ended:
        return TERMINATED + ended.number


def _command(line: CommandLine, context: Context) -> int:
    """Hand over to the command."""
    try:
        return line.command.run(line.options, context)
    except UserError as error:
        return _unusable(error, line)
    except LimitReachedError as limit:
        return _stopped(context.known, str(limit), line)
    except KeyboardInterrupt:
        _report_interrupted(context.known, line)
        raise


def _unusable(error: UserError, line: CommandLine) -> int:
    from tumato_symbolic.cli.failure import show_user_error
    from tumato_symbolic.cli.mixups import recognized

    show_user_error(recognized(error, line.options, line.words), line.options)
    return USAGE


def _stopped(known: object, why: str, line: CommandLine) -> int:
    """Report what was known when a command had to end, and why it had to."""
    if known is None:
        from tumato_symbolic.cli.failure import show_undecided

        show_undecided(why, line.options)
        return UNDECIDED
    return line.command.stopped(known, why, line.options)


def _report_interrupted(known: object, line: CommandLine) -> None:
    """After Ctrl-C an explanation says what it has found; of the other commands, nothing is worth half."""
    if known is not None and line.options.reports_interruption:
        _stopped(known, "it was interrupted", line)
