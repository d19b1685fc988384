"""The report of a command, and where its time went."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from typing import Protocol, TypeVar

from tumato_symbolic.cli.console import note, wants_colour, write
from tumato_symbolic.cli.parser import Options
from tumato_symbolic.limits import Context
from tumato_symbolic.report.layout import dump

Done_contra = TypeVar("Done_contra", contravariant=True)


class Report(Protocol[Done_contra]):
    """A module of `report`: one result for a person, for a program and for GitHub."""

    def as_text(self, done: Done_contra, colour: bool) -> str:
        """For a person."""

    def as_json(self, done: Done_contra) -> Mapping[str, object]:
        """For a program."""

    def as_github(self, done: Done_contra) -> str:
        """Workflow commands."""


def show(report: Report[Done_contra], done: Done_contra, options: Options, *, to_stderr: bool = False) -> None:
    """Print a result in the format that was asked for."""
    match options.output_format:
        case "json":
            text = dump(report.as_json(done))
        case "github":
            text = report.as_github(done)
        case _:
            text = report.as_text(done, wants_colour(sys.stderr if to_stderr else sys.stdout))
    (note if to_stderr else write)(text)


def show_profile(context: Context, options: Options) -> None:
    """Where the time went, on the standard error stream, if that was asked for."""
    if options.profile:
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
