"""Sets of states and steps as BDDs; the only room that knows dd."""

from tumato_symbolic.symbolic.choose import lasting, preferred
from tumato_symbolic.symbolic.encoding import Encoding, encode
from tumato_symbolic.symbolic.extract import Extractor
from tumato_symbolic.symbolic.goals import Regions, Target, never_entered, regions, targets
from tumato_symbolic.symbolic.manager import (
    NO_LIMITS,
    Backend,
    Bdd,
    LimitReachedError,
    Limits,
    Manager,
    available_backend,
)
from tumato_symbolic.symbolic.steps import Steps, build_steps, compatible_sets, staying_in

__all__ = [
    "NO_LIMITS",
    "Backend",
    "Bdd",
    "Encoding",
    "Extractor",
    "LimitReachedError",
    "Limits",
    "Manager",
    "Regions",
    "Steps",
    "Target",
    "available_backend",
    "build_steps",
    "compatible_sets",
    "encode",
    "lasting",
    "never_entered",
    "preferred",
    "regions",
    "staying_in",
    "targets",
]
