"""`tumato-sym explain`: why there is no policy, and what would change that."""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any, ClassVar

from msgspec import Struct
from msgspec.structs import replace

from tumato_symbolic.cli import arguments
from tumato_symbolic.cli.console import note, wants_colour, write, write_to
from tumato_symbolic.cli.exits import NO, UNDECIDED, YES
from tumato_symbolic.cli.numbers import whole, whole_or_all
from tumato_symbolic.cli.options import MINUTE, CommandOptions, OutputFormat, Target, argument
from tumato_symbolic.cli.output import show_as
from tumato_symbolic.diagnostics import Source
from tumato_symbolic.limits import Context

if TYPE_CHECKING:
    from tumato_symbolic.cli.many import Doing, Work
    from tumato_symbolic.explain.explanation import Explanation, Wanted
    from tumato_symbolic.report.explained import Explained
    from tumato_symbolic.report.many import Many
    from tumato_symbolic.spec import Ordering, Restoration

ABOUT = """\
Say why there is no policy for a specification, and what would change that.

All states that fail, in a few groups; for each group the fewest lines that suffice for it; what the nearest sets of
actions break; what could be dropped or changed, each way tried; and the largest part of the states for which there is
a policy, as an assumption.
"""

EXAMPLES = """\
examples:
  tumato-sym explain robots.tum
  tumato-sym explain robots.tum --write robots_assumed.tum       # with the assumption that makes it realizable
  tumato-sym explain robots.tum --output-format sarif > explain.sarif
  tumato-sym explain robots/                                     # a folder: a line for each, in one table
"""


_BETWEEN = 0.5
"""Seconds between two records of what is known, where nothing is written."""

_REPAIRS = 3
"""So many ways to change lines are looked for, unless another number is asked for."""


class Options(CommandOptions, frozen=True):
    """What may be typed after `explain`."""

    specs: tuple[str, ...] = arguments.several_specs()
    max_cubes: int | None = argument(
        "--max-cubes",
        type=whole(1),
        metavar="N",
        help="list at most N groups of failing states (default: 1,000 for a program, the largest ones for a person)",
    )
    cores: int = argument(
        "--cores", type=whole(1), default=1, metavar="N", help="give up to N reasons for each group (default: 1)"
    )
    repairs: Wanted = argument(
        "--repairs",
        type=whole_or_all(0),
        default=_REPAIRS,
        metavar="N",
        help=f"look for N ways to change lines (default: {_REPAIRS}), or for `all`, also those that give up safety",
    )
    write: str | None = argument(
        "--write",
        metavar="FILE",
        help="write the specification with the assumption that makes it realizable (- for the standard output, the "
        "report then goes to the standard error stream)",
        writes=Target("specification", "--write", "assumed.tum"),
    )
    timeout: float | None = arguments.timeout("60")
    memory: int | None = arguments.memory()
    effect_ordering: Ordering | None = arguments.effect_ordering()
    restoration: Restoration | None = arguments.restoration()
    output_format: OutputFormat = arguments.output_format("json", "github", "sarif")

    jobs: int | None = arguments.jobs("several specifications")

    reports_interruption: ClassVar[bool] = True

    @property
    def own_seconds(self) -> float | None:
        """A minute for each specification."""
        return None if self.is_many else MINUTE

    def mistake(self) -> str | None:
        """What is written is written for one specification."""
        if self.is_many and "-" in self.specs:
            return "the standard input is one specification; name files or folders for several"
        if self.is_many and self.write is not None:
            return "--write writes one specification, and there are several"
        if self.is_many and self.output_format not in ("text", "json"):
            return f"--output-format {self.output_format} is for one specification; give them one after the other"
        return None

    def each(self) -> Iterator[Work]:
        """Every specification with options of its own. Raises `UserError`."""
        from tumato_symbolic.cli.many import Work, specifications

        for file in specifications(self.specs):
            yield Work(file, replace(self, specs=(file,), output_format="json"))


class _Known(Struct, frozen=True):
    """What is known by now, how many pieces of its text are written, and when that was recorded."""

    done: Explained
    written: int = 0
    recorded: float = 0.0


def run(options: Options, context: Context) -> int:
    """Exit with 1 where there is no policy: that is the answer, and the explanation belongs to it."""
    if options.is_many:
        from tumato_symbolic.cli.many import run_many

        return run_many(options.each(), _doing(), options, context, jobs=options.jobs)
    from tumato_symbolic.cli.inputs import errors_in, read_spec, show_warnings
    from tumato_symbolic.explain.explain import MAX_CUBES, explained
    from tumato_symbolic.explain.explanation import Explanation, Unexplained
    from tumato_symbolic.report.explained import Explained

    context.tell("reading the specification")
    source, spec, warnings = read_spec(options.specs[0], options.restoration)
    show_warnings(warnings, source, options)
    every_cube = options.max_cubes is not None
    known = _Known(Explained(source, spec, Unexplained(), warnings, None, every_cube))
    known = _learned(known, options, context)
    with errors_in(source):
        for found in explained(
            spec,
            options.effect_ordering,
            max_cubes=MAX_CUBES if options.max_cubes is None else options.max_cubes,
            cores=options.cores,
            wanted_repairs=options.repairs,
            context=context,
        ):
            done = replace(known.done, found=found)
            if options.write and done.written is None and isinstance(found, Explanation) and found.part is not None:
                _write(options.write, source, found)
                done = replace(done, written=options.write)
            known = _learned(replace(known, done=done), options, context)
    return _ended(known, options)


def stopped(known: _Known | Many, why: str, options: Options) -> int:
    """Report what is known, or what of it is not written yet, when work has to end."""
    if not isinstance(known, _Known):
        from tumato_symbolic.cli.many import ended as many_ended

        return many_ended(known, why, _doing(), options)
    from tumato_symbolic.explain.explanation import stopped as what_is_known

    return _ended(replace(known, done=replace(known.done, found=what_is_known(known.done.found, why))), options)


def _doing() -> Doing:
    from tumato_symbolic.cli.many import Doing

    return Doing(run, stopped, _said)


def _said(report: Mapping[str, Any]) -> str:
    """What was found of one of several specifications."""
    if report["verdict"] == "realizable":
        return "nothing to explain"
    from tumato_symbolic.report.layout import count

    found = [count(report["failing_states"], "failing state"), f"reasons: {len(report['failures']):,}"]
    found.append(f"repairs: {len(report['repairs']):,}")
    return ", ".join(found) + (f"; {report['limit']}" if report["limit"] else "")


def _learned(known: _Known, options: Options, context: Context) -> _Known:
    """Write the text of what is new, and record what is known; the other formats wait for the end."""
    before, now = known.written, time.monotonic()
    if options.output_format == "text":
        known = _written(known, options)
    if known.written > before or now - known.recorded >= _BETWEEN:
        known = replace(known, recorded=now)
        context.learn(known)
    return known


def _written(known: _Known, options: Options) -> _Known:
    from tumato_symbolic.report.explained import pieces

    found = pieces(known.done, wants_colour(sys.stderr if options.report_apart else sys.stdout))
    if len(found) > known.written:
        (note if options.report_apart else write)("\n".join(found[known.written :]))
    return replace(known, written=len(found))


def _ended(known: _Known, options: Options) -> int:
    """Write what is not written yet, and give the exit code."""
    if options.output_format == "text":
        _written(known, options)
    else:
        from tumato_symbolic.report import explained_data

        show_as(
            options,
            json=lambda: explained_data.as_json(known.done),
            findings=lambda: explained_data.findings(known.done),
            incomplete=explained_data.incomplete(known.done),
        )
    return _code(known)


def _code(known: _Known) -> int:
    from tumato_symbolic.explain.explanation import NothingToExplain, Unexplained

    match known.done.found:
        case NothingToExplain():
            return YES
        case Unexplained():
            return UNDECIDED
        case _:
            return NO


def _write(path: str, source: Source, found: Explanation) -> None:
    """Write the specification with the assumption of its realizable part, or with the starts of it."""
    from tumato_symbolic.explain.writing import with_assumption, with_starts

    assert found.part is not None, "there is something to write"
    text = (with_starts if found.spec.starts else with_assumption)(source, found.part.text)
    write_to(path, text, "specification")
