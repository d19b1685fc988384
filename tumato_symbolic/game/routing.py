"""Decisions for safe states: inside the region of the own goals, then through states that are already decided."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from msgspec import Struct

from tumato_symbolic.game.blocks import Block, blocks_of
from tumato_symbolic.game.fixpoints import Layers, attractor, closed_loop, preimage, turns_of
from tumato_symbolic.game.problem import Problem
from tumato_symbolic.game.subgoals import one_after_the_other, subgoals_of
from tumato_symbolic.semantics import ActiveGoals
from tumato_symbolic.symbolic import Bdd, Rounds, Target, Turn, preferred, with_own_bits

MANY_NODES = 10_000
"""With larger sets of pairs a search goes on in turns, if it can."""


class OwnRegions(Struct, frozen=True):
    """Decisions whose runs stay where the same goals are active until these are reached, with the fewest steps.

    `ranks` are those of the policy, as `attractor` gives them, where they are known: a single target, and one region.
    Where one subgoal is reached after the other, runs are not the shortest, and may be shorter than their ranks.
    """

    policy: Bdd
    ranks: tuple[Layers, ...] | None = None

    def within(self, states: Bdd) -> OwnRegions:
        """The same in a part of the states, which has all that are decided, and which no allowed step leaves."""
        ranks = self.ranks and tuple([layers[0] & states, *layers[1:]] for layers in self.ranks)
        return OwnRegions(self.policy, ranks)


def only_region(problem: Problem) -> OwnRegions | None:
    """`own_region_policy` where there is one region with one target, and runs are the shortest; None elsewhere.

    What it does not decide fails in safe states, for it decides all that have a plan when each is taken alone.
    """
    single = len(problem.targets) == len(problem.regions) == 1
    if problem.goals_are_many or problem.steps.one_at_a_time or not single:
        return None
    return own_region_policy(problem)


def own_region_policy(problem: Problem) -> OwnRegions:
    """The policy of all own regions."""
    policy = problem.false
    if problem.goals_are_many:
        return OwnRegions(_all_regions(problem, problem.targets[0]))
    targets_in: dict[ActiveGoals, list[Target]] = {}
    for target in problem.targets:
        for active in dict.fromkeys(residual.bodies for residual, _ in target.residuals):
            targets_in.setdefault(active, []).append(target)
    for active, region in problem.regions.items():
        here = region & problem.steps.safe
        wanted = [target for target in targets_in.get(active, ()) if (target.pending & here) != problem.false]
        if len(wanted) == 1:
            decided, layers, ranked = _in_region(problem, wanted[0], here, active)
            if ranked and len(problem.targets) == 1 and here == problem.steps.safe:
                return OwnRegions(decided, (layers,))
            policy = policy | decided
        elif wanted:
            policy = policy | route(problem, problem.false, here, here, wanted)
    return OwnRegions(policy)


def _in_region(problem: Problem, target: Target, here: Bdd, active: ActiveGoals) -> tuple[Bdd, Layers, bool]:
    """Decisions for the region of some goals, the layers of the target, and whether these are good enough as ranks.

    With one action at a time runs are not the shortest anyway: then subgoals are reached one after the other, which
    takes much smaller diagrams. Exact ranks are needed where runs are bounded, or unsafe states ask how long they are.
    """
    subgoals = subgoals_of(problem, active) if problem.steps.one_at_a_time else []
    found = one_after_the_other(problem, target, here, subgoals) if len(subgoals) > 1 else None
    if found is None:
        return (*_nearest_first(problem, target, here, here), True)
    return (*found, problem.spec.max_plan_length is None and problem.steps.unsafe == problem.false)


def _all_regions(problem: Problem, target: Target) -> Bdd:
    """`own_region_policy` for all regions at once, where one target stands for all residual goals."""
    safe, own = problem.steps.safe, with_own_bits(problem.encoding, target)
    bits = problem.encoding.goal_bits
    if bits is None or not bits.actions:
        return _nearest_first(problem, target, safe, own)[0]
    return route(problem, problem.false, safe, safe & own, [target])


def _nearest_first(problem: Problem, target: Target, here: Bdd, own: Bdd) -> tuple[Bdd, Layers]:
    """The fixpoint for a region with one target: states by the number of steps of their best run inside it.

    A state that satisfies the target already still has to make a step: it is decided by its own number, but runs of
    others end in it. Where the target speaks of goal bits, `own` has the states with the bits of their region. The
    layers are those states that runs of others may pass, by how many steps are left; the last one is empty.
    """
    policy, undecided, layers = problem.false, here, [target.states]
    relation = target.pending & here
    blocks = None if target.meaning else blocks_of(problem, relation)
    if blocks is not None:
        return _block_by_block(problem, target, here, own, blocks)
    into, asked = preimage(problem, relation), bool(target.meaning)
    while _goes_on(problem, undecided, layers):
        pairs = undecided & problem.own(target, into(layers[-1]))
        decided = problem.steps.states_of(pairs)
        policy = policy | preferred(problem.encoding, pairs)
        undecided = undecided & ~decided
        layers.append(decided & own & ~target.states)
        if not asked and problem.encoding.manager.nodes(pairs) > MANY_NODES:
            turn, asked = turns_of(problem, relation), True
            if turn is not None:
                policy = policy | _in_turns(problem, turn, relation, undecided, layers)
                break
    return policy, layers if layers[-1] == problem.false else [*layers, problem.false]


def _block_by_block(
    problem: Problem, target: Target, here: Bdd, own: Bdd, blocks: Sequence[Block]
) -> tuple[Bdd, Layers]:
    """`_nearest_first` for single actions: each state is decided by the first block with one that leads there."""
    manager, undecided, layers = problem.encoding.manager, here, [target.states]
    parts = [[problem.false] for _ in blocks]
    while _goes_on(problem, undecided, layers):
        leading = [block.leading.into(layers[-1]) for block in blocks]
        decided = left = undecided & manager.union(leading)
        for part, states in zip(parts, leading, strict=True):
            part.append(left & states)
            left = left & ~part[-1]
        undecided = undecided & ~decided
        layers.append(decided & own & ~target.states)
    policy = manager.union(
        block.pairs & manager.balanced_union(part) for block, part in zip(blocks, parts, strict=True)
    )
    return policy, layers if layers[-1] == problem.false else [*layers, problem.false]


def _goes_on(problem: Problem, undecided: Bdd, layers: Layers) -> bool:
    """Whether there may be another layer."""
    bound = problem.spec.max_plan_length
    return problem.false not in {undecided, layers[-1]} and (bound is None or len(layers) <= bound)


def _in_turns(problem: Problem, turn: Turn, relation: Bdd, undecided: Bdd, layers: Layers) -> Bdd:
    """Goes on with `_nearest_first`: adds to the layers, and then chooses for the states of all of them at once."""
    rounds, left, target = Rounds(turn), undecided, layers[0]
    while _goes_on(problem, left, layers):
        decided = left & rounds.into(layers[-1])
        left = left & ~decided
        layers.append(decided & ~target)
    return preferred(problem.encoding, relation & undecided & rounds.pairs())


def route(problem: Problem, policy: Bdd, undecided: Bdd, within: Bdd, wanted: Sequence[Target]) -> Bdd:
    """`policy` and decisions for as many undecided states as possible, fewest steps first.

    Runs use decided states of `within` only, so that a later decision never spoils an earlier one.
    """
    while undecided != problem.false:
        so_far = closed_loop(problem, policy)
        decided = within & so_far.decided
        ranks = [attractor(problem, t.states, so_far.predecessor, decided, problem.last_layer) for t in wanted]
        nearest = next(iter(_by_steps(problem, wanted, ranks, undecided, problem.steps.allowed)), None)
        if nearest is None:
            break
        policy = policy | preferred(problem.encoding, nearest)
        undecided = undecided & ~problem.steps.states_of(nearest)
    return policy


def shortest_decisions(problem: Problem, ranks: Sequence[Layers], undecided: Bdd, relation: Bdd) -> Bdd:
    """For every undecided state the pair with the fewest steps, where `ranks` are the first successors'."""
    policy = problem.false
    for pairs in _by_steps(problem, problem.targets, ranks, undecided, relation):
        fresh = pairs & ~problem.steps.states_of(policy)
        policy = policy | preferred(problem.encoding, fresh)
    return policy


def _by_steps(
    problem: Problem, wanted: Sequence[Target], ranks: Sequence[Layers], states: Bdd, relation: Bdd
) -> Iterator[Bdd]:
    """The pairs that reach their target in one step, in two, and so on; empty sets are left out."""
    parts = [
        (target, preimage(problem, relation & states & target.pending), layers)
        for target, layers in zip(wanted, ranks, strict=True)
    ]
    for rank in range(max(map(len, ranks), default=0)):
        pairs = problem.encoding.manager.union(
            problem.own(target, into(layers[rank]))
            for target, into, layers in parts
            if rank < len(layers) and layers[rank] != problem.false
        )
        if pairs != problem.false:
            yield pairs
