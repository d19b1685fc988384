"""`tumato-sym verify FOLDER`: every policy and certificate in it against the specification of the same name."""

from __future__ import annotations

import os
import time
from collections.abc import Sequence
from functools import partial
from pathlib import Path

from tumato_symbolic.cli.console import Progress
from tumato_symbolic.cli.exits import NO, UNDECIDED, USAGE, YES
from tumato_symbolic.cli.inputs import show_warnings
from tumato_symbolic.cli.judging import exit_code, judge, wanted_jobs
from tumato_symbolic.cli.output import show, show_profile
from tumato_symbolic.cli.parser import Options
from tumato_symbolic.diagnostics import Code, Diagnostic, UserError
from tumato_symbolic.limits import Context
from tumato_symbolic.policy.claim import load_claim
from tumato_symbolic.report import folder as report
from tumato_symbolic.report.folder import Entry, Folder
from tumato_symbolic.verify.children import Lost, can_fork, in_children

SUFFIXES = (".policy.json", ".unrealizable.json")
"""How the names of files end that are verified by folder."""

EXAMPLES = Path("..", "examples")
"""Where a specification is looked for last, seen from the folder of its policy."""

FEWEST_BYTES = 100_000
"""Smaller folders are verified sooner than children are made."""

_WORST_FIRST = (USAGE, NO, UNDECIDED, YES)


def run_folder(options: Options) -> int:
    """Verify every file and report them together; the exit code is that of the worst one.

    Raises `UserError` (TUM501) where there is nothing to verify: an empty folder proves nothing.
    """
    folder, started = Path(options.policy), time.perf_counter()
    paths = sorted(path for suffix in SUFFIXES for path in folder.glob(f"*{suffix}"))
    if not paths:
        message = (
            f"there is nothing to verify in the folder {folder}: no file is called NAME{' or NAME'.join(SUFFIXES)}"
        )
        raise UserError((Diagnostic(Code.TUM501, message, help="write one with `tumato-sym synth SPEC -o FILE`"),))
    with Progress() as progress:
        entries = _entries(paths, options, Context(progress=progress))
    for entry, _ in entries:
        if entry.done is not None:
            show_warnings(entry.done.warnings, entry.done.source, options)
    done = Folder(str(folder), tuple(entry for entry, _ in entries), options.strict, time.perf_counter() - started)
    show(report, done, options)
    show_profile(progress, options)
    return min((code for _, code in entries), key=_WORST_FIRST.index)


def _entries(paths: Sequence[Path], options: Options, context: Context) -> list[tuple[Entry, int]]:
    """All files, in their order, each with its exit code; by several processes where that pays."""
    jobs = wanted_jobs(options)
    parts = _parts(paths, jobs) if jobs > 1 and can_fork() else []
    if len(parts) < 2:
        return [_entry(path, options, context, jobs) for path in paths]
    context.tell(f"verifying {len(paths)} files")
    answers = in_children([partial(_part, part, options, context) for part in parts], jobs)
    found: dict[Path, tuple[Entry, int]] = {}
    for part, answer in zip(parts, answers, strict=True):
        found.update(zip(part, _kept(answer), strict=True))
    return [found[path] for path in paths]


def _kept(answer: list[tuple[Entry, int]] | Lost) -> list[tuple[Entry, int]]:
    """What a child has found. Raises `MemoryError` where it was ended: most likely for want of memory."""
    if not isinstance(answer, Lost):
        return answer
    raise MemoryError(answer.reason)


def _part(paths: Sequence[Path], options: Options, context: Context) -> list[tuple[Entry, int]]:
    return [_entry(path, options, context, 1) for path in paths]


def _parts(paths: Sequence[Path], jobs: int) -> list[list[Path]]:
    """The files, divided so that every process gets about as many bytes; undivided where there are few."""
    sizes = {path: path.stat().st_size if path.exists() else 0 for path in paths}
    if sum(sizes.values()) < FEWEST_BYTES:
        return [list(paths)]
    parts: list[list[Path]] = [[] for _ in range(min(jobs, len(paths)))]
    for path in sorted(paths, key=sizes.__getitem__, reverse=True):
        min(parts, key=lambda part: sum(sizes[each] for each in part)).append(path)
    return parts


def _entry(path: Path, options: Options, context: Context, jobs: int) -> tuple[Entry, int]:
    try:
        spec, claim = str(_specification(path, options)), load_claim(str(path))
        done = judge(claim, str(path), spec, options, context, jobs=jobs)
    except UserError as error:
        return Entry(str(path), error=error), USAGE
    return Entry(str(path), done), exit_code(done)


def _specification(path: Path, options: Options) -> Path:
    """The specification that a file belongs to. Raises `UserError` (TUM501) where there is none."""
    name = path.name.rsplit(".", 2)[0] + ".tum"
    examples = Path(os.path.normpath(path.parent / EXAMPLES))
    folders = [*map(Path, options.spec_folders), path.parent, examples]
    # Path.is_file() fails for names that are too long
    found = next((folder / name for folder in folders if os.path.isfile(folder / name)), None)  # noqa: PTH113
    if found is None:
        message = f"there is no specification {name} for this file in {', '.join(map(str, folders))}"
        raise UserError((Diagnostic(Code.TUM501, message, help="say with --specs DIR where it is"),))
    return found
