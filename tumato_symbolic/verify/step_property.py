"""Total and safe: a decision for every valid state, and every decision allowed (`docs/semantics.md`, section 3)."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from tumato_symbolic.semantics import Objection, objections
from tumato_symbolic.spec import Ordering
from tumato_symbolic.verify.encoding import formula_term
from tumato_symbolic.verify.frame import Frame
from tumato_symbolic.verify.outcomes import UnsafeOutcome
from tumato_symbolic.verify.result import PropertyResult, Refutation
from tumato_symbolic.verify.terms import Term, at_most_one, conjunction, disjunction, negation

TIMEOUT = "Z3 did not answer within the time limit of one obligation: {claim}"


@dataclass(frozen=True, slots=True)
class Obligation:
    """A claim about every state `s`, and what it takes to violate it."""

    claim: str
    violation: Term


def prove_total(frame: Frame) -> PropertyResult:
    """Every valid state has a decision: `V ⇒ defined`."""
    claim = "every valid state has a decision"
    answer, model = frame.first_state(frame.valid, negation(frame.defined))
    if answer == "unsat":
        return PropertyResult("total", "proved", 1, "z3")
    if answer == "unknown":
        return PropertyResult("total", "undecided", reason=TIMEOUT.format(claim=claim))
    return PropertyResult("total", "refuted", refutation=Refutation("missing", frame.state.read(model)))


def prove_safe(frame: Frame, ordering: Ordering) -> PropertyResult:
    """Every decision for a valid state is allowed."""
    obligations = list(_conditions(frame))
    undecided: str | None = None
    for obligation in obligations:
        answer, model = frame.first_state(frame.decided, obligation.violation)
        if answer == "sat":
            state, chosen = frame.read(model)
            objection = next(objections(frame.spec, state, chosen, ordering), None)
            return _refuted(frame, model, objection)
        if answer == "unknown":
            undecided = TIMEOUT.format(claim=obligation.claim)
    unsafe = UnsafeOutcome(frame.spec, frame.state, frame.executed, ordering)
    answer, model = frame.first_state(frame.decided, *unsafe.constraints)
    if answer == "sat":
        return _refuted(frame, model, unsafe.objection(model, *frame.read(model)))
    if answer == "unknown":
        undecided = TIMEOUT.format(claim="every outcome is safe")
    if ordering == "first":
        answer, model = frame.first_state(frame.acting, negation(frame.safe_after))
        if answer == "sat":
            return _refuted(frame, model, next(objections(frame.spec, *frame.read(model), ordering), None))
        if answer == "unknown":
            undecided = TIMEOUT.format(claim="all nominal effects together lead to a safe state")
    if undecided is not None:
        return PropertyResult("safe", "undecided", reason=undecided)
    return PropertyResult("safe", "proved", len(obligations) + (1 if ordering == "any" else 2), "z3")


def _conditions(frame: Frame) -> Iterator[Obligation]:
    """Conditions 1 to 4 of section 3, and safety of the states where nothing is done.

    Condition 6 follows from 5 under `any`: the nominal effects one after the other are an outcome.
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
    idle = negation(disjunction(executed))
    yield Obligation("nothing is done in safe states only", conjunction((idle, negation(frame.safe))))


def _refuted(frame: Frame, model: object, objection: Objection | None) -> PropertyResult:
    state, chosen = frame.read(model)
    if objection is None:
        raise RuntimeError(f"{sorted(chosen)} is allowed in {state}, against the solver")
    return PropertyResult("safe", "refuted", refutation=Refutation("not-allowed", state, chosen, objection))
