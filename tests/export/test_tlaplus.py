"""What a module of TLA+ is called, and what it names."""

from __future__ import annotations

import pytest
from msgspec.structs import replace

from tests.export.policies import example
from tumato_symbolic.diagnostics import Code, UserError
from tumato_symbolic.export import tlaplus


@pytest.mark.parametrize("name", ["my-robot", "9", "MODULE", "a b", ""])
def test_a_file_with_a_name_that_no_module_can_have_is_refused(name: str) -> None:
    """The tools want a module to be called like its file."""
    with pytest.raises(UserError) as error:
        tlaplus.files(replace(example("amr"), name=name))
    assert error.value.diagnostics[0].code is Code.TUM510


@pytest.mark.parametrize("name", ["amr", "brake", "lid"])
def test_every_claim_is_defined_and_configured(name: str) -> None:
    """What the configuration names is in the module; where safety takes several steps, it is a property."""
    module, configuration = tlaplus.files(example(name))
    claims = [line.split() for line in configuration.splitlines() if line.startswith(("INVARIANT", "PROPERTY"))]
    assert all(f"\n{claim} == " in module for _, claim in claims)
    assert (["PROPERTY", "SafetyRestored"] in claims) == (name != "amr")
    assert ["INVARIANT", "SafeAfterEffects"] in claims
