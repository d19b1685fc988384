"""Total and safe: a decision for every valid state, and every decision allowed (`docs/semantics.md`, section 3)."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

from msgspec import Struct

from tumato_symbolic.semantics import ActionSet, Objection, State, objections
from tumato_symbolic.spec import Ordering
from tumato_symbolic.verify.by_z3.encoding import formula_term
from tumato_symbolic.verify.by_z3.outcomes import UnsafeOutcome
from tumato_symbolic.verify.by_z3.policy_problem import PolicyProblem
from tumato_symbolic.verify.by_z3.solver import UndecidedError
from tumato_symbolic.verify.by_z3.terms import Term, at_most_one, conjunction, disjunction, negation
from tumato_symbolic.verify.result import PropertyResult, Refutation


class Obligation(Struct, frozen=True):
    """A claim about every decided state, and what it takes to violate it.

    `explain` reads the objection from a model; without it, it is the first one that `semantics` finds.
    """

    claim: str
    violation: Term
    explain: Callable[[Any, State, ActionSet], Objection] | None = None


def prove_total(problem: PolicyProblem) -> PropertyResult:
    """Every valid state has a decision: `V ⇒ defined`. With starts: every start has one, and only valid states have."""
    if problem.spec.starts:
        return _prove_starts(problem)
    model = problem.first_model("every valid state has a decision", problem.valid, negation(problem.defined))
    if model is None:
        return PropertyResult("total", "proved", 1, "z3")
    return PropertyResult("total", "refuted", refutation=Refutation("missing", problem.state.read(model)))


def _prove_starts(problem: PolicyProblem) -> PropertyResult:
    """`V ∧ start ⇒ defined`, and `defined ⇒ V`."""
    start = conjunction((problem.valid_at_all, formula_term(problem.spec.start, problem.state)))
    model = problem.first_model("every start has a decision", start, negation(problem.defined))
    if model is not None:
        return PropertyResult("total", "refuted", refutation=Refutation("missing", problem.state.read(model)))
    model = problem.first_model("only valid states are decided", problem.defined, negation(problem.valid_at_all))
    if model is None:
        return PropertyResult("total", "proved", 2, "z3")
    state, chosen = problem.read(model)
    return PropertyResult("total", "refuted", refutation=Refutation("invalid", state, chosen))


def prove_safe(problem: PolicyProblem, ordering: Ordering) -> PropertyResult:
    """Every decision for a valid state is allowed. One that is not is found also where other obligations are open."""
    obligations = [*_conditions(problem), _outcomes(problem, ordering)]
    if ordering == "first":
        violation = conjunction((problem.acting, negation(problem.kept_after)))
        what = "keep the rules" if problem.spec.restores_stepwise else "lead to a safe state"
        obligations.append(Obligation(f"all nominal effects together {what}", violation))
    undecided: UndecidedError | None = None
    for obligation in obligations:
        try:
            model = problem.first_model(obligation.claim, problem.decided, obligation.violation)
        except UndecidedError as unknown:
            undecided = unknown
            continue
        if model is not None:
            return _refuted(problem, obligation, model, ordering)
    if undecided is not None:
        raise undecided
    return PropertyResult("safe", "proved", len(obligations), "z3")


def _conditions(problem: PolicyProblem) -> Iterator[Obligation]:
    """Conditions 1 to 4 of section 3, and safety of the states where no action takes effect.

    In several steps, doing nothing breaks no rule, and restores nothing. Condition 6 follows from 5 under `any`: the
    nominal effects one after the other are an outcome.
    """
    spec, executed = problem.spec, problem.executed
    for cases in spec.cases:
        action, runs = spec.actions[cases[0]], disjunction(executed[case] for case in cases)
        if (action.conditions or len(cases) > 1) and runs is not False:
            holds = conjunction(formula_term(rule.formula, problem.state) for rule in action.preconditions)
            missed = [conjunction((executed[case], negation(_meant(problem, case)))) for case in cases]
            violation = disjunction((conjunction((runs, negation(holds))), *missed))
            yield Obligation(f"the preconditions of {action.name} hold wherever it is executed", violation)
    for number, resource in enumerate(spec.resources):
        users = [executed[place] for place, action in enumerate(spec.actions) if number in action.resources]
        if len(users) > 1:
            yield Obligation(f"{resource} is controlled by one action at a time", negation(at_most_one(users)))
    for variable, term in zip(spec.variables, problem.agreement, strict=True):
        if term is not True:
            yield Obligation(f"nominal effects agree on {variable.name}", negation(term))
    for rule in spec.reaction_rules:
        violation = negation(formula_term(rule.formula, problem.state, executed))
        yield Obligation(f"the reaction rule '{rule.text}' holds", violation)
    if spec.restoration == "one_step":
        idle = negation(disjunction(executed[number] for number, action in enumerate(spec.actions) if action.effects))
        yield Obligation("where no action takes effect, the state is safe", conjunction((idle, negation(problem.safe))))


def _meant(problem: PolicyProblem, case: int) -> Term:
    """The state is one in which this case of its action is meant."""
    guard = problem.spec.actions[case].guard
    return True if guard is None else formula_term(guard.formula, problem.state)


def _outcomes(problem: PolicyProblem, ordering: Ordering) -> Obligation:
    """Condition 5 of section 3."""
    unsafe = UnsafeOutcome(problem.spec, problem.state, problem.executed, ordering, problem.context)
    claim = "every outcome keeps the rules" if problem.spec.restores_stepwise else "every outcome is safe"
    return Obligation(claim, conjunction(unsafe.constraints), unsafe.objection)


def _refuted(problem: PolicyProblem, obligation: Obligation, model: object, ordering: Ordering) -> PropertyResult:
    state, chosen = problem.read(model)
    objection = (
        obligation.explain(model, state, chosen)
        if obligation.explain is not None
        else next(objections(problem.spec, state, chosen, ordering), None)
    )
    if objection is None:
        raise RuntimeError(f"{sorted(chosen)} is allowed in {state}, against the solver")
    return PropertyResult("safe", "refuted", refutation=Refutation("not-allowed", state, chosen, objection))
