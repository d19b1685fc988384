"""Total and safe: a decision for every valid state, and every decision allowed (`docs/semantics.md`, section 3)."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

from tumato_symbolic.semantics import ActionSet, Objection, State, objections
from tumato_symbolic.spec import Ordering
from tumato_symbolic.verify.by_z3.encoding import formula_term
from tumato_symbolic.verify.by_z3.frame import Frame
from tumato_symbolic.verify.by_z3.outcomes import UnsafeOutcome
from tumato_symbolic.verify.by_z3.solver import UndecidedError
from tumato_symbolic.verify.by_z3.terms import Term, at_most_one, conjunction, disjunction, negation
from tumato_symbolic.verify.result import PropertyResult, Refutation


@dataclass(frozen=True, slots=True)
class Obligation:
    """A claim about every decided state, and what it takes to violate it.

    `explain` reads the objection from a model; without it, it is the first one that `semantics` finds.
    """

    claim: str
    violation: Term
    explain: Callable[[Any, State, ActionSet], Objection] | None = None


def prove_total(frame: Frame) -> PropertyResult:
    """Every valid state has a decision: `V ⇒ defined`."""
    model = frame.first_model("every valid state has a decision", frame.valid, negation(frame.defined))
    if model is None:
        return PropertyResult("total", "proved", 1, "z3")
    return PropertyResult("total", "refuted", refutation=Refutation("missing", frame.state.read(model)))


def prove_safe(frame: Frame, ordering: Ordering) -> PropertyResult:
    """Every decision for a valid state is allowed. One that is not is found also where other obligations are open."""
    obligations = [*_conditions(frame), _outcomes(frame, ordering)]
    if ordering == "first":
        violation = conjunction((frame.acting, negation(frame.kept_after)))
        what = "keep the rules" if frame.spec.restores_stepwise else "lead to a safe state"
        obligations.append(Obligation(f"all nominal effects together {what}", violation))
    undecided: UndecidedError | None = None
    for obligation in obligations:
        try:
            model = frame.first_model(obligation.claim, frame.decided, obligation.violation)
        except UndecidedError as unknown:
            undecided = unknown
            continue
        if model is not None:
            return _refuted(frame, obligation, model, ordering)
    if undecided is not None:
        raise undecided
    return PropertyResult("safe", "proved", len(obligations), "z3")


def _conditions(frame: Frame) -> Iterator[Obligation]:
    """Conditions 1 to 4 of section 3, and safety of the states where no action takes effect.

    In several steps, doing nothing breaks no rule, and restores nothing. Condition 6 follows from 5 under `any`: the
    nominal effects one after the other are an outcome.
    """
    spec, executed = frame.spec, frame.executed
    for number, action in enumerate(spec.actions):
        if action.preconditions and executed[number] is not False:
            holds = conjunction(formula_term(rule.formula, frame.state) for rule in action.preconditions)
            violation = conjunction((executed[number], negation(holds)))
            yield Obligation(f"the preconditions of {action.name} hold wherever it is executed", violation)
    for number, resource in enumerate(spec.resources):
        users = [executed[place] for place, action in enumerate(spec.actions) if number in action.resources]
        if len(users) > 1:
            yield Obligation(f"{resource} is controlled by one action at a time", negation(at_most_one(users)))
    for variable, term in zip(spec.variables, frame.agreement, strict=True):
        if term is not True:
            yield Obligation(f"nominal effects agree on {variable.name}", negation(term))
    for rule in spec.reaction_rules:
        violation = negation(formula_term(rule.formula, frame.state, executed))
        yield Obligation(f"the reaction rule '{rule.text}' holds", violation)
    if spec.restoration == "one_step":
        idle = negation(disjunction(executed[number] for number, action in enumerate(spec.actions) if action.effects))
        yield Obligation("where no action takes effect, the state is safe", conjunction((idle, negation(frame.safe))))


def _outcomes(frame: Frame, ordering: Ordering) -> Obligation:
    """Condition 5 of section 3."""
    unsafe = UnsafeOutcome(frame.spec, frame.state, frame.executed, ordering, frame.context)
    claim = "every outcome keeps the rules" if frame.spec.restores_stepwise else "every outcome is safe"
    return Obligation(claim, conjunction(unsafe.constraints), unsafe.objection)


def _refuted(frame: Frame, obligation: Obligation, model: object, ordering: Ordering) -> PropertyResult:
    state, chosen = frame.read(model)
    objection = (
        obligation.explain(model, state, chosen)
        if obligation.explain is not None
        else next(objections(frame.spec, state, chosen, ordering), None)
    )
    if objection is None:
        raise RuntimeError(f"{sorted(chosen)} is allowed in {state}, against the solver")
    return PropertyResult("safe", "refuted", refutation=Refutation("not-allowed", state, chosen, objection))
