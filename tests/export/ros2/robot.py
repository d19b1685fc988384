"""A simulated robot around the loop: effects, failures and disturbances by chance, answers late and out of order."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from random import Random

from msgspec import Struct

from tests.export.ros2.loop import Loop, Said
from tumato_symbolic.export.request import Request
from tumato_symbolic.policy import Table
from tumato_symbolic.semantics import ActionSet, State, allowed, apply, is_safe


def rows_of(made: Request) -> Mapping[State, ActionSet]:
    """The decisions of a policy that is a table."""
    assert isinstance(made.policy.decisions, Table)
    return made.policy.decisions.rows


class Question(Struct):
    """A question for the state: what the robot saw when it looked, and how much had happened until then."""

    number: int
    saw: State | None = None
    effects: int = 0
    disturbances: int = 0


class SimulatedRobot:
    """What the world does to the loop, and complaints about what the loop does."""

    def __init__(self, made: Request, loop: Loop, seed: int) -> None:
        self._spec, self._ordering, self._loop, self._random = made.spec, made.ordering, loop, Random(seed)
        self._decided = rows_of(made)
        self._state = self._random.choice(list(self._decided))
        self._running: dict[int, bool] = {}
        self._halted: set[int] = set()
        self._questions: list[Question] = []
        self._effects = self._disturbances = 0
        self._judged = False
        self.counts: Counter[str] = Counter()
        self.complaints: list[str] = []

    def live(self, ticks: int) -> None:
        """So many things happen."""
        happenings = [self._effect] * 4 + [self._end] * 3 + [self._look] * 5 + [self._answer] * 5 + [self._ask] * 4
        for _ in range(ticks):
            self._loop.now += self._random.randrange(20)
            if self._random.random() < 0.06:
                self._disturb()
            else:
                self._random.choice(happenings)()
            if self._random.random() < 0.1:
                self._idle(self._loop.check())

    def _ask(self) -> None:
        if len(self._questions) < 3:
            self._questions.append(Question(self._loop.ask()))

    def _look(self) -> None:
        waiting = [each for each in self._questions if each.saw is None]
        if waiting:
            each = self._random.choice(waiting)
            each.saw, each.effects, each.disturbances = self._state, self._effects, self._disturbances

    def _answer(self) -> None:
        ready = [each for each in self._questions if each.saw is not None]
        if ready:
            question = self._random.choice(ready)
            self._questions.remove(question)
            assert question.saw is not None
            self._judge(question, question.saw, self._loop.seen(question.saw, question.number))

    def _effect(self) -> None:
        """An action takes effect, one that was halted as well: until its result, that is its right."""
        able = [action for action, has_had_one in self._running.items() if not has_had_one]
        if able:
            action = self._random.choice(able)
            effects = self._spec.actions[action].effects
            if effects:
                self._state = apply(self._random.choice(effects), self._state)
                self._effects += 1
                self.counts["effects"] += 1
                if self._judged and not is_safe(self._spec, self._state):
                    self.complaints.append(f"{self._state} is not safe after {action}")
                if self._state not in self._decided:  # it was disturbed while it acted
                    self._disturb()
            self._running[action] = True

    def _end(self) -> None:
        """An action ends; if it has taken no effect yet, it has failed."""
        if self._running:
            action = self._random.choice(list(self._running))
            self.counts["ends" if self._running.pop(action) else "failures"] += 1
            self._halted.discard(action)
            self._idle(self._loop.ended(action))

    def _disturb(self) -> None:
        self._state = self._random.choice(list(self._decided))
        self._disturbances += 1
        self._judged = False

    def _idle(self, said: Said) -> None:
        """Nothing is started or halted but in a state that was seen."""
        if said.started or said.halted or said.stop != "no":
            self.complaints.append(f"{said} without a state")

    def _judge(self, question: Question, saw: State, said: Said) -> None:
        wanted = self._decided[saw]
        if said.started:
            self.counts["decisions"] += 1
            if frozenset(said.started) != wanted:
                self.complaints.append(f"{said.started} in {saw}, where the policy says {set(wanted)}")
            if not allowed(self._spec, saw, frozenset(said.started), self._ordering):
                self.complaints.append(f"{said.started} is not allowed in {saw}")
            if self._running:
                self.complaints.append(f"{said.started} start while {set(self._running)} still run")
            if question.effects != self._effects:
                self.complaints.append(f"{said.started} start in {saw}, before all effects were seen")
            self._running.update(dict.fromkeys(said.started, False))
            self._judged = question.disturbances == self._disturbances
        if said.halted:
            self.counts["halts"] += 1
            if set(said.halted) != self._running.keys() or self._halted:
                self.complaints.append(f"{said.halted} are halted, where {set(self._running)} run")
            if self._running.keys() == wanted:
                self.complaints.append(f"{said.halted} are halted in {saw}, where the policy wants them")
            self._halted = set(said.halted)
        if said.stop != "no":
            self.complaints.append(f"stopped ({said.stop}) in {saw}")
