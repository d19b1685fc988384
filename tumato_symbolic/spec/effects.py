"""Sets of effects as the assignments that they denote (`docs/semantics.md`, section 2)."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import islice

from tumato_symbolic.diagnostics import Code, Span
from tumato_symbolic.diagnostics.wording import quoted
from tumato_symbolic.spec.collector import Findings
from tumato_symbolic.spec.formula import TRUE, And, Formula
from tumato_symbolic.spec.satisfiability import Budget, OutOfBudgetError, models
from tumato_symbolic.spec.specification import Assignment, Rule, Variable

MAX_OUTCOMES = 10_000
"""The most assignments that one entry of alternative effects may denote."""

MAX_EFFECT_WORK = 2_000_000
"""How many terms are looked at, for all actions together, to find the assignments that effects denote."""

_SHOWN = 5


class Effects:
    """Finds assignments, within one budget for the whole specification."""

    def __init__(self, variables: tuple[Variable, ...], findings: Findings) -> None:
        self._variables = variables
        self._sizes = {number: len(each.values) for number, each in enumerate(variables)}
        self._findings = findings
        self._budget = Budget(MAX_EFFECT_WORK)

    def nominal(self, parts: Sequence[Rule], action: str, span: Span, conditional: bool) -> Assignment | None:
        """The one assignment that nominal effects denote; None, and a report, where it is not one.

        `conditional`: an implication stands among them, which was hardly meant to be about the state afterwards.
        """
        found = self._assignments(parts, _SHOWN + 1, action, span)
        if found is None:
            return None
        if len(found) == 1:
            return found[0]
        if not found:
            self._findings.add(
                Code.TUM305,
                f"the nominal effects of {quoted(action)} contradict each other",
                span,
                "they must leave exactly one assignment to the variables that they mention",
            )
            return None
        shown = "; ".join(self._worded(each) for each in found[:_SHOWN])
        more = "; …" if len(found) > _SHOWN else ""
        self._findings.add(
            Code.TUM305,
            f"the nominal effects of {quoted(action)} leave more than one assignment: {shown}{more}",
            span,
            _conditional_effect()
            if conditional
            else "name the expected one here and put the others under `alternative effects:`",
        )
        return None

    def alternative(self, parts: Sequence[Rule], action: str, span: Span) -> tuple[Assignment, ...] | None:
        """Every assignment that alternative effects denote; None, and a report, where there is none."""
        found = self._assignments(parts, MAX_OUTCOMES + 1, action, span)
        if found is None:
            return None
        if not found:
            self._findings.add(
                Code.TUM306,
                f"these alternative effects of {quoted(action)} contradict each other",
                span,
                "an outcome has to be possible; remove the entry or correct it",
            )
            return None
        if len(found) > MAX_OUTCOMES:
            self._too_many(action, span)
            return None
        return tuple(found)

    def _assignments(self, parts: Sequence[Rule], limit: int, action: str, span: Span) -> list[Assignment] | None:
        try:
            known = list(islice(models(_conjunction(parts), self._sizes, self._budget), limit))
        except OutOfBudgetError:
            self._too_many(action, span)
            return None
        return [tuple(sorted((number, value) for (_, number), value in each.items())) for each in known]

    def _too_many(self, action: str, span: Span) -> None:
        self._findings.add(
            Code.TUM307,
            f"these effects of {quoted(action)} denote too many assignments to list them",
            span,
            f"at most {MAX_OUTCOMES:,} are possible; mention fewer variables",
        )

    def _worded(self, assignment: Assignment) -> str:
        pairs = [f"{self._variables[each].name} is {self._variables[each].values[value]}" for each, value in assignment]
        return quoted(", ".join(pairs))


def _conditional_effect() -> str:
    from tumato_symbolic.syntax.habits import CONDITIONAL_EFFECT

    return CONDITIONAL_EFFECT


def _conjunction(parts: Sequence[Rule]) -> Formula:
    """One formula for a list of effects; conjunctions inside are opened, since they say the same as commas."""
    opened: list[Formula] = []
    for part in parts:
        opened.extend(part.formula.operands if isinstance(part.formula, And) else (part.formula,))
    return And(tuple(opened)) if len(opened) > 1 else opened[0] if opened else TRUE
