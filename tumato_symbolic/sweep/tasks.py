"""What those who solve are asked, and what they answer: records that go over a wire as JSON.

Who asks needs no solver, and so nothing here imports one.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from tumato_symbolic.limits import Limits

if TYPE_CHECKING:
    from tumato_symbolic.spec import Ordering, Restoration
    from tumato_symbolic.verify import ProverName


@dataclass(frozen=True, slots=True)
class Task:
    """A text to solve, with everything on which the answer depends.

    `against` is the policy file that its policy is compared with; `policy`: its own file is wanted as well. `seconds`
    and `megabytes` are how much the answer may cost.
    """

    name: str
    text: str
    ordering: Ordering | None = None
    restoration: Restoration | None = None
    prover: ProverName = "auto"
    prove: bool = True
    seconds: float | None = None
    megabytes: int | None = None
    against: str | None = None
    policy: bool = False

    @property
    def limits(self) -> Limits:
        """How much the answer may cost."""
        return Limits(self.seconds, self.megabytes)


@dataclass(frozen=True, slots=True)
class Answer:
    """What is found: `result` goes into a line of results; `policy` is the file of the policy, where it is wanted."""

    result: dict[str, object]
    policy: str | None = None


NOTHING: dict[str, object] = {
    "verdict": "undecided",
    "proof": None,
    "digest": None,
    "states": None,
    "longest_run": None,
    "failures": [],
    "compared": None,
    "limit": None,
    "diagnostics": [],
}
"""A result of which nothing is known."""
