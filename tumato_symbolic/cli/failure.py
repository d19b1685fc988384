"""What a user sees when the input cannot be used: diagnostics in the format that was asked for."""

from __future__ import annotations

import sys

from tumato_symbolic.cli.console import note, wants_colour, write
from tumato_symbolic.cli.parser import Options
from tumato_symbolic.diagnostics import UserError, render
from tumato_symbolic.report.findings import finding_json, github_command, github_commands
from tumato_symbolic.report.layout import dump


def show_undecided(why: str, options: Options) -> None:
    """That there is no answer, and nothing to say beside why."""
    spec = options.specs[0] if options.specs else options.policy
    match options.output_format:
        case "json":
            text = dump({"verdict": "undecided", "limit": why})
        case "github":
            text = github_command("error", f"undecided: {why}", spec)
        case "sarif":
            from tumato_symbolic import __version__
            from tumato_symbolic.report.sarif import findings_sarif

            text = dump(findings_sarif((), spec, __version__))
        case _:
            text = f"{spec}: undecided: {why}."
    (note if _is_report_apart(options) else write)(text)


def _is_report_apart(options: Options) -> bool:
    """Whether the standard output is for what the command makes, and not for its report."""
    made = options.output if options.command in ("synth", "export-proof") else options.write
    return made == "-"


def show_user_error(error: UserError, options: Options) -> None:
    """A message, or the report that the command owes in another format."""
    name = error.source.name if error.source else None
    put = note if _is_report_apart(options) else write
    match options.output_format:
        case "json":
            findings = [finding_json(diagnostic, name) for diagnostic in error.diagnostics]
            put(dump({"verdict": "error", "diagnostics": findings}))
        case "github":
            put(github_commands(error.diagnostics, name))
        case "sarif":
            from tumato_symbolic import __version__
            from tumato_symbolic.report.sarif import findings_sarif

            put(dump(findings_sarif(error.diagnostics, name or options.specs[0], __version__)))
        case _:
            note(render(error.diagnostics, error.source, color=wants_colour(sys.stderr)))
