"""Random texts in short and written out, read by the package: `python -m tests.spec.copied 2000` compares so many."""

from __future__ import annotations

import sys

from tests.shorthand import shorthand
from tumato_symbolic.diagnostics import Source
from tumato_symbolic.spec import Loaded, digest, load


def bare(loaded: Loaded) -> object:
    """A specification without texts and places."""
    spec = loaded.spec
    assert spec is not None, loaded.diagnostics
    return (
        digest(spec),
        [(each.name, each.values) for each in spec.variables],
        [(each.name, each.duration, each.resources, each.effects) for each in spec.actions],
        [[rule.formula for rule in each.preconditions] for each in spec.actions],
        [rule.formula for rule in (*spec.reaction_rules, *spec.state_rules, *spec.assumptions, *spec.bodies)],
    )


def differs(seed: int) -> bool:
    """Whether the two texts of a seed mean different things."""
    short, long = (load(Source("generated", text)) for text in shorthand(seed))
    return bare(short) != bare(long)


if __name__ == "__main__":
    different = [seed for seed in range(int(sys.argv[1])) if differs(seed)]
    print(f"{sys.argv[1]} compared, {len(different)} differ: {different[:10]}")
