"""What those who solve are asked, and what they answer: records that go over a wire as lines of JSON.

Who asks needs no solver, and so nothing here imports one.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Self

from msgspec import Struct, to_builtins
from msgspec.json import decode
from msgspec.structs import replace

from tumato_symbolic.limits import Limits
from tumato_symbolic.spec import Ordering, Restoration
from tumato_symbolic.verify import ProverName


class Task(Struct, frozen=True):
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


class Answer(Struct, frozen=True):
    """What is found: `result` goes into a line of results; `policy` is the file of the policy, where it is wanted."""

    result: dict[str, object]
    policy: str | None = None


class _Line(Struct, frozen=True):
    """What is a line of JSON on the wire, in ASCII, whatever the encoding there."""

    def written(self) -> str:
        """As a line of JSON."""
        return json.dumps(to_builtins(self))

    @classmethod
    def read(cls, line: str) -> Self:
        """From a line of JSON."""
        return decode(line, type=cls)


class Batch(_Line, frozen=True):
    """Texts that one process solves one after the other; `common` is what all their tasks share.

    Once it is at work for `enough` seconds, no other text is begun.
    """

    common: Task
    texts: tuple[str, ...]
    enough: float

    @property
    def tasks(self) -> Iterator[Task]:
        """Each text as a task of its own."""
        return (replace(self.common, text=each) for each in self.texts)


class Reply(_Line, frozen=True):
    """The answers to the first texts of a batch, and how many seconds they took together.

    `bug` is the traceback of an exception that came instead of the next answer.
    """

    answers: tuple[Answer, ...]
    seconds: float
    bug: str | None = None


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
