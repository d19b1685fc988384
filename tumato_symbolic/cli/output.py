"""The report of a command, printed in the format that was asked for, and where its time went (`--profile`)."""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING, Protocol, TypeVar

from tumato_symbolic.cli.console import note, wants_colour, write
from tumato_symbolic.cli.options import CommandOptions
from tumato_symbolic.limits import Context

if TYPE_CHECKING:
    from tumato_symbolic.report.findings import Finding

Done_contra = TypeVar("Done_contra", contravariant=True)


class Report(Protocol[Done_contra]):
    """A module of `report`: one result for a person, for a program, and at its places."""

    def as_text(self, done: Done_contra, colour: bool) -> str:
        """For a person."""

    def as_json(self, done: Done_contra) -> Mapping[str, object]:
        """For a program."""

    def findings(self, done: Done_contra) -> Sequence[Finding]:
        """For GitHub, and as SARIF."""


def show(report: Report[Done_contra], done: Done_contra, options: CommandOptions) -> None:
    """Print a result in the format that was asked for."""
    show_as(
        options,
        text=partial(report.as_text, done),
        json=partial(report.as_json, done),
        findings=partial(report.findings, done),
    )


def show_as(
    options: CommandOptions,
    *,
    text: Callable[[bool], str] | None = None,
    json: Callable[[], Mapping[str, object]] | None = None,
    findings: Callable[[], Sequence[Finding]] | None = None,
    incomplete: Sequence[Mapping[str, object]] = (),
) -> None:
    """Print a report in the format that was asked for; only that is made. `text` is told whether to use colour.

    GitHub and SARIF are given the findings, SARIF also what is `incomplete`.

    It goes to the standard output, or beside it where that is for what the command makes.
    """
    match options.output_format:
        case "json" if json is not None:
            shown = _dumped(json())
        case "sarif" if findings is not None:
            from tumato_symbolic.report.sarif import as_sarif

            shown = _dumped(as_sarif(findings(), incomplete))
        case "github" if findings is not None:
            from tumato_symbolic.report.findings import as_github

            shown = as_github(findings())
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
