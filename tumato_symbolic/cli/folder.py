"""`tumato-sym verify FOLDER`: every policy and certificate in it against the specification of the same name."""

from __future__ import annotations

import os
import sys
import time
from pathlib import Path

from tumato_symbolic.cli.certificate import certificate_exit_code, judge_certificate
from tumato_symbolic.cli.console import wants_colour, write
from tumato_symbolic.cli.exits import NO, UNDECIDED, USAGE, YES
from tumato_symbolic.cli.parser import Options
from tumato_symbolic.cli.verify import exit_code, judge
from tumato_symbolic.diagnostics import Code, Diagnostic, UserError
from tumato_symbolic.policy.claim import load_claim
from tumato_symbolic.policy.unrealizable import Unrealizability
from tumato_symbolic.report.folder import Entry, Folder, as_github, as_json, as_text
from tumato_symbolic.report.layout import dump

SUFFIXES = (".policy.json", ".unrealizable.json")
"""How the names of files end that are verified by folder."""

EXAMPLES = Path("..", "examples")
"""Where a specification is looked for last, seen from the folder of its policy."""

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
    entries = [_entry(path, options) for path in paths]
    done = Folder(str(folder), tuple(entry for entry, _ in entries), options.strict, time.perf_counter() - started)
    match options.output_format:
        case "json":
            write(dump(as_json(done)))
        case "github":
            write(as_github(done))
        case _:
            write(as_text(done, wants_colour(sys.stdout)))
    return min((code for _, code in entries), key=_WORST_FIRST.index)


def _entry(path: Path, options: Options) -> tuple[Entry, int]:
    try:
        spec, claim = str(_specification(path, options)), load_claim(str(path))
        if isinstance(claim, Unrealizability):
            disproved = judge_certificate(claim, str(path), spec, options)
            return Entry(str(path), disproved), certificate_exit_code(disproved)
        done = judge(claim, str(path), spec, options)
    except UserError as error:
        return Entry(str(path), error=error), USAGE
    return Entry(str(path), done), exit_code(done)


def _specification(path: Path, options: Options) -> Path:
    """The specification that a file belongs to. Raises `UserError` (TUM501) where there is none."""
    name = path.name.rsplit(".", 2)[0] + ".tum"
    examples = Path(os.path.normpath(path.parent / EXAMPLES))
    folders = [*map(Path, options.spec_folders), path.parent, examples]
    found = next((folder / name for folder in folders if (folder / name).is_file()), None)
    if found is None:
        message = f"there is no specification {name} for this file in {', '.join(map(str, folders))}"
        raise UserError((Diagnostic(Code.TUM501, message, help="say with --specs DIR where it is"),))
    return found
