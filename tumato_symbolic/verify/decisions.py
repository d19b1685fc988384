"""The policy as runs see it, and ranks recomputed by following all runs at once."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from functools import cached_property
from operator import itemgetter

from tumato_symbolic.diagrams import Diagram, DiagramBuilder, Reference
from tumato_symbolic.policy import Policy, Table, as_table
from tumato_symbolic.semantics import (
    NOTHING,
    ActionSet,
    Residual,
    State,
    holds,
    is_valid,
    nominal_agrees,
    residual_goal,
    successor,
)
from tumato_symbolic.spec import Formula, Spec, variables_of

LARGEST_TABLE = 200_000
"""How many decided states are followed explicitly; beyond, ranks must come with the policy."""


class Decisions(Mapping[State, ActionSet]):
    """What the policy says of valid states; what it says of others is ignored."""

    def __init__(self, spec: Spec, policy: Policy) -> None:
        self._spec = spec
        self._policy = policy

    def __getitem__(self, state: State) -> ActionSet:
        chosen = self.stated(state)
        if chosen is None or not is_valid(self._spec, state):
            raise KeyError(state)
        return chosen

    def __iter__(self) -> Iterator[State]:
        return iter(self.rows or ())

    def __len__(self) -> int:
        return len(self.rows or ())

    def stated(self, state: State) -> ActionSet | None:
        """What the policy says of a state, valid or not."""
        decisions = self._policy.decisions
        if isinstance(decisions, Table):
            return decisions.rows.get(state)
        if not decisions.diagram.evaluate(decisions.defined, state):
            return None
        return frozenset(
            action for action, root in enumerate(decisions.roots) if decisions.diagram.evaluate(root, state)
        )

    @cached_property
    def rows(self) -> dict[State, ActionSet] | None:
        """All of them, in the order of the states; None where there are too many."""
        table = as_table(self._policy, LARGEST_TABLE)
        if table is None:
            return None
        ordered = sorted(table.rows.items(), key=itemgetter(0))
        return {state: chosen for state, chosen in ordered if is_valid(self._spec, state)}

    @cached_property
    def followers(self) -> dict[State, State]:
        """`δ(s, π(s))`, where the nominal effects of `π(s)` agree."""
        spec, rows = self._spec, self.rows or {}
        agree = {chosen: nominal_agrees(spec, chosen) for chosen in set(rows.values())}
        return {state: successor(spec, state, chosen) for state, chosen in rows.items() if agree[chosen]}

    @cached_property
    def origins(self) -> dict[State, list[State]]:
        """Every state with those that step to it."""
        found: dict[State, list[State]] = {}
        for state, after in self.followers.items():
            found.setdefault(after, []).append(state)
        return found


class Ranks:
    """How many nominal steps the policy still needs, per residual goal and state, by following the runs backwards.

    Only a search: what it finds is proved, or shown by one run. Needs `decisions.rows`.
    """

    def __init__(self, spec: Spec, decisions: Decisions) -> None:
        self._spec = spec
        self._decisions = decisions
        self._known: dict[Residual, dict[State, int]] = {}

    def of(self, goal: Residual) -> dict[State, int]:
        """The rank of every state where the policy acts, and of every other one that it steps to; others are absent."""
        if goal not in self._known:
            self._known[goal] = self._compute(goal)
        return self._known[goal]

    def _compute(self, goal: Residual) -> dict[State, int]:
        spec = self._spec
        tests = [truth(spec.bodies[body].formula, goal.executed) for body in sorted(goal.bodies)]
        if spec.restores_stepwise:  # goals are met in safe states only
            tests += [truth(rule.formula, NOTHING) for rule in (*spec.validity, *spec.state_rules)]
        origins = self._decisions.origins
        places = dict.fromkeys((*self._decisions.followers, *origins))
        layer = [state for state in places if all(test(state) for test in tests)]
        ranks = dict.fromkeys(layer, 0)
        steps = 0
        while layer:
            steps += 1
            layer = [origin for state in layer for origin in origins.get(state, ()) if origin not in ranks]
            ranks.update(dict.fromkeys(layer, steps))
        return ranks

    def missed(self) -> Iterator[State]:
        """The states from where the policy does not reach the residual goal within the bound, in their order."""
        bound = self._spec.max_plan_length
        for state, after in self._decisions.followers.items():
            rank = self.of(residual_goal(self._spec, state, self._decisions[state])).get(after)
            if rank is None or (bound is not None and rank >= bound):
                yield state

    def diagram(self, goal: Residual) -> tuple[Diagram[int | None], Reference]:
        """The ranks of the states where the policy acts, as a diagram; None elsewhere."""
        spec, ranks = self._spec, self.of(goal)
        rows = {state: ranks[state] for state in self._decisions.followers if state in ranks}
        leaves: list[int | None] = [None, *sorted(set(rows.values()))]
        builder = DiagramBuilder[int | None](range(len(spec.variables)), leaves)
        root = builder.from_table([len(variable.values) for variable in spec.variables], rows, None)
        return builder.finish(), root


def truth(formula: Formula, executed: ActionSet) -> Callable[[State], bool]:
    """`holds(formula, ·, executed)`, remembered by the values of the variables that the formula mentions."""
    mentioned = sorted(variables_of(formula))
    known: dict[tuple[int, ...], bool] = {}

    def test(state: State) -> bool:
        key = tuple(state[variable] for variable in mentioned)
        found = known.get(key)
        if found is None:
            found = known[key] = holds(formula, state, executed)
        return found

    return test
