"""The cases of an action with clauses: one for each way in which its conditions may hold together.

Conditions that share variables belong to one *component*. The cases of a component are found by looking at the values
of its variables, those of an action are the product of its components.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import product
from math import prod
from typing import TypeAlias

from tumato_symbolic.diagnostics import Code, Note
from tumato_symbolic.diagnostics.wording import quoted
from tumato_symbolic.spec.clauses import Change, Clause, ClauseSet
from tumato_symbolic.spec.collector import Findings
from tumato_symbolic.spec.effects import MAX_OUTCOMES, Effects, conjunction, opened, worded
from tumato_symbolic.spec.fold import Connectives, fold
from tumato_symbolic.spec.formula import FALSE, TRUE, Executing, Formula, Is, Or, variables_of
from tumato_symbolic.spec.satisfiability import Budget, OutOfBudgetError, search, size, truth
from tumato_symbolic.spec.specification import Action, Alternative, Assignment, Rule, Variable

MAX_CASES = 10_000
"""The most cases of all actions together, an action without clauses being one."""

MAX_CASE_WORK = 2_000_000
"""How many terms of conditions are looked at to find the cases of all actions."""

COMBINATION = 20
"""As many terms take as long as one combination of values, besides those of its conditions."""

MAX_SEARCH_WORK = 2_000_000
"""How many terms are looked at to find states in which effects disagree or leave the range of a variable."""

_Active: TypeAlias = tuple[tuple[int, int, tuple[Formula, ...]], ...]
"""Which effects happen: the number of their set, that of their clause, and the predicates."""


@dataclass(frozen=True, slots=True)
class Unfinished:
    """An action with clauses, of which the cases are not made yet; the nominal set is the first one."""

    action: Action
    sets: tuple[ClauseSet, ...]


@dataclass(frozen=True, slots=True)
class _Part:
    """A case of one component: what happens in it, and where it is met."""

    active: _Active
    guard: Formula


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
            components = [self._parts(component) for component in _components(unfinished.sets)]
            self._count(prod(map(len, components)), unfinished)
        except (OutOfBudgetError, TooManyCasesError):
            message = f"the conditions of {quoted(unfinished.action.name)} make too many cases"
            way_out = f"at most {MAX_CASES:,} for all actions are possible; let conditions speak of fewer variables"
            self._findings.add(Code.TUM319, message, unfinished.action.span, way_out)
            return (unfinished.action,)
        written = tuple(each.written() for each in unfinished.sets)
        never = replace(unfinished.action, guard=_rule(FALSE, unfinished), written=written)
        return tuple(self._cases(unfinished, components)) or (never,)

    def _count(self, cases: int, unfinished: Unfinished) -> None:
        self._made += cases
        self._work.spend(cases * len(unfinished.sets))
        if self._made > MAX_CASES:
            raise TooManyCasesError

    def _cases(self, unfinished: Unfinished, components: list[list[_Part]]) -> Iterator[Action]:
        """One action for each list of assignments of the sets, as the values of variables are declared."""
        base = [(number, 0, each.clauses[0].fixed) for number, each in enumerate(unfinished.sets)]
        known: dict[tuple[int, tuple[Formula, ...]], tuple[Assignment, ...]] = {}
        guards: dict[tuple[tuple[Assignment, ...], ...], list[Formula]] = {}
        whole = True
        for parts in product(*components):
            active = (*base, *(each for part in parts for each in part.active))
            guard = conjunction([part.guard for part in parts if part.guard != TRUE])
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
        active: _Active,
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
                found[variable] &= _values_where(formula, found[variable])
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
        self, unfinished: Unfinished, number: int, active: _Active, denoted: tuple[Assignment, ...], state: str | None
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
                clipped = _one_of(change.variable, change.clipped, self._sizes[change.variable])
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

    def _parts(self, component: _Component) -> list[_Part]:
        """The cases of one component: combinations of values are in one where the same happens."""
        happening = self._by_value(component) if len(component.variables) == 1 else self._by_values(component)
        cases: dict[frozenset[tuple[int, Formula]], int] = {}
        parts: list[_Active] = []
        table: list[int] = []
        for active in happening:
            effects = frozenset((number, formula) for number, _, fixed in active for formula in fixed)
            if effects not in cases:
                cases[effects] = len(parts)
                parts.append(active)
            table.append(cases[effects])
        guards = _guards(tuple(table), [(each, self._sizes[each]) for each in component.variables])
        return [_Part(active, guards[number]) for number, active in enumerate(parts)]

    def _by_value(self, component: _Component) -> list[_Active]:
        """What happens at each value of the only variable."""
        (variable,) = component.variables
        domain = frozenset(range(self._sizes[variable]))
        happening: list[list[tuple[int, int, tuple[Formula, ...]]]] = [[] for _ in domain]
        for number, place, clause in component.clauses:
            values = _values_where(clause.condition, domain)
            self._work.spend(size(clause.condition) + len(values))
            for value in values:
                happening[value].append((number, place, _happening(clause, {variable: value})))
        return [tuple(sorted(active, key=_place)) for active in happening]

    def _by_values(self, component: _Component) -> Iterator[_Active]:
        """What happens at each combination of values of the variables, the last of which changes fastest."""
        variables = component.variables
        combinations = prod(self._sizes[variable] for variable in variables)
        self._work.spend(
            combinations * (COMBINATION + sum(size(clause.condition) for _, _, clause in component.clauses))
        )
        for values in product(*(range(self._sizes[variable]) for variable in variables)):
            here = dict(zip(variables, values, strict=True))
            known = {("variable", variable): value for variable, value in here.items()}
            yield tuple(
                (number, place, _happening(clause, here))
                for number, place, clause in component.clauses
                if truth(clause.condition, known) is True
            )


@dataclass(frozen=True, slots=True)
class _Component:
    """Clauses that share variables, each with the number of its set and its own."""

    variables: tuple[int, ...]
    clauses: tuple[tuple[int, int, Clause], ...]


def _components(sets: Sequence[ClauseSet]) -> list[_Component]:
    """All clauses that depend on the state, by the variables that they depend on."""
    found: list[tuple[frozenset[int], list[tuple[int, int, Clause]]]] = []
    for number, place, clause in _depending(sets):
        mentioned = variables_of(clause.condition) | {change.variable for change in clause.changes}
        touching = [one for one in found if one[0] & mentioned or not (one[0] or mentioned)]
        others = [one for one in found if not any(one is each for each in touching)]
        clauses = [each for one in touching for each in one[1]]
        found = [*others, (mentioned.union(*(one[0] for one in touching)), [*clauses, (number, place, clause)])]
    return [_Component(tuple(sorted(variables)), tuple(clauses)) for variables, clauses in found]


def _depending(sets: Sequence[ClauseSet]) -> Iterator[tuple[int, int, Clause]]:
    """Clauses with the number of their set and their own; relative effects before all clauses each for itself."""
    for number, each in enumerate(sets):
        base, *others = each.clauses
        yield from ((number, 0, Clause(TRUE, (), (change,), base.span)) for change in base.changes)
        yield from ((number, place, clause) for place, clause in enumerate(others, 1))


def _happening(clause: Clause, values: dict[int, int]) -> tuple[Formula, ...]:
    """The effects of a clause where variables have these values."""
    relative = [Is(change.variable, change.results[values[change.variable]]) for change in clause.changes]
    return (*clause.fixed, *relative)


def _place(active: tuple[int, int, tuple[Formula, ...]]) -> tuple[int, int]:
    return active[:2]


def _values_where(condition: Formula, domain: frozenset[int]) -> frozenset[int]:
    """The values of the only variable that a condition speaks of with which it holds."""
    by: Connectives[frozenset[int]] = Connectives(
        constant=lambda value: domain if value else frozenset(),
        negation=lambda values: domain - values,
        conjunction=lambda several: domain.intersection(*several),
        disjunction=lambda several: frozenset[int]().union(*several),
        equivalence=lambda left, right: domain - (left ^ right),
    )

    def atom(atom: Is | Executing) -> frozenset[int]:
        return frozenset((atom.value,)) if isinstance(atom, Is) else frozenset()

    return fold(condition, atom, by)


def _guards(table: tuple[int, ...], variables: Sequence[tuple[int, int]]) -> dict[int, Formula]:
    """Where each number stands in a table over the values of variables, which come with the numbers of their values."""
    if not variables:
        return {table[0]: TRUE}
    (variable, size), *others = variables
    length = len(table) // size
    rows: dict[tuple[int, ...], list[int]] = {}
    for value in range(size):
        rows.setdefault(table[value * length : (value + 1) * length], []).append(value)
    found: dict[int, dict[Formula, list[int]]] = {}
    for row, values in rows.items():
        for number, inner in _guards(row, others).items():
            found.setdefault(number, {}).setdefault(inner, []).extend(values)
    guards: dict[int, Formula] = {}
    for number, parts in found.items():
        each = [
            conjunction([formula for formula in (_one_of(variable, sorted(values), size), inner) if formula != TRUE])
            for inner, values in parts.items()
        ]
        guards[number] = Or(tuple(each)) if len(each) > 1 else each[0]
    return guards


def _one_of(variable: int, values: Sequence[int], size: int) -> Formula:
    """That a variable, which has so many values, has one of these, at least one."""
    atoms = tuple(Is(variable, value) for value in values)
    return TRUE if len(atoms) == size else Or(atoms) if len(atoms) > 1 else atoms[0]


def _rule(guard: Formula, unfinished: Unfinished) -> Rule:
    return Rule(guard, f"what happens in this case of {unfinished.action.name}", unfinished.action.span)
