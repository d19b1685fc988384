"""A policy executed step by step: the prompt, and the commands from the standard input."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Mapping
from itertools import islice

from tumato_symbolic.diagnostics import Code, Diagnostic, UserError
from tumato_symbolic.explain.decision import why
from tumato_symbolic.policy import Vocabulary, parse_assignments
from tumato_symbolic.report import decided
from tumato_symbolic.report.objections import Place, broken_here
from tumato_symbolic.report.traces import event_text, move_text
from tumato_symbolic.semantics import (
    ActionSet,
    Disturbance,
    Event,
    Move,
    State,
    Trace,
    first_broken,
    moves_from,
    nominal_agrees,
    reached,
    residual_goal,
)
from tumato_symbolic.spec import Ordering
from tumato_symbolic.syntax.reading import standard_input

_LISTED = 20
"""So many outcomes are shown and can be chosen."""

_LONGEST_LINE = 100_000
"""Characters of one command on the standard input."""

_HELP = """\
  Enter            all effects are nominal
  a number         this outcome
  s VAR=VALUE …    disturb the state
  b                back, to before the last event
  w                why the policy decides so
  q                quit"""


class Session:
    """One execution, with what the user may do in it. `say` puts a text where the user reads."""

    def __init__(
        self,
        place: Place,
        name: str,
        policy: Mapping[State, ActionSet],
        ordering: Ordering,
        say: Callable[[str], None],
    ) -> None:
        self._place, self._spec, self._name, self._policy = place, place.spec, name, policy
        self._ordering: Ordering = ordering
        self._say = say
        self._trace = Trace(())

    def run(self, start: State) -> Trace:
        """What has happened when the user quits, or the input ends."""
        self._trace = Trace(start)
        self._show()
        for line in _lines():
            if line in ("q", "quit"):
                break
            self._obey(line)
        return self._trace

    def _obey(self, line: str) -> None:
        word, *rest = line.split() or [""]
        match word:
            case "b" if not rest:
                self._back()
            case "w" if not rest:
                self._why()
            case "s" if rest:
                self._disturb(rest)
            case "?" | "h" | "help":
                self._say(_HELP)
            case _ if not rest and (not word or (word.isascii() and word.isdigit())):
                self._step(int(word[:_LISTED] or "0"))
            case _:
                self._say(f"There is no command {line[:40]!r}. These are:\n{_HELP}")

    def _decision(self) -> ActionSet | None:
        """What is executed now, if anything can be."""
        chosen = self._policy.get(self._trace.last)
        return None if chosen is None or not nominal_agrees(self._spec, chosen) else chosen

    def _moves(self) -> list[Move]:
        """The outcomes that can be chosen now; one more where there are too many."""
        chosen = self._decision()
        if chosen is None:
            return []
        return list(islice(moves_from(self._spec, self._trace.last, chosen, self._ordering), _LISTED + 2))

    def _show(self) -> None:
        self._say("\n".join(self._lines_of_state()))

    def _lines_of_state(self) -> Iterator[str]:
        place, here, chosen = self._place, self._trace.last, self._decision()
        broken = broken_here(place, here)
        yield f"{place.state(here)}{broken and f' ({broken})'}"
        yield f"  goal: {place.goals(here)}"
        if chosen is None:
            yield "  The policy does not decide what can be executed here: s, b or q?"
            return
        yield f"  decides: {place.actions(chosen)}"
        nominal, *others = self._moves()
        yield f"    Enter: {move_text(place, here, nominal)}"
        for number, move in enumerate(others[:_LISTED], 1):
            yield f"    {number}: {move_text(place, here, move)}"
        if len(others) > _LISTED:
            yield "    … and more, which are not listed"

    def _step(self, number: int) -> None:
        moves = self._moves()[: _LISTED + 1]
        if number < len(moves):
            self._add(moves[number])
        elif moves:
            self._say(f"There is no outcome {number}.")
        else:
            self._say("Nothing can be executed here: s, b or q?")

    def _disturb(self, words: list[str]) -> None:
        try:
            asked = parse_assignments(Vocabulary.of(self._spec), words, whole=False)
        except UserError as error:
            self._say("; ".join(each.message for each in error.diagnostics))
            return
        variables, here = self._spec.variables, self._trace.last
        after = tuple(
            variable.values.index(asked[variable.name]) if variable.name in asked else here[number]
            for number, variable in enumerate(variables)
        )
        broken = first_broken(self._spec.assumptions, after)
        if broken is not None:
            self._say(f"That cannot be: the assumption {self._place.rule(broken)} excludes it.")
        elif after == here:
            self._say("That is the state already.")
        else:
            self._add(Disturbance(after))

    def _add(self, event: Event) -> None:
        here, self._trace = self._trace.last, self._trace.then(event)
        self._say(f"{len(self._trace.events)}. {event_text(self._place, here, event)}")
        if self._meets_the_goal():
            self._say("The goal is met.")
        self._show()

    def _meets_the_goal(self) -> bool:
        """Whether the last event met the goals that were active at the start, or after the last that were met."""
        spec, goal, met = self._spec, None, False
        for before, event in zip(self._trace.states, self._trace.events, strict=False):
            met = False
            if isinstance(event, Disturbance):
                goal = None
                continue
            goal = goal or residual_goal(spec, before, event.decision)
            met = reached(spec, goal, event.after)
            goal = None if met else goal
        return met

    def _back(self) -> None:
        if self._trace.events:
            self._trace = Trace(self._trace.start, self._trace.events[:-1])
        self._show()

    def _why(self) -> None:
        try:
            decision = why(self._spec, self._policy, self._trace.last, self._ordering)
        except KeyError:
            self._say("The policy does not decide this state.")
            return
        self._say(decided.as_text(decided.Decided(self._place, self._name, decision, None)))


def _lines() -> Iterator[str]:
    """The lines of the standard input, after a prompt on a terminal. Raises `UserError` where it cannot be read."""
    try:
        stream = standard_input()
        asks = sys.stdin.isatty()
        while True:
            if asks:
                sys.stderr.write("> ")
                sys.stderr.flush()
            line = stream.readline(_LONGEST_LINE)
            if not line:
                return
            yield line.decode(errors="replace").strip()
    except OSError as error:
        message = f"the standard input cannot be read: {error.strerror or error}"
        raise UserError((Diagnostic(Code.TUM101, message),)) from error
