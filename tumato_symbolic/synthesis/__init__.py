"""From a specification to a policy, or to the reason why there is none."""

from tumato_symbolic.limits import Context, Limits
from tumato_symbolic.synthesis.outcome import Failure, Outcome, Realizable, Statistics, Undecided, Unrealizable
from tumato_symbolic.synthesis.synthesize import PolicyFormat, synthesize

__all__ = [
    "Context",
    "Failure",
    "Limits",
    "Outcome",
    "PolicyFormat",
    "Realizable",
    "Statistics",
    "Undecided",
    "Unrealizable",
    "synthesize",
]
