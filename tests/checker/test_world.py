"""The stand-alone checker's own meaning, function by function, against the text of docs/semantics.md."""

from __future__ import annotations

import math
from itertools import product
from random import Random
from typing import Any

import pytest

from tests.checker.standalone import checker
from tests.checker.test_forged import text_of
from tests.checker.test_witnesses import TWO
from tests.checker.unrealizable import spec_text
from tests.generate import ALL_PROFILES, random_text
from tests.semantics import literal
from tests.verify.test_forged_ranks import restoring
from tests.verify.test_forged_steps import ORDERINGS, SPECS
from tumato_symbolic import parse
from tumato_symbolic.semantics import active_goals, duration, residual_goal
from tumato_symbolic.spec import Ordering, Spec, canonical_text

GENERATED = [random_text(seed, ALL_PROFILES[profile]) for profile in ALL_PROFILES for seed in (3000, 3001, 3002)]
BY_TEXT = [*((spec, text_of(spec)) for spec in SPECS), *((parse(text), text) for text in GENERATED)]
ALL = [(spec, text) for spec, text in BY_TEXT if len(spec.actions) <= 5]


def world(text: str, ordering: Ordering = "any") -> Any:
    """The checker's view of a specification."""
    return checker.World(checker.read_specification(text.encode()), ordering)


def named(spec: Spec, state: literal.State) -> tuple[str, ...]:
    """A state as the checker has it."""
    return tuple(variable.values[value] for variable, value in zip(spec.variables, state, strict=True))


def names(spec: Spec, chosen: literal.Actions) -> frozenset[str]:
    """A set as the checker has it."""
    return frozenset(spec.actions[number].name for number in chosen)


def some(spec: Spec, count: int) -> list[literal.State]:
    """Some valid states."""
    return [state for state in literal.states(spec) if literal.valid(spec, state)][:count]


@pytest.mark.parametrize("ordering", ORDERINGS)
def test_allowed_sets(ordering: Ordering) -> None:
    """All allowed sets of a smaller duration than a limit, each once; `objection` has none to them alone."""
    for spec, text in ALL:
        own = world(text, ordering)
        for state in some(spec, 6):
            fine = {names(spec, each): duration(spec, each) for each in literal.allowed(spec, state, ordering)}
            for below in (0, 1, 2, math.inf):
                found = list(own.allowed_sets(named(spec, state), below))
                assert len(found) == len(set(found))
                assert set(found) == {each for each, takes in fine.items() if takes < below}
            for chosen in literal.sets(spec):
                each = names(spec, chosen)
                assert (own.objection(named(spec, state), each) is None) == (each in fine)
                if chosen and len(chosen) < 4:
                    ends = {named(spec, end) for end in literal.outcomes(spec, state, chosen, ordering)}
                    assert {end for end, _ in own.outcomes(named(spec, state), each)} == ends
                    inside = [named(spec, end) for end in literal.states(spec) if literal.safe(spec, end)]
                    unchanged = not any(literal.effects(spec, action) for action in chosen)
                    kept = own.stays_within(named(spec, state), named(spec, state), each, own.all_rules)
                    falsified = "falsified" in literal.broken(spec, state, chosen, ordering)
                    assert kept == (unchanged or (ends <= set(inside) and not falsified))


def test_what_grows_no_further() -> None:
    """A set is grown exactly while nothing is at fault that every larger set has as well."""
    for spec, text in ALL[: len(SPECS)]:
        own = world(text)
        everything = names(spec, frozenset(range(len(spec.actions))))
        for state, chosen in product(some(spec, 6), literal.sets(spec)):
            each, here = names(spec, chosen), named(spec, state)
            others = everything - each
            hopeless = any(
                not any(
                    checker.holds(rule, here, each | frozenset(more))
                    for size in range(len(others) + 1)
                    for more in checker.itertools.combinations(sorted(others), size)
                )
                and checker.truth(rule, here, each, others) is False
                for rule, _ in own.spec.reaction_rules
            )
            kinds = set(literal.broken(spec, state, chosen, "any")) & {"resource", "nominal-conflict"}
            fine = not kinds and not hopeless and (not each or own.stays_within(here, here, each, own.required(here)))
            takes = duration(spec, chosen)
            assert own.may_grow(here, each, others, takes + 1) == fine
            assert not own.may_grow(here, each, others, takes)


def test_truth_while_actions_are_open() -> None:
    """What is told is so, whichever of the open actions are executed; without open ones all is told."""
    for spec, text in ALL:
        own = world(text)
        rules = [rule for rule, _ in own.spec.reaction_rules]
        for state, (executed, idle) in product(some(spec, 3), list(cubes(own))[::2]):
            others = frozenset(own.spec.actions) - executed - idle
            here = named(spec, state)
            for rule in rules:
                told = checker.truth(rule, here, executed, others)
                found = {checker.holds(rule, here, each) for each in inside(executed, others)}
                assert told is None or found == {told}
                assert told is not None or others


def cubes(own: Any) -> list[tuple[frozenset[str], frozenset[str]]]:
    """All pairs of executed and idle actions."""
    actions = sorted(own.spec.actions)[:4]
    found = []
    for kinds in product(range(3), repeat=len(actions)):
        parts = [frozenset(a for a, kind in zip(actions, kinds, strict=True) if kind == each) for each in (0, 1)]
        found.append((parts[0], parts[1]))
    return found


def inside(executed: frozenset[str], others: frozenset[str]) -> list[frozenset[str]]:
    """All sets of a cube."""
    ordered = sorted(others)
    return [
        executed | {action for place, action in enumerate(ordered) if code >> place & 1}
        for code in range(1 << len(ordered))
    ]


def test_rules_that_fail_in_a_whole_cube() -> None:
    """A cube breaks a rule exactly where all its sets do; otherwise a set that keeps it is named."""
    met = set()
    for spec, text in ALL:
        own = world(text)
        for state, (executed, idle) in product(some(spec, 3), cubes(own)):
            others = frozenset(own.spec.actions) - executed - idle
            for rule, _ in own.spec.reaction_rules:
                cube = checker.Cube(executed, idle, "reaction-rule", rule=checker.text_of(rule, own.spec))
                keeping = [each for each in inside(executed, others) if checker.holds(rule, named(spec, state), each)]
                told = checker.kept_rule(own, named(spec, state), cube)
                assert (told == "") == (not keeping)
                if told:
                    kept = {f"{own.show_set(each)} keeps the rule" for each in keeping}
                    shown = frozenset(told.partition("}")[0][1:].split(", ")) - {""}
                    assert told in kept or executed <= shown
                met.add((told == "", bool(others)))
    assert met == set(product((True, False), repeat=2))


def test_rules_are_split_up_to_a_limit(monkeypatch: pytest.MonkeyPatch) -> None:
    """Cases on open actions are counted."""
    spec = SPECS[0]
    own = world(text_of(spec))
    (rule, _), *_ = own.spec.reaction_rules
    cube = checker.Cube(frozenset(), frozenset(), "reaction-rule", rule=checker.text_of(rule, own.spec))
    here = named(spec, (0, 1))
    monkeypatch.setattr(checker, "LARGEST", 0)
    with pytest.raises(checker.TooLarge, match="sets of actions in a rule"):
        checker.kept_rule(own, here, cube)


def test_two_actions_that_exclude_each_other() -> None:
    """It takes both: one that controls a resource, or gives a value, shares none with one that does not."""
    own = world(TWO)
    shared = {frozenset(("one", "too"))}
    disagreeing = {frozenset(("back", other)) for other in ("one", "two", "too")}
    for pair in map(frozenset, checker.itertools.combinations(("back", "one", "too", "two"), 2)):
        for kind, excluded in (("resource", shared), ("nominal-conflict", disagreeing)):
            cube = checker.Cube(pair, frozenset(), kind, actions=pair)
            assert (checker.unviolated(own, ("a", "a"), cube) == "") == (pair in excluded), (pair, kind)


def test_cases_and_guesses_are_counted(monkeypatch: pytest.MonkeyPatch) -> None:
    """The cases of a rule with two open actions that one of them keeps, and the guesses of a choice of two options."""
    rule = "(NOT (P is b)) OR ((executing bc) OR (executing cb))"
    own = world(spec_text("abc", "bc cb", f"BEGIN REACTION RULES rule: {rule} END REACTION RULES"))
    cube = checker.Cube(frozenset(), frozenset(), "reaction-rule", rule=rule)
    monkeypatch.setattr(checker, "LARGEST", 2)
    assert checker.kept_rule(own, ("b",), cube) == "{bc} (duration 0) keeps the rule"
    monkeypatch.setattr(checker, "LARGEST", 1)
    with pytest.raises(checker.TooLarge, match="more than 1 sets of actions in a rule"):
        checker.kept_rule(own, ("b",), cube)
    assert checker.Choosing([2], []).succeeds()
    with pytest.raises(checker.TooLarge, match="more than 1 choices of options"):
        checker.Choosing([2, 2], []).succeeds()


def test_sets_and_outcomes_are_counted(monkeypatch: pytest.MonkeyPatch) -> None:
    """Three actions that leave all as it is: eight sets, and seven that are still to come after one of all three."""
    actions = " ".join(f"action {name} effects: A is x" for name in "pqr")
    text = f"BEGIN STATE VECTOR state A can be x END STATE VECTOR BEGIN ACTIONS {actions} END ACTIONS"
    for most, fine in ((8, True), (7, False)):
        monkeypatch.setattr(checker, "LARGEST", most)
        own = checker.World(checker.read_specification(text.encode()), "any")
        try:
            assert len(list(own.allowed_sets(("x",)))) == 8 and fine
        except checker.TooLarge:
            assert not fine
    for most, fine in ((7, True), (6, False)):
        monkeypatch.setattr(checker, "LARGEST", most)
        try:
            assert len(list(own.outcomes(("x",), frozenset("pqr")))) == 7 and fine
        except checker.TooLarge:
            assert not fine


def test_goals() -> None:
    """Active and residual goals by their texts."""
    for spec, text in BY_TEXT:
        own = world(text)
        bodies = [canonical_text(spec, body.formula) for body in spec.bodies]
        for state in some(spec, 12):
            here = named(spec, state)
            active = {checker.text_of(body, own.spec) for body in own.active_goals(here)}
            assert active == {bodies[body] for body in active_goals(spec, state)}
            for chosen in list(literal.sets(spec))[:8]:
                goal, executed = own.residual_goal(here, names(spec, chosen))
                pending = residual_goal(spec, state, chosen)
                assert {checker.text_of(body, own.spec) for body in goal} == {bodies[body] for body in pending.bodies}
                assert executed == names(spec, pending.executed)


@pytest.mark.parametrize("length", [1, 2, 4])
def test_steps_that_are_left(length: int) -> None:
    """How many steps the policy needs, wherever it starts; and never where it goes round or ends."""
    spec, policy = restoring(length, length)
    own = world(text_of(spec))
    decide = {named(spec, state): names(spec, chosen) for state, chosen in policy.items()}
    judge = checker.Judge(own, decide.get)
    goal = own.residual_goal(("a",), frozenset())
    for place in range(length + 1):
        assert judge.steps_left(goal, ("abcdefgh"[place],)) == length - place
    waiting = checker.Judge(own, {**decide, ("a",): frozenset()}.get)
    assert waiting.steps_left(goal, ("a",)) is None
    assert waiting.steps_left(goal, ("b",)) == length - 1
    ending = checker.Judge(own, {state: chosen for state, chosen in decide.items() if state != ("a",)}.get)
    assert ending.steps_left(goal, ("a",)) is None
    assert ending.serves(("b",), decide[("b",)])


def test_choices_of_options() -> None:
    """One option of every state so that every clause has one: found exactly where there is one."""
    random = Random(5)
    found = set()
    for _ in range(400):
        counts = [random.randint(1, 3) for _ in range(random.randint(1, 4))]
        picks = [(state, place) for state, count in enumerate(counts) for place in range(count)]
        clauses = [random.choices(picks, k=random.randint(0 if random.random() < 0.05 else 1, 3)) for _ in range(6)]
        expected = any(
            all(any(way[state] == place for state, place in clause) for clause in clauses)
            for way in product(*map(range, counts))
        )
        assert checker.Choosing(counts, clauses).succeeds() == expected
        found.add(expected)
    assert found == {True, False}
    assert not checker.Choosing([2, 0], []).succeeds()
