"""From a specification to a policy, or to the reason why there is none."""

from tumato_symbolic.limits import Context, Limits
from tumato_symbolic.synthesis.diagnosis import Cured, JointAction, Restorability, restorability
from tumato_symbolic.synthesis.outcome import Failure, Outcome, Realizable, Statistics, Undecided, Unrealizable
from tumato_symbolic.synthesis.synthesize import PolicyFormat, synthesize

__all__ = [
    "Context",
    "Cured",
    "Failure",
    "JointAction",
    "Limits",
    "Outcome",
    "PolicyFormat",
    "Realizable",
    "Restorability",
    "Statistics",
    "Undecided",
    "Unrealizable",
    "restorability",
    "synthesize",
]
