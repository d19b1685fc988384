"""Theorems about policies that restore safety in several steps, or by severity; see `test_coq.py`."""

from __future__ import annotations

from collections.abc import Mapping

import pytest
from msgspec.structs import replace

from tests.checker.stepwise import MODES
from tests.export.cases import agrees, is_right, stepwise
from tests.export.compiler import Case, Library, needs_coq
from tests.semantics.test_restoration import OVERRIDE
from tumato_symbolic import parse
from tumato_symbolic.export.efforts import nominal_sums
from tumato_symbolic.semantics import NOTHING, ActionSet, Restorations, State, is_safe, is_valid, judge
from tumato_symbolic.spec import Restoration, Spec

BRAKE = """
BEGIN STATE VECTOR state Speed can be fast, slow, stopped END STATE VECTOR
BEGIN ACTIONS
action brake duration: 2 preconditions: Speed is fast nominal effects: Speed is slow {alternative}
action stop duration: 1 preconditions: Speed is slow nominal effects: Speed is stopped
action crash duration: 9 preconditions: Speed is fast nominal effects: Speed is stopped
action coast duration: 3 preconditions: Speed is fast nominal effects: Speed is slow
END ACTIONS
BEGIN STATE RULES rule: Speed is stopped END STATE RULES
BEGIN CONFIG restoration: {restoration} END CONFIG
"""

BOTH = [(a, b) for a in (0, 1) for b in (0, 1)]

VALVES = """
BEGIN STATE VECTOR state A can be open, closed state B can be open, closed END STATE VECTOR
BEGIN ACTIONS
action close_a duration: 1 nominal effects: A is closed
action close_b duration: 1 nominal effects: B is closed
END ACTIONS
BEGIN STATE RULES rule: A is closed rule: B is closed END STATE RULES
"""


BRAKING: dict[State, ActionSet] = {(0,): frozenset((0,)), (1,): frozenset((1,)), (2,): frozenset()}


def brake(restoration: Restoration, *, jams: bool = False, crash: bool = False) -> Spec:
    """The brakes may jam, and then nothing happens; without `crash`, nothing stops a fast car in one step."""
    text = BRAKE.format(restoration=restoration, alternative="alternative effects: none" if jams else "")
    spec = parse(text)
    return spec if crash else replace(spec, actions=tuple(a for a in spec.actions if a.name != "crash"))


def test_the_file_tells_tiers_restoration_and_efforts() -> None:
    """A reader finds the severities, the mode, and what each decision takes."""
    text = Case(brake("fair"), BRAKING, "any").text
    assert "    (* severity 1 *) [\n    (* Speed is stopped *)\n    Is 0 2\n    ]\n" in text
    assert "restored_in := Fair" in text
    assert "Definition e0 : option effort := Some (1, 1)%N." in text
    assert "Definition e1 : option effort := Some (3, 2)%N." in text
    assert text.count("Node [Leaf e1; Leaf e0; Leaf no]") == 2
    assert "check spec Any decisions known = true" in text
    assert Case(brake("bounded"), BRAKING, "any").text.count("Node [Leaf e1; Leaf e0; Leaf no]") == 1
    assert "Leaf e" not in Case(brake("one_step"), BRAKING, "any").text


@pytest.mark.parametrize("seed", range(12))
def test_nominal_sums_are_those_of_the_explicit_meaning(seed: int) -> None:
    """Where all decisions are allowed; elsewhere levels may fall, and the sums say nothing."""
    for case in stepwise(seed, "fair", 3):
        valid = {state: chosen for state, chosen in case.rows.items() if is_valid(case.spec, state)}
        if judge(case.spec, valid, case.ordering).not_allowed:
            continue
        restorations, sums = Restorations(case.spec, valid, case.ordering), nominal_sums(case.spec, valid)
        for state, chosen in valid.items():
            if not is_safe(case.spec, state):
                assert sums.get(state) == restorations.nominal(state, chosen)


@needs_coq
@pytest.mark.parametrize("restoration", ["bounded", "fair"])
def test_a_brake_in_two_steps(restoration: Restoration, library: Library) -> None:
    """The theorem compiles, on nothing but the logic; a detour and an idle car are refused."""
    spec = brake(restoration)
    answer = library.compile(Case(spec, BRAKING, "any").text)
    assert (answer.returncode, answer.stdout.strip()) == (0, "Closed under the global context"), answer.stderr
    wrong: list[Mapping[State, ActionSet]] = [
        {**BRAKING, (0,): frozenset((2,))},
        {**BRAKING, (0,): frozenset()},
        {**BRAKING, (1,): frozenset()},
    ]
    assert not any(library.checks([Case(spec, rows, "any") for rows in wrong]))


@needs_coq
def test_modes_differ(library: Library) -> None:
    """One step is better than two, whatever it takes; brakes that may jam restore nothing within a bound."""
    crashing = {**BRAKING, (0,): frozenset((2,))}
    cases = [
        Case(brake("one_step", crash=True), crashing, "any"),
        Case(brake("bounded", crash=True), crashing, "any"),
        Case(brake("bounded", crash=True), BRAKING, "any"),
        Case(brake("one_step"), BRAKING, "any"),
        Case(brake("bounded", jams=True), BRAKING, "any"),
        Case(brake("fair", jams=True), BRAKING, "any"),  # coasting never jams
        Case(brake("fair", jams=True), {**BRAKING, (0,): frozenset((2,))}, "any"),
    ]
    assert library.checks(cases) == [True, True, False, False, False, False, True]


@needs_coq
@pytest.mark.parametrize("planted", ["(3, 2)", "(1, 1)"])
def test_efforts_are_not_believed(planted: str, library: Library) -> None:
    """A wrong effort is refused, be it too large or too small, in the worst case or as planned."""
    bounded, fair = (Case(brake(restoration), BRAKING, "any").text for restoration in ("bounded", "fair"))
    duration, steps = int(planted[1]), int(planted[4])
    others = (f"({duration + 1}, {steps})", f"({duration - 1}, {steps})", f"({duration}, {steps + 1})")
    wrong = [text.replace(f"Some {planted}", f"Some {other}") for text in (bounded, fair) for other in others]
    head, between, tail = fair.partition("(* If only nominal effects occur. *)")
    right, lost = "Node [Leaf e1; Leaf e0; Leaf no]", "Node [Leaf no; Leaf e0; Leaf no]"
    wrong += [head.replace(right, lost) + between + tail, head + between + tail.replace(right, lost)]
    assert library.answers([bounded, fair, *wrong]) == [True, True, *(False for _ in wrong)]
    assert library.compile(wrong[0]).returncode != 0


@needs_coq
def test_the_checker_agrees_with_the_explicit_meaning(library: Library) -> None:
    """`check` answers `true` for right policies of every mode, with one to three severities, and for no others.

    Of more specifications: `python -m tests.export.trial coq`.
    """
    agrees({mode: [each for seed in (1, 4) for each in stepwise(seed, *mode)] for mode in MODES}, library)


@needs_coq
def test_known_policies(library: Library) -> None:
    """One valve after the other, not both at once; and a decision that another state needs, the one deviation."""
    valves, override = (replace(parse(text), restoration="bounded") for text in (VALVES, OVERRIDE))
    closing: dict[State, ActionSet] = {state: frozenset(n for n in (0, 1) if not state[n]) for state in BOTH}
    walking: dict[State, ActionSet] = {(0,): frozenset((0,)), (1,): frozenset((2,)), (2,): NOTHING, (3,): NOTHING}
    cases = [
        Case(valves, {**closing, (0, 0): frozenset((0,))}, "any"),
        Case(valves, closing, "any"),
        Case(override, walking, "any"),
        Case(override, {**walking, (1,): frozenset((1,))}, "any"),
    ]
    assert [is_right(case) for case in cases] == [True, False, True, False]
    assert library.checks(cases) == [True, False, True, False]
