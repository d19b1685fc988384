"""The symbolic step relation equals the explicit one, on both backends."""

from __future__ import annotations

from itertools import chain, combinations
from random import Random

import pytest

from tests.generate import ALL_PROFILES, random_spec
from tests.semantics.build import Build
from tumato_symbolic.semantics import (
    ActionSet,
    State,
    active_goals,
    all_states,
    allowed_sets,
    is_safe,
    is_valid,
    nominal_agrees,
    objections,
    outcomes,
    reached,
    residual_goal,
    successor,
)
from tumato_symbolic.spec import And, Not, Ordering, Spec
from tumato_symbolic.symbolic import (
    Backend,
    Encoding,
    Steps,
    available_backend,
    build_steps,
    encode,
    lasting,
    lay_out,
    preferred,
    regions,
    staying_in,
    targets,
)
from tumato_symbolic.symbolic import steps as module
from tumato_symbolic.symbolic.layout import Group
from tumato_symbolic.symbolic.manager import Bdd

BACKENDS: list[Backend] = sorted({"autoref", available_backend()})
SEEDS = range(12)


def every_set(spec: Spec) -> list[ActionSet]:
    """All subsets of the actions."""
    numbers = range(len(spec.actions))
    return [frozenset(s) for s in chain.from_iterable(combinations(numbers, size) for size in range(len(numbers) + 1))]


def relation(steps: Steps) -> set[tuple[State, ActionSet]]:
    """`Ok` as the engine has it, pair by pair."""
    encoding = steps.encoding
    return {
        (state, chosen)
        for state in all_states(encoding.spec)
        for chosen in every_set(encoding.spec)
        if encodes(encoding, chosen)
        and (encoding.at(steps.allowed, state) & encoding.choices_cube(chosen)) != encoding.manager.false
    }


def encodes(encoding: Encoding, chosen: ActionSet) -> bool:
    """Whether a set is a combination of choices: at most one action of each group."""
    return all(len(chosen & set(group.actions)) <= 1 for group in encoding.groups)


@pytest.mark.parametrize("backend", BACKENDS)
@pytest.mark.parametrize("ordering", ["any", "first"])
@pytest.mark.parametrize("seed", SEEDS)
def test_allowed_pairs_are_those_of_the_semantics(seed: int, ordering: Ordering, backend: Backend) -> None:
    """`Ok(s, A)` of section 3, for every state and set of a generated specification."""
    spec = random_spec(seed, ALL_PROFILES["restoring" if seed % 2 else "mixed"])
    steps = build_steps(lay_out(spec, backend), spec, ordering)
    valid = [state for state in all_states(spec) if is_valid(spec, state)]
    assert relation(steps) == {(state, chosen) for state in valid for chosen in allowed_sets(spec, state, ordering)}
    assert list(steps.encoding.states_in(steps.valid)) == valid
    assert list(steps.encoding.states_in(steps.safe)) == [state for state in valid if is_safe(spec, state)]


@pytest.mark.parametrize("seed", SEEDS)
def test_predecessors_and_successors_follow_all_nominal_effects_at_once(seed: int) -> None:
    """`before` and `successors` agree with `δ`."""
    spec = random_spec(seed, ALL_PROFILES["mixed"])
    steps = build_steps(lay_out(spec, available_backend()), spec, "any")
    encoding, false = steps.encoding, steps.encoding.manager.false
    states = list(all_states(spec))
    goal = states[len(states) // 2]
    before = steps.before(encoding.state_cube(goal))
    for state in states[:20]:
        for chosen in every_set(spec):
            if encodes(encoding, chosen) and nominal_agrees(spec, chosen):
                pair = encoding.state_cube(state) & encoding.choices_cube(chosen)
                end = successor(spec, state, chosen)
                assert ((pair & before) != false) == (end == goal)
                assert steps.successors(pair) == encoding.state_cube(end)


@pytest.mark.parametrize("backend", BACKENDS)
@pytest.mark.parametrize("seed", SEEDS)
def test_the_successors_of_a_relation_are_those_of_its_pairs(seed: int, backend: Backend) -> None:
    """Also where a group is idle in all pairs, in some, or in none."""
    spec = random_spec(seed, ALL_PROFILES["mixed"])
    steps, random = build_steps(lay_out(spec, backend), spec, "any"), Random(seed)
    encoding, union = steps.encoding, steps.encoding.manager.union
    pairs = [
        (state, chosen)
        for state in all_states(spec)
        for chosen in every_set(spec)
        if encodes(encoding, chosen) and nominal_agrees(spec, chosen)
    ]
    for number in (0, 1, 3, 20):
        some = random.sample(pairs, min(number, len(pairs)))
        taken = union(encoding.state_cube(state) & encoding.choices_cube(chosen) for state, chosen in some)
        ends = union(encoding.state_cube(successor(spec, state, chosen)) for state, chosen in some)
        assert steps.successors(taken) == ends


@pytest.mark.parametrize("seed", SEEDS)
def test_regions_and_targets_are_the_active_and_residual_goals(seed: int) -> None:
    """Every valid state lies in the region of `Γ(s)` alone, every allowed pair has the target of its residual goal."""
    spec = random_spec(seed, ALL_PROFILES["interacting"])
    steps = build_steps(lay_out(spec, available_backend()), spec, "any")
    encoding = steps.encoding
    active = regions(encoding, steps.valid)
    found = targets(steps, active)
    for state in all_states(spec):
        inside = [goals for goals, region in active.items() if encoding.contains(region, state)]
        assert inside == ([active_goals(spec, state)] if is_valid(spec, state) else [])
    for state, chosen in sorted(relation(steps), key=str)[:100]:
        pair = encoding.state_cube(state) & encoding.choices_cube(chosen)
        has = [target for target in found if (target.pending & pair) != encoding.manager.false]
        residual = residual_goal(spec, state, chosen)
        assert [[r for r, pairs in target.residuals if (pairs & pair) != encoding.manager.false] for target in has] == [
            [residual]
        ]
        goal = {t for t in all_states(spec) if is_safe(spec, t) and reached(spec, residual, t)}
        assert set(encoding.states_in(has[0].states)) == goal


@pytest.mark.parametrize("seed", SEEDS)
def test_the_preferred_set_is_the_smallest_then_the_one_declared_first(seed: int) -> None:
    """Section 6: fewest actions, then the first in the order of sorted positions; `lasting` sums durations exactly."""
    spec = random_spec(seed, ALL_PROFILES["restoring"])
    steps = build_steps(lay_out(spec, available_backend()), spec, "any")
    encoding = steps.encoding
    chosen = preferred(encoding, steps.allowed)
    for state in encoding.states_in(steps.valid):
        sets = sorted(allowed_sets(spec, state, "any"), key=lambda one: (len(one), sorted(one)))
        here = encoding.at(chosen, state)
        assert here == (encoding.choices_cube(sets[0]) if sets else encoding.manager.false)
    for some in every_set(spec):
        if encodes(encoding, some):
            total = sum(spec.actions[action].duration for action in some)
            assert (encoding.choices_cube(some) & lasting(encoding, total)) != encoding.manager.false
            assert (encoding.choices_cube(some) & lasting(encoding, total + 1)) == encoding.manager.false


@pytest.mark.parametrize("seed", SEEDS)
def test_the_next_state_of_a_policy_and_its_moves(seed: int) -> None:
    """`next_state` is `δ(s, π(s))` bit by bit; `moves` splits a relation by all that its sets nominally write."""
    spec = random_spec(seed, ALL_PROFILES["restoring" if seed % 2 else "mixed"])
    steps = build_steps(lay_out(spec, available_backend()), spec, "any")
    encoding, manager = steps.encoding, steps.encoding.manager
    states = list(all_states(spec))
    valid = [state for state in states if is_valid(spec, state)]
    assert list(encoding.states_in(steps.unsafe)) == [state for state in valid if not is_safe(spec, state)]
    chosen = preferred(encoding, steps.allowed)
    following = encoding.next_state(chosen)
    decided = {
        state: next(each for each in every_set(spec) if encodes(encoding, each) and _is(encoding, chosen, state, each))
        for state in encoding.states_in(steps.states_of(chosen))
    }
    for state in states[:40]:
        end = successor(spec, state, decided.get(state, frozenset()))
        for bit, where in following.items():
            after = (encoding.state_cube(end) & manager.cube({bit: True})) != manager.false
            assert encoding.contains(where, state) == after
    moves = steps.moves(chosen, len(states) ** 2, keep_sets=True)
    assert moves is not None
    for state, each in decided.items():
        pair = encoding.state_cube(state) & encoding.choices_cube(each)
        written = tuple(sorted({item for action in each for item in spec.actions[action].nominal}))
        assert [effect for effect, pairs in moves.items() if (pairs & pair) != manager.false] == [written]
    plain = steps.moves(chosen, len(moves))
    assert plain == {effect: steps.states_of(pairs) for effect, pairs in moves.items()}
    assert steps.moves(chosen, len(moves) - 1) is None
    goal = encoding.state_cube(valid[-1])
    leading = {s for s, each in decided.items() if successor(spec, s, each) == valid[-1]}
    assert set(encoding.states_in(steps.predecessor(chosen, goal))) == leading


def _is(encoding: Encoding, relation: Bdd, state: State, each: ActionSet) -> bool:
    return (relation & encoding.state_cube(state) & encoding.choices_cube(each)) != encoding.manager.false


@pytest.mark.parametrize("turned", [False, True])
def test_an_order_in_which_one_action_hurts(turned: bool) -> None:
    """One of two actions is harmless wherever it comes, the other one after it: whichever is declared first."""
    build = Build({"x": "abc", "y": "ab"})
    parts: list[tuple[str, list[str]]] = [("x=a y=b", []), ("", ["x=c"])]
    for nominal, alternatives in reversed(parts) if turned else parts:
        build.action(nominal, alternatives)
    spec = build.spec(state_rules=[Not(And((build.atom("x=c"), build.atom("y=b"))))])
    for ordering in ("any", "first"):
        steps = build_steps(lay_out(spec, available_backend()), spec, ordering)
        expected = {(state, each) for state in all_states(spec) for each in allowed_sets(spec, state, ordering)}
        assert relation(steps) == expected


@pytest.mark.parametrize("ordering", ["any", "first"])
def test_one_more_assumption(ordering: Ordering) -> None:
    """Steps within a set of states: what is outside is neither valid nor safe, so nothing may lead there."""
    spec = random_spec(3, ALL_PROFILES["restoring"])
    encoding = encode(spec, available_backend())
    whole = build_steps(encoding, spec, ordering)
    valid = list(encoding.states_in(whole.valid))
    inside = valid[::2]
    within = encoding.manager.union([encoding.state_cube(state) for state in inside])
    steps = build_steps(encoding, spec, ordering, within)
    assert list(encoding.states_in(steps.valid)) == inside
    assert list(encoding.states_in(steps.safe)) == [state for state in inside if is_safe(spec, state)]
    safe = {state for state in inside if is_safe(spec, state)}
    expected = {
        (state, each)
        for state in inside
        for each in every_set(spec)
        if encodes(encoding, each)
        and not {kind.kind for kind in objections(spec, state, each, ordering)} - {"unsafe", "nominal-unsafe"}
        and set(outcomes(spec, state, each, ordering)) | {successor(spec, state, each)} <= safe
    }
    assert relation(steps) == expected


@pytest.fixture
def taken(monkeypatch: pytest.MonkeyPatch) -> list[Group]:
    """The groups whose effects are looked at, in turn."""
    found, after_effect_of = list[Group](), module._after_effect_of

    def counted(encoding: Encoding, group: Group, following: Bdd) -> Bdd:
        found.append(group)
        return after_effect_of(encoding, group, following)

    monkeypatch.setattr(module, "_after_effect_of", counted)
    return found


@pytest.mark.parametrize("shared", [False, True])
@pytest.mark.parametrize("all_safe", [False, True])
def test_groups_that_write_different_variables_are_taken_once(shared: bool, all_safe: bool, taken: list[Group]) -> None:
    """Their effects commute, so that nothing is looked at again, from the lowest group up; else they are.

    Once more where an unsafe state may be left; what is not asked about may be wrong.
    """
    build = Build(dict.fromkeys("wxyz", "abc"))
    for name in "wxyz":
        build.action(f"{name}=b", [f"{name}=a x=c" if shared and name != "x" else f"{name}=a"])
    rules = [Not(And((build.atom("w=a"), build.atom("x=b"))))]
    spec = build.spec(state_rules=() if all_safe else rules, assumptions=rules if all_safe else ())
    encoding = encode(spec, available_backend())
    steps = build_steps(encoding, spec, "any")
    assert (len(taken) > (4 if all_safe else 8)) is shared
    assert taken[:4] == sorted(encoding.groups, key=lambda each: encoding.manager.level(each.bits[0]), reverse=True)
    expected = {(state, each) for state in all_states(spec) for each in allowed_sets(spec, state, "any")}
    assert relation(steps) == {pair for pair in expected if is_valid(spec, pair[0])}
    everywhere = staying_in(encoding, "any", steps.safe, encoding.choice_domain())
    assert steps.candidates & everywhere == steps.allowed
