"""What every element requires of a step, over one manager: dropping elements is leaving out conjuncts.

`Ok` is a conjunction over elements, once it is known which alternatives can happen: *every outcome keeps all rules* is
*every outcome keeps this rule*, for each rule. Each part is computed once, so that hundreds of specifications that
differ in what is dropped cost little more than one.
"""

from __future__ import annotations

from collections.abc import Iterator
from copy import copy

from msgspec import Struct
from msgspec.structs import replace

from tumato_symbolic.explain.elements import Element, Elements, elements_of, keep_only, replace_rule, rule_of
from tumato_symbolic.limits import Context
from tumato_symbolic.semantics import State
from tumato_symbolic.spec import Assignment, Formula, Ordering, Rule, Spec, variables_of
from tumato_symbolic.symbolic import (
    Backend,
    Bdd,
    Encoding,
    Steps,
    build_steps,
    compatible_sets,
    encode,
    meant_sets,
    regions,
    staying_in,
    tiers_within,
)


class Requirement(Struct, frozen=True):
    """What one element requires beside others: the alternatives that can happen, or the other users of a resource."""

    element: Element
    others: Elements = frozenset()


class Requirements:
    """The steps of a specification and of everything that dropping elements makes of it.

    `valid` are the states that satisfy *all* assumptions: whatever is dropped, only these are asked about. `compatible`
    has the sets that are compatible when no action needs a resource, with the cases that are meant.
    """

    def __init__(self, spec: Spec, ordering: Ordering, backend: Backend, context: Context | None = None) -> None:
        self.spec = spec
        self.ordering = ordering
        self.elements = elements_of(spec)
        no_resources = frozenset(each for each in self.elements if each.kind != "resource")
        self.encoding: Encoding = encode(keep_only(spec, no_resources), backend, context)
        self.manager = self.encoding.manager
        self.valid: Bdd = self.encoding.states_where(rule.formula for rule in spec.assumptions)
        self.regions = regions(self.encoding, self.valid)
        self.compatible: Bdd = self.encoding.domain() & compatible_sets(self.encoding) & meant_sets(self.encoding)
        self._relevant = {rule: self._relevant_alternatives(rule) for rule in self.elements if self._is_lasting(rule)}
        self._known: dict[Requirement, Bdd] = {}
        self._here: tuple[State, dict[Requirement, Bdd]] | None = None

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
        return self.manager.intersection([self.compatible, *map(self._relation, self._of(kept))])

    def steps(self, kept: Elements, within: Bdd | None = None) -> Steps:
        """The step relation when only these elements are kept; `within` is one more assumption, as a set of states."""
        if within is not None:
            return self._narrowed(self.steps(kept), kept, within)
        valid = self._states_where(kept, "assumption")
        allowed, encoding = self.allowed(kept), self.encoding
        if not self.spec.restores_stepwise:
            safe = valid & self._states_where(kept, "state-rule")
            return Steps(encoding, self.ordering, valid, safe, allowed, allowed, (valid, safe))
        encoding = Encoding.of(encoding, keep_only(self.spec, kept))
        tiers = tiers_within(encoding, valid)
        return Steps(encoding, self.ordering, valid, tiers[-1], allowed, allowed, tiers)

    def _narrowed(self, steps: Steps, kept: Elements, within: Bdd) -> Steps:
        """Those of the steps that never leave some states."""
        encoding = Encoding.of(self.encoding, keep_only(self.spec, kept))
        asked = steps.allowed & within
        allowed = asked & staying_in(encoding, self.ordering, within, self.compatible, asked)
        tiers = tuple(tier & within for tier in steps.tiers)
        return replace(steps, valid=tiers[0], safe=tiers[-1], candidates=allowed, allowed=allowed, tiers=tiers)

    def changed(self, element: Element, rule: Rule) -> Requirements:
        """The same with another predicate in the place of a rule or a precondition; the rest is not computed again."""
        other = self._with_spec(replace_rule(self.spec, element, rule))
        other.forget(element)
        return other

    def forget(self, element: Element) -> None:
        """Compute anew, when it is asked next, what was found about an element."""
        self._known = {
            requirement: found
            for requirement, found in self._known.items()
            if element not in {requirement.element, *(each for each in requirement.others if each.kind == "state-rule")}
        }
        self._here = None
        if self._is_lasting(element):
            self._relevant = self._relevant | {element: self._relevant_alternatives(element)}

    def bounded(self, bound: int) -> Requirements:
        """The same with another plan bound."""
        return self._with_spec(replace(self.spec, max_plan_length=bound))

    def _with_spec(self, spec: Spec) -> Requirements:
        other = copy(self)
        other.spec = spec
        return other

    def steps_within(self, states: Bdd) -> Steps:
        """The step relation of the whole specification when only these valid states may occur."""
        return build_steps(self.encoding, self.spec, self.ordering, states)

    @property
    def starts(self) -> Bdd:
        """The valid states that are starts."""
        return self.formula(self.spec.start)

    def stuck(self, kept: Elements) -> Bdd:
        """The valid states without an allowed set."""
        return self.valid & ~self.manager.exists(self.encoding.all_choice_bits, self.allowed(kept))

    def is_stuck(self, state: State, kept: Elements) -> bool:
        """Whether no set is allowed in one state: only what the elements say of this state is looked at."""
        if self._here is None or self._here[0] != state:
            self._here = (state, {})
        known = self._here[1]
        left = self.encoding.at(self.compatible, state)
        for requirement in self._of(kept):
            if requirement not in known:
                known[requirement] = self.encoding.at(self._relation(requirement), state)
            left = left & known[requirement]
            if left == self.false:
                return True
        return False

    def _states_where(self, kept: Elements, kind: str) -> Bdd:
        rules = (_rule(self.spec, each) for each in self._sorted(kept) if each.kind == kind)
        return self.encoding.states_where(rule.formula for rule in rules)

    def _sorted(self, kept: Elements) -> list[Element]:
        return [each for each in self.elements if each in kept]

    def _of(self, kept: Elements) -> Iterator[Requirement]:
        """What the elements that are kept require together; a resource requires something of all its users."""
        users: dict[int, list[Element]] = {}
        for element in self._sorted(kept):
            if self._is_lasting(element):
                yield Requirement(element, kept & (self._relevant[element] | self._severer(element)))
            elif element.kind in ("precondition", "reaction-rule"):
                yield Requirement(element)
            elif element.kind == "resource":
                users.setdefault(element.part, []).append(element)
        yield from (Requirement(first, frozenset(rest)) for first, *rest in users.values() if rest)

    def _relation(self, requirement: Requirement) -> Bdd:
        """The pairs of state and set that meet a requirement."""
        if requirement not in self._known:
            self._known[requirement] = self._computed(requirement)
        return self._known[requirement]

    def _computed(self, requirement: Requirement) -> Bdd:
        element = requirement.element
        if element.kind == "resource":
            return self._at_most_one([element.number, *(each.number for each in requirement.others)])
        holds = self.encoding.formula(_rule(self.spec, element).formula)
        if element.kind == "reaction-rule":
            return holds
        if element.kind == "precondition":
            holds = ~self._executing(element.number) | holds
        if not self._is_lasting(element):
            return holds
        encoding, domain = Encoding.of(self.encoding, keep_only(self.spec, requirement.others)), self.encoding.domain()
        if element.kind == "precondition":
            return holds & staying_in(encoding, self.ordering, domain, holds)
        kept = staying_in(encoding, self.ordering, domain & holds, self.manager.true)
        if element.kind == "assumption" or not self.spec.restores_stepwise:
            return kept
        concerned = self._states_where(requirement.others, "state-rule")
        if self.spec.restoration != "one_step":
            concerned = concerned & holds
        return ~concerned | kept

    def _severer(self, element: Element) -> Elements:
        """The state rules that have to hold before a step has to keep a state rule."""
        if element.kind != "state-rule":
            return frozenset()
        rules, severity = self.spec.state_rules, self.spec.state_rules[element.number].severity
        return frozenset(Element("state-rule", n) for n, rule in enumerate(rules) if rule.severity < severity)

    def _is_lasting(self, element: Element) -> bool:
        """Whether the element must hold in states that effects lead to."""
        throughout = self.spec.preconditions == "throughout"
        return element.kind in ("state-rule", "assumption") or (throughout and element.kind == "precondition")

    def _executing(self, first: int) -> Bdd:
        """The sets that execute an action, of which this is the first case."""
        return self.encoding.executing_any(self.spec.cases_from(first))

    def _at_most_one(self, actions: list[int]) -> Bdd:
        none, one = self.manager.true, self.manager.false
        for action in actions:
            runs = self._executing(action)
            none, one = none & ~runs, (one & ~runs) | (none & runs)
        return none | one

    def _relevant_alternatives(self, element: Element) -> Elements:
        """The alternatives that do something else than the nominal effect to what a rule mentions.

        Without nominal effects also those that write anything: it is by them that the action has effects.
        """
        mentioned = variables_of(_rule(self.spec, element).formula)
        return frozenset(
            Element("alternative", first, part)
            for first, action in zip(self.spec.first_case, self.spec.actions, strict=True)
            for part, entry in enumerate(action.alternatives)
            if any(_on(outcome, mentioned) != _on(action.nominal, mentioned) for outcome in entry.outcomes)
            or (not action.nominal and any(entry.outcomes))
        )

    def formula(self, formula: Formula) -> Bdd:
        """The valid states where a formula over the state holds."""
        return self.valid & self.encoding.formula(formula)


def _on(assignment: Assignment, variables: frozenset[int]) -> Assignment:
    return tuple(pair for pair in assignment if pair[0] in variables)


def _rule(spec: Spec, element: Element) -> Rule:
    rule = rule_of(spec, element)
    assert rule is not None, "only elements with a predicate are asked for it"
    return rule
