"""Which valid states fail when each is taken alone, and why (`docs/semantics.md`, sections 7 and 9.8)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from msgspec import Struct

from tumato_symbolic.game import Alone, Layers, OwnRegions, Problem, chances, distances, in_time, way_of, winning
from tumato_symbolic.symbolic import Bdd
from tumato_symbolic.synthesis.result import STATES_LISTED, Failure, FailureKind

if TYPE_CHECKING:
    from tumato_symbolic.policy.unrealizability import NoAllowedSet, NoPlan, NoRestoration


class Failing(Struct, frozen=True):
    """The failing states by kind, disjoint; kinds without states are left out.

    `apart` are the distances from the targets; `way` has the steps that runs may take, where safety may take several
    steps to restore.
    """

    kinds: dict[FailureKind, Bdd]
    apart: tuple[Layers, ...]
    way: Alone | None


def has_stuck_states(problem: Problem) -> bool:
    """Whether there is a valid state without an allowed set."""
    return _stuck(problem) != problem.false


def _stuck(problem: Problem) -> Bdd:
    return problem.steps.valid & ~problem.steps.states_of(problem.steps.allowed)


def failing_states(problem: Problem, own: OwnRegions | None = None) -> Failing:
    """All valid states that fail alone; `own` is `only_region`, if that is known."""
    way = way_of(problem)
    if own is None or own.ranks is None or way is not None:
        apart, pairs = chances(problem, way)
        served = winning(problem, apart, pairs)
    else:
        apart = tuple(in_time(problem, own.ranks))
        served = problem.steps.states_of(own.policy) | winning(
            problem, apart, problem.steps.allowed & ~problem.steps.safe
        )
    stuck, lost = _stuck(problem), problem.false
    if way is not None and problem.spec.restoration != "one_step":
        lost, stuck = problem.steps.unsafe & ~way.restorable, stuck & problem.steps.safe
    without_plan = problem.steps.valid & ~stuck & ~lost & ~served
    found: dict[FailureKind, Bdd] = {"no-allowed-set": stuck, "no-restoration": lost, "no-plan": without_plan}
    return Failing({kind: states for kind, states in found.items() if states != problem.false}, apart, way)


def failures_of(problem: Problem, kinds: dict[FailureKind, Bdd]) -> tuple[Failure, ...]:
    """Failing states, counted and listed; kinds without states are left out."""
    return tuple(_failure(problem, kind, states) for kind, states in kinds.items() if states != problem.false)


def _failure(problem: Problem, kind: FailureKind, states: Bdd) -> Failure:
    listed = []
    for state in problem.encoding.states_in(states):
        listed.append(state)
        if len(listed) == STATES_LISTED:
            break
    return Failure(kind, problem.encoding.count_states(states), listed[0], tuple(listed))


def reason_of(
    problem: Problem, failing: Failing, among: Bdd | None = None
) -> NoAllowedSet | NoRestoration | NoPlan | None:
    """What a certificate says of the first failing state (`among` some); None where it has no form for any of them.

    Where safety may take several steps to restore: of safe states that have no allowed set or no plan, and of states
    that cannot be restored.
    """
    from tumato_symbolic.synthesis.unrealizability import no_allowed_set, no_plan, no_restoration

    first, kinds, false, apart = problem.encoding.first_state, failing.kinds, problem.false, failing.apart
    asked = problem.steps.valid if among is None else among
    trap = kinds.get("no-restoration", false)
    lost, stuck, without_plan = (
        asked & kinds.get(kind, false) for kind in ("no-restoration", "no-allowed-set", "no-plan")
    )
    if lost != false:
        return no_restoration(problem, first(lost), trap)
    if problem.spec.restores_stepwise:
        apart, stuck, without_plan = distances(problem), stuck & problem.steps.safe, without_plan & problem.steps.safe
    if stuck != false:
        return no_allowed_set(problem, first(stuck))
    return no_plan(problem, first(without_plan), apart) if without_plan != false else None
