"""The states and steps of a specification as functions that the walk can compare (`docs/semantics.md`, section 3).

A function is of a state `s`, and of a set of actions `A` by one variable for every *group*, actions of which at
most one can be in an allowed set: 0 when none is, otherwise the place of the action in its group. So `Ok(s, A)` is one
function; an effect and a successor are what is substituted for its variables.

Where there are many residual goals, a function may also be of the goal of a run, by one variable for every body, *it is
active*, and one for every action that bodies speak of, *it was executed first*.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import cached_property
from math import prod

from tumato_symbolic.semantics import (
    ActionSet,
    Contest,
    State,
    contested_resources,
    contested_values,
    exclusive_groups,
)
from tumato_symbolic.spec import Connectives, Executing, Formula, Is, Ordering, Rule, Spec, fold, goal_parameters
from tumato_symbolic.verify.by_diagrams.functions import FALSE, TRUE, Function
from tumato_symbolic.verify.by_diagrams.order import walk_order
from tumato_symbolic.verify.by_diagrams.walk import Walk


class Steps:
    """States and steps of a specification: `chosen[a]` is `a ∈ A`, `tiers[n]` the valid states that satisfy `n` tiers.

    `valid_at_all` are the states that satisfy the assumptions, in the part that is looked at or not.

    `order` names the variables that come first in the diagrams.
    """

    def __init__(self, spec: Spec, ordering: Ordering, order: Sequence[int], deadline: float | None = None) -> None:
        self.spec = spec
        self._ordering = ordering
        self.groups = exclusive_groups(spec)
        sizes = [*(len(variable.values) for variable in spec.variables), *(len(group) + 1 for group in self.groups)]
        told_by, first = goal_parameters(spec), len(sizes)
        bodies, actions = (told_by.bodies, told_by.actions) if told_by is not None else ((), ())
        self.active_variable = {body: number for number, body in enumerate(bodies, first)}
        self.first_variable = {action: number for number, action in enumerate(actions, first + len(bodies))}
        sizes += [2] * (len(bodies) + len(actions))
        self.walk = walk = Walk(walk_order(spec, order, self.groups, told_by), sizes)
        walk.deadline = deadline
        self._place = {
            action: (group, place)
            for group, actions in enumerate(self.groups)
            for place, action in enumerate(actions, 1)
        }
        self.chosen = [
            self._is(self.group_variable(action), self._place[action][1]) for action in range(len(spec.actions))
        ]
        self.valid_at_all = walk.all_of(self.formula(rule.formula) for rule in spec.assumptions)
        self.valid = self.valid_at_all
        if spec.part is not None:
            self.valid = walk.all_of((self.valid, self.formula(spec.part.formula)))
        self.tiers = [self.valid]
        for tier in spec.tiers:
            self.tiers.append(walk.all_of((self.tiers[-1], *(self.formula(rule.formula) for rule in tier))))
        self.safe = self.tiers[-1]

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

    # Conditions 1 to 4

    def all_hold(self, rules: Iterable[Rule]) -> Function:
        """Where all of some rules hold."""
        return self.walk.all_of(self.formula(rule.formula) for rule in rules)

    @cached_property
    def applicable(self) -> Function:
        """All actions of `A` may be executed, as far as each alone is concerned."""
        each = zip(self.chosen, self.spec.actions, strict=True)
        guards = ((chosen, action.guard) for chosen, action in each if action.guard is not None)
        met = (self.walk.select(chosen, (TRUE, self.formula(guard.formula))) for chosen, guard in guards)
        return self.walk.all_of((self._preconditions_hold, *met))

    @cached_property
    def _preconditions_hold(self) -> Function:
        """The preconditions of all actions of `A` hold."""
        walk, parts = self.walk, list[Function]()
        for cases in self.spec.cases:
            chosen = walk.any_of(self.chosen[case] for case in cases)
            parts.append(walk.select(chosen, (TRUE, self.all_hold(self.spec.actions[cases[0]].preconditions))))
        return walk.all_of(parts)

    @cached_property
    def lasting(self) -> Function:
        """What has to hold in a state on the way, of the actions `A` that have not taken effect there."""
        return self._preconditions_hold if self.spec.preconditions == "throughout" else TRUE

    def together(self, contests: Iterable[Contest], executed: Sequence[Function]) -> Function:
        """Actions of different sides are both executed."""
        walk, found = self.walk, list[Function]()
        for contest in contests:
            taken = FALSE
            for side in contest:
                chosen = walk.any_of(executed[action] for action in side)
                found.append(walk.all_of((taken, chosen)))
                taken = walk.any_of((taken, chosen))
        return walk.any_of(found)

    def conflict(self, executed: Sequence[Function]) -> Function:
        """Two executed actions exclude each other."""
        return self.together((*contested_resources(self.spec), *contested_values(self.spec)), executed)

    @cached_property
    def compatible(self) -> Function:
        """No two actions of `A` exclude each other."""
        return self.walk.negation(self.conflict(self.chosen))

    # Conditions 5 and 6

    def after(self, action: int, function: Function) -> Function:
        """`function` after every effect of `action`, which is then no longer to come."""
        idle, constant = {self.group_variable(action): FALSE}, self.walk.constant
        effects = (
            {variable: constant(value) for variable, value in effect} | idle
            for effect in self.spec.actions[action].effects
        )
        return self.walk.all_of(self.walk.compose(function, effect) for effect in effects)

    @cached_property
    def requirements(self) -> list[tuple[Function, Function]]:
        """Conditions 5 and 6: where `s` is in the first, all of `Next(s, A)` has to be in the second.

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
        concerned = self._concerned(target)
        found = walk.all_of((target, self._compatible_among(concerned)))
        while found != before:
            before = found
            for action in concerned:
                found = walk.all_of((found, walk.select(self.chosen[action], (TRUE, self.after(action, found)))))
        return found

    def _concerned(self, target: Function) -> list[int]:
        """The actions that may lead out of `target`: they write what it tests, or it speaks of them."""
        tested, level_of = set(self.walk.levels_of(target)), self.walk.level_of
        return [
            number
            for number, action in enumerate(self.spec.actions)
            if level_of[self.group_variable(number)] in tested
            or any(level_of[variable] in tested for effect in action.effects for variable, _ in effect)
        ]

    def _compatible_among(self, actions: Sequence[int]) -> Function:
        """No two of these actions, if they are in `A`, exclude each other."""
        if len(actions) == len(self.chosen):
            return self.compatible
        among = set(actions)
        executed = [each if number in among else FALSE for number, each in enumerate(self.chosen)]
        return self.walk.negation(self.conflict(executed))

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
        walk, concerned = self.walk, set(self._concerned(then))
        acting = [action for action, each in enumerate(self.spec.actions) if each.effects]
        others = walk.any_of(self.chosen[action] for action in acting if action not in concerned)
        effects = (
            walk.select(self.chosen[action], (TRUE, self.after(action, then)))
            for action in acting
            if action in concerned
        )
        ends_here = walk.any_of((*(self.chosen[action] for action in acting), target))
        return walk.all_of((ends_here, walk.select(others, (TRUE, then)), *effects))

    def successor(self, executed: Sequence[Function]) -> dict[int, Function]:
        """`δ`: the next value of every variable that may change, where the nominal effects agree."""
        walk, found = self.walk, dict[int, Function]()
        for number, action in enumerate(self.spec.actions):
            for variable, value in action.nominal:
                stays = found.get(variable, walk.variable(variable))
                found[variable] = walk.select(executed[number], (stays, walk.constant(value)))
        return found

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
            parts.append(walk.compose(self.safe, self.successor(self.chosen)))
        return walk.all_of((*parts, self.outcomes_safe))

    def into(self, target: Function) -> Function:
        """`Next(s, A) ⊆ target`. Speaks of sets without conflicts only."""
        outcomes, walk = self.outcomes_in(target), self.walk
        if self._ordering == "any":  # then all nominal effects in turn are an outcome
            return outcomes
        return walk.all_of((outcomes, walk.compose(target, self.successor(self.chosen))))

    # States

    def first_state(self, where: Function) -> State:
        """The first state, as declared, for which `where` holds, possibly for one set only; there is one."""
        found: list[int] = []
        for variable, declared in enumerate(self.spec.variables):
            for value in range(len(declared.values)):
                rest = self.walk.compose(where, {variable: self.walk.constant(value)})
                if rest != FALSE:
                    found.append(value)
                    where = rest
                    break
        return tuple(found)

    def count(self, where: Function) -> int:
        """In how many states a predicate of the state holds."""
        return self.walk.count(where) // prod(self.walk.sizes_after(len(self.spec.variables)))

    def is_state(self, state: State) -> Function:
        """One state."""
        return self.walk.all_of(self._is(variable, value) for variable, value in enumerate(state))

    def holds(self, function: Function, state: State, chosen: ActionSet) -> bool:
        """Whether a predicate is true of one state and one set without conflicts."""
        places = dict.fromkeys(range(len(state), len(state) + len(self.groups)), 0)
        places |= {self.group_variable(action): self._place[action][1] for action in chosen}
        values = {variable: self.walk.constant(value) for variable, value in (*enumerate(state), *places.items())}
        return self.walk.compose(function, values) != FALSE
