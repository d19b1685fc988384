"""`Out(s, A) ⊆ S` as a Z3 problem: one outcome that is not safe, sought among all (`docs/semantics.md`, section 3)."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import islice
from typing import Any

import z3

from tumato_symbolic.semantics import (
    ActionSet,
    Objection,
    State,
    excluded,
    fault_after,
    objections,
    replay,
)
from tumato_symbolic.spec import Action, Assignment, Ordering, Spec
from tumato_symbolic.verify.by_z3.encoding import Place, agreement_terms, formula_term, is_true
from tumato_symbolic.verify.by_z3.solver import Solver, UndecidedError
from tumato_symbolic.verify.by_z3.terms import (
    Context,
    Number,
    Term,
    at_most_one,
    conjunction,
    disjunction,
    implies,
    negation,
)
from tumato_symbolic.verify.by_z3.tier_terms import Tiers

LISTED_ACTIONS = 6
"""Of up to so many actions all outcomes are listed."""
OBJECTIONS_AT_ONCE = 20
"""So many objections are listed to one set of actions that was found."""


class AnyOutcome:
    """Some executed actions take effect, one effect each, in some order; `reached` is what they lead to.

    Of the effects that write a variable the last one, its *winner*, gives the value. An order is needed only among
    actions that may run together and write a common variable; for the others any order is the same. `conflicting`:
    the executed actions may share resources, as those of a policy that is not safe.
    """

    def __init__(
        self,
        spec: Spec,
        place: Place,
        executed: Sequence[Term],
        ordering: Ordering,
        context: Context,
        *,
        conflicting: bool = False,
    ) -> None:
        self._spec = spec
        self._conflicting = conflicting
        self._context = context
        self._taken: dict[int, list[Term]] = {
            number: [z3.Bool(f"u.{number}.{effect}", context) for effect in range(len(action.effects))]
            for number, action in enumerate(spec.actions)
            if executed[number] is not False
        }
        self._used = {number: disjunction(taken) for number, taken in self._taken.items()}
        self._ranks = self._rank_numbers() if ordering == "any" else {}
        self.constraints = [
            *(implies(used, executed[number]) for number, used in self._used.items()),
            *(at_most_one(taken) for taken in self._taken.values()),
            disjunction(self._used.values()),
            *self._exclusions(ordering),
        ]
        self.reached = Place([self._code(variable, code) for variable, code in enumerate(place.bits)])

    def _exclusions(self, ordering: Ordering) -> list[Term]:
        """Pairs of actions that do not both take effect: all under `first`, and those that may not run together."""
        if ordering == "first":
            return [at_most_one(self._used.values())]
        used = [self._used.get(number, False) for number in range(len(self._spec.actions))]
        if self._conflicting:
            return agreement_terms(self._spec, used)
        sharing = [
            at_most_one(used for number, used in self._used.items() if held in self._spec.actions[number].resources)
            for held in range(len(self._spec.resources))
        ]
        return [*sharing, *agreement_terms(self._spec, used)]

    def _rank_numbers(self) -> dict[int, Number]:
        """A place in the order for every action, by its first case, that must have one."""
        spec = self._spec
        apart = [0] * len(spec.actions) if self._conflicting else excluded(spec)
        writers = [0] * len(spec.variables)
        for number in self._taken:
            for variable in written(spec.actions[number]):
                writers[variable] |= 1 << number
        own = {cases[0]: sum(1 << case for case in cases) for cases in spec.cases}
        ordered = sorted(
            {
                spec.first_case[number]
                for number in self._taken
                for variable in written(spec.actions[number])
                if writers[variable] & ~apart[number] & ~own[spec.first_case[number]]
            }
        )
        width = max(1, (len(ordered) - 1).bit_length())
        return {number: z3.BitVec(f"o.{number}", width, self._context) for number in ordered}

    def _code(self, variable: int, code: Sequence[Term]) -> list[Term]:
        """The bits of a variable after the outcome."""
        first = self._spec.first_case
        writing = {number: self._writing(number, variable) for number in self._taken}
        writers = [number for number, terms in writing.items() if terms]
        using: dict[int, list[Term]] = {}
        for number in writers:
            using.setdefault(first[number], []).extend(term for term, _ in writing[number])
        uses = {number: disjunction(terms) for number, terms in using.items()}
        ranked = [number for number in uses if number in self._ranks]
        wins: dict[int, Term] = dict.fromkeys(uses, True)
        if len(ranked) > 1:
            wins.update({number: z3.Bool(f"w.{number}.{variable}", self._context) for number in ranked})
            self.constraints.extend(self._winner(ranked, wins, uses))
        untouched = negation(disjunction(uses.values()))
        return [
            disjunction(
                [
                    conjunction((untouched, bit)),
                    *(
                        conjunction((wins[first[number]], term))
                        for number in writers
                        for term, value in writing[number]
                        if value >> digit & 1
                    ),
                ]
            )
            for digit, bit in enumerate(code)
        ]

    def _writing(self, number: int, variable: int) -> list[tuple[Term, int]]:
        """The effects of an action that write a variable, with the value."""
        return [
            (taken, value)
            for taken, effect in zip(self._taken[number], self._spec.actions[number].effects, strict=True)
            for changed, value in effect
            if changed == variable
        ]

    def _winner(self, ranked: list[int], wins: dict[int, Term], uses: dict[int, Term]) -> list[Term]:
        """If one of these actions writes the variable, one that writes it is later than all others that do."""
        return [
            implies(disjunction(uses[number] for number in ranked), disjunction(wins[number] for number in ranked)),
            *(implies(wins[number], uses[number]) for number in ranked),
            *(
                implies(conjunction((wins[one], uses[other])), z3.ULT(self._ranks[other], self._ranks[one]))
                for one in ranked
                for other in ranked
                if one != other
            ),
        ]

    def steps(self, model: Any) -> list[tuple[int, Assignment]]:  # noqa: ANN401 - z3 has no types
        """The effects that happen in a model, in their order."""
        used = [
            (self._rank_in(model, self._spec.first_case[number]), number)
            for number, term in self._used.items()
            if is_true(model, term)
        ]
        return [
            (number, self._spec.actions[number].effects[effect])
            for _, number in sorted(used)
            for effect, term in enumerate(self._taken[number])
            if is_true(model, term)
        ]

    def _rank_in(self, model: Any, first: int) -> int:  # noqa: ANN401 - z3 has no types
        """The place of an action in the order; 0 where it does not matter."""
        found = self._ranks.get(first)
        return 0 if found is None else int(model.eval(found, model_completion=True).as_long())


class UnsafeOutcome(AnyOutcome):
    """An outcome that is not safe; where safety may take several steps to restore, that breaks a rule to be kept.

    Or, where preconditions have to hold throughout, that falsifies one of an executed action that has not taken effect.
    """

    def __init__(
        self, spec: Spec, place: Place, executed: Sequence[Term], ordering: Ordering, context: Context
    ) -> None:
        super().__init__(spec, place, executed, ordering, context)
        faults = [negation(Tiers(spec, place).kept(self.reached)), *self._falsified(executed)]
        self.constraints.append(disjunction(faults))

    def _falsified(self, executed: Sequence[Term]) -> Iterator[Term]:
        """The preconditions of an action that has not taken effect do not hold, where they have to."""
        if self._spec.preconditions == "throughout":
            for number, used in self._used.items():
                rules = self._spec.actions[number].preconditions
                holds = conjunction(formula_term(rule.formula, self.reached) for rule in rules)
                yield conjunction((executed[number], negation(used), negation(holds)))

    def objection(self, model: Any, state: State, chosen: ActionSet) -> Objection:  # noqa: ANN401 - z3 has no types
        """The outcome that a model gives, replayed, without the effects that are not needed."""
        steps = self.steps(model)
        acting = {number for number, _ in steps} <= chosen
        fault = fault_after(self._spec, state, chosen, replay(state, steps)) if steps and acting else None
        if fault is None:
            raise RuntimeError(f"the outcome {steps} of {sorted(chosen)} in {state} is safe, against the solver")
        for step in list(steps):
            shorter = [kept for kept in steps if kept is not step]
            found = fault_after(self._spec, state, chosen, replay(state, shorter)) if shorter else None
            if found is not None:
                steps, fault = shorter, found
        return fault


def objections_to(
    spec: Spec, state: State, chosen: ActionSet, ordering: Ordering, deadline: float = math.inf
) -> list[Objection]:
    """Some objections to `chosen` in `state`; none where it is allowed. Raises `UndecidedError`.

    The outcomes of many actions are too many to list: there, Z3 looks for an unsafe one.
    """
    if ordering == "first" or len(chosen) <= LISTED_ACTIONS:
        return list(islice(objections(spec, state, chosen, ordering), OBJECTIONS_AT_ONCE))
    single = [each for each in objections(spec, state, chosen, "first") if each.kind != "nominal-unsafe"]
    if single:
        return single[:OBJECTIONS_AT_ONCE]
    solver = Solver()
    here = Place.fresh(spec, "fixed", solver.context).after(tuple(enumerate(state)))
    executed = [number in chosen for number in range(len(spec.actions))]
    unsafe = UnsafeOutcome(spec, here, executed, ordering, solver.context)
    answer = solver.ask(*unsafe.constraints, deadline=deadline)
    if answer == "unknown":
        raise UndecidedError("every outcome of a set is safe")
    return [unsafe.objection(solver.model, state, chosen)] if answer == "sat" else []


def written(action: Action) -> frozenset[int]:
    """The variables that an action may write."""
    return frozenset(variable for effect in action.effects for variable, _ in effect)
