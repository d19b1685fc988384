"""The warning about actions that a policy executes together although one may falsify a precondition of another."""

from __future__ import annotations

from collections.abc import Iterator

from msgspec import Struct

from tumato_symbolic.diagnostics import Code, Diagnostic, Note
from tumato_symbolic.game import Problem
from tumato_symbolic.semantics import State, apply, holds, state_text
from tumato_symbolic.spec import Assignment, Rule, Spec, variables_of
from tumato_symbolic.symbolic import Bdd, Encoding


class _Race(Struct, frozen=True):
    """In some states, the action `writer` has an effect that falsifies a precondition of the action `pending`."""

    pending: int
    writer: int
    states: Bdd


def races(problem: Problem, policy: Bdd) -> tuple[Diagnostic, ...]:
    """The warning about a policy, where preconditions have to hold at the start only; none where all is well."""
    spec, encoding = problem.spec, problem.encoding
    if spec.preconditions != "at_start":
        return ()
    found = [race for race in _races(problem, policy) if race.states != problem.false]
    if not found:
        return ()
    everywhere = encoding.manager.union(race.states for race in found)
    state = encoding.first_state(everywhere)
    race = next(race for race in found if encoding.contains(race.states, state))
    return (_warning(spec, race, state, encoding.count_states(everywhere)),)


def _races(problem: Problem, policy: Bdd) -> Iterator[_Race]:
    spec, encoding = problem.spec, problem.encoding
    pairs = list(_may_race(encoding))
    executed = encoding.states_executing(policy) if pairs else []
    for pending, writer in pairs:
        waiting = encoding.manager.union(executed[case] for case in spec.cases[pending])
        preconditions = spec.actions[spec.cases[pending][0]].preconditions
        for case in spec.cases[writer]:
            both = waiting & executed[case]
            if both != problem.false:
                holds_there = encoding.all_of(rule.formula for rule in preconditions)
                lost = both & ~encoding.after_every_effect(case, holds_there)
                yield _Race(spec.cases[pending][0], case, lost)


def _may_race(encoding: Encoding) -> Iterator[tuple[int, int]]:
    """The pairs of actions, in order, of which the first has preconditions that speak of what the second writes.

    Choices of one group are left out.
    """
    spec = encoding.spec
    homes = [frozenset(encoding.choice_of[case][0] for case in cases) for cases in spec.cases]
    writers: dict[int, dict[frozenset[int], list[int]]] = {}
    for action, cases in enumerate(spec.cases):
        for variable in {v for case in cases for effect in spec.actions[case].effects for v, _ in effect}:
            writers.setdefault(variable, {}).setdefault(homes[action], []).append(action)
    for pending, (home, cases) in enumerate(zip(homes, spec.cases, strict=True)):
        preconditions = spec.actions[cases[0]].preconditions
        others = [
            actions
            for variable in {v for rule in preconditions for v in variables_of(rule.formula)}
            for its, actions in writers.get(variable, {}).items()
            if its != home or len(home) > 1
        ]
        yield from ((pending, writer) for writer in sorted(set[int]().union(*others)) if writer != pending)


def _warning(spec: Spec, race: _Race, state: State, count: int) -> Diagnostic:
    pending, writer = spec.actions[race.pending], spec.actions[race.writer]
    effect, rule = _falsifying(spec, race, state)
    places = "1 state" if count == 1 else f"{count:,} states"
    change = " ".join(f"{spec.variables[v].name}={spec.variables[v].values[value]}" for v, value in effect)
    return Diagnostic(
        Code.TUM354,
        f"in {places} the policy executes actions together of which one may falsify a precondition of another before "
        f"that takes effect. For example in {state_text(spec, state)}: `{writer.name}` ({change}) falsifies "
        f"`{' '.join(rule.text.split())}` of `{pending.name}`",
        rule.span,
        "with `preconditions: throughout` in CONFIG such sets are not allowed",
        (Note(f"`{writer.name}` is declared here", writer.span),),
    )


def _falsifying(spec: Spec, race: _Race, state: State) -> tuple[Assignment, Rule]:
    """The first effect, and the precondition that it falsifies."""
    return next(
        (effect, rule)
        for effect in spec.actions[race.writer].effects
        for rule in spec.actions[race.pending].preconditions
        if not holds(rule.formula, apply(effect, state))
    )
