"""Sets of states, listed."""

from __future__ import annotations

from itertools import product
from random import Random

import pytest

from tumato_symbolic.diagrams import NOTHING, Sets, sets

SIZES = (2, 3, 1, 4, 2)


@pytest.mark.parametrize("seed", range(20))
@pytest.mark.parametrize("most_ends", [0, 1, 8, 10_000])
def test_every_state_of_a_set_is_listed_once(seed: int, most_ends: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Whatever number of variables at the end are listed together."""
    monkeypatch.setattr(sets, "MOST_ENDS", most_ends)
    random = Random(seed)
    wanted = {state for state in product(*map(range, SIZES)) if random.random() < seed / 19}
    every, found = Sets(range(len(SIZES)), SIZES), NOTHING
    for state in wanted:
        found = every.either(found, every.cube(tuple((level, (value,)) for level, value in enumerate(state))))
    listed = list(every.states(found))
    assert len(listed) == len(wanted)
    assert set(listed) == wanted
