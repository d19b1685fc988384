"""From a specification to a policy, or to the reason why there is none."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tumato_symbolic.limits import Context, Limits
from tumato_symbolic.synthesis.result import Failure, Realizable, Statistics, SynthesisResult, Undecided, Unrealizable
from tumato_symbolic.synthesis.synthesize import PolicyFormat, synthesize

if TYPE_CHECKING:
    from tumato_symbolic.synthesis.diagnosis import Cured, Restorability


def __getattr__(name: str) -> object:
    """What would restore states is imported on first use: where there is a policy, nobody asks."""
    if name not in ("Cured", "Restorability"):
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from tumato_symbolic.synthesis import diagnosis

    return getattr(diagnosis, name)
