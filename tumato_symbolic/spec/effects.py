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
"""So many assignments are shown of effects that have several."""


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
            self.too_many(action, span)
            return None
        return tuple(found)

    def _assignments(self, parts: Sequence[Rule], limit: int, action: str, span: Span) -> list[Assignment] | None:
        return self.denoted([part.formula for part in parts], limit, action, span)

    def denoted(self, parts: Sequence[Formula], limit: int, action: str, span: Span) -> list[Assignment] | None:
        """At most so many of the assignments that effects denote; None, and a report, where that is too much work."""
        try:
            known = list(islice(models(conjunction(parts), self._sizes, self._budget), limit))
        except OutOfBudgetError:
            self.too_many(action, span)
            return None
        return [tuple(sorted((number, value) for (_, number), value in each.items())) for each in known]

    def too_many(self, action: str, span: Span) -> None:
        """Report that effects denote more than can be listed."""
        self._findings.add(
            Code.TUM307,
            f"these effects of {quoted(action)} denote too many assignments to list them",
            span,
            f"at most {MAX_OUTCOMES:,} are possible; mention fewer variables",
        )

    def _worded(self, assignment: Assignment) -> str:
        return quoted(worded(assignment, self._variables))


def _conditional_effect() -> str:
    from tumato_symbolic.syntax.habits import CONDITIONAL_EFFECT

    return CONDITIONAL_EFFECT


def worded(assignment: Assignment, variables: tuple[Variable, ...]) -> str:
    """`S_Place is dock, S_Arm is up`."""
    return ", ".join([f"{variables[each].name} is {variables[each].values[value]}" for each, value in assignment])


def conjunction(parts: Sequence[Formula]) -> Formula:
    """One formula for a list of effects; conjunctions inside are opened, since they say the same as commas."""
    parts = opened(parts)
    return And(tuple(parts)) if len(parts) > 1 else parts[0] if parts else TRUE


def opened(parts: Sequence[Formula]) -> list[Formula]:
    """The same parts, with those of conjunctions in their place."""
    found: list[Formula] = []
    for part in parts:
        found.extend(part.operands if isinstance(part, And) else (part,))
    return found
