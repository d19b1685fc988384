"""Generated specifications, printed and loaded again."""

from __future__ import annotations

from typing import Any

import pytest
from msgspec import Struct
from msgspec.structs import asdict, replace

from tests.generate import NOWHERE, random_spec, random_text
from tests.profiles import ALL_PROFILES, Profile
from tumato_symbolic.diagnostics import Source
from tumato_symbolic.spec import Spec, load


def bare(value: Any) -> Any:
    """A record without the places and texts that it came from; what an alternative may do has no order."""
    if isinstance(value, tuple):
        return tuple(bare(part) for part in value)
    if not isinstance(value, Struct):
        return value
    kept = {name: bare(part) for name, part in asdict(value).items()}
    hidden = {"span": NOWHERE, "text": "", "outcomes": tuple(sorted(kept.get("outcomes", ())))}
    hidden |= {"resource_span": None, "bound_span": None}
    return replace(value, **{name: hidden.get(name, part) for name, part in kept.items()})


def loaded(seed: int, profile: Profile) -> Spec | None:
    """The specification that the text of a seed means."""
    return load(Source(f"{seed}.tum", random_text(seed, profile))).spec


@pytest.mark.parametrize("profile", ALL_PROFILES.values(), ids=ALL_PROFILES)
def test_a_printed_specification_loads_as_the_same_record(profile: Profile) -> None:
    """Parser and resolver give back what the generator made, through aliases, commas, parentheses and nesting."""
    for seed in range(70):
        assert bare(loaded(seed, profile)) == bare(random_spec(seed, profile)), seed
