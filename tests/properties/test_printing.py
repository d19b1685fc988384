"""Generated specifications, printed and loaded again."""

from __future__ import annotations

from dataclasses import fields, is_dataclass, replace
from typing import Any

import pytest

from tests.generate import NOWHERE, random_spec, random_text
from tests.profiles import ALL_PROFILES, Profile
from tumato_symbolic.diagnostics import Source
from tumato_symbolic.spec import Spec, load


def bare(value: Any) -> Any:
    """A record without the places and texts that it came from; what an alternative may do has no order."""
    if isinstance(value, tuple):
        return tuple(bare(part) for part in value)
    if not is_dataclass(value) or isinstance(value, type):
        return value
    kept = {part.name: bare(getattr(value, part.name)) for part in fields(value) if part.init}
    hidden = {"span": NOWHERE, "text": "", "outcomes": tuple(sorted(kept.get("outcomes", ())))}
    return replace(value, **{name: hidden.get(name, part) for name, part in kept.items()})


def loaded(seed: int, profile: Profile) -> Spec | None:
    """The specification that the text of a seed means."""
    return load(Source(f"{seed}.tum", random_text(seed, profile))).spec


@pytest.mark.parametrize("profile", ALL_PROFILES.values(), ids=ALL_PROFILES)
def test_a_printed_specification_loads_as_the_same_record(profile: Profile) -> None:
    """Parser and resolver give back what the generator made, through aliases, commas, parentheses and nesting."""
    for seed in range(70):
        assert bare(loaded(seed, profile)) == bare(random_spec(seed, profile)), seed
