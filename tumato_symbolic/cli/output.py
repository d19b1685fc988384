"""The report of a command, and where its time went."""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from functools import partial
from typing import Protocol, TypeVar

from tumato_symbolic.cli.console import note, wants_colour, write
from tumato_symbolic.cli.options import CommandOptions
from tumato_symbolic.limits import Context

Done_contra = TypeVar("Done_contra", contravariant=True)


class Report(Protocol[Done_contra]):
    """A module of `report`: one result for a person, for a program and for GitHub."""

    def as_text(self, done: Done_contra, colour: bool) -> str:
        """For a person."""

    def as_json(self, done: Done_contra) -> Mapping[str, object]:
        """For a program."""

    def as_github(self, done: Done_contra) -> str:
        """Workflow commands."""


def show(report: Report[Done_contra], done: Done_contra, options: CommandOptions) -> None:
    """Print a result in the format that was asked for."""
    show_as(
        options,
        text=partial(report.as_text, done),
        json=partial(report.as_json, done),
        github=partial(report.as_github, done),
    )


def show_as(
    options: CommandOptions,
    *,
    text: Callable[[bool], str] | None = None,
    json: Callable[[], Mapping[str, object]] | None = None,
    github: Callable[[], str] | None = None,
    sarif: Callable[[], Mapping[str, object]] | None = None,
) -> None:
    """Print a report in the format that was asked for; only that is made. `text` is told whether to use colour.

    It goes to the standard output, or beside it where that is for what the command makes.
    """
    match options.output_format:
        case "json" if json is not None:
            shown = _dumped(json())
        case "sarif" if sarif is not None:
            shown = _dumped(sarif())
        case "github" if github is not None:
            shown = github()
        case "text" if text is not None:
            shown = text(wants_colour(sys.stderr if options.report_apart else sys.stdout))
        case other:
            raise AssertionError(f"the command offers the format {other}, and does not make it")
    (note if options.report_apart else write)(shown)


def _dumped(report: Mapping[str, object]) -> str:
    from tumato_symbolic.report.layout import dump

    return dump(report)


def show_profile(context: Context) -> None:
    """The time by stage, on the standard error stream."""
    from tumato_symbolic.report.profile import profile_text

    note(profile_text(context.stages(), _peak_megabytes()))


def _peak_megabytes() -> int | None:
    """The most memory that this process took; None where the system does not tell."""
    try:
        import resource
    except ImportError:
        return None
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak // (2**20 if sys.platform == "darwin" else 2**10)
