"""Limits, how they are worded, progress, what is known so far: the context that stages of long work are handed."""

from __future__ import annotations

import math
import time
from collections.abc import Callable

from msgspec import Struct


class LimitReachedError(Exception):
    """A limit was met before there was an answer; the message says which, and during what."""


class Limits(Struct, frozen=True):
    """How much an answer may cost: seconds, and megabytes. None: no limit.

    Megabytes bound the diagrams of CUDD; the command line bounds the memory of its processes as well.
    """

    seconds: float | None = None
    megabytes: int | None = None


NO_LIMITS = Limits()


class Context:
    """What every stage of a long piece of work is handed: one deadline, one progress line, one record of what is known.

    The clock started `spent` seconds before the context is made. `progress` is told every stage, `learned` every
    finding.
    """

    def __init__(
        self,
        limits: Limits = NO_LIMITS,
        progress: Callable[[str], None] | None = None,
        learned: Callable[[object], None] | None = None,
        spent: float = 0.0,
    ) -> None:
        self.limits = limits
        self.started = time.monotonic() - spent
        self.deadline = None if limits.seconds is None else self.started + limits.seconds
        self.stage = "starting"
        self.known: object = None
        self.progress, self.learned = progress, learned
        self._since = self.started
        self._stages: dict[str, float] = {}

    @property
    def is_over(self) -> bool:
        """Whether time is up."""
        return self.deadline is not None and time.monotonic() >= self.deadline

    def check(self) -> None:
        """Raise `LimitReachedError` when time is up. Cheap enough for every turn of a loop."""
        if self.deadline is not None and time.monotonic() >= self.deadline:
            raise LimitReachedError(self.described())

    def seconds_left(self) -> float | None:
        """How much time is left; None without a limit. Raises `LimitReachedError` when there is none."""
        if self.deadline is None:
            return None
        self.check()
        return max(0.0, self.deadline - time.monotonic())

    def described(self, which: str = "time") -> str:
        """That a limit was met, and during what, as reports say it."""
        amount = f"{self.limits.seconds:g} s" if which == "time" else f"{self.limits.megabytes} MB"
        return f"the {which} limit of {amount} was met while {self.stage}"

    def tell(self, stage: str) -> None:
        """Say what is being done from now on, as in "proving goals". Raises `LimitReachedError` when time is up."""
        self.check()
        self.enter(stage)

    def enter(self, stage: str) -> None:
        """Count the time from now on for a stage, and tell it."""
        self._clock()
        self.stage = stage
        if self.progress is not None:
            self.progress(stage)

    def stages(self) -> dict[str, float]:
        """How many seconds each stage took by now, in the order in which they came first."""
        self._clock()
        return dict(self._stages)

    def _clock(self) -> None:
        now = time.monotonic()
        self._stages[self.stage] = self._stages.get(self.stage, 0.0) + now - self._since
        self._since = now

    def learn(self, known: object) -> None:
        """Record all that is known by now, in place of what was recorded before: it is reported when a limit is met."""
        self.known = known
        if self.learned is not None:
            self.learned(known)

    def within(self, seconds: float | None = None, learned: Callable[[object], None] | None = None) -> Context:
        """A context for a part of the work, which may take so many seconds and no longer than the whole.

        It tells what this one tells, and what it learns goes to `learned` instead of here. Where its
        `LimitReachedError` is caught, `check()` here says whether the whole is over as well.
        """
        part = Context(Limits(seconds, self.limits.megabytes), self.enter, learned)
        if part.deadline is None or (self.deadline is not None and self.deadline < part.deadline):
            part.deadline, part.limits = self.deadline, self.limits
        part.stage = self.stage
        return part


class Budget:
    """How long each part of a piece of work may take: `seconds` (None: no limit), and no longer than the whole."""

    def __init__(self, seconds: float | None = None, context: Context | None = None) -> None:
        self.seconds = seconds
        self.context = context or Context()

    def until(self, spent: float = 0.0) -> float:
        """When a part has to end that took `spent` seconds already, on the monotonic clock; infinite where never."""
        latest = math.inf if self.context.deadline is None else self.context.deadline
        return latest if self.seconds is None else min(latest, time.monotonic() + self.seconds - spent)
