"""What two policies decide otherwise, against a comparison state by state."""

from collections import Counter
from itertools import product
from math import prod
from random import Random
from unittest.mock import patch

import pytest
from hypothesis import given
from hypothesis import strategies as st
from msgspec.structs import replace

from tests.generate import NOWHERE
from tests.policy.strategies import QUICK, amr_like, policies, rows_of, spec_of
from tumato_symbolic.limits import Context, LimitReachedError, Limits
from tumato_symbolic.policy import DecisionDiagram, Policy, Table, Vocabulary, as_diagram
from tumato_symbolic.semantics import ActionSet, State
from tumato_symbolic.spec import Is, Not, Rule
from tumato_symbolic.views import Decided, Difference, difference

_MOST_STATES = 5_000

Rows = dict[State, ActionSet]


def edited(policy: Policy, random: Random) -> Policy:
    """A policy that differs a little: decisions, the order of declaration, names, table or diagram."""
    rows, vocabulary = dict(rows_of(policy)), policy.vocabulary
    for state in list(rows):
        if random.random() < 0.2:
            rows[state] = frozenset(a for a in range(len(vocabulary.actions)) if random.random() < 0.5)
        elif random.random() < 0.1:
            del rows[state]
    if random.random() < 0.3:
        vocabulary, rows = _with_variable(vocabulary, rows, random)
    if random.random() < 0.3:
        vocabulary, rows = _without_value(vocabulary, rows, random)
    if random.random() < 0.3:
        vocabulary = Vocabulary(vocabulary.variables, (*vocabulary.actions, "added"))
        rows = {state: chosen | {len(vocabulary.actions) - 1} if state[0] else chosen for state, chosen in rows.items()}
    if random.random() < 0.5:
        vocabulary, rows = _shuffled(vocabulary, rows, random)
    made = Policy(vocabulary, Table(dict(sorted(rows.items()))))
    return replace(made, decisions=as_diagram(made)) if random.random() < 0.5 else made


def _with_variable(vocabulary: Vocabulary, rows: Rows, random: Random) -> tuple[Vocabulary, Rows]:
    extended = Vocabulary((*vocabulary.variables, ("added variable", ("p", "q"))), vocabulary.actions)
    return extended, {
        (*state, value): chosen for state, chosen in rows.items() for value in (0, 1) if random.random() < 0.9
    }


def _without_value(vocabulary: Vocabulary, rows: Rows, random: Random) -> tuple[Vocabulary, Rows]:
    """One value of a variable is gone, and another one is new."""
    place = random.randrange(len(vocabulary.variables))
    name, values = vocabulary.variables[place]
    variables = list(vocabulary.variables)
    variables[place] = (name, (*values[:-1], "added value"))
    return Vocabulary(tuple(variables), vocabulary.actions), rows


def _shuffled(vocabulary: Vocabulary, rows: Rows, random: Random) -> tuple[Vocabulary, Rows]:
    """The same, declared in another order."""
    variables = random.sample(range(len(vocabulary.variables)), len(vocabulary.variables))
    values = [random.sample(range(size), size) for size in vocabulary.sizes]
    actions = random.sample(range(len(vocabulary.actions)), len(vocabulary.actions))
    declared = Vocabulary(
        tuple(
            (vocabulary.variables[old][0], tuple(vocabulary.variables[old][1][value] for value in values[old]))
            for old in variables
        ),
        tuple(vocabulary.actions[old] for old in actions),
    )
    return declared, {
        tuple(values[old].index(state[old]) for old in variables): frozenset(map(actions.index, chosen))
        for state, chosen in rows.items()
    }


def decided(policy: Policy, state: dict[str, str]) -> Decided:
    """What a policy says of a state of the names of both."""
    vocabulary = policy.vocabulary
    if any(state[name] not in values for name, values in vocabulary.variables):
        return Decided(None, known=False)
    chosen = rows_of(policy).get(tuple(values.index(state[name]) for name, values in vocabulary.variables))
    if chosen is None:
        return Decided(None)
    return Decided(tuple(sorted(vocabulary.actions[action] for action in chosen)))


def unordered(found: Decided) -> Decided:
    """The same with the actions sorted by name."""
    return found if found.actions is None else replace(found, actions=tuple(sorted(found.actions)))


def told(before: Decided, after: Decided, *, whole: bool) -> tuple[Decided, Decided]:
    """Two decisions as a change tells them: whole, or by the actions that only one of them has."""
    if whole:
        return before, after
    one, other = set(before.actions or ()), set(after.actions or ())
    both = before.actions is not None and after.actions is not None
    first, second = (
        replace(each, whole=False, actions=None if each.actions is None else tuple(sorted(only if both else ())))
        for each, only in ((before, one - other), (after, other - one))
    )
    return first, second


def check(old: Policy, new: Policy, found: Difference) -> None:
    """Compare state by state: how many states differ, by decisions, and which are in which cubes."""
    known = dict(new.vocabulary.variables)
    for name, values in old.vocabulary.variables:
        known[name] = (*known.get(name, ()), *(value for value in values if value not in known.get(name, ())))
    assert dict(found.variables) == known
    compared, expected = 0, Counter[tuple[Decided, Decided]]()
    whole = all(each.before.whole for each in found.changes)
    cubes = {(unordered(each.before), unordered(each.after)): each.cubes or () for each in found.changes}
    for values in product(*known.values()):
        state = dict(zip(known, values, strict=True))
        before, after = decided(old, state), decided(new, state)
        if before.actions is None and after.actions is None:
            continue
        compared += 1
        inside = {
            known_change
            for known_change, listed in cubes.items()
            if any(all(state[name] in allowed for name, allowed in cube) for cube in listed)
        }
        change = told(before, after, whole=whole)
        assert inside == ({change} if before != after else set())
        if before != after:
            expected[change] += 1
    assert (found.compared, found.changed) == (compared, sum(expected.values()))
    assert {(unordered(each.before), unordered(each.after)): each.states for each in found.changes} == expected
    for each in found.changes:
        state = dict(each.example)
        shown = unordered(each.before), unordered(each.after)
        assert told(decided(old, state), decided(new, state), whole=whole) == shown


@QUICK
@given(policies(), st.integers(0, 10**9), st.booleans())
def test_pairs_of_policies(policy: Policy, seed: int, coarse: bool) -> None:
    """Edited policies, tables and diagrams, differ where they do state by state, in both directions.

    So they do where there are too many changes to tell whole decisions.
    """
    other = edited(policy, Random(seed))
    if prod(policy.vocabulary.sizes) * 4 <= _MOST_STATES:
        with patch("tumato_symbolic.views.two_policies._MANY", 0 if coarse else 10_000):
            check(policy, other, difference(policy, other, most=10_000))
            check(other, policy, difference(other, policy, most=10_000))


@QUICK
@given(policies(), st.integers(0, 10**9))
def test_the_order_of_declaration_does_not_matter(policy: Policy, seed: int) -> None:
    """Nor whether it is a table."""
    vocabulary, rows = _shuffled(policy.vocabulary, dict(rows_of(policy)), Random(seed))
    found = difference(policy, Policy(vocabulary, Table(rows)))
    assert found.same
    assert (found.changed, found.changes, found.by_action) == (0, (), ())


def test_actions_that_start_and_stop() -> None:
    """In how many states each is executed by one policy only."""
    old = amr_like()
    new = replace(old, decisions=Table({state: frozenset({0}) for state in rows_of(old)}))
    found = {each.action: (each.started, each.stopped) for each in difference(old, new).by_action}
    assert found == {"go": (2, 0), "load": (0, 1), "stop": (0, 1)}


def test_only_valid_states_are_compared_where_there_is_a_specification() -> None:
    """Also where the numbers of the specification are not those of the policies."""
    old = amr_like()
    new = replace(old, decisions=Table({}))
    spec = spec_of(Vocabulary(old.vocabulary.variables[::-1], old.vocabulary.actions))
    assumed = replace(spec, assumptions=(Rule(Not(Is(0, 1)), "", NOWHERE),))
    assert [difference(old, new, each).changed for each in (None, spec, assumed)] == [4, 4, 2]


def test_what_is_left_out_is_said() -> None:
    """Of more kinds of change than are wanted, those of most states are described; a limit is told."""
    old = amr_like(diagram=True)
    new = replace(old, decisions=Table({state: frozenset() for state in rows_of(old)}))
    found = difference(old, new, most=1)
    assert (len(found.changes), found.left, found.changed) == (1, 2, 3)
    with pytest.raises(LimitReachedError):
        difference(old, new, context=Context(Limits(seconds=0.0)))


def test_states_are_never_listed() -> None:
    """2^60 states, of which one half changes."""
    names = tuple((f"S{number}", ("off", "on")) for number in range(60))
    vocabulary = Vocabulary(names, ("go",))
    small = as_diagram(Policy(Vocabulary(names[:1], ("go",)), Table({(0,): frozenset(), (1,): frozenset({0})})))
    idle = as_diagram(Policy(Vocabulary(names[:1], ("go",)), Table({(0,): frozenset(), (1,): frozenset()})))
    old, new = (Policy(vocabulary, DecisionDiagram(each.diagram, each.roots, each.defined)) for each in (small, idle))
    found = difference(old, new)
    (change,) = found.changes
    assert (found.compared, change.states, change.cubes) == (2**60, 2**59, ((("S0", ("on",)),),))
