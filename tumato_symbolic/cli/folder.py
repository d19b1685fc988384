"""`tumato-sym verify FOLDER`: every policy and certificate in it against its specification."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, cast

from msgspec.structs import replace

from tumato_symbolic.cli.exits import NO, UNDECIDED, USAGE, worst
from tumato_symbolic.cli.matching import Specifications
from tumato_symbolic.cli.verifying import Criteria, exit_code, verify_claim
from tumato_symbolic.diagnostics import Code, Diagnostic, UserError
from tumato_symbolic.limits import NO_LIMITS, Context, LimitReachedError
from tumato_symbolic.limits.processes import can_fork
from tumato_symbolic.policy import load_claim
from tumato_symbolic.report.folder import Entry, Folder
from tumato_symbolic.verify.workers import Lost, in_workers

if TYPE_CHECKING:
    from tumato_symbolic.cli.verifying import Verdict

SUFFIXES = (".policy.json", ".unrealizable.json")
"""How the names of files end that are verified by folder."""

FEWEST_BYTES = 100_000
"""Smaller folders are verified sooner than children are made."""


def verify_folder(
    name: str, specs: Specifications, criteria: Criteria, context: Context, *, jobs: int, require_all: bool
) -> Folder:
    """Every file of a folder; with `require_all`, the specifications as well that have none.

    Raises `UserError` (TUM501) where there is nothing to verify: an empty folder proves nothing.
    """
    folder, started = Path(name), time.perf_counter()
    paths = sorted(path for suffix in SUFFIXES for path in folder.glob(f"*{suffix}"))
    if not paths:
        message = (
            f"there is nothing to verify in the folder {folder}: no file is called NAME{' or NAME'.join(SUFFIXES)}"
        )
        raise UserError((Diagnostic(Code.TUM501, message, help="write one with `tumato-sym synth SPEC -o FILE`"),))
    missing = list[Entry]()

    def learn(found: Mapping[Path, Entry]) -> Folder:
        entries = (*(found.get(path, Entry(str(path))) for path in paths), *missing)
        done = Folder(str(folder), entries, criteria.strict, time.perf_counter() - started)
        context.learn(done)
        return done

    found = _entries(paths, specs, criteria, context, learn, jobs=jobs)
    if require_all:
        missing += [Entry(str(path), missing=True) for path in _without(found.values(), specs)]
    return learn(found)


def ended_folder(known: Folder, why: str) -> Folder:
    """The files that were verified when a limit was met, and that the others were not."""
    entries = (
        entry if entry.done is not None or entry.error is not None or entry.missing else replace(entry, limit=why)
        for entry in known.entries
    )
    return replace(known, entries=tuple(entries))


def folder_code(done: Folder) -> int:
    """The exit code of the worst file."""
    return worst(map(_code, done.entries))


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
    criteria: Criteria,
    context: Context,
    learn: Callable[[Mapping[Path, Entry]], object],
    *,
    jobs: int,
) -> dict[Path, Entry]:
    """All files, by several processes where that pays; `learn` is told the results so far."""
    found = dict[Path, Entry]()
    parts = _parts(paths, jobs, context.limits != NO_LIMITS) if jobs > 1 and can_fork() else []
    if len(parts) < 2:
        for path in paths:
            part = context.within(learned=partial(_learn_of, path, found, learn))
            found[path] = _entry(path, specs, criteria, part, jobs=jobs)
            learn(found)
        return found

    def heard(number: int, answer: list[Entry] | Lost) -> None:
        found.update(zip(parts[number], _kept(answer), strict=True))
        context.enter(f"verifying {len(paths)} files, {len(found)} done")
        learn(found)

    context.tell(f"verifying {len(paths)} files")
    in_workers([partial(_part, part, specs, criteria, context) for part in parts], jobs, heard)
    return found


def _learn_of(
    path: Path, found: Mapping[Path, Entry], learn: Callable[[Mapping[Path, Entry]], object], verdict: object
) -> None:
    learn({**found, path: Entry(str(path), cast("Verdict", verdict))})


def _kept(answer: list[Entry] | Lost) -> list[Entry]:
    """What a child has found. Raises `MemoryError` where it was ended: most likely because memory ran out."""
    if not isinstance(answer, Lost):
        return answer
    raise MemoryError(answer.reason)


def _part(paths: Sequence[Path], specs: Specifications, criteria: Criteria, context: Context) -> list[Entry]:
    return [_entry(path, specs, criteria, context.within(), jobs=1) for path in paths]


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


def _entry(path: Path, specs: Specifications, criteria: Criteria, context: Context, *, jobs: int) -> Entry:
    try:
        claim = load_claim(str(path))
        return Entry(
            str(path), verify_claim(claim, str(path), str(specs.of(path, claim.digest)), criteria, context, jobs=jobs)
        )
    except UserError as error:
        return Entry(str(path), error=error)
    except LimitReachedError as limit:
        return Entry(str(path), limit=str(limit))
