"""`tumato-sym sweep`: many variants of one specification."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, ClassVar, Literal

from tumato_symbolic.cli import arguments
from tumato_symbolic.cli.console import note, write
from tumato_symbolic.cli.exits import NO, UNDECIDED, USAGE, YES
from tumato_symbolic.cli.numbers import seconds, whole, whole_or_all
from tumato_symbolic.cli.options import STANDARD_OUTPUT, CommandOptions, OutputFormat, Target, argument
from tumato_symbolic.limits import Context

if TYPE_CHECKING:
    from collections.abc import Callable

    from tumato_symbolic.cli.progress import Progress
    from tumato_symbolic.diagnostics import Source
    from tumato_symbolic.report.swept import Swept
    from tumato_symbolic.spec import Ordering, Restoration
    from tumato_symbolic.sweep import Plan, Results, Task
    from tumato_symbolic.sweep.portions import Hired
    from tumato_symbolic.verify import ProverName

ABOUT = """\
Solve many variants of one specification, prove each answer, and compare it with that of the specification itself.

With -D NAME=VALUE,… the variants have other values for a list that ALIASES names, or a setting of CONFIG. With
--drop each, they do without one rule, precondition, alternative or assumption: which of them matter? With --mutate N,
each has one small mistake: how many of these do the rules and goals notice?
"""

EXAMPLES = """\
examples:
  tumato-sym sweep amr.tum -D max_plan_length=3,4,5
  tumato-sym sweep fleet.tum -D 'ROBOTS={r1},{r1,r2}' -D restoration=one_step,bounded
  tumato-sym sweep amr.tum --drop each
  tumato-sym sweep amr.tum --mutate 100 -o results.jsonl     # goes on where it stopped
  tumato-sym sweep amr.tum --mutate all --scheduler 10.0.0.7:8786
"""


class Options(CommandOptions, frozen=True):
    """What may be typed after `sweep`."""

    specs: tuple[str, ...] = arguments.specs()
    define: tuple[str, ...] = argument(
        "-D",
        metavar="NAME=VALUE,…",
        action="append",
        default=[],
        help="a variant for each value of a named list or a setting; given several times, for each combination",
    )
    drop: Literal["each"] | None = argument(
        "--drop", choices=("each",), help="a variant without each rule, precondition, alternative and assumption"
    )
    mutate: int | Literal["all"] | None = argument(
        "--mutate", type=whole_or_all(1), metavar="N", help="N variants with one small mistake each, or `all`"
    )
    seed: int | None = arguments.seed("which mistakes are drawn by --mutate (default: 0)", None)
    show: int | None = argument(
        "--show", type=whole(0), metavar="N", help="print the text of variant N, and solve nothing"
    )
    results: str | None = argument(
        "-o",
        "--output",
        metavar="FILE",
        help="add each result to this file, as a line of JSON; the same command goes on where it stopped",
        writes=Target("results file", "-o", "results.jsonl"),
    )
    each_seconds: float | None = argument(
        "--timeout", type=seconds, metavar="SECONDS", help="how long each variant may take (default: no limit)"
    )
    each_megabytes: int | None = arguments.memory("how much memory each variant may use")
    scheduler: str | None = argument(
        "--scheduler",
        metavar="ADDRESS",
        help="have a Dask cluster do the work, with its scheduler at HOST:PORT "
        "(pip install 'tumato-symbolic[cluster]')",
    )
    jobs: int | None = arguments.jobs("the variants on this machine")
    effect_ordering: Ordering | None = arguments.effect_ordering()
    restoration: Restoration | None = arguments.restoration()
    prover: ProverName = arguments.prover()
    prove: bool = arguments.no_verify("do without proofs (the results say so)")
    output_format: OutputFormat = arguments.output_format("json", "github", json="a JSON object a line")

    reports_interruption: ClassVar[bool] = True

    def mistake(self) -> str | None:
        """One kind of variants, and one place where the work is done."""
        if sum((bool(self.define), self.drop is not None, self.mutate is not None)) != 1:
            return "give one of -D NAME=VALUE,…, --drop each and --mutate N"
        if self.seed is not None and self.mutate is None:
            return "--seed is for --mutate"
        if self.scheduler is not None and self.jobs is not None:
            return "give either --scheduler, or --jobs for processes of this machine"
        if self.results == STANDARD_OUTPUT:
            return "-o needs a file to go on with; --output-format json puts the same lines on the standard output"
        if self.scheduler == "":
            return "--scheduler needs the address HOST:PORT of a scheduler"
        return None


def run(options: Options, context: Context) -> int:
    """Exit with 0 where every variant has a policy; of --drop and --mutate, where each makes a difference."""
    from tumato_symbolic.cli.inputs import read_spec, show_warnings
    from tumato_symbolic.diagnostics import UserError
    from tumato_symbolic.report.swept import Swept
    from tumato_symbolic.sweep import kept, sweep

    context.tell("reading the specification")
    source, _, warnings = read_spec(options.specs[0], options.restoration)
    plan = _plan(source, options)
    if options.show is not None:
        return _show(plan, options.show)
    show_warnings(warnings, source, options)
    with kept(options.results, plan.header(_version())) as results:
        progress = _progress(plan, results, options, context)

        def heard() -> None:
            progress.more(f"solving variants, {len(results.lines):,} of {len(plan.variants):,} done")

        heard()
        before = len(results.lines)
        try:
            sweep(plan, _common(options), _hired(plan, options), results, heard=heard)
        except KeyboardInterrupt:
            progress.record()
            raise
        except UserError as error:
            if len(results.lines) > before:
                _report(Swept(plan, results.in_order(), error.diagnostics[0].message), options)
            raise
    return _report(Swept(plan, results.in_order()), options)


def stopped(known: Swept, why: str, options: Options) -> int:
    """Report what was found by then."""
    from msgspec.structs import replace

    if options.results is not None:
        note(f"tumato-sym: {options.results} has what was found; the same command goes on from there")
    return _report(replace(known, limit=why), options)


def _version() -> str:
    from tumato_symbolic import __version__

    return __version__


def _plan(source: Source, options: Options) -> Plan:
    from tumato_symbolic.sweep import Plan, defined, definition, dropped, mutated

    common: dict[str, object] = {
        "effect_ordering": options.effect_ordering,
        "restoration": options.restoration,
        "prover": options.prover if options.prove else None,
        "timeout": options.each_seconds,
        "memory": options.each_megabytes,
    }
    if options.define:
        definitions = [definition(each) for each in options.define]
        values = {each.name: list(each.values) for each in definitions}
        return Plan("define", source, defined(source, definitions), {"define": values, **common})
    if options.drop is not None:
        return Plan("drop", source, dropped(source), common)
    assert options.mutate is not None, "it is one of the three"
    seed = options.seed or 0
    drawn, possible = mutated(source, options.mutate, seed)
    return Plan("mutate", source, drawn, {"mutate": options.mutate, "seed": seed, "possible": possible, **common})


def _show(plan: Plan, number: int) -> int:
    from tumato_symbolic.diagnostics import Code, Diagnostic, UserError

    if number >= len(plan.variants):
        help_ = f"they are numbered from 0, the specification itself, to {len(plan.variants) - 1}"
        raise UserError((Diagnostic(Code.TUM201, f"there is no variant {number}", help=help_),))
    write(plan.variants[number].text(plan.source))
    return YES


def _common(options: Options) -> Task:
    from tumato_symbolic.sweep import Task

    return Task(
        "",
        "",
        options.effect_ordering,
        options.restoration,
        options.prover,
        options.prove,
        options.each_seconds,
        options.each_megabytes,
    )


def _hired(plan: Plan, options: Options) -> Callable[[], Hired]:
    """Who does the work."""
    if options.scheduler is not None:
        from tumato_symbolic.sweep.cluster import cluster

        return partial(cluster, options.scheduler)
    from tumato_symbolic.cli.verifying import wanted_jobs
    from tumato_symbolic.sweep import processes

    return partial(processes, min(wanted_jobs(options.jobs), max(1, len(plan.variants) - 1)))


def _progress(plan: Plan, results: Results, options: Options, context: Context) -> Progress:
    """What the user is told while the work goes on; the first line for a program is the header."""
    from tumato_symbolic.cli.progress import Progress
    from tumato_symbolic.report.swept import Swept
    from tumato_symbolic.sweep import written

    def line(number: int) -> str | None:
        found = results.header if number == 0 else results.lines.get(number - 1)
        return None if found is None or options.output_format != "json" else written(found)

    def known() -> Swept | None:
        return Swept(plan, results.in_order()) if results.lines else None

    return Progress(context, line, known)


def _report(done: Swept, options: Options) -> int:
    from tumato_symbolic.cli.output import show_as
    from tumato_symbolic.report import swept

    if options.output_format != "json":  # whose lines were written when they were known
        show_as(options, text=lambda colour: swept.as_text(done, colour), findings=lambda: swept.findings(done))
    return _code(done)


def _code(done: Swept) -> int:
    """What a script may conclude: of values, that of the worst variant; else whether each change makes a difference."""
    verdicts = {each["verdict"] for each in done.variants}
    unproved = any(each["proof"] == "undecided" for each in done.variants)
    if done.plan.kind == "define":
        if "error" in verdicts:
            return USAGE
        if "unrealizable" in verdicts:
            return NO
        return UNDECIDED if done.limit or unproved or "undecided" in verdicts else YES
    if done.idle:
        return NO
    return UNDECIDED if done.limit or any(each["differs"] is None for each in done.counted) else YES
