"""*Conflict*: the stand-alone checker accepts cuts that are a proof, and nothing that is one off."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product
from pathlib import Path
from random import Random
from typing import Any

import pytest

from tests.checker.standalone import checker
from tests.checker.unrealizable import Document, assert_proved, assert_refuted, judged, spec_text

PLACES = "lmrLR"
STEPS = {"l": "lm", "m": "mLR", "r": "rm", "L": "L", "R": "R"}
GOALS = {"l": 0, "r": 1}
LEAVES = [0, 1, 2, None, 3]
NEVER = 3
"""The reference to the leaf null; those to the numbers 0, 1, 2 are 0, 1, 2."""

TO_R, TO_L, TO_EITHER = [2, 1, 2, NEVER, 0], [2, 1, 2, 0, NEVER], [2, 1, 2, 0, 0]
"""Distances of the places."""


def crossing(bound: int | None) -> str:
    """The goal of `l` is R, that of `r` is L, and both have to pass `m`, which leads to one of the two."""
    goals = "BEGIN GOALS goal type: priority when P is l then goal: P is R when P is r then goal: P is L END GOALS"
    return spec_text(PLACES, "lm rm mL mR", goals, bound)


def choice(state: str, after: str = "", goal: int | None = None) -> Document:
    """A state with all its options, or some of them, or a goal that is not its own."""
    goal = GOALS.get(state, 2) if goal is None else goal
    options = [{"Successor": {"P": place}, "Goal": goal} for place in after or STEPS[state]]
    return {"State": {"P": state}, "Options": options}


def cut(goal: int, run: str, end: str = "") -> Document:
    """A loop, or a path to an end."""
    found = {"Kind": "path" if end else "loop", "Goal": goal, "States": [PLACES.index(place) for place in run]}
    return {**found, "End": {"P": end}} if end else found


def named(*roots: int, bodies: Sequence[str] = ("P is R", "P is L", "")) -> list[Document]:
    """The goals R, L and none, with their roots."""
    return [
        {"Bodies": [body] if body else [], "Executed": [], "Root": root}
        for body, root in zip(bodies, roots, strict=True)
    ]


def conflict(cuts: Sequence[Document], distances: Sequence[list[int]] = (TO_R, TO_L), **parts: Any) -> Document:
    """A conflict between `l` and `r`."""
    return {
        "Kind": "conflict",
        "Starts": [0, 2],
        "Choices": [choice(place) for place in PLACES],
        "Cuts": list(cuts),
        "Order": ["P"],
        "Leaves": LEAVES,
        "Nodes": [[0, each] for each in distances],
        "Goals": named(len(LEAVES), len(LEAVES) + 1, 0),
        **parts,
    }


LOOPS = [cut(0, "lm"), cut(1, "rm")]
PATHS = [cut(0, "lm", "L"), cut(1, "rm", "R")]
RESPECTED = "there is a choice of options that respects all cuts"
NEARER = "is nearer by more than one step"

RIGHT: list[tuple[int | None, list[Document]]] = [
    (None, LOOPS),
    (2, LOOPS),
    (9, LOOPS),
    (2, PATHS),
    (None, LOOPS + PATHS),
    (None, LOOPS * 2),
    (None, [cut(0, "lml"), cut(1, "rmmm")]),
    (1, [cut(0, "l", "m")]),
]
WRONG: list[tuple[int | None, list[Document], str]] = [
    (None, [], RESPECTED),
    (None, LOOPS[:1], RESPECTED),
    (None, [LOOPS[0]] * 2, RESPECTED),
    (None, PATHS, RESPECTED),
    (3, PATHS, RESPECTED),
    (2, [PATHS[0]] * 2, RESPECTED),
    (None, [cut(1, "lm"), LOOPS[1]], RESPECTED),
    (None, [cut(0, "lR"), LOOPS[1]], RESPECTED),
    (None, [cut(0, "lmR"), LOOPS[1]], RESPECTED),
    (None, [cut(0, "l"), cut(1, "r")], RESPECTED),
    (2, [cut(0, "l", "m"), *PATHS], "cut 0 ends in (P m), from where its goal may be reached"),
    (2, [cut(0, "lm", "R"), *PATHS], "cut 0 ends in (P R), from where its goal may be reached"),
    (3, [cut(0, "ll", "m"), *LOOPS], "cut 0 ends in (P m), from where its goal may be reached"),
    (2, [cut(0, "lRm", "L"), *PATHS], "cut 0 passes (P R), where its goal may be met"),
    (None, [cut(0, "ml"), *LOOPS], "cut 0 begins in a state that is not among the starts"),
]


@pytest.mark.parametrize(("bound", "cuts"), RIGHT)
def test_conflicts_that_are_a_proof(bound: int | None, cuts: list[Document], tmp_path: Path) -> None:
    """Loops whatever the bound; paths where there is no time for a detour; more cuts than are needed."""
    assert_proved(judged(tmp_path, crossing(bound), conflict(cuts)))


@pytest.mark.parametrize(("bound", "cuts", "why"), WRONG)
def test_conflicts_that_are_no_proof(bound: int | None, cuts: list[Document], why: str, tmp_path: Path) -> None:
    """A cut too few, one step more, a cut of another goal, one that may meet its goal, one that begins elsewhere."""
    assert_refuted(judged(tmp_path, crossing(bound), conflict(cuts)), why)


WRONG_PARTS: dict[str, tuple[int | None, Document, str]] = {
    "no starts": (None, conflict(LOOPS, Starts=[]), "cut 0 begins in a state that is not among the starts"),
    "one start": (None, conflict(LOOPS, Starts=[0]), "cut 1 begins in a state that is not among the starts"),
    "an option too few": (
        None,
        conflict(LOOPS[:1], Choices=[choice("l"), choice("m", "mL"), *map(choice, "rLR")]),
        "leads to (P R) and leaves no goal pending, which is no option there",
    ),
    "an option twice": (
        None,
        conflict([cut(0, "l")], Choices=[choice("l", "ll"), *map(choice, "mrLR")]),
        "leads to (P m) and leaves (P is R) pending, which is no option there",
    ),
    "an option with another goal": (
        None,
        conflict([cut(2, "l")], Choices=[choice("l", goal=2), *map(choice, "mrLR")]),
        "leaves (P is R) pending, which is no option there",
    ),
    "a distance at the goal": (
        None,
        conflict([cut(0, "l", "l")], [[NEVER] * 5, TO_L]),
        "(P R) meets (P is R), and its distance is not 0",
    ),
    "infinite next to finite": (None, conflict([cut(0, "l", "l")], [[NEVER, NEVER, NEVER, NEVER, 0], TO_L]), NEARER),
    "nearer by two": (2, conflict([cut(0, "l", "m")], [[4, 2, 2, NEVER, 0], TO_L]), NEARER),
    "nearer by two, from the bound": (2, conflict([cut(0, "l", "m")], [[4, 4, 2, NEVER, 0], TO_L]), NEARER),
    "one root for two goals": (
        1,
        conflict([cut(1, "r", "m")], Goals=named(5, 5, 0)),
        "(P L) meets (P is L), and its distance is not 0",
    ),
    "one right root for two goals": (None, conflict(LOOPS, [TO_EITHER], Goals=named(5, 5, 0)), RESPECTED),
    "two roots that say the same": (None, conflict(LOOPS, [TO_EITHER] * 2), RESPECTED),
    "a goal that there is not": (
        None,
        conflict(LOOPS, Goals=named(5, 6, 0, 5, bodies=["P is R", "P is L", "", "P is m"])),
        "there is no such goal",
    ),
}


@pytest.mark.parametrize("name", WRONG_PARTS)
def test_every_part_of_a_conflict_is_needed(name: str, tmp_path: Path) -> None:
    """Starts, options, distances, and goals that share a root: each is refuted by its own claim."""
    bound, reason, why = WRONG_PARTS[name]
    assert_refuted(judged(tmp_path, crossing(bound), reason), why)


def test_from_the_bound_on_all_is_too_far(tmp_path: Path) -> None:
    """With a bound, null and larger numbers are the bound, so they may stand beside each other."""
    far = conflict(PATHS, [[NEVER, 1, 4, NEVER, 0], TO_L])
    assert_proved(judged(tmp_path, crossing(2), far))
    assert_refuted(judged(tmp_path, crossing(3), {**far, "Cuts": LOOPS}), NEARER)


@pytest.mark.parametrize("root", [5, 7])
def test_goals_with_one_root_are_one(root: int, tmp_path: Path) -> None:
    """It does not matter by which of its names a goal is listed, nor whether the root is written down twice."""
    choices = [choice("l", goal=3), *map(choice, "mrLR")]
    goals = named(5, 6, 0, root, bodies=["P is R", "P is L", "", "P is R"])
    again = conflict(LOOPS, [TO_R, TO_L, TO_R], Choices=choices, Goals=goals)
    assert_proved(judged(tmp_path, crossing(None), again))


def alone(goal: str, options: dict[str, str], distances: list[int], each: Document) -> Document:
    """A conflict of the first place with itself: its goal, the options of some places, and one cut."""
    choices = [choice(place, after, 0) for place, after in options.items()]
    goals = named(len(LEAVES), bodies=[f"P is {goal}"])
    return conflict([each], [distances], Starts=[0], Choices=choices, Goals=goals)


@pytest.mark.parametrize(("bound", "is_proof"), [(None, False), (4, False), (3, False), (2, True), (1, True)])
def test_a_loop_is_left_for_where_the_goal_is_near_enough(bound: int | None, is_proof: bool, tmp_path: Path) -> None:
    """From `x`, which one step leads to, it takes two more."""
    text = spec_text("stxyG", "st ts sx xy yG", "BEGIN GOALS goal type: priority goal: P is G END GOALS", bound)
    loop = alone("G", {"s": "stx", "t": "ts"}, [4, 4, 2, 1, 0], {"Kind": "loop", "Goal": 0, "States": [0, 1]})
    answer = judged(tmp_path, text, loop)
    assert_proved(answer) if is_proof else assert_refuted(answer, RESPECTED)


@pytest.mark.parametrize(("bound", "is_proof"), [(2, True), (3, False)])
def test_a_path_may_begin_where_its_goal_holds(bound: int, is_proof: bool, tmp_path: Path) -> None:
    """A run serves a goal that it reaches after a step or more; where it starts does not count."""
    goals = "BEGIN GOALS goal type: priority goal: P is a END GOALS "
    moving = "BEGIN REACTION RULES rule: executing ab OR executing bc OR executing ca END REACTION RULES"
    text = spec_text("abc", "ab bc ca", goals + moving, bound)
    path = {"Kind": "path", "Goal": 0, "States": [0, 1], "End": {"P": "c"}}
    answer = judged(tmp_path, text, alone("a", {"a": "b", "b": "c"}, [0, 2, 1], path))
    assert_proved(answer) if is_proof else assert_refuted(answer, "from where its goal may be reached")


def test_the_search_for_a_choice_is_right() -> None:
    """It finds a choice where there is one, by trying all, and none elsewhere."""
    found = set()
    for seed in range(400):
        dice = Random(seed)
        counts = [dice.randint(1, 3) for _ in range(dice.randint(1, 6))]
        picks = [(state, place) for state, count in enumerate(counts) for place in range(count)]
        clauses = [[dice.choice(picks) for _ in range(dice.randint(1, 3))] for _ in range(dice.randint(1, 14))]
        wanted = any(
            all(any(chosen[state] == place for state, place in clause) for clause in clauses)
            for chosen in product(*map(range, counts))
        )
        assert checker.Choosing(counts, clauses).succeeds() == wanted, seed
        found.add(wanted)
    assert found == {True, False}
    assert not checker.Choosing([2, 0], []).succeeds()
    assert not checker.Choosing([1], [[]]).succeeds()


@pytest.mark.parametrize("starts", [[0, 5], [-1], [True], ["0"], [0.0]])
def test_starts_are_numbers_of_choices(starts: list[Any], tmp_path: Path) -> None:
    """Anything else is unreadable, not refuted."""
    answer = judged(tmp_path, crossing(None), conflict([cut(0, "l")], Starts=starts))
    assert (answer.code, "`Starts` is a list of numbers below 5" in answer.err) == (2, True)
