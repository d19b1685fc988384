"""What a user sees when there is no answer: the input cannot be used, or a limit was met before there was one."""

from __future__ import annotations

import sys

from tumato_symbolic.cli.console import note, wants_colour
from tumato_symbolic.cli.options import CommandOptions
from tumato_symbolic.cli.output import show_as
from tumato_symbolic.diagnostics import UserError, render
from tumato_symbolic.report.findings import finding_json, findings_of, undecided


def show_undecided(why: str, options: CommandOptions) -> None:
    """That there is no answer, and nothing to say beside why."""
    file = options.specs[0] if options.specs else options.inputs()[-1]
    show_as(
        options,
        text=lambda _: f"{file}: undecided: {why}.",
        json=lambda: {"verdict": "undecided", "limit": why},
        findings=lambda: [undecided(why, file)],
    )


def show_user_error(error: UserError, options: CommandOptions) -> None:
    """A message, or the command's report in another format."""
    if options.output_format == "text":
        note(render(error.diagnostics, error.source, color=wants_colour(sys.stderr)))
        return
    name = error.source.name if error.source else None
    show_as(
        options,
        json=lambda: {
            "verdict": "error",
            "diagnostics": [finding_json(diagnostic, name) for diagnostic in error.diagnostics],
        },
        findings=lambda: findings_of(error.diagnostics, name),
    )
