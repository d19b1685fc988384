"""The cases of an action with clauses: one for each way in which its conditions may hold together."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import product
from math import prod

from msgspec import Struct
from msgspec.structs import replace

from tumato_symbolic.diagnostics import Code, Note
from tumato_symbolic.diagnostics.wording import quoted
from tumato_symbolic.spec.clauses import Change, ClauseSet
from tumato_symbolic.spec.collector import Findings
from tumato_symbolic.spec.components import Active, Part, components, parts
from tumato_symbolic.spec.effects import MAX_OUTCOMES, Effects, conjunction, opened, worded
from tumato_symbolic.spec.formula import FALSE, TRUE, Formula, Or, variables_of
from tumato_symbolic.spec.satisfiability import Budget, OutOfBudgetError, search, size
from tumato_symbolic.spec.specification import Action, Alternative, Assignment, Rule, Variable
from tumato_symbolic.spec.value_sets import one_of, values_where

MAX_CASES = 10_000
"""The most cases of all actions together, an action without clauses being one."""

MAX_CASE_WORK = 2_000_000
"""How many terms of conditions are looked at to find the cases of all actions."""

MAX_SEARCH_WORK = 2_000_000
"""How many terms are looked at to find states in which effects disagree or leave the range of a variable."""


class Unfinished(Struct, frozen=True):
    """An action with clauses, of which the cases are not made yet; the nominal set is the first one."""

    action: Action
    sets: tuple[ClauseSet, ...]


class TooManyCasesError(Exception):
    """The cases were not made; that is reported."""


class Cases:
    """Makes the cases of actions, within one budget for the whole specification."""

    def __init__(
        self, variables: tuple[Variable, ...], assumptions: tuple[Rule, ...], effects: Effects, findings: Findings
    ) -> None:
        self._variables = variables
        self._sizes = {number: len(each.values) for number, each in enumerate(variables)}
        self._assumptions = [rule.formula for rule in assumptions]
        self._effects = effects
        self._findings = findings
        self._work = Budget(MAX_CASE_WORK)
        self._search = Budget(MAX_SEARCH_WORK)
        self._made = 0

    def of(self, unfinished: Unfinished) -> tuple[Action, ...]:
        """The cases of an action; what is in error is left out of them, and reported."""
        self._warn_of_ends(unfinished)
        try:
            found = [parts(each, self._sizes, self._work) for each in components(unfinished.sets)]
            self._count(prod(map(len, found)), unfinished)
        except (OutOfBudgetError, TooManyCasesError):
            message = f"the conditions of {quoted(unfinished.action.name)} make too many cases"
            way_out = f"at most {MAX_CASES:,} for all actions are possible; let conditions speak of fewer variables"
            self._findings.add(Code.TUM319, message, unfinished.action.span, way_out)
            return (unfinished.action,)
        written = tuple(each.written() for each in unfinished.sets)
        never = replace(unfinished.action, guard=_rule(FALSE, unfinished), written=written)
        return tuple(self._cases(unfinished, found)) or (never,)

    def _count(self, cases: int, unfinished: Unfinished) -> None:
        self._made += cases
        self._work.spend(cases * len(unfinished.sets))
        if self._made > MAX_CASES:
            raise TooManyCasesError

    def _cases(self, unfinished: Unfinished, by_component: list[list[Part]]) -> Iterator[Action]:
        """One action for each list of assignments of the sets, as the values of variables are declared."""
        base = [(number, 0, each.clauses[0].fixed) for number, each in enumerate(unfinished.sets)]
        known: dict[tuple[int, tuple[Formula, ...]], tuple[Assignment, ...]] = {}
        guards: dict[tuple[tuple[Assignment, ...], ...], list[Formula]] = {}
        whole = True
        for chosen in product(*by_component):
            active = (*base, *(each for part in chosen for each in part.active))
            guard = conjunction([part.guard for part in chosen if part.guard != TRUE])
            found = self._denoted(unfinished, active, guard, known)
            if found is None:
                return
            whole = whole and bool(found)
            if found:
                guards.setdefault(tuple(found), []).append(guard)
        written = tuple(each.written() for each in unfinished.sets)
        for (nominal, *others), met in guards.items():
            entries = zip(others, unfinished.sets[1:], strict=True)
            guard = met[0] if len(met) == 1 else Or(tuple(met))
            yield replace(
                unfinished.action,
                nominal=nominal[0],
                alternatives=tuple(Alternative(outcomes, each.text, each.span) for outcomes, each in entries),
                guard=None if len(guards) == 1 and whole else _rule(guard, unfinished),
                written=written,
            )

    def _denoted(
        self,
        unfinished: Unfinished,
        active: Active,
        guard: Formula,
        known: dict[tuple[int, tuple[Formula, ...]], tuple[Assignment, ...]],
    ) -> list[tuple[Assignment, ...]] | None:
        """The assignments of each set in one case; empty where the case is never met, None where it is in error."""
        found = []
        for number, each in enumerate(unfinished.sets):
            key = number, tuple(formula for of, _, fixed in active if of == number for formula in fixed)
            if key not in known:
                denoted = self._effects.denoted(key[1], MAX_OUTCOMES + 1, unfinished.action.name, each.span)
                if denoted is None:
                    return None
                if len(denoted) > MAX_OUTCOMES:
                    self._effects.too_many(unfinished.action.name, each.span)
                    return None
                known[key] = tuple(denoted)
            if not known[key] or (number == 0 and len(known[key]) > 1):
                state = self._met(unfinished.action, guard)
                if state == "":
                    return []
                self._report(unfinished, number, active, known[key], state)
                return None
            found.append(known[key])
        return found

    def _met(self, action: Action, guard: Formula) -> str | None:
        """Where a case is met, in words; empty where it is nowhere, None where that was not found out."""
        formulas = [guard, *(rule.formula for rule in action.preconditions)]
        try:
            model = self._model(formulas)
            model = None if model is None else self._model([*formulas, *self._assumptions])
        except OutOfBudgetError:
            return None
        if model is None:
            return ""
        mentioned = sorted(frozenset[int]().union(*map(variables_of, formulas)))
        shown = worded(tuple((variable, model[variable]) for variable in mentioned), self._variables)
        return f"where {shown}" if shown else "in every state"

    def _model(self, formulas: Sequence[Formula]) -> dict[int, int] | None:
        """Values with which all formulas hold; what is said of one variable alone is settled first."""
        found: dict[int, frozenset[int]] = {}
        others: list[Formula] = []
        for formula in opened(formulas):
            mentioned = variables_of(formula)
            self._search.spend(size(formula))
            for variable in mentioned:
                found.setdefault(variable, frozenset(range(self._sizes[variable])))
            if len(mentioned) == 1:
                (variable,) = mentioned
                found[variable] &= values_where(formula, found[variable])
            else:
                others.append(formula)
        if not all(found.values()):
            return None
        mixed = sorted(frozenset[int]().union(*map(variables_of, others)))
        open_ = [(("variable", variable), sorted(found[variable])) for variable in mixed]
        known = next(search(conjunction(others), open_, {}, self._search), None)
        if known is None:
            return None
        return {variable: known.get(("variable", variable), min(values)) for variable, values in found.items()}

    def _report(
        self, unfinished: Unfinished, number: int, active: Active, denoted: tuple[Assignment, ...], state: str | None
    ) -> None:
        """Report a set of effects that does not denote what it has to where a case is met."""
        name, clauses = unfinished.action.name, unfinished.sets[number].clauses
        where = "perhaps in some state" if state is None else state
        if denoted:
            shown = "; ".join(quoted(worded(each, self._variables)) for each in denoted[:5])
            message = f"the nominal effects of {quoted(name)} leave more than one assignment {where}: {shown}"
            way_out = "name the expected one here and put the others under `alternative effects:`"
            self._findings.add(Code.TUM305, message, clauses[0].span, way_out)
            return
        own = [(clauses[place], fixed) for of, place, fixed in active if of == number and fixed]
        last, notes = own[-1][0], tuple[Note, ...]()
        for at, (clause, fixed) in enumerate(own):
            earlier = next((one for one, its in own[:at] if not self._agree((*its, *fixed))), None)
            if earlier is not None and earlier is not clause:
                last, notes = clause, (Note("the others are here", earlier.span),)
                break
        code = Code.TUM305 if number == 0 else Code.TUM306
        message = f"these effects of {quoted(name)} disagree with others that happen together with them, {where}"
        way_out = "let their conditions exclude each other, or exclude the state by a precondition"
        self._findings.add(code, message, last.span, way_out, notes)

    def _agree(self, formulas: tuple[Formula, ...]) -> bool:
        try:
            return self._model(formulas) is not None
        except OutOfBudgetError:
            return True

    def _warn_of_ends(self, unfinished: Unfinished) -> None:
        """Warn of relative effects that meet the end of the range in a state in which the action may start."""
        for clause in (clause for each in unfinished.sets for clause in each.clauses):
            for change in clause.changes:
                if not change.clipped:
                    continue
                clipped = one_of(change.variable, change.clipped, self._sizes[change.variable])
                state = self._met(unfinished.action, conjunction([clipped, clause.condition]))
                if state:
                    self._warn_of_end(change, state)

    def _warn_of_end(self, change: Change, state: str) -> None:
        variable = self._variables[change.variable]
        numbers = [int(value) for value in variable.values]
        end = max(numbers) if change.rises else min(numbers)
        kept = [number for place, number in enumerate(numbers) if place not in set(change.clipped)]
        bound = "" if not kept else f"<= {max(kept)}" if change.rises else f">= {min(kept)}"
        self._findings.add(
            Code.TUM331,
            f"this would leave the range of {quoted(variable.name)} {state}; it becomes {end} there",
            change.span,
            f"if that is not meant, add the precondition `{variable.name} {bound}`" if kept else None,
        )


def _rule(guard: Formula, unfinished: Unfinished) -> Rule:
    return Rule(guard, f"what happens in this case of {unfinished.action.name}", unfinished.action.span)
