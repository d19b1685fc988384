"""What a user sees when the input cannot be used: diagnostics in the format that was asked for."""

from __future__ import annotations

import sys

from tumato_symbolic.cli.console import note, wants_colour, write
from tumato_symbolic.cli.parser import Options
from tumato_symbolic.diagnostics import UserError, render
from tumato_symbolic.report.findings import finding_json, github_commands
from tumato_symbolic.report.layout import dump


def show_user_error(error: UserError, options: Options) -> None:
    """Text and workflow commands go where messages go; JSON is the one object that the command owes."""
    name = error.source.name if error.source else None
    match options.output_format:
        case "json":
            findings = [finding_json(diagnostic, name) for diagnostic in error.diagnostics]
            text = dump({"verdict": "error", "diagnostics": findings})
            if options.command == "synth" and options.output == "-":
                note(text)
            else:
                write(text)
        case "github":
            write(github_commands(error.diagnostics, name))
        case "sarif":
            from tumato_symbolic import __version__
            from tumato_symbolic.report.sarif import findings_sarif

            write(dump(findings_sarif(error.diagnostics, name or options.specs[0], __version__)))
        case _:
            note(render(error.diagnostics, error.source, color=wants_colour(sys.stderr)))
