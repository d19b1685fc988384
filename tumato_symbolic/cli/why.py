"""`tumato-sym why`: why a policy decides as it does in a state."""

from __future__ import annotations

from tumato_symbolic.cli.console import note, write
from tumato_symbolic.cli.exits import NO, YES
from tumato_symbolic.cli.inputs import errors_in, read_spec
from tumato_symbolic.cli.parser import Options
from tumato_symbolic.diagnostics import Code, Diagnostic, UserError
from tumato_symbolic.diagnostics.wording import nearest, quoted
from tumato_symbolic.explain.decision import Decisions, judged, why
from tumato_symbolic.limits import Context
from tumato_symbolic.policy import Policy, UndecidedState, bind, parse_assignments
from tumato_symbolic.report.decided import Decided, as_json, as_text
from tumato_symbolic.report.layout import dump
from tumato_symbolic.report.reasons import Place
from tumato_symbolic.semantics import ActionSet
from tumato_symbolic.spec import Spec


def run(options: Options, context: Context) -> int:
    """Exit with 1 where the policy says nothing about the state."""
    context.tell("reading the specification")
    source, spec, _ = read_spec(options.specs[0])
    context.tell(f"reading {options.policy}")
    policy = Policy.load(options.policy)
    with errors_in(source):
        policy = bind(policy, spec)
    ordering = options.effect_ordering or spec.ordering
    asked = parse_assignments(policy.vocabulary, options.assignments)
    state = tuple(variable.values.index(asked[variable.name]) for variable in spec.variables)
    context.tell("judging the decision")
    decisions = Decisions(spec, policy)
    instead = None if options.instead is None else _actions(spec, options.instead)
    try:
        decision = why(spec, decisions, state, ordering)
    except KeyError:
        note(f"tumato-sym: {UndecidedState(asked)}")
        return NO
    other = None if instead is None else judged(spec, decisions, state, instead, ordering)
    done = Decided(Place(spec, source.name), options.policy, decision, other)
    write(dump(as_json(done)) if options.output_format == "json" else as_text(done))
    return YES


def _actions(spec: Spec, text: str) -> ActionSet:
    """The set that a list of names stands for; the empty text is the empty set."""
    names = [name.strip() for name in text.split(",") if name.strip()]
    known = [action.name for action in spec.actions]
    for name in names:
        if name not in known:
            similar = nearest(name, known)
            help_ = f"did you mean {quoted(similar)}?" if similar else "see the ACTIONS block of the specification"
            raise UserError((Diagnostic(Code.TUM505, f"there is no action {quoted(name)}", help=help_),))
    return frozenset(known.index(name) for name in names)
