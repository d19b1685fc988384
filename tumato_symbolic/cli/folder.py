"""`tumato-sym verify FOLDER`: every policy and certificate in it against its specification."""

from __future__ import annotations

import time
from collections.abc import Sequence
from functools import partial
from pathlib import Path

from tumato_symbolic.cli.console import Progress
from tumato_symbolic.cli.exits import NO, UNDECIDED, USAGE, YES
from tumato_symbolic.cli.inputs import show_warnings
from tumato_symbolic.cli.judging import exit_code, judge, wanted_jobs
from tumato_symbolic.cli.matching import Specifications
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
    specs = Specifications(options)
    with Progress() as progress:
        entries = _entries(paths, specs, options, Context(progress=progress))
    if options.require_all:
        entries += [(Entry(str(path), missing=True), NO) for path in _without(entries, specs)]
    for entry, _ in entries:
        if entry.done is not None:
            show_warnings(entry.done.warnings, entry.done.source, options)
    done = Folder(str(folder), tuple(entry for entry, _ in entries), options.strict, time.perf_counter() - started)
    show(report, done, options)
    show_profile(progress, options)
    return min((code for _, code in entries), key=_WORST_FIRST.index)


def _without(entries: Sequence[tuple[Entry, int]], specs: Specifications) -> list[Path]:
    """The specifications with neither policy nor certificate. A file that cannot be used counts for its namesake."""
    used = [Path(entry.done.source.name) if entry.done else specs.named(Path(entry.path)) for entry, _ in entries]
    return specs.without(path for path in used if path is not None)


def _entries(
    paths: Sequence[Path], specs: Specifications, options: Options, context: Context
) -> list[tuple[Entry, int]]:
    """All files, in their order, each with its exit code; by several processes where that pays."""
    jobs = wanted_jobs(options)
    parts = _parts(paths, jobs) if jobs > 1 and can_fork() else []
    if len(parts) < 2:
        return [_entry(path, specs, options, context, jobs) for path in paths]
    context.tell(f"verifying {len(paths)} files")
    answers = in_children([partial(_part, part, specs, options, context) for part in parts], jobs)
    found: dict[Path, tuple[Entry, int]] = {}
    for part, answer in zip(parts, answers, strict=True):
        found.update(zip(part, _kept(answer), strict=True))
    return [found[path] for path in paths]


def _kept(answer: list[tuple[Entry, int]] | Lost) -> list[tuple[Entry, int]]:
    """What a child has found. Raises `MemoryError` where it was ended: most likely for want of memory."""
    if not isinstance(answer, Lost):
        return answer
    raise MemoryError(answer.reason)


def _part(paths: Sequence[Path], specs: Specifications, options: Options, context: Context) -> list[tuple[Entry, int]]:
    return [_entry(path, specs, options, context, 1) for path in paths]


def _parts(paths: Sequence[Path], jobs: int) -> list[list[Path]]:
    """The files, divided so that every process gets about as many bytes; undivided where there are few."""
    sizes = {path: path.stat().st_size if path.exists() else 0 for path in paths}
    if sum(sizes.values()) < FEWEST_BYTES:
        return [list(paths)]
    parts: list[list[Path]] = [[] for _ in range(min(jobs, len(paths)))]
    for path in sorted(paths, key=sizes.__getitem__, reverse=True):
        min(parts, key=lambda part: sum(sizes[each] for each in part)).append(path)
    return parts


def _entry(path: Path, specs: Specifications, options: Options, context: Context, jobs: int) -> tuple[Entry, int]:
    try:
        claim = load_claim(str(path))
        done = judge(claim, str(path), str(specs.of(path, claim.digest)), options, context, jobs=jobs)
    except UserError as error:
        return Entry(str(path), error=error), USAGE
    return Entry(str(path), done), exit_code(done)
