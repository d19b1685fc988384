"""Tests of cubes and of the predicates made of them."""

from itertools import product
from random import Random

from tests.explain.oracle import read_predicate
from tests.generate import random_spec
from tumato_symbolic.explain.as_predicates import predicate_text, shortest_formula
from tumato_symbolic.explain.cubes import disjoint_cubes, set_of, shortest_cubes
from tumato_symbolic.semantics import all_states
from tumato_symbolic.symbolic import Bdd, Encoding, available_backend, encode


def _drawn(seed: int) -> tuple[Encoding, Bdd, Bdd]:
    """A random set of states and another one that does not matter."""
    random, encoding = Random(seed), encode(random_spec(seed), available_backend())
    shares: list[list[Bdd]] = [[], [], []]
    for state in all_states(encoding.spec):
        random.choice((shares[0], shares[0], shares[1], shares[2])).append(encoding.state_cube(state))
    return encoding, encoding.manager.union(shares[1]), encoding.manager.union(shares[2])


def test_disjoint_cubes_hold_exactly_the_states() -> None:
    """Cubes are disjoint, contain all the states, and beside them only what does not matter."""
    for seed in range(40):
        encoding, states, indifferent = _drawn(seed)
        cover = disjoint_cubes(encoding, states, indifferent)
        listed = [state for cube in cover.cubes for state in product(*cube)]
        assert cover.rest == encoding.manager.false
        assert len(listed) == len(set(listed))
        found = encoding.manager.union(map(encoding.state_cube, listed))
        assert states & ~found == encoding.manager.false
        assert found & ~(states | indifferent) == encoding.manager.false


def test_a_limit_leaves_a_rest() -> None:
    """With a limit, the cubes and the rest are the whole set, and the first cube is the same."""
    for seed in range(20):
        encoding, states, indifferent = _drawn(seed)
        whole = disjoint_cubes(encoding, states, indifferent)
        part = disjoint_cubes(encoding, states, indifferent, 1)
        assert part.cubes == whole.cubes[:1]
        covered = encoding.manager.union(set_of(encoding, cube) for cube in part.cubes)
        assert part.rest == states & ~covered


def test_shortest_cubes_are_irredundant() -> None:
    """No cube of a cover can be left out."""
    for seed in range(20):
        encoding, states, indifferent = _drawn(seed)
        cubes = [set_of(encoding, cube) for cube in shortest_cubes(encoding, states, indifferent) or ()]
        for left_out in range(len(cubes)):
            others = encoding.manager.union(cube for number, cube in enumerate(cubes) if number != left_out)
            assert states & ~others != encoding.manager.false


def test_the_text_of_a_set_means_the_set() -> None:
    """The predicate of a set of states, read again, holds exactly there (or where it does not matter)."""
    for seed in range(40):
        encoding, states, indifferent = _drawn(seed)
        text = predicate_text(encoding.spec, shortest_formula(encoding, states, indifferent))
        found = encoding.formula(read_predicate(encoding.spec, text)) & encoding.domain()
        assert states & ~found == encoding.manager.false
        assert found & ~(states | indifferent) == encoding.manager.false


def test_the_text_of_any_predicate_means_the_predicate() -> None:
    """Every generated rule, printed and read again, has the same meaning."""
    for seed in range(40):
        encoding = encode(random_spec(seed), available_backend())
        spec, domain = encoding.spec, encoding.domain()
        for rule in (*spec.state_rules, *spec.reaction_rules, *spec.bodies):
            again = read_predicate(spec, predicate_text(spec, rule.formula))
            assert encoding.formula(again) & domain == encoding.formula(rule.formula) & domain
