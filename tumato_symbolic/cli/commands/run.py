"""`tumato-sym run`: execute a policy, step by step or many times."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

from msgspec.structs import replace

from tumato_symbolic.cli import arguments
from tumato_symbolic.cli.console import note, write, write_to
from tumato_symbolic.cli.exits import NO, YES
from tumato_symbolic.cli.numbers import probability, whole
from tumato_symbolic.cli.options import CommandOptions, OutputFormat, Target, argument, is_folder
from tumato_symbolic.cli.output import show_as
from tumato_symbolic.limits import Context, LimitReachedError

if TYPE_CHECKING:
    from tumato_symbolic.cli.many import Work
    from tumato_symbolic.explain.decision import Decisions
    from tumato_symbolic.report.many import Many
    from tumato_symbolic.report.objections import Place
    from tumato_symbolic.semantics import State, Trace
    from tumato_symbolic.simulation import Faults, Starts
    from tumato_symbolic.spec import Ordering, Restoration

ABOUT = """\
Execute a policy from a state: step by step, or by itself.

Without one of the options --faults, --disturb, --steps and --runs, every step waits for a line on the standard input:
Enter lets all effects be nominal, a number chooses another outcome, `s VAR=VALUE` disturbs the state, `b` goes back,
`w` says why the policy decides so, `?` lists this, `q` ends. Variables without a value are drawn by chance, so that the
policy decides the state.

By itself, a run ends once the goals are met that were active at its start (or after the last disturbance). `worst`
looks for the longest way to the goal that outcomes in any order can force: from the state that is given, or from all
states that have the given values.
"""

EXAMPLES = """\
examples:
  tumato-sym run policy.json amr.tum S_Location=corridor S_Battery=low S_Load=free S_Conveyor=on
  tumato-sym run policy.json amr.tum --faults random --disturb 0.1 --runs 1000 --seed 7
  tumato-sym run policy.json amr.tum --faults worst --itf worst.itf.json
  tumato-sym run proofs/ robots/ --faults worst                   # every NAME.policy.json, in one table
"""

_STEPS = 1_000
"""So many steps a run has at most, unless another number is asked for."""


class Options(CommandOptions, frozen=True):
    """What may be typed after `run`."""

    policy: str = arguments.policy("the policy, a .json file, or a folder of them")
    specs: tuple[str, ...] = arguments.specs(
        help_="the specification, a .tum file; for a folder, that of its specifications"
    )
    assignments: tuple[str, ...] = arguments.state("*", "where to start: values of variables")
    faults: Literal["none", "random", "worst"] | None = argument(
        "--faults",
        choices=("none", "random", "worst"),
        help="which outcomes there are: the nominal ones (none, the default), any by chance (random), or those that "
        "keep the goal away longest (worst)",
    )
    disturb: float | None = argument(
        "--disturb",
        type=probability,
        metavar="P",
        help="after a step, change one variable to another value with this probability (default: 0)",
    )
    steps: int | None = argument(
        "--steps", type=whole(1), metavar="N", help=f"how many steps a run has at most (default: {_STEPS:,})"
    )
    runs: int | None = argument("--runs", type=whole(1), metavar="N", help="how many runs there are (default: 1)")
    seed: int = arguments.seed("what chance depends on: the same seed gives the same runs (default: 0)", 0)
    itf: str | None = argument(
        "--itf",
        metavar="FILE",
        help="write the run as an ITF trace, the format of Apalache",
        writes=Target("trace", "--itf", "trace.itf.json"),
    )
    jobs: int | None = arguments.jobs("a folder of policies")
    timeout: float | None = arguments.timeout()
    memory: int | None = arguments.memory()
    effect_ordering: Ordering | None = arguments.effect_ordering()
    restoration: Restoration | None = arguments.restoration()
    output_format: OutputFormat = arguments.output_format("json")

    @property
    def by_itself(self) -> bool:
        """Whether nobody is asked what happens."""
        return any(each is not None for each in (self.faults, self.disturb, self.steps, self.runs))

    @property
    def may_take_long(self) -> bool:
        """Not where every step is shown."""
        return self.by_itself

    @property
    def is_many(self) -> bool:
        """Whether a folder of policies is executed."""
        return is_folder(self.policy)

    def each(self) -> Iterator[Work]:
        """Every policy of the folder with options of its own. Raises `UserError` where it has none."""
        from tumato_symbolic.cli.many import Work, policies_in

        for policy, spec in policies_in(self.policy, self.specs[0]):
            own = replace(self, policy=policy, specs=(spec,), output_format="json") if isinstance(spec, str) else spec
            yield Work(policy, own)

    def mistake(self) -> str | None:
        """Step by step there is somebody to ask; the worst case leaves nothing to chance."""
        if self.is_many and (not self.by_itself or self.itf is not None):
            return "a folder of policies is executed by itself, and no trace written; add --faults none, say"
        if not self.by_itself:
            if "-" in self.inputs():
                return "step by step, the standard input is for commands; add --faults none for a run by itself"
            if self.output_format != "text" or self.timeout or self.memory:
                return "--output-format, --timeout and --memory are for runs by themselves; add --faults none for one"
        if self.faults == "worst" and (self.disturb is not None or self.steps or self.runs):
            return "--faults worst looks at all runs of any length; --disturb, --steps and --runs are for other faults"
        if self.itf is not None and (self.runs or 1) > 1:
            return "--itf writes one run, and there are several"
        return None


class _Loaded(NamedTuple):
    """What is executed, from where: `start` is None where not every variable is given a value."""

    place: Place
    policy: Decisions
    ordering: Ordering
    start: State | None
    starts: Starts


def run(options: Options, context: Context) -> int:
    """Exit with 0 where every run meets its goal; step by step, once the user has seen enough."""
    from tumato_symbolic.policy import UndecidedState
    from tumato_symbolic.simulation import NoStartError

    if options.is_many:
        from tumato_symbolic.cli.many import Doing, run_many

        return run_many(options.each(), Doing(run, None, _said), options, context, jobs=options.jobs)
    loaded = _load(options, context)
    try:
        if not options.by_itself:
            return _step_by_step(loaded, options)
        return _worst(loaded, options, context) if options.faults == "worst" else _many(loaded, options, context)
    except (NoStartError, UndecidedState) as error:
        note(f"tumato-sym: {error}")
        return NO


def stopped(known: Many, why: str, options: Options) -> int:
    """Report the policies of a folder that were executed when a limit was met."""
    from tumato_symbolic.cli.many import Doing, ended

    return ended(known, why, Doing(run, None, _said), options)


def _said(report: Mapping[str, Any]) -> str:
    """What was found of one policy of a folder."""
    from tumato_symbolic.report.layout import count

    if report["faults"] == "worst":
        steps = (
            "the goal may be kept away for ever"
            if report["steps"] is None
            else f"at most {count(report['steps'], 'step')}"
        )
        return f"{report['specification']}: {steps} from {count(report['starts'], 'start')}"
    ends = (f"{number:,} {_ENDS[end]}" for end, number in report["ends"].items() if number)
    return f"{report['specification']}: of {count(report['runs'], 'run')} {', '.join(ends)}"


_ENDS = {
    "goal": "met the goal",
    "bound": "came to the bound",
    "loop": "came to a loop",
    "undefined": "were not decided",
}


def _load(options: Options, context: Context) -> _Loaded:
    from tumato_symbolic.cli.inputs import read_policy
    from tumato_symbolic.explain.decision import Decisions
    from tumato_symbolic.policy import bind, parse_assignments
    from tumato_symbolic.report.objections import Place
    from tumato_symbolic.simulation import Starts

    source, spec, policy = read_policy(options, options.restoration, context, bind)
    asked = parse_assignments(policy.vocabulary, options.assignments, whole=False)
    given = {
        number: variable.values.index(asked[variable.name])
        for number, variable in enumerate(spec.variables)
        if variable.name in asked
    }
    start = tuple(given[number] for number in range(len(spec.variables))) if len(given) == len(spec.variables) else None
    ordering = options.effect_ordering or spec.ordering
    return _Loaded(Place(spec, source.name), Decisions(spec, policy), ordering, start, Starts(spec, policy, given))


def _step_by_step(loaded: _Loaded, options: Options) -> int:
    from tumato_symbolic.cli.stepping import Session
    from tumato_symbolic.simulation import Dice

    start = loaded.start or loaded.starts.draw(Dice(options.seed))
    say = note if options.report_apart else write
    session = Session(loaded.place, options.policy, loaded.policy, loaded.ordering, say)
    _write_itf(loaded.place, session.run(start), options)
    return YES


def _worst(loaded: _Loaded, options: Options, context: Context) -> int:
    from tumato_symbolic.report import simulated
    from tumato_symbolic.simulation import MOST_OUTCOMES, worst_case

    starts = loaded.starts.all(MOST_OUTCOMES)
    trace = starts and worst_case(loaded.place.spec, loaded.policy, starts, loaded.ordering, context)
    if not starts or not trace:
        reason = f"more than {MOST_OUTCOMES:,} outcomes can follow, which are too many to look at one by one"
        raise LimitReachedError(f"{reason}; `verify --guarantees` looks at all states at once")
    done = simulated.WorstCase(loaded.place, options.policy, len(starts), trace)
    _write_itf(loaded.place, trace, options)
    show_as(options, text=lambda _: simulated.worst_as_text(done), json=lambda: simulated.worst_as_json(done))
    return YES if trace.end == "goal" else NO


def _many(loaded: _Loaded, options: Options, context: Context) -> int:
    from tumato_symbolic.report import simulated
    from tumato_symbolic.simulation import Dice, Simulation, executed, summarized

    runs, spec, faults = options.runs or 1, loaded.place.spec, _faults(options)
    disturb = options.disturb or 0.0
    simulation = Simulation(spec, loaded.policy, loaded.ordering, faults, disturb, options.steps or _STEPS)
    dice = Dice(options.seed)
    kept: list[Trace] = []

    def traces() -> Iterator[Trace]:
        for _ in range(runs):
            context.check()
            trace = executed(simulation, loaded.start or loaded.starts.draw(dice), dice)
            if runs == 1:
                kept.append(trace)
            yield trace

    context.tell("executing the policy")
    summary = summarized(spec, traces())
    if kept:
        _write_itf(loaded.place, kept[0], options)
    shown = kept[0] if kept else None if summary.missed is None else summary.missed[1]
    done = simulated.Simulated(loaded.place, options.policy, faults, disturb, options.seed, summary, shown)
    show_as(options, text=lambda _: simulated.as_text(done), json=lambda: simulated.as_json(done))
    return YES if summary.met == summary.runs else NO


def _faults(options: Options) -> Faults:
    return "random" if options.faults == "random" else "none"


def _write_itf(place: Place, trace: Trace, options: Options) -> None:
    """The trace as a file, where one is asked for."""
    if options.itf is None:
        return
    from tumato_symbolic.report.layout import dump
    from tumato_symbolic.report.traces import trace_itf

    write_to(options.itf, f"{dump(trace_itf(place, trace))}\n", "trace")
