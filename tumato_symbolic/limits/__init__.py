"""How much work may cost, whom it tells what it does, and what it has found: the lowest room, which imports nothing."""

from tumato_symbolic.limits.context import NO_LIMITS, Budget, Context, LimitReachedError, Limits
from tumato_symbolic.limits.packages import MissingPackageError, has_z3, need_z3
