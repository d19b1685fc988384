"""`tumato-sym diff`: how two policies differ, or two specifications and their policies."""

from __future__ import annotations

from typing import TYPE_CHECKING

from msgspec.structs import replace

from tumato_symbolic.cli import arguments
from tumato_symbolic.cli.exits import NO, UNDECIDED, YES
from tumato_symbolic.cli.options import CommandOptions, OutputFormat, argument
from tumato_symbolic.limits import Context, LimitReachedError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from tumato_symbolic.cli.mixups import Kind
    from tumato_symbolic.diagnostics import UserError
    from tumato_symbolic.report.differing import Differing, SpecificationsDiffer
    from tumato_symbolic.spec import Spec
    from tumato_symbolic.synthesis import SynthesisResult

ABOUT = """\
Say which decisions differ between two policies: in which states, and how many, what was decided and what is.

Tables and diagrams are compared alike, whatever the order in which names are declared; states are never listed. With
the specification of the new policy, only valid states are compared. Of two specifications, the lines that differ in
meaning are shown, and how the policies differ that are synthesized from them; these are not proved. The exit code is 0
where nothing differs, else 1.
"""

EXAMPLES = """\
examples:
  tumato-sym diff old.json policy.json
  tumato-sym diff old.json policy.json amr.tum --output-format json
  tumato-sym diff old.tum amr.tum                   # what changed in meaning, and in what the robot does
"""


class Options(CommandOptions, frozen=True):
    """What may be typed after `diff`."""

    old: str = argument(metavar="OLD", help="the old policy, or the old specification")
    new: str = argument(metavar="NEW", help="the new one of the same kind")
    spec: str | None = argument(metavar="SPEC", nargs="?", help="the specification of the new policy")
    timeout: float | None = arguments.timeout()
    memory: int | None = arguments.memory()
    output_format: OutputFormat = arguments.output_format("json", "github")

    @property
    def specs(self) -> tuple[str, ...]:
        """The one that is no more than that; OLD and NEW are of either kind."""
        return () if self.spec is None else (self.spec,)

    def inputs(self) -> list[str]:
        """All of them are read."""
        return [name for name in (self.old, self.new, self.spec) if name]


def run(options: Options, context: Context) -> int:
    """Exit with 1 where something differs, with 3 where that is not known."""
    from tumato_symbolic.cli.mixups import kind_of

    kinds = [kind_of(name) for name in (options.old, options.new)]
    if "specification" not in kinds:
        return _report(_policies(options, context), options)
    if options.spec is not None or not {*kinds} <= {"specification", None}:
        raise _mixed(options, kinds)
    return _report(_specifications(options, context), options)


def stopped(known: SpecificationsDiffer, why: str, options: Options) -> int:
    """Report which elements differ, when the policies could not be compared in time."""
    return _report(replace(known, limit=why), options)


def _report(done: Differing, options: Options) -> int:
    from tumato_symbolic.cli.output import show
    from tumato_symbolic.report import differing

    show(differing, done, options)
    return {"same": YES, "different": NO, "undecided": UNDECIDED}[done.verdict]


def _mixed(options: Options, kinds: Sequence[Kind | None]) -> UserError:
    from tumato_symbolic.diagnostics import Code, Diagnostic, UserError
    from tumato_symbolic.diagnostics.wording import quoted

    message = "two specifications are compared without a third file"
    for name, kind in zip((options.old, options.new), kinds, strict=True):
        if kind not in ("specification", None):
            message = f"{quoted(name)} is a {kind}, and is compared with a specification"
    help_ = "name two policies, and the specification of the new one if you like; or two specifications"
    return UserError((Diagnostic(Code.TUM501, message, help=help_),))


def _policies(options: Options, context: Context) -> Differing:
    from tumato_symbolic.cli.inputs import errors_in, read_spec
    from tumato_symbolic.policy import Policy, fitted
    from tumato_symbolic.report.differing import PoliciesDiffer
    from tumato_symbolic.views import difference

    source, spec = None, None
    if options.spec is not None:
        context.tell("reading the specification")
        source, spec, _ = read_spec(options.spec)
    policies = []
    for name in (options.old, options.new):
        context.tell(f"reading {name}")
        policies.append(Policy.load(name))
    old, new = policies
    if source is not None and spec is not None:
        with errors_in(source):
            new = fitted(new, spec)
    return PoliciesDiffer(options.old, options.new, difference(old, new, spec, context), options.spec)


def _specifications(options: Options, context: Context) -> Differing:
    from tumato_symbolic.cli.inputs import errors_in, read_spec
    from tumato_symbolic.report.differing import SpecificationsDiffer
    from tumato_symbolic.synthesis import Realizable
    from tumato_symbolic.views import altered, difference

    specs, outcomes = [], []
    for name in (options.old, options.new):
        context.tell(f"reading {name}")
        specs.append(read_spec(name)[:2])
    (_, old), (_, new) = specs
    done = SpecificationsDiffer(options.old, options.new, altered(old, new))
    context.learn(done)
    for source, spec in specs:
        with errors_in(source):
            outcomes.append(_solved(spec, context))
    done = replace(done, outcomes=tuple(outcomes))
    context.learn(done)
    one, other = outcomes
    if isinstance(one, Realizable) and isinstance(other, Realizable):
        return replace(done, found=difference(one.policy, other.policy, context=context))
    limits = [each.limit for each in outcomes if not isinstance(each, Realizable) and each.limit is not None]
    return replace(done, limit=next(iter(limits), None))


def _solved(spec: Spec, context: Context) -> SynthesisResult:
    """The policy of a specification; that it takes too long is known to the whole."""
    from tumato_symbolic.synthesis import Undecided, synthesize

    found = synthesize(spec, policy_format="diagram", certify=False, diagnose=False, context=context.within())
    if isinstance(found, Undecided) and context.is_over:
        raise LimitReachedError(found.limit)
    return found
