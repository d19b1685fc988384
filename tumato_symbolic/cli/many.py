"""A command for many files: which files, those of folders too, several processes, and a row of the table for each."""

from __future__ import annotations

import io
import json
import sys
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import redirect_stderr, redirect_stdout, suppress
from functools import partial
from pathlib import Path
from typing import Any

from msgspec import Struct
from msgspec.structs import replace

from tumato_symbolic.cli.console import wants_colour, write
from tumato_symbolic.cli.exits import UNDECIDED, worst
from tumato_symbolic.cli.matching import Specifications, inside
from tumato_symbolic.cli.options import CommandOptions, is_folder
from tumato_symbolic.cli.progress import Progress
from tumato_symbolic.diagnostics import Code, Diagnostic, UserError
from tumato_symbolic.limits import Context, LimitReachedError
from tumato_symbolic.limits.processes import can_fork
from tumato_symbolic.policy import load_claim
from tumato_symbolic.report.many import Many, Report, Row, as_line, as_text, failed, undecided, without_report
from tumato_symbolic.verify.workers import Lost, cores, in_workers

Run = Callable[[Any, Context], int]
"""A command."""

Ended = Callable[[Any, str, Any], int]
"""What it does when it has to end."""


class Work(Struct, frozen=True):
    """What a command does for one file: with these options, or nothing, where something is wrong with it."""

    name: str
    options: CommandOptions | UserError


class Doing(Struct, frozen=True):
    """A command: how it runs, how it ends at a limit, and what it says in a few words of its report."""

    run: Run
    ended: Ended | None
    said: Callable[[Report], str]


def specifications(names: Sequence[str]) -> list[str]:
    """The files that are named, and those with specifications in the folders that are.

    Raises `UserError` (TUM501) where a folder has none.
    """
    found: list[str] = []
    for name in names:
        if not is_folder(name):
            found.append(name)
            continue
        there = [str(each) for each in inside([Path(name)])]
        if not there:
            message = f"there is no specification in the folder {name}: no file is called NAME.tum or NAME.tmt"
            raise UserError((Diagnostic(Code.TUM501, message, help="name another folder, or files"),))
        found += there
    return list(dict.fromkeys(found))


def policies_in(folder: str, specs: str) -> Iterator[tuple[str, str | UserError]]:
    """Every NAME.policy.json of a folder with its specification, or what is wrong where there is none.

    That is `specs`, or, where this is a folder, the one that `verify` would take. Raises `UserError` (TUM501) where the
    folder has no policy.
    """
    paths = sorted(Path(folder).glob("*.policy.json"))
    if not paths:
        message = f"there is no policy in the folder {folder}: no file is called NAME.policy.json"
        raise UserError((Diagnostic(Code.TUM501, message, help="write one with `tumato-sym synth SPEC -o FILE`"),))
    found = Specifications(folder, [specs])
    for path in paths:
        if not is_folder(specs):
            yield str(path), specs
            continue
        try:
            yield str(path), str(found.named(path) or found.of(path, load_claim(str(path)).digest))
        except UserError as error:
            yield str(path), error


def run_many(work: Iterable[Work], doing: Doing, options: CommandOptions, context: Context, *, jobs: int | None) -> int:
    """Do it all and report it; the exit code is that of the worst file."""
    todo, started, jobs = list(work), time.perf_counter(), jobs or cores()
    found: dict[int, Row] = {}
    wants_lines = options.output_format == "json"

    def line(number: int) -> str | None:
        return as_line(found[number]) if wants_lines and number in found else None

    def known() -> Many:
        return Many(tuple(found[each] for each in sorted(found)), len(todo), time.perf_counter() - started)

    progress = Progress(context, line, known)

    def heard(number: int, answer: Row | Lost) -> None:
        found[number] = undecided(todo[number].name, answer.reason) if isinstance(answer, Lost) else answer
        progress.more(f"{len(todo):,} files, {len(found):,} done")

    _load_once()
    context.tell(f"{len(todo):,} files, none done")
    tasks = [partial(_row, each, doing, context) for each in todo]
    if jobs > 1 and can_fork() and len(tasks) > 1:
        in_workers(tasks, jobs, heard)
    else:
        for number, task in enumerate(tasks):
            heard(number, task())
    return report(known(), doing, options)


def report(done: Many, doing: Doing, options: CommandOptions) -> int:
    """Print the table, where the lines are not printed already."""
    if options.output_format == "text":
        write(as_text(done, doing.said, wants_colour(sys.stdout)))
    return worst([*(row.code for row in done.rows), *([UNDECIDED] if len(done.rows) < done.of else [])])


def ended(known: Many, why: str, doing: Doing, options: CommandOptions) -> int:
    """Report the files that were done by then."""
    return report(replace(known, limit=why), doing, options)


def _load_once() -> None:
    """Load what every file needs before there are children, which then have it."""
    from tumato_symbolic.limits import has_z3

    has_z3()
    with suppress(ImportError):
        from tumato_symbolic.symbolic import available_backend

        available_backend()


def _row(work: Work, doing: Doing, context: Context) -> Row:
    """What the command says of one file."""
    if isinstance(work.options, UserError):
        return failed(work.name, work.options)
    said, noted = io.StringIO(), io.StringIO()
    options = work.options
    part = context.within(options.own_seconds)
    with redirect_stdout(said), redirect_stderr(noted):
        try:
            code = doing.run(options, part)
        except UserError as error:
            return failed(work.name, error)
        except LimitReachedError as limit:
            context.check()
            if part.known is None or doing.ended is None:
                return undecided(work.name, str(limit))
            code = doing.ended(part.known, str(limit), options)
        except MemoryError:
            return undecided(work.name, "memory ran out")
    if not said.getvalue():
        return without_report(work.name, code, noted.getvalue())
    return Row(work.name, code, json.loads(said.getvalue()))


def named_apart(files: Sequence[str]) -> Iterator[tuple[str, str]]:
    """Each file with its name, without folder and ending. Raises `UserError` (TUM118) where two have the same."""
    known: dict[str, str] = {}
    for file in files:
        name = Path(file).stem
        if name in known:
            message = f"{known[name]} and {file} are both called {name}, and so would be what is written for them"
            raise UserError((Diagnostic(Code.TUM118, message, help="do them one after the other, into two folders"),))
        known[name] = file
        yield file, name
