"""`tumato-sym check`: read specifications and report what is wrong with them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from msgspec.structs import replace

from tumato_symbolic.cli import arguments
from tumato_symbolic.cli.console import note
from tumato_symbolic.cli.exits import UNDECIDED, USAGE, YES
from tumato_symbolic.cli.options import CommandOptions, OutputFormat, are_large
from tumato_symbolic.cli.output import show_as
from tumato_symbolic.limits import Context

if TYPE_CHECKING:
    from tumato_symbolic.report.checked import Checked
    from tumato_symbolic.spec import Restoration

ABOUT = """\
Find mistakes in specifications without solving them: syntax, names, effects, and what cannot be intended.

Made for editors and commit hooks: it answers at once. Warnings alone exit with 0. What shows only in the states, such
as a rule that nothing breaks, is looked for where there are few of them; `synth` looks for it everywhere.
"""

EXAMPLES = """\
examples:
  tumato-sym check amr.tum
  tumato-sym check specs/*.tum --output-format github
"""


class Options(CommandOptions, frozen=True):
    """What may be typed after `check`."""

    specs: tuple[str, ...] = arguments.specs("+", "specifications, .tum files")
    restoration: Restoration | None = arguments.restoration()
    timeout: float | None = arguments.timeout()
    memory: int | None = arguments.memory()
    output_format: OutputFormat = arguments.output_format("json", "github", "sarif")

    @property
    def may_take_long(self) -> bool:
        """Where there is much to read."""
        return are_large(self.specs)


def run(options: Options, context: Context) -> int:
    """Check every file; one that cannot be used does not keep the others from being checked."""
    files: list[Checked] = []
    for path in options.specs:
        context.tell(f"reading {path}")
        files.append(_check(path, options.restoration))
        context.learn(tuple(files))
    return _report(files, options)


def stopped(known: tuple[Checked, ...], why: str, options: Options) -> int:
    """Report the files that were checked by then."""
    left = len(options.specs) - len(known)
    code = _report(known, options, f"{left} of {len(options.specs)} specifications were not checked: {why}")
    return code if code == USAGE else UNDECIDED


def _report(files: Sequence[Checked], options: Options, undecided: str | None = None) -> int:
    from tumato_symbolic.report import checked

    more = {} if undecided is None else {"verdict": "undecided", "limit": undecided}
    show_as(
        options,
        text=lambda colour: checked.as_text(files, colour),
        json=lambda: {**checked.as_json(files), **more},
        findings=lambda: checked.findings(files),
    )
    if undecided is not None:
        note(f"tumato-sym: {undecided}")
    return USAGE if any(file.failed for file in files) else YES


def _check(path: str, restoration: Restoration | None) -> Checked:
    from tumato_symbolic.diagnostics import UserError, not_allowed
    from tumato_symbolic.report.checked import Checked
    from tumato_symbolic.semantics.lint import lint
    from tumato_symbolic.spec import load
    from tumato_symbolic.syntax import read_source

    try:
        source = read_source(path)
    except UserError as error:
        return Checked(path, error.source, None, error.diagnostics)
    loaded = load(source)
    if loaded.spec is None:
        from tumato_symbolic.cli.mixups import misplaced

        other = misplaced(path)
        return Checked(path, source, None, loaded.diagnostics if other is None else (other,))
    spec = loaded.spec if restoration is None else replace(loaded.spec, restoration=restoration)
    return Checked(path, source, spec, (*loaded.diagnostics, *not_allowed(lint(spec), source)))
