"""How much work may cost, whom it tells what it does, and what it has found: the lowest room, which imports nothing."""

from tumato_symbolic.limits.context import NO_LIMITS, Budget, Context, LimitReachedError, Limits
from tumato_symbolic.limits.packages import MissingPackageError, has_z3, need_z3

__all__ = ["MissingPackageError"]
"""What docs/ offers to programs of others; the other names are for the rooms of this package."""
