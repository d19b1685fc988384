"""A specification and a policy as functions that the walk can compare (`docs/semantics.md`, sections 3 to 5).

A function speaks of a state `s`, and of a set of actions `A` by one variable for every *group*, actions of which at
most one can be in an allowed set: 0 when none is, otherwise the place of the action in its group. So `Ok(s, A)` is one
function; the policy, an effect and a successor are what is substituted for its variables.
"""

from __future__ import annotations

import operator
from collections.abc import Iterator, Sequence
from functools import cached_property

from tumato_symbolic.policy import DecisionDiagram
from tumato_symbolic.semantics import ActionSet, State, disagreeing_pairs, exclusive_groups, exclusive_pairs
from tumato_symbolic.spec import Connectives, Executing, Formula, Is, Ordering, Spec, fold
from tumato_symbolic.verify.by_diagrams.order import walk_order
from tumato_symbolic.verify.by_diagrams.walk import FALSE, TRUE, Function, Walk

MOST_CASES = 128
"""Where the policy nominally writes at most so many different things, each is looked at apart."""


class Model:
    """`valid`, `decided` and `acting` are as in `docs/certificate.md`.

    `policy[a]` is `a ∈ π(s)`, `chosen[a]` is `a ∈ A`.
    """

    def __init__(
        self, spec: Spec, decisions: DecisionDiagram, ordering: Ordering, deadline: float | None = None
    ) -> None:
        self.spec = spec
        self._ordering = ordering
        self.groups = exclusive_groups(spec)
        sizes = [*(len(variable.values) for variable in spec.variables), *(len(group) + 1 for group in self.groups)]
        self.walk = walk = Walk(walk_order(spec, decisions.diagram.order, self.groups), sizes)
        walk.deadline = deadline
        taken = walk.taken(decisions.diagram, int)
        self.policy = [taken[root] for root in decisions.roots]
        self._place = {
            action: (group, place)
            for group, actions in enumerate(self.groups)
            for place, action in enumerate(actions, 1)
        }
        self.chosen = [
            self._is(self.group_variable(action), self._place[action][1]) for action in range(len(spec.actions))
        ]
        self.valid = walk.all_of(self.formula(rule.formula) for rule in spec.assumptions)
        self.tiers = [self.valid]  # the valid states that satisfy no, one, … tiers of state rules, the severest first
        for tier in spec.tiers:
            self.tiers.append(walk.all_of((self.tiers[-1], *(self.formula(rule.formula) for rule in tier))))
        self.safe = self.tiers[-1]
        self.decided = walk.all_of((self.valid, taken[decisions.defined]))
        self._next: dict[Function, Function] = {}

    def group_variable(self, action: int) -> int:
        """The variable that tells which action of its group is chosen."""
        return len(self.spec.variables) + self._place[action][0]

    def _is(self, variable: int, value: int) -> Function:
        size = self.walk.sizes[self.walk.level_of[variable]]
        return self.walk.by_value(variable, [int(each == value) for each in range(size)])

    def formula(self, formula: Formula, executed: Sequence[Function] = ()) -> Function:
        """Where a formula holds; `executed[a]` is the truth of `executing a`."""

        def atom(atom: Is | Executing) -> Function:
            return self._is(atom.variable, atom.value) if isinstance(atom, Is) else executed[atom.action]

        return fold(formula, atom, self.connectives)

    @cached_property
    def connectives(self) -> Connectives[Function]:
        """What the connectives of formulas are among functions."""
        walk = self.walk
        return Connectives(
            constant=int,
            negation=walk.negation,
            conjunction=walk.all_of,
            disjunction=walk.any_of,
            equivalence=lambda one, other: walk.select(one, (walk.negation(other), other)),
        )

    # Demands 1 to 4

    def preconditions(self, action: int) -> Function:
        """Where an action may be executed, as far as it alone is concerned."""
        return self.walk.all_of(self.formula(rule.formula) for rule in self.spec.actions[action].preconditions)

    @cached_property
    def applicable(self) -> Function:
        """All actions of `A` may be executed, as far as each alone is concerned."""
        each = enumerate(self.chosen)
        return self.walk.all_of(self.walk.select(chosen, (TRUE, self.preconditions(action))) for action, chosen in each)

    @cached_property
    def lasting(self) -> Function:
        """What has to hold in a state on the way, of the actions `A` that have not taken effect there."""
        return self.applicable if self.spec.preconditions == "throughout" else TRUE

    def together(self, pairs: Sequence[tuple[int, int]], executed: Sequence[Function]) -> Function:
        """Two actions of one of these pairs are both executed."""
        walk, others = self.walk, dict[int, list[Function]]()
        for one, other in pairs:
            others.setdefault(other, []).append(executed[one])
        return walk.any_of(walk.all_of((executed[other], walk.any_of(ones))) for other, ones in others.items())

    @cached_property
    def exclusive(self) -> list[tuple[int, int]]:
        """The pairs of actions that exclude each other."""
        return exclusive_pairs(self.spec)

    @cached_property
    def compatible(self) -> Function:
        """No two actions of `A` exclude each other."""
        return self.walk.negation(self.together(self.exclusive, self.chosen))

    @cached_property
    def acting(self) -> Function:
        """`s` is decided, and the nominal effects of `π(s)` agree."""
        return self.walk.without(self.decided, self.together(disagreeing_pairs(self.spec), self.policy))

    # Demands 5 and 6

    def after(self, action: int, function: Function) -> Function:
        """`function` after every effect of `action`, which is then no longer to come."""
        idle, constant = {self.group_variable(action): FALSE}, self.walk.constant
        effects = (
            {variable: constant(value) for variable, value in effect} | idle
            for effect in self.spec.actions[action].effects
        )
        return self.walk.all_of(self.walk.substitute(function, effect) for effect in effects)

    @cached_property
    def requirements(self) -> list[tuple[Function, Function]]:
        """Demands 5 and 6: where `s` is in the first, all of `Next(s, A)` has to be in the second.

        Where safety is restored in one step that is: all safe. In several, a rule counts where it holds, and only with
        those that are as severe as the severest broken ones, or more (sections 9 and 10).
        """
        spec, walk = self.spec, self.walk
        if not spec.restores_stepwise:
            return [(TRUE, self.safe)]
        found = [(self.safe, self.safe), (walk.without(self.valid, self.safe), self.valid)]
        for kept, tier in zip(self.tiers, spec.tiers, strict=False):
            for rule in tier:
                holds = self.formula(rule.formula)
                counts = kept if spec.restoration == "one_step" else walk.all_of((kept, holds))
                found.append((walk.without(counts, self.safe), walk.all_of((self.valid, holds))))
        return [(where, target) for where, target in found if where != FALSE]

    @cached_property
    def safe_from_here(self) -> Function:
        """`s` is safe and `lasting` holds, and so it stays whatever effects of `A` are still to come."""
        return self.stays_in(self._fine)

    @cached_property
    def _fine(self) -> Function:
        """`s` is safe, and `lasting` holds."""
        return self.walk.all_of((self.safe, self.lasting))

    def stays_in(self, target: Function) -> Function:
        """`s` is in `target`, and stays there whatever effects of `A` are still to come, in any order.

        The one solution of `f(s, A) ⇔ s ∈ target and f(e(s), A \\ a)` for every effect `e` of every `a ∈ A`; `target`
        may speak of `A` as well.
        """
        walk, before = self.walk, FALSE
        found = walk.all_of((target, self.compatible))
        while found != before:
            before = found
            for action, chosen in enumerate(self.chosen):
                found = walk.all_of((found, walk.select(chosen, (TRUE, self.after(action, found)))))
        return found

    @cached_property
    def outcomes_safe(self) -> Function:
        """Condition 5: every outcome of `A` in `s` is safe. Speaks of sets without conflicts only."""
        return self._outcomes_in(self.safe, self.safe_from_here if self._ordering == "any" else self._fine)

    def outcomes_in(self, target: Function) -> Function:
        """Every outcome of `A` in `s` is in `target`, and `lasting` holds. Speaks of sets without conflicts only."""
        return self._outcomes_in(target, self.remains_in(target))

    def remains_in(self, target: Function) -> Function:
        """What has to hold after each effect so that all outcomes are in `target`, and `lasting` holds."""
        fine = self.walk.all_of((target, self.lasting))
        return self.stays_in(fine) if self._ordering == "any" else fine

    def _outcomes_in(self, target: Function, then: Function) -> Function:
        """Every outcome of `A` in `s` is in `target`, where `then` has to hold after each effect."""
        walk = self.walk
        actions = [(action, self.chosen[action]) for action, each in enumerate(self.spec.actions) if each.effects]
        effects = (walk.select(chosen, (TRUE, self.after(action, then))) for action, chosen in actions)
        return walk.all_of((walk.any_of((*(chosen for _, chosen in actions), target)), *effects))

    def leads_into(self, target: Function) -> Function:
        """`Next(s, π(s)) ⊆ target`, where the policy acts without conflicts."""
        if self._ordering == "any":  # then all nominal effects in turn are an outcome
            return self.walk.all_of((self.acting, self.as_decided(self._outcomes_in(target, self.stays_in(target)))))
        outcomes = self.as_decided(self._outcomes_in(target, target))
        return self.walk.all_of((self.acting, outcomes, self.next(target)))

    def successor(self, executed: Sequence[Function]) -> dict[int, Function]:
        """`δ`: the next value of every variable that may change, where the nominal effects agree."""
        walk, found = self.walk, dict[int, Function]()
        for number, action in enumerate(self.spec.actions):
            for variable, value in action.nominal:
                stays = found.get(variable, walk.variable(variable))
                found[variable] = walk.select(executed[number], (stays, walk.constant(value)))
        return found

    @cached_property
    def _steps(self) -> list[tuple[Function, dict[int, int]]] | None:
        """The acting states by what the policy nominally writes there; None where that is too many cases."""
        walk, actions = self.walk, self.spec.actions
        pairs = sorted({pair for action in actions for pair in action.nominal})
        masks = [sum(1 << pairs.index(pair) for pair in action.nominal) for action in actions]
        each = zip(self.policy, masks, strict=True)
        written = [
            FALSE,
            *(
                walk.select(walk.all_of((self.acting, executed)), (FALSE, walk.constant(mask)))
                for executed, mask in each
            ),
        ]
        while len(written) > 1:
            halves = zip(written[::2], written[1::2], strict=False)
            written = [walk.combine(operator.or_, *both) for both in halves] + written[len(written) & ~1 :]
            if any(len(walk.values_of(each)) > MOST_CASES for each in written):
                return None
        cases = walk.parts(walk.select(self.acting, (walk.constant(-1), *written)))
        return [
            (where, dict(pair for place, pair in enumerate(pairs) if mask >> place & 1))
            for mask, where in cases.items()
            if mask >= 0
        ]

    def next(self, function: Function) -> Function:
        """`function` in `δ(s, π(s))` where the policy acts; elsewhere it means nothing."""
        if function not in self._next:
            self._next[function] = self._after_step(function)
        return self._next[function]

    def _after_step(self, function: Function) -> Function:
        if self._steps is None:
            return self.walk.substitute(function, self.successor(self.policy))
        found = FALSE
        for where, writes in self._steps:
            found = self.walk.assign(where, writes, function, found)
        return found

    def obligations(self) -> Iterator[tuple[str, Function]]:
        """What makes a decision allowed: claims, each with the decided states that violate it."""
        spec, walk, policy = self.spec, self.walk, self.policy
        for number, action in enumerate(spec.actions):
            if action.preconditions:
                executed = walk.all_of((self.decided, policy[number]))
                yield f"the preconditions of {action.name} hold", walk.without(executed, self.preconditions(number))
        conflict = walk.all_of((self.decided, self.together(self.exclusive, policy)))
        yield "resources are controlled once, and nominal effects agree", conflict
        for rule in spec.reaction_rules:
            yield (
                f"the reaction rule '{rule.text}' holds",
                walk.without(self.decided, self.formula(rule.formula, policy)),
            )
        apart = walk.without(self.decided, conflict)
        if spec.restores_stepwise:
            for where, target in self.requirements:
                ends = [self.as_decided(self.outcomes_in(target))]
                ends += [self.next(target)] if self._ordering == "first" else []
                yield "the rules that have to be kept are", walk.without(walk.all_of((apart, where)), walk.all_of(ends))
            return
        yield "every outcome is safe", walk.without(apart, self.as_decided(self.outcomes_safe))
        if self._ordering == "first":
            yield "δ is safe", walk.without(apart, self.next(self.safe))

    def as_decided(self, function: Function) -> Function:
        """`function` of `(s, π(s))`, where no two actions of `π(s)` are in conflict."""
        walk, policy = self.walk, self.policy
        for group, actions in enumerate(self.groups):
            variable = len(self.spec.variables) + group
            found = walk.substitute(function, {variable: FALSE})
            for place, member in enumerate(actions, 1):
                found = walk.assign(policy[member], {variable: place}, function, found)
            function = found
        return function

    @cached_property
    def allowed(self) -> Function:
        """`Ok(s, A)`; where safety may be restored in several steps, `Keep(s, A)`."""
        spec, walk = self.spec, self.walk
        parts = [self.applicable, self.compatible]
        parts += [self.formula(rule.formula, self.chosen) for rule in spec.reaction_rules]
        if spec.restores_stepwise:
            parts += [walk.select(where, (TRUE, self.into(target))) for where, target in self.requirements]
            return walk.all_of(parts)
        if self._ordering == "first":
            parts.append(walk.substitute(self.safe, self.successor(self.chosen)))
        return walk.all_of((*parts, self.outcomes_safe))

    def into(self, target: Function) -> Function:
        """`Next(s, A) ⊆ target`. Speaks of sets without conflicts only."""
        outcomes, walk = self.outcomes_in(target), self.walk
        if self._ordering == "any":  # then all nominal effects in turn are an outcome
            return outcomes
        return walk.all_of((outcomes, walk.substitute(target, self.successor(self.chosen))))

    # Durations

    def duration(self, executed: Sequence[Function]) -> Function:
        """The sum of the durations of the executed actions."""
        amounts = [self.walk.constant(action.duration) for action in self.spec.actions]
        each = zip(executed, amounts, strict=True)
        return self._total([self.walk.select(predicate, (FALSE, amount)) for predicate, amount in each])

    def size(self, executed: Sequence[Function]) -> Function:
        """The number of executed actions."""
        return self._total(executed)

    def _total(self, numbers: Sequence[Function]) -> Function:
        return self.walk.combine_all(operator.add, [FALSE, *numbers])

    def least(self, where: Function, measure: Function) -> Function:
        """That part of `where`, which is not empty, in which `measure` is smallest."""
        walk = self.walk
        elsewhere = walk.constant(walk.values_of(measure)[-1] + 1)
        smallest = walk.values_of(walk.select(where, (elsewhere, measure)))[0]
        return walk.all_of((where, walk.combine(operator.eq, measure, walk.constant(smallest))))

    # States

    def first_state(self, where: Function) -> State:
        """The first state, as declared, for which `where` holds, possibly for one set only; there is one."""
        found: list[int] = []
        for variable, declared in enumerate(self.spec.variables):
            for value in range(len(declared.values)):
                rest = self.walk.substitute(where, {variable: self.walk.constant(value)})
                if rest != FALSE:
                    found.append(value)
                    where = rest
                    break
        return tuple(found)

    def is_state(self, state: State) -> Function:
        """One state."""
        return self.walk.all_of(self._is(variable, value) for variable, value in enumerate(state))

    def holds(self, function: Function, state: State, chosen: ActionSet) -> bool:
        """Whether a predicate is true of one state and one set without conflicts."""
        places = dict.fromkeys(range(len(state), len(state) + len(self.groups)), 0)
        places |= {self.group_variable(action): self._place[action][1] for action in chosen}
        values = {variable: self.walk.constant(value) for variable, value in (*enumerate(state), *places.items())}
        return self.walk.substitute(function, values) != FALSE
