"""Where a command writes: checked before the work, so that neither an input nor an output is lost."""

from __future__ import annotations

import os
import stat
import sys
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path
from typing import TextIO, TypeVar

from msgspec.structs import replace

from tumato_symbolic.cli.console import need_output
from tumato_symbolic.cli.options import STANDARD_OUTPUT, CommandOptions, Target
from tumato_symbolic.diagnostics import Code, Diagnostic, UserError
from tumato_symbolic.diagnostics.wording import quoted
from tumato_symbolic.limits.processes import open_file

AnyOptions = TypeVar("AnyOptions", bound=CommandOptions)


def settled(options: AnyOptions) -> AnyOptions:
    """The options of a command that may begin: whatever it writes can be written, and is no input or other output.

    Every name of the standard output becomes `-`. Raises `UserError` (TUM117, TUM118, TUM510).
    """
    named = {field: getattr(options, field) for field in options.outputs()}
    options = replace(options, **{field: _name(output) for field, output in named.items() if output is not None})
    inputs = [(name, _standard(sys.stdin) if name == "-" else _status(name)) for name in options.inputs()]
    known: dict[object, Target] = {}
    for target in options.targets():
        if target.path == STANDARD_OUTPUT:
            need_output()
        else:
            _check_file(target)
        _check_inputs(target, inputs)
        place = _place(target)
        if place is not None and known.setdefault(place, target) is not target:
            raise _not_apart(known[place], target)
    return options


def certificate_path(output: str) -> Path | None:
    """Where the certificate belongs that there is no policy to write to `output`; None where there is no file."""
    target = Path(output)
    if output == STANDARD_OUTPUT or is_stream(target):
        return None
    return target.with_name(f"{target.name.removesuffix('.json').removesuffix('.policy')}.unrealizable.json")


def is_stream(path: Path) -> bool:
    """Whether a name stands for an open file, a device or a pipe: nothing belongs beside it."""
    try:
        return open_file(path) is not None or not stat.S_ISREG(path.stat().st_mode)
    except FileNotFoundError:
        return False


def _name(output: str) -> str:
    with suppress(OSError, RuntimeError):  # what is wrong with the name is said below
        if open_file(Path(output)) == 1:
            return STANDARD_OUTPUT
    return output


def _check_file(target: Target) -> None:
    """Raise `UserError` (TUM510) where a file surely cannot be written."""
    try:
        problem = _obstacle(target)
    except (OSError, RuntimeError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        problem = f"cannot be: {reason[:1].lower()}{reason[1:]}", _another(target)
    if problem is None:
        return
    reason, way_out = problem
    message = f"the {target.what} cannot be written: {quoted(target.path)[1:-1]} {reason}"
    raise UserError((Diagnostic(Code.TUM510, message, help=way_out),))


def _obstacle(target: Target) -> tuple[str, str] | None:
    """What is wrong with the name of a file, and a way out."""
    path = Path(target.path)
    number = open_file(path)
    if number is not None:
        os.fstat(number)
        return None
    try:
        found = path.stat()
    except FileNotFoundError:
        found = None
    except NotADirectoryError:
        return f"cannot be: {path.parent} is not a folder", _another(target)
    if found is not None and stat.S_ISDIR(found.st_mode):
        return "is a folder", f"name a file, such as {path / target.example}"
    if found is not None and not stat.S_ISREG(found.st_mode):
        return None  # a device or a pipe takes what is written to it
    if found is not None and not os.access(path, os.W_OK):
        return "may not be written to", _another(target)
    folder = path.resolve().parent
    if not folder.exists():
        shown = path.parent if path.parent.resolve() == folder else folder
        return "is in a folder that does not exist", f"make the folder {shown} first"
    if not os.access(folder, os.W_OK | os.X_OK):
        return "is in a folder that you may not write to", _another(target)
    return None


def _another(target: Target) -> str:
    return f"name another file with {target.option} FILE"


def _check_inputs(target: Target, inputs: Iterable[tuple[str, os.stat_result | None]]) -> None:
    """Raise `UserError` (TUM118) where the target is an input, be it by another name or through a link."""
    written = _standard(sys.stdout) if target.path == STANDARD_OUTPUT else _status(target.path)
    if written is None or stat.S_ISCHR(written.st_mode):
        return
    for name, read in inputs:
        if read is not None and os.path.samestat(read, written):
            there = "the standard output" if target.path == STANDARD_OUTPUT else quoted(target.path)
            message = f"the {target.what} is not written to {there}: that is {_input(name, target.path)}"
            raise UserError((Diagnostic(Code.TUM118, message, help=_another(target)),))


def _not_apart(one: Target, other: Target) -> UserError:
    """That two files that are written are the same (TUM118)."""
    if one.path == other.path == STANDARD_OUTPUT:
        message = f"the {one.what} and the {other.what} do not both go to the standard output"
    else:
        message = f"the {one.what} and the {other.what} are not both written to {quoted(one.path)}"
    return UserError((Diagnostic(Code.TUM118, message, help=_another(one if other.option == "-o" else other)),))


def _place(target: Target) -> tuple[int, int] | Path | str | None:
    """What two names of the same file have in common; None for a device or a pipe, which may take several."""
    if target.path == STANDARD_OUTPUT:
        return STANDARD_OUTPUT
    if is_stream(Path(target.path)):
        return None
    found = _status(target.path)
    return Path(target.path).resolve() if found is None else (found.st_dev, found.st_ino)


def _input(name: str, path: str) -> str:
    if name == path:
        return "an input of this command"
    return f"the same file as the input {'<stdin>' if name == '-' else quoted(name)}"


def _status(path: str) -> os.stat_result | None:
    try:
        return Path(path).stat()
    except (OSError, ValueError):
        return None


def _standard(stream: TextIO | None) -> os.stat_result | None:
    """What a standard stream leads to."""
    try:
        return None if stream is None else os.fstat(stream.fileno())
    except (OSError, ValueError):
        return None
