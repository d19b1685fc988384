"""`tumato-sym synth`: synthesize, prove, write, report."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, cast

from msgspec.structs import replace

from tumato_symbolic.cli import arguments
from tumato_symbolic.cli.exits import NO, UNDECIDED, YES
from tumato_symbolic.cli.options import CommandOptions, OutputFormat, Target, argument, is_folder
from tumato_symbolic.limits import Context

if TYPE_CHECKING:
    from tumato_symbolic.cli.many import Doing, Work
    from tumato_symbolic.report.many import Many
    from tumato_symbolic.report.synthesized import Synthesized
    from tumato_symbolic.spec import Ordering, Restoration
    from tumato_symbolic.verify import ProverName

ABOUT = """\
Compute a policy for a specification, prove it, and write it.

The policy says for every valid state which actions to execute. It is written only after it has been proved. Where there
is none, the states that fail are named, and NAME.unrealizable.json with the proof of that is written instead.

Of several specifications, or a folder of them, each has its own policy and a line in a table. The exit code is that of
the worst: 2, then 1, then 3, then 0.
"""

EXAMPLES = """\
examples:
  tumato-sym synth amr.tum                                      # writes policy.json
  tumato-sym synth amr.tum -o - | python -m json.tool | less    # the policy on the standard output
  tumato-sym synth amr.tum --output-format json                 # the answer for a program
  tumato-sym synth robots/ -o proofs/                           # a folder: NAME.policy.json for each, in one table
  tumato-sym synth amr.tum --html amr.html                      # and a page for a browser
"""

_POLICY = "policy.json"
"""Where the policy is written, unless another file is named."""


class Options(CommandOptions, frozen=True):
    """What may be typed after `synth`."""

    specs: tuple[str, ...] = arguments.several_specs()
    output: str = arguments.output(
        Target("policy"),
        _POLICY,
        "where to write the policy (default: policy.json here; - for the standard output, the report then goes to the "
        "standard error stream); of several specifications, the folder for NAME.policy.json (default: this one)",
    )
    effect_ordering: Ordering | None = arguments.effect_ordering()
    restoration: Restoration | None = arguments.restoration()
    policy_format: Literal["auto", "table", "diagram"] = argument(
        "--policy-format",
        choices=("auto", "table", "diagram"),
        default="auto",
        help="a row for every state, or a decision diagram (default: auto, a table up to about 10,000 valid states)",
    )
    prove: bool = arguments.no_verify("write the policy without a proof (the report says so)")
    html: str | None = argument(
        "--html",
        metavar="FILE",
        help="also write a page for a browser about the answer, as `report` does",
        writes=Target("page", "--html", "report.html"),
    )
    timeout: float | None = arguments.timeout()
    memory: int | None = arguments.memory()
    prover: ProverName = arguments.prover()
    jobs: int | None = arguments.jobs("the proof of a large policy, or several specifications")
    profile: bool = arguments.profile()
    output_format: OutputFormat = arguments.output_format("json", "github", "sarif")

    def mistake(self) -> str | None:
        """Several specifications have several policies, in a folder."""
        if not self.is_many:
            return None
        if "-" in self.specs:
            return "the standard input is one specification; name files or folders for several"
        if self.html is not None:
            return "--html writes one page, and there are several specifications"
        if self.output_format not in ("text", "json"):
            return f"--output-format {self.output_format} is for one specification; give them one after the other"
        if self.output != _POLICY and not is_folder(self.output):
            return f"of several specifications, -o names the folder for the policies, and {self.output} is none"
        return None

    def each(self) -> Iterator[Work]:
        """Every specification with options of its own. Raises `UserError`."""
        from tumato_symbolic.cli.many import Work, named_apart, specifications

        folder = Path("." if self.output == _POLICY else self.output)
        for file, name in named_apart(specifications(self.specs)):
            policy = str(folder / f"{name}.policy.json")
            yield Work(file, replace(self, specs=(file,), output=policy, output_format="json", jobs=1))

    def inputs(self) -> list[str]:
        """The specifications, those in folders as well."""
        if not self.is_many:
            return list(self.specs)
        from tumato_symbolic.cli.many import specifications

        return specifications(self.specs)

    def targets(self) -> Iterator[Target]:
        """The policy, and the certificate that there is none."""
        from tumato_symbolic.cli.targets import certificate_path

        if self.is_many:
            for work in self.each():
                if isinstance(work.options, Options):
                    yield from work.options.targets()
            return
        yield from CommandOptions.targets(self)
        certificate = certificate_path(self.output)
        if certificate is not None:
            yield Target("certificate that there is no policy", path=str(certificate))


def run(options: Options, context: Context) -> int:
    """Exit with 0 only when there is a policy, it is proved (unless that was declined), and it is written."""
    if options.is_many:
        from tumato_symbolic.cli.many import run_many

        return run_many(options.each(), _doing(), options, context, jobs=options.jobs)
    from tumato_symbolic.cli.inputs import errors_in, read_spec
    from tumato_symbolic.cli.synthesizing import prove, solve, write_answer, write_html
    from tumato_symbolic.report.synthesized import Synthesized
    from tumato_symbolic.synthesis import Undecided

    context.tell("reading the specification")
    source, spec, warnings = read_spec(options.specs[0], options.restoration)
    so_far = Synthesized(
        source, spec, Undecided("", None), None, warnings, options.output, False, restoration=options.restoration
    )
    context.learn(so_far)
    with errors_in(source):
        so_far = solve(so_far, options.effect_ordering, options.policy_format, context)
        so_far = prove(so_far, options.prover, options.jobs, context, wanted=options.prove)
    done = write_answer(so_far, context)
    if options.html is not None:
        write_html(done, options.html, context)
    context.tell("writing the report")
    code = _report(done, options)
    if options.profile:
        from tumato_symbolic.cli.output import show_profile

        show_profile(context)
    return code


def stopped(known: Synthesized | Many, why: str, options: Options) -> int:
    """Report what was known when a limit was met; what the answer is, if that was known."""
    if options.is_many:
        from tumato_symbolic.cli.many import ended as many_ended

        return many_ended(cast("Many", known), why, _doing(), options)
    known = cast("Synthesized", known)
    from tumato_symbolic.synthesis.synthesize import stopped as ended
    from tumato_symbolic.verify.result import stopped as not_all_proved

    found = ended(known.outcome, why)
    proof = None if known.proof is None else not_all_proved(known.proof, why)
    return _report(replace(known, outcome=found, proof=proof, cut_short=why), options)


def _doing() -> Doing:
    from tumato_symbolic.cli.many import Doing

    return Doing(run, stopped, _said)


def _said(report: Mapping[str, Any]) -> str:
    """What was found of one of several specifications."""
    if report["verdict"] == "unrealizable":
        failures = (f"{each['count']:,} {each['kind']}" for each in report["failures"])
        return f"failing states: {', '.join(failures)}; {report['certificate'] or 'no certificate'}"
    if report["policy"] is None:
        return "not proved, and not written"
    from tumato_symbolic.report.layout import count

    return f"{count(report['states']['valid'], 'valid state')}, {report['policy']}"


def _report(done: Synthesized, options: Options) -> int:
    from tumato_symbolic.cli.inputs import show_warnings
    from tumato_symbolic.cli.output import show
    from tumato_symbolic.report import synthesized
    from tumato_symbolic.synthesis import Unrealizable

    show_warnings(done.warnings, done.source, options)
    show(synthesized, done, options)
    if done.written:
        return YES
    return NO if isinstance(done.outcome, Unrealizable) else UNDECIDED
