"""`tumato-sym why`: why a policy decides as it does in a state."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tumato_symbolic.cli import arguments
from tumato_symbolic.cli.console import note
from tumato_symbolic.cli.exits import NO, YES
from tumato_symbolic.cli.options import CommandOptions, OutputFormat, argument
from tumato_symbolic.cli.output import show_as
from tumato_symbolic.diagnostics import Code, Diagnostic, UserError
from tumato_symbolic.limits import Context

if TYPE_CHECKING:
    from tumato_symbolic.semantics import ActionSet
    from tumato_symbolic.spec import Ordering, Restoration, Spec

ABOUT = """\
Say why a policy decides as it does in a state: which goal is active and why, the run to the goal, which other sets of
actions are not allowed, and by which outcome, and what the allowed ones would cost.
"""

EXAMPLES = """\
examples:
  tumato-sym why policy.json amr.tum S_Location=corridor S_Battery=low S_Load=free S_Conveyor=on
  tumato-sym why policy.json amr.tum S_Location=corridor S_Battery=low S_Load=free S_Conveyor=on --not move_to_charger
"""


class Options(CommandOptions, frozen=True):
    """What may be typed after `why`."""

    policy: str = arguments.policy()
    specs: tuple[str, ...] = arguments.specs()
    assignments: tuple[str, ...] = arguments.state("+")
    instead: str | None = argument(
        "--not", metavar="ACTION[,ACTION]", help="say why the policy does not choose this set of actions ('': none)"
    )
    output_format: OutputFormat = arguments.output_format("json")
    timeout: float | None = arguments.timeout()
    memory: int | None = arguments.memory()
    effect_ordering: Ordering | None = arguments.effect_ordering()
    restoration: Restoration | None = arguments.restoration()


def run(options: Options, context: Context) -> int:
    """Exit with 1 where the policy says nothing about the state."""
    from tumato_symbolic.cli.inputs import read_policy
    from tumato_symbolic.explain.decision import Decisions, alternative, why
    from tumato_symbolic.policy import UndecidedState, bind, judged_within, parse_assignments
    from tumato_symbolic.report import decided
    from tumato_symbolic.report.objections import Place
    from tumato_symbolic.semantics import cases_in

    source, spec, policy = read_policy(options, options.restoration, context, bind)
    ordering = options.effect_ordering or spec.ordering
    asked = parse_assignments(policy.vocabulary, options.assignments)
    state = tuple(variable.values.index(asked[variable.name]) for variable in spec.variables)
    context.tell("explaining the decision")
    spec = judged_within(spec, policy)
    decisions = Decisions(spec, policy)
    instead = None if options.instead is None else cases_in(spec, _actions(spec, options.instead), state)
    try:
        decision = why(spec, decisions, state, ordering)
    except KeyError:
        note(f"tumato-sym: {UndecidedState(asked)}{_NOT_NEEDED if spec.starts else ''}")
        return NO
    other = None if instead is None else alternative(spec, decisions, state, instead, ordering)
    done = decided.Decided(Place(spec, source.name), options.policy, decision, other)
    show_as(options, text=lambda _: decided.as_text(done), json=lambda: decided.as_json(done))
    return YES


_NOT_NEEDED = "; with START, a policy decides the starts and all that can follow from them, not every valid state"


def _actions(spec: Spec, text: str) -> ActionSet:
    """The set of actions that a list of names stands for; the empty text is the empty set."""
    from tumato_symbolic.diagnostics.wording import nearest, quoted

    names = [name.strip() for name in text.split(",") if name.strip()]
    known = spec.action_names
    for name in names:
        if name not in known:
            similar = nearest(name, known)
            help_ = f"did you mean {quoted(similar)}?" if similar else "see the ACTIONS block of the specification"
            raise UserError((Diagnostic(Code.TUM505, f"there is no action {quoted(name)}", help=help_),))
    return frozenset(known.index(name) for name in names)
