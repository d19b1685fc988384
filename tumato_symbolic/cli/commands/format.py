"""`tumato-sym format`: lay out specifications."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from tumato_symbolic.cli import arguments
from tumato_symbolic.cli.console import note, wants_colour, write
from tumato_symbolic.cli.exits import NO, USAGE, YES
from tumato_symbolic.cli.options import CommandOptions, are_large, argument
from tumato_symbolic.limits import Context

if TYPE_CHECKING:
    from tumato_symbolic.diagnostics import Source

ABOUT = """\
Give specifications their one layout: indentation, blank lines, spaces, and ends of long lines.

Nothing else changes: a specification means the same, and comments stay where they are. A file is replaced as a whole or
left as it was; one with mistakes in its syntax is left, and the mistakes are shown. With `-`, what comes from the
standard input goes to the standard output.
"""

EXAMPLES = """\
examples:
  tumato-sym format amr.tum
  tumato-sym format specs/*.tum --check
  tumato-sym format - < amr.tum
"""


class Options(CommandOptions, frozen=True):
    """What may be typed after `format`."""

    specs: tuple[str, ...] = arguments.specs("+", "specifications, .tum files; - for the standard input")
    check: bool = arguments.check("write nothing; name the files whose layout is another, and exit with 1")
    diff: bool = argument("--diff", action="store_true", help="the same, and show what would change")

    @property
    def may_take_long(self) -> bool:
        """Where there is much to read."""
        return are_large(self.specs)


def run(options: Options, context: Context) -> int:
    """Lay out every file; one that cannot be used does not keep the others from it."""
    from tumato_symbolic.cli.mixups import misplaced
    from tumato_symbolic.diagnostics import UserError, render

    codes = {YES}
    for path in options.specs:
        context.tell(f"laying out {path}")
        try:
            codes.add(_lay_out(path, options))
        except UserError as error:
            other = misplaced(path)
            found = error.diagnostics if other is None else (other,)
            note(render(found, error.source, color=wants_colour(sys.stderr)))
            codes.add(USAGE)
    return max(codes)


def _lay_out(path: str, options: Options) -> int:
    from tumato_symbolic.editor.format import format_text
    from tumato_symbolic.policy import save_text
    from tumato_symbolic.syntax import read_source

    source = read_source(path)
    text = format_text(source)
    if options.check or options.diff:
        if text != source.text:
            write("".join(_differences(source, text)) if options.diff else f"{source.name} has another layout")
        return NO if text != source.text else YES
    if path == "-" and text:
        write(text)
    elif path != "-" and text != source.text:
        _need_file(path)
        save_text(_as_before(text, Path(path).read_bytes()), Path(path), "specification")
        write(f"{path} is laid out anew")
    return YES


def _need_file(path: str) -> None:
    """Raise `UserError` (TUM510) where a text was read that cannot be written back: a pipe, a device."""
    from tumato_symbolic.diagnostics import Code, Diagnostic, UserError
    from tumato_symbolic.diagnostics.wording import quoted

    if not Path(path).is_file():
        help_ = "name a file, or - for the standard input"
        raise UserError((Diagnostic(Code.TUM510, f"{quoted(path)} is no file that can be written anew", help=help_),))


def _as_before(text: str, old: bytes) -> str:
    """A text with the ends of lines and the byte-order mark that a file has."""
    mark = "\ufeff" if old.startswith(b"\xef\xbb\xbf") else ""
    return mark + (text.replace("\n", "\r\n") if old.partition(b"\n")[0].endswith(b"\r") else text)


def _differences(source: Source, text: str) -> Iterator[str]:
    from difflib import unified_diff

    before, after = (each.splitlines(keepends=True) for each in (source.text, text))
    for line in unified_diff(before, after, source.name, f"{source.name} (laid out)"):
        yield line if line.endswith("\n") else f"{line}\n\\ No newline at end of file\n"
