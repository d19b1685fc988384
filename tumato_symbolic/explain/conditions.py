"""What every element demands of a step, over one manager: dropping elements is leaving out conjuncts.

`Ok` is a conjunction over elements, given which alternatives can happen: *every outcome keeps all rules* is *every
outcome keeps this rule*, for each rule. Each part is computed once, so that hundreds of specifications that differ in
what is dropped cost little more than one.
"""

from __future__ import annotations

from collections.abc import Iterator
from copy import copy
from dataclasses import replace
from itertools import combinations

from tumato_symbolic.explain.elements import Element, Elements, elements_of, keep_only, replace_rule, rule_of
from tumato_symbolic.semantics import State
from tumato_symbolic.spec import Assignment, Formula, Ordering, Rule, Spec, variables_of
from tumato_symbolic.symbolic import Backend, Bdd, Encoding, Steps, build_steps, encode, regions


class Conditions:
    """The steps of a specification and of everything that dropping elements makes of it.

    `valid` are the states that satisfy *all* assumptions: whatever is dropped, only these are asked about.
    """

    def __init__(self, spec: Spec, ordering: Ordering, backend: Backend) -> None:
        self.spec = spec
        self.ordering = ordering
        self.elements = elements_of(spec)
        no_resources = frozenset(each for each in self.elements if each.kind != "resource")
        self.encoding: Encoding = encode(keep_only(spec, no_resources), backend)
        self.manager = self.encoding.manager
        self.valid: Bdd = self.encoding.domain() & self.encoding.all_of(rule.formula for rule in spec.assumptions)
        self.regions = regions(self.encoding, self.valid)
        self._plain = self._steps_of(keep_only(spec, frozenset()))
        self._relevant = {rule: self._relevant_alternatives(rule) for rule in self.elements if _is_lasting(rule)}
        self._lasting: dict[tuple[Element, Elements], Bdd] = {}
        self._simple: dict[Element, Bdd] = {}

    @property
    def false(self) -> Bdd:
        """The empty set."""
        return self.manager.false

    @property
    def everything(self) -> Elements:
        """All elements."""
        return frozenset(self.elements)

    def allowed(self, kept: Elements) -> Bdd:
        """`Ok(s, A)` when only these elements are kept."""
        return self.manager.intersection([self._plain.allowed, *self._demands(kept)])

    def steps(self, kept: Elements) -> Steps:
        """The step relation when only these elements are kept."""
        valid = self.encoding.domain() & self._all_of(kept, "assumption")
        allowed = self.allowed(kept)
        return Steps(self.encoding, self.ordering, valid, valid & self._all_of(kept, "state-rule"), allowed, allowed)

    def changed(self, element: Element, rule: Rule) -> Conditions:
        """The same with another predicate in the place of a rule or a precondition; the rest is not computed again."""
        other = self._with_spec(replace_rule(self.spec, element, rule))
        other._simple = {each: found for each, found in self._simple.items() if each != element}
        other._lasting = {key: found for key, found in self._lasting.items() if key[0] != element}
        if _is_lasting(element):
            other._relevant = self._relevant | {element: other._relevant_alternatives(element)}
        return other

    def bounded(self, bound: int) -> Conditions:
        """The same with another plan bound."""
        return self._with_spec(replace(self.spec, max_plan_length=bound))

    def _with_spec(self, spec: Spec) -> Conditions:
        other = copy(self)
        other.spec = spec
        return other

    def steps_within(self, states: Bdd) -> Steps:
        """The step relation of the whole specification when only these valid states may occur."""
        return build_steps(replace(self.encoding, spec=self.spec), self.ordering, states)

    def stuck(self, kept: Elements) -> Bdd:
        """The valid states without an allowed set."""
        return self.valid & ~self.manager.exists(self.encoding.all_choice_bits, self.allowed(kept))

    def is_stuck(self, state: State, kept: Elements) -> bool:
        """Whether no set is allowed in one state: only what the elements say of this state is looked at."""
        left = self.encoding.at(self._plain.allowed, state)
        for demand in self._demands(kept):
            left = left & self.encoding.at(demand, state)
            if left == self.false:
                return True
        return False

    def _all_of(self, kept: Elements, kind: str) -> Bdd:
        return self.encoding.all_of(_rule(self.spec, each).formula for each in self._sorted(kept) if each.kind == kind)

    def _sorted(self, kept: Elements) -> list[Element]:
        return [each for each in self.elements if each in kept]

    def _demands(self, kept: Elements) -> Iterator[Bdd]:
        """One relation for each element that is kept, or two that share a resource."""
        users: dict[int, list[int]] = {}
        for element in self._sorted(kept):
            if _is_lasting(element):
                yield self._demand_of_lasting(element, kept & self._relevant[element])
            elif element.kind in ("precondition", "reaction-rule"):
                yield self._demand(element)
            elif element.kind == "resource":
                users.setdefault(element.part, []).append(element.number)
        for actions in users.values():
            for first, second in combinations(actions, 2):
                yield ~(self.encoding.executing(first) & self.encoding.executing(second))

    def _demand(self, element: Element) -> Bdd:
        """A precondition or a reaction rule, which depend on nothing else."""
        if element not in self._simple:
            holds = self.encoding.formula(_rule(self.spec, element).formula)
            idle = ~self.encoding.executing(element.number) if element.kind == "precondition" else self.false
            self._simple[element] = idle | holds
        return self._simple[element]

    def _demand_of_lasting(self, element: Element, alternatives: Elements) -> Bdd:
        """Every outcome, given these alternatives, keeps a state rule or an assumption."""
        key = (element, alternatives)
        if key not in self._lasting:
            bare = keep_only(self.spec, alternatives)
            rule = _rule(self.spec, element)
            self._lasting[key] = self._steps_of(replace(bare, state_rules=(rule,))).allowed
        return self._lasting[key]

    def _steps_of(self, spec: Spec) -> Steps:
        return build_steps(replace(self.encoding, spec=spec), self.ordering)

    def _relevant_alternatives(self, element: Element) -> Elements:
        """The alternatives that do something else than the nominal effect to what a rule speaks of."""
        speaks_of = variables_of(_rule(self.spec, element).formula)
        return frozenset(
            Element("alternative", number, part)
            for number, action in enumerate(self.spec.actions)
            for part, entry in enumerate(action.alternatives)
            if any(_on(outcome, speaks_of) != _on(action.nominal, speaks_of) for outcome in entry.outcomes)
        )

    def formula(self, formula: Formula) -> Bdd:
        """The valid states where a formula over the state holds."""
        return self.valid & self.encoding.formula(formula)


def _is_lasting(element: Element) -> bool:
    """Whether every outcome must keep the element."""
    return element.kind in ("state-rule", "assumption")


def _on(assignment: Assignment, variables: frozenset[int]) -> Assignment:
    return tuple(pair for pair in assignment if pair[0] in variables)


def _rule(spec: Spec, element: Element) -> Rule:
    rule = rule_of(spec, element)
    assert rule is not None, "only elements with a predicate are asked for it"
    return rule
