"""Tests that advice never trades safety away (`advice.py` counts on hundreds of specifications)."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import pytest
from msgspec.structs import replace

from tests.explain.advice import (
    GIVEN_UP,
    TAUTOLOGY,
    UNRELATED,
    UNSAID,
    USELESS,
    Form,
    bad_advice,
    examine_generated,
    generated_text,
)
from tests.explain.oracle import repaired
from tests.explain.robots import BRAKE, FORKLIFT, NEAR, ROBOTS, TAUT, battery
from tests.explain.variants import VARIANTS
from tumato_symbolic import Realizable, parse, synthesize
from tumato_symbolic.diagnostics import Source
from tumato_symbolic.explain.additions import NewAction, NoGoalWhile, Setting
from tumato_symbolic.explain.elements import Element
from tumato_symbolic.explain.explain import explain
from tumato_symbolic.explain.explanation import Change, Explanation, Repair, Wanted
from tumato_symbolic.explain.repairs import SHARE
from tumato_symbolic.limits import Context, Limits
from tumato_symbolic.report.explained import Explained, as_text
from tumato_symbolic.report.explained_data import as_json
from tumato_symbolic.spec import Spec

ONLY_BY_RULES = next(each.text for each in VARIANTS if each.name == "rule_too_strong")
"""Nothing but giving up a state rule serves."""

STOPPED_BY_PEOPLE = """\
BEGIN STATE VECTOR
state Human can be away, here
state Place can be dock, rack
END STATE VECTOR
BEGIN ACTIONS
action go
preconditions: Human is away
nominal effects: Place is rack
END ACTIONS
BEGIN GOALS
goal type: KIND
goal: Place is rack
END GOALS
"""


@cache
def _explained(text: str, wanted: Wanted = 3) -> Explanation:
    found = explain(parse(text), wanted_repairs=wanted)
    assert isinstance(found, Explanation)
    return found


def _has_policy(spec: Spec) -> bool:
    return isinstance(synthesize(spec, certify=False), Realizable)


def _report(text: str, found: Explanation) -> str:
    return as_text(Explained(Source("x.tum", text), parse(text), found, (), None, False), False)


@pytest.mark.parametrize("name", ROBOTS)
def test_advice_on_robots_is_safe(name: str) -> None:
    """No state rule is given up where something else serves, no exception is empty, the environment is said."""
    text = ROBOTS[name]
    assert list(bad_advice(parse(text), text, _explained(text), _has_policy)) == []


@pytest.mark.parametrize("seed", range(700, 708))
def test_advice_on_generated_specifications_is_safe(seed: int) -> None:
    """The same, by the explicit meaning, which also holds that every repair that is printed gives a policy.

    `python -m tests.explain.advice` asks for hundreds.
    """
    assert examine_generated(seed) in (None, [])


def _told(text: str, **changes: object) -> set[str]:
    """What is wrong with an explanation that says something else than it should."""
    spec, found = parse(text), replace(_explained(text), **changes)
    return set(bad_advice(spec, text, found, _has_policy))


def _change(text: str | None) -> tuple[Repair, ...]:
    return (Repair((Change(Element("state-rule", 0), text),)),)


def test_bad_advice_is_noticed() -> None:
    """Each kind that is counted: so that a count of 0 means something."""
    part = _explained(BRAKE).part
    assert part is not None
    assert _told(BRAKE, repairs=_change(None)) == {GIVEN_UP}
    assert _told(TAUT, repairs=_change("(IF B is low THEN NOT P is in) OR P is in")) == {GIVEN_UP, TAUTOLOGY}
    assert _told(NEAR, repairs=_change("NOT B is critical OR (B is critical AND L is on)")) == {GIVEN_UP, UNRELATED}
    assert _told(BRAKE, part=replace(part, environment=())) == {UNSAID}
    assert _told(BRAKE, repairs=(Repair(additions=(NewAction(None, ((0, 0),)),)),)) == set()
    assert _told(BRAKE, repairs=(Repair(additions=(NoGoalWhile(((0, (1,)),)),)),)) == {USELESS}


def test_what_adds_comes_first() -> None:
    """A setting before a change of a line; and of settings, the stronger."""
    assert [type(each) for repair in _explained(BRAKE).repairs for each in repair.additions] == [Setting]
    assert _explained(BRAKE).repairs[0].additions == (Setting("bounded"),)
    assert _explained(TAUT).repairs[0].additions == (Setting("fair"),)


def test_a_missing_effect_is_named() -> None:
    """Where no action changes a variable as it must, the action is spelled out; and that the robot may be unable to."""
    found = _explained(NEAR)
    (repair,) = found.repairs
    (action,) = repair.additions
    assert isinstance(action, NewAction)
    assert "1. add this, if the robot can do it; no action controls B\n" in _report(NEAR, found)
    assert as_json(Explained(Source("x.tum", NEAR), parse(NEAR), found, (), None, False))["repairs"] == [
        {
            "add": [{"kind": "action", "text": "action NAME\npreconditions: B is critical\nnominal effects: B is ok"}],
            "environment": ["B"],
            "gives_up_safety": False,
            "verified": True,
        }
    ]


@pytest.mark.parametrize(
    ("kind", "where"), [("priority", "before the goals: + "), ("constraint", "around the goals: + ")]
)
def test_goals_give_way_to_the_environment(kind: str, where: str) -> None:
    """Where only a value of the environment is in the way, no goal is active while it is there."""
    text = STOPPED_BY_PEOPLE.replace("KIND", kind)
    found = _explained(text)
    free = next(repair for repair in found.repairs if any(isinstance(each, NoGoalWhile) for each in repair.additions))
    assert free.additions == (NoGoalWhile(((0, (1,)),)),)
    assert where in _report(text, found)
    assert "when Human is here then goal: true" in _report(text, found)
    assert isinstance(synthesize(repaired(parse(text), free)), Realizable)


def test_goals_give_way_to_each_value_that_stops_the_robot() -> None:
    """Two values of one variable and one of another, of which every failing state has one, and safe states none."""
    text = STOPPED_BY_PEOPLE.replace("KIND", "priority").replace("away, here", "away, here, unknown")
    text = text.replace("\nEND STATE VECTOR", "\nstate Stop can be up, down\nEND STATE VECTOR")
    text = text.replace("Human is away", "Human is away, Stop is up")
    found = _explained(text)
    free = next(repair for repair in found.repairs if any(isinstance(each, NoGoalWhile) for each in repair.additions))
    assert free.additions == (NoGoalWhile(((0, (1, 2)), (2, (1,)))),)
    assert isinstance(synthesize(repaired(parse(text), free)), Realizable)


def test_no_goal_gives_way_to_values_with_which_alone_it_is_active() -> None:
    """Most states without a plan have such a value where another one is in the way."""
    text = STOPPED_BY_PEOPLE.replace(
        "goal type: KIND", "goal type: priority\nwhen Sky is dark then goal: Place is dock"
    )
    text = text.replace("away, here", "away, here, near, unknown").replace(
        "\nEND STATE VECTOR", "\nstate Sky can be clear, dark\nEND STATE VECTOR"
    )
    text = text.replace(
        "Place is rack\nEND ACTIONS", "Place is rack\naction back\nnominal effects: Place is dock\nEND ACTIONS"
    )
    found = _explained(text)
    free = next(repair for repair in found.repairs if any(isinstance(each, NoGoalWhile) for each in repair.additions))
    assert free.additions == (NoGoalWhile(((0, (1, 2, 3)),)),)


def test_goals_do_not_give_way_for_good() -> None:
    """What would leave a goal active nowhere is no repair."""
    text = STOPPED_BY_PEOPLE.replace("goal type: KIND", "goal type: priority when Human is here then")
    assert not any(isinstance(each, NoGoalWhile) for repair in _explained(text).repairs for each in repair.additions)


def test_what_helps_is_told_where_nothing_serves_alone() -> None:
    """Additions that serve together, none of which can be left out, before anything gives up safety."""
    found = _explained(FORKLIFT)
    (repair,) = found.repairs
    assert not repair.gives_up_safety
    kinds = [type(each) for each in repair.additions]
    assert kinds == [Setting, NewAction, NewAction, NoGoalWhile]
    assert "`restoration: bounded` in CONFIG: 252 of them" in _report(FORKLIFT, found)


def test_a_state_rule_is_given_up_last() -> None:
    """Under a heading of its own, where nothing else serves, or where all repairs are asked for."""
    found = _explained(ONLY_BY_RULES)
    assert [repair.gives_up_safety for repair in found.repairs] == [True]
    assert "\nGives up safety (" in _report(ONLY_BY_RULES, found)
    assert "\nPossible changes" not in _report(ONLY_BY_RULES, found)
    assert not any(repair.gives_up_safety for repair in _explained(BRAKE).repairs)
    everything = _explained(BRAKE, "all")
    given_up = [repair.gives_up_safety for repair in everything.repairs]
    assert given_up == sorted(given_up)
    assert any(given_up)
    report = _report(BRAKE, everything)
    assert 0 < report.index("\nPossible changes") < report.index("\nGives up safety (all repairs were asked for;")


def test_an_exception_leaves_something_of_its_rule() -> None:
    """Where every exception would leave nothing of a rule, the rule is dropped under its own name."""
    changes = [change for repair in _explained(TAUT, "all").repairs for change in repair.changes]
    assert [change.text for change in changes if change.element.kind == "state-rule"] == [None]


def test_an_exception_is_about_few_variables() -> None:
    """What has nothing to do with a rule is not mentioned; nor is what makes no difference."""
    (change,) = _explained(BRAKE).repairs[1].changes
    assert change.text == "Speed is slow OR Speed is fast"
    assert not any(
        "L is" in (change.text or "") for repair in _explained(NEAR, "all").repairs for change in repair.changes
    )


class _Stage(Context):
    """The context of a stage none of whose parts has any time."""

    def within(self, seconds: float | None = None, learned: Callable[[object], None] | None = None) -> Context:
        return Context(Limits(0.0))


class _Hurried(Context):
    """A context in which the search for repairs that keep all rules is cut short."""

    def within(self, seconds: float | None = None, learned: Callable[[object], None] | None = None) -> Context:
        return _Stage(Limits(60.0))


def test_a_search_that_is_cut_short_leaves_time_for_the_rest() -> None:
    """What keeps all rules has a share of the time; it is said where the share was not enough."""
    assert 0 < SHARE < 1
    found = explain(parse(ONLY_BY_RULES), context=_Hurried(Limits(60.0)))
    assert isinstance(found, Explanation)
    assert found.others_untried
    assert [repair.gives_up_safety for repair in found.repairs] == [True]
    assert "Gives up safety (nothing else was found in time;" in _report(ONLY_BY_RULES, found)


def test_a_long_core_has_few_repairs() -> None:
    """A battery with many moves: what is missing first, then how the robot could charge elsewhere."""
    found = _explained(battery(12))
    assert not any(repair.gives_up_safety for repair in found.repairs)
    assert all(len(repair.changes) <= 1 for repair in found.repairs)


BARRED = """\
BEGIN STATE VECTOR
state Place can be dock, hall, rack
END STATE VECTOR
BEGIN ACTIONS
action out
preconditions: Place is dock
nominal effects: Place is hall
WAYS
END ACTIONS
BEGIN REACTION RULES
rule: NOT executing out
END REACTION RULES
BEGIN GOALS
goal type: priority
goal: Place is rack
END GOALS
""".replace(
    "WAYS", "".join(f"action way{n}\npreconditions: Place is hall\nnominal effects: Place is rack\n" for n in range(4))
)


def test_each_kind_of_line_is_told_before_more_of_one() -> None:
    """Any of four actions might start elsewhere; that a reaction rule is at fault is told before the second of them."""
    kinds = [[change.element.kind for change in repair.changes] for repair in _explained(BARRED).repairs]
    assert kinds == [["precondition"], ["reaction-rule"], ["precondition"]]


THREE_OBSTACLES = """\
BEGIN STATE VECTOR
state Human can be away, here
state Door can be open, shut
state Place can be dock, hall, rack, pit
END STATE VECTOR
BEGIN ACTIONS
action out
preconditions: Place is dock
nominal effects: Place is hall
action go
preconditions: Human is away, Door is open, Place is hall
nominal effects: Place is rack
END ACTIONS
BEGIN GOALS
goal type: priority
goal: Place is rack
END GOALS
"""


def test_what_is_added_together_comes_before_many_lines_that_are_dropped() -> None:
    """People and a door are waited for, and the robot gets out of the pit."""
    first = _explained(THREE_OBSTACLES).repairs[0]
    assert not first.changes
    assert {type(each) for each in first.additions} == {NewAction, NoGoalWhile}


def test_an_action_that_helps_only_later_is_tried() -> None:
    """It serves the goal from where safety is restored, and leads from no failing state to one that does not fail."""
    found = _explained(generated_text(7125, "clauses"))
    assert not any(repair.gives_up_safety for repair in found.repairs)
    assert found.repairs[0].additions == (NewAction(None, ((0, 1),)),)


@pytest.mark.parametrize(("seed", "form"), [(7018, "clauses"), (7136, "clauses"), (7280, "starts"), (9192, "starts")])
def test_advice_on_clauses_and_starts(seed: int, form: Form) -> None:
    """Seeds of the campaign on which something was wrong once, in the advice or in what judges it."""
    assert examine_generated(seed, form) == []
