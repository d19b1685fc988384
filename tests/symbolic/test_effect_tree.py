"""Tests of many effects at once."""

from itertools import combinations, product
from random import Random

from tumato_symbolic import parse
from tumato_symbolic.spec import Assignment
from tumato_symbolic.symbolic import encode
from tumato_symbolic.symbolic.effect_tree import after_every, effect_tree

SPEC = parse(
    "BEGIN STATE VECTOR state A can be a, b, c state B can be a, b state C can be a, b, c, d END STATE VECTOR"
    " BEGIN ACTIONS action x nominal effects: A is a END ACTIONS"
)


def _all_effects() -> list[Assignment]:
    """Every assignment of some of the variables."""
    sizes = [len(variable.values) for variable in SPEC.variables]
    return [
        tuple(zip(some, values, strict=True))
        for count in range(len(sizes) + 1)
        for some in combinations(range(len(sizes)), count)
        for values in product(*(range(sizes[variable]) for variable in some))
    ]


def test_a_tree_does_what_its_effects_do() -> None:
    """What holds after every effect of a tree is what holds after each of them taken alone."""
    encoding, random, effects = encode(SPEC, "autoref"), Random(3), _all_effects()
    states = [encoding.state_cube(state) for state in product(range(3), range(2), range(4))]
    for _ in range(60):
        chosen = tuple(random.sample(effects, random.randint(1, 30)))
        target = encoding.manager.union(state for state in states if random.random() < 0.8)
        expected = encoding.manager.intersection(
            encoding.manager.cofactor(target, encoding.assignment_bits(effect)) for effect in chosen
        )
        assert after_every(encoding.manager, effect_tree(chosen), target, encoding.assignment_bits) == expected
