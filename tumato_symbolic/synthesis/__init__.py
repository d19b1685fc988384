"""From a specification to a policy, or to the reason why there is none."""

from tumato_symbolic.limits import Context, Limits
from tumato_symbolic.synthesis.diagnosis import Cured, JointAction, Restorability, restorability
from tumato_symbolic.synthesis.result import Failure, Realizable, Statistics, SynthesisResult, Undecided, Unrealizable
from tumato_symbolic.synthesis.synthesize import PolicyFormat, synthesize

__all__ = [
    "Context",
    "Cured",
    "Failure",
    "JointAction",
    "Limits",
    "PolicyFormat",
    "Realizable",
    "Restorability",
    "Statistics",
    "SynthesisResult",
    "Undecided",
    "Unrealizable",
    "restorability",
    "synthesize",
]
