"""`tumato-sym verify FOLDER`: every policy and certificate in it against its specification."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, cast

from tumato_symbolic.cli.exits import NO, UNDECIDED, USAGE, YES
from tumato_symbolic.cli.inputs import show_warnings
from tumato_symbolic.cli.judging import exit_code, judge, wanted_jobs
from tumato_symbolic.cli.matching import Specifications
from tumato_symbolic.cli.output import show, show_profile
from tumato_symbolic.cli.parser import Options
from tumato_symbolic.diagnostics import Code, Diagnostic, UserError
from tumato_symbolic.limits import NO_LIMITS, Context, LimitReachedError
from tumato_symbolic.limits.processes import can_fork
from tumato_symbolic.policy.claim import load_claim
from tumato_symbolic.report import folder as report
from tumato_symbolic.report.folder import Entry, Folder
from tumato_symbolic.verify.children import Lost, in_children

if TYPE_CHECKING:
    from tumato_symbolic.cli.judging import Judged

SUFFIXES = (".policy.json", ".unrealizable.json")
"""How the names of files end that are verified by folder."""

FEWEST_BYTES = 100_000
"""Smaller folders are verified sooner than children are made."""

_WORST_FIRST = (USAGE, NO, UNDECIDED, YES)


def run_folder(options: Options, context: Context) -> int:
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
    specs, missing = Specifications(options), list[Entry]()

    def learn(found: Mapping[Path, Entry]) -> Folder:
        entries = (*(found.get(path, Entry(str(path))) for path in paths), *missing)
        done = Folder(str(folder), entries, options.strict, time.perf_counter() - started)
        context.learn(done)
        return done

    found = _entries(paths, specs, options, context, learn)
    if options.require_all:
        missing += [Entry(str(path), missing=True) for path in _without(found.values(), specs)]
    code = _report(learn(found), options)
    show_profile(context, options)
    return code


def stopped_folder(known: Folder, why: str, options: Options) -> int:
    """Report the files that were judged when a limit was met, and that the others were not."""
    entries = (
        entry if entry.done is not None or entry.error is not None or entry.missing else replace(entry, limit=why)
        for entry in known.entries
    )
    return _report(replace(known, entries=tuple(entries)), options)


def _report(done: Folder, options: Options) -> int:
    for entry in done.entries:
        if entry.done is not None:
            show_warnings(entry.done.warnings, entry.done.source, options)
    show(report, done, options)
    return min(map(_code, done.entries), key=_WORST_FIRST.index)


def _without(entries: Iterable[Entry], specs: Specifications) -> list[Path]:
    """The specifications with neither policy nor certificate. A file that cannot be used counts for its namesake."""
    used = [Path(entry.done.source.name) if entry.done else specs.named(Path(entry.path)) for entry in entries]
    return specs.without(path for path in used if path is not None)


def _code(entry: Entry) -> int:
    if entry.done is not None:
        return exit_code(entry.done)
    if entry.missing:
        return NO
    return USAGE if entry.error is not None else UNDECIDED


def _entries(
    paths: Sequence[Path],
    specs: Specifications,
    options: Options,
    context: Context,
    learn: Callable[[Mapping[Path, Entry]], object],
) -> dict[Path, Entry]:
    """All files, by several processes where that pays; `learn` is told the results so far."""
    jobs, found = wanted_jobs(options), dict[Path, Entry]()
    parts = _parts(paths, jobs, context.limits != NO_LIMITS) if jobs > 1 and can_fork() else []
    if len(parts) < 2:
        for path in paths:
            part = context.within(learned=partial(_learn_of, path, found, learn))
            found[path] = _entry(path, specs, options, part, jobs=jobs)
            learn(found)
        return found

    def heard(number: int, answer: list[Entry] | Lost) -> None:
        found.update(zip(parts[number], _kept(answer), strict=True))
        context.enter(f"verifying {len(paths)} files, {len(found)} done")
        learn(found)

    context.tell(f"verifying {len(paths)} files")
    in_children([partial(_part, part, specs, options, context) for part in parts], jobs, heard)
    return found


def _learn_of(
    path: Path, found: Mapping[Path, Entry], learn: Callable[[Mapping[Path, Entry]], object], judged: object
) -> None:
    learn({**found, path: Entry(str(path), cast("Judged", judged))})


def _kept(answer: list[Entry] | Lost) -> list[Entry]:
    """What a child has found. Raises `MemoryError` where it was ended: most likely for want of memory."""
    if not isinstance(answer, Lost):
        return answer
    raise MemoryError(answer.reason)


def _part(paths: Sequence[Path], specs: Specifications, options: Options, context: Context) -> list[Entry]:
    return [_entry(path, specs, options, context.within(), jobs=1) for path in paths]


def _parts(paths: Sequence[Path], jobs: int, limited: bool) -> list[list[Path]]:
    """The files, divided so that every process gets about as many bytes; undivided where there are few.

    Where there is a limit each file is a part, so that what is found is known at once.
    """
    sizes = {path: path.stat().st_size if path.exists() else 0 for path in paths}
    if sum(sizes.values()) < FEWEST_BYTES:
        return [list(paths)]
    if limited:
        return [[path] for path in paths]
    parts: list[list[Path]] = [[] for _ in range(min(jobs, len(paths)))]
    for path in sorted(paths, key=sizes.__getitem__, reverse=True):
        min(parts, key=lambda part: sum(sizes[each] for each in part)).append(path)
    return parts


def _entry(path: Path, specs: Specifications, options: Options, context: Context, *, jobs: int) -> Entry:
    try:
        claim = load_claim(str(path))
        return Entry(str(path), judge(claim, str(path), str(specs.of(path, claim.digest)), options, context, jobs=jobs))
    except UserError as error:
        return Entry(str(path), error=error)
    except LimitReachedError as limit:
        return Entry(str(path), limit=str(limit))
