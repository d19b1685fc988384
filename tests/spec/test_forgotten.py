"""What was probably forgotten is said, once and at its place, and the text can allow it."""

from pathlib import Path

import pytest
from msgspec.structs import replace

from tests.spec.marked import loaded, unmark
from tumato_symbolic.diagnostics import Diagnostic, Source, not_allowed
from tumato_symbolic.semantics.lint import lint
from tumato_symbolic.spec import digest


def robot(
    variables: str = "",
    actions: str = "",
    rules: str = "",
    *,
    goal: str = "Place is dock",
    config: str = "",
    aliases: str = "",
) -> str:
    """A robot that goes to and fro, about which there is nothing to say, and what is added to it."""
    return f"""BEGIN STATE VECTOR
state Place can be dock, field
{variables}
END STATE VECTOR
BEGIN ALIASES
{aliases}
END ALIASES
BEGIN RESOURCES resource WHEELS END RESOURCES
BEGIN ACTIONS
action go controlled resources: WHEELS nominal effects: Place is field
action back controlled resources: WHEELS nominal effects: Place is dock
{actions}
END ACTIONS
BEGIN STATE RULES
{rules}
END STATE RULES
BEGIN GOALS
goal type: priority
goal: {goal}
END GOALS
BEGIN CONFIG {config} END CONFIG
"""


def said(text: str) -> list[Diagnostic]:
    """Everything that `check` says about a text."""
    found = loaded(text)
    assert found.spec is not None, found.diagnostics
    return [*found.diagnostics, *lint(found.spec)]


HUMAN = "state Human can be away, here"
ENTER = "action enter nominal effects: Human is here"
LEAVE = "action leave preconditions: Human is here nominal effects: Human is away"
AWAY = "rule: IF Human is here THEN Place is dock"
LAMP = "state L can be off, on"
LIT = "action lamp effects: L is on"
DARK = "action dark effects: L is off"
IN_FIELD = "IF Place is field THEN"
DOOR = "state Door can be open, shut"
HELD = "goal: true when Place is field then goal: «Place is field»"

FORGOTTEN = [
    ("TUM341", robot("state «H» can be no, yes"), "nothing mentions the state variable `H`"),
    ("TUM342", robot("state «H» can be a, b, c", rules=f"rule: {IN_FIELD} H is a"), "`b` and `c` of `H` apart"),
    (
        "TUM342",
        robot("state «H» can be a, b, unknown, c", rules=f"rule: {IN_FIELD} H is a"),
        "the values `b` and `c` of `H` apart",
    ),
    (
        "TUM343",
        robot("state «B» can be empty, low, ok", "action charge effects: B is ok", goal="NOT B is low"),
        "nothing mentions the value `empty` of `B`",
    ),
    ("TUM344", robot("state «H» can be away, here", rules=f"rule: {IN_FIELD} H is here"), "no action changes `H`"),
    (
        "TUM344",
        robot("state «H» can be away, here state E can be off, on", rules="rule: IF H is here THEN E is on"),
        "no action changes `H` and `E`: they are the environment's",
    ),
    (
        "TUM345",
        robot("state «Door» can be open, shut", "action open effects: Door is open", f"rule: {IN_FIELD} Door is open"),
        "no action takes `Door` away from `open`",
    ),
    (
        "TUM345",
        robot(
            "state «N» can be 0..2",
            "action up preconditions: N is 0 effects: N is 1 action top preconditions: N < 2 effects: N is 2",
            f"rule: {IN_FIELD} N > 0",
        ),
        "no action takes `N` away from `2`",
    ),
    (
        "TUM346",
        robot(HUMAN, f"{ENTER.replace('enter', '«enter»')} {LEAVE}", AWAY),
        "`enter` and `leave` command `Human`, which everything else only observes",
    ),
    (
        "TUM347",
        robot(LAMP, f"{LIT} {DARK}", f"rule: «{IN_FIELD} L is on AND Place is dock»", config="restoration: bounded"),
        "has 2 parts: while one is broken, the others need not be kept",
    ),
    (
        "TUM348",
        robot(LAMP, f"{LIT} alternative effects: «IF Place is dock THEN L is off» {DARK}"),
        "speaks of the state afterwards",
    ),
    ("TUM355", robot().replace("goal: Place is dock", f"when Place is dock then {HELD}"), "holds already"),
]


@pytest.mark.parametrize(("code", "marked", "message"), FORGOTTEN, ids=lambda each: str(each)[:40])
def test_what_was_forgotten_is_said(code: str, marked: str, message: str) -> None:
    """The code, the place and the words; nothing else of its kind is said."""
    case = unmark(marked)
    found = [each for each in said(case.text) if each.code.name == code]
    assert [each.span for each in found] == [case.span]
    assert message in found[0].message
    assert found[0].help


@pytest.mark.parametrize(("code", "marked", "message"), FORGOTTEN, ids=lambda each: str(each)[:40])
def test_the_text_can_allow_it(code: str, marked: str, message: str) -> None:
    """On the line, or in the comments just above it; neither what the text means nor who reads it takes notice."""
    text = unmark(marked).text
    (diagnostic,) = (each for each in said(text) if each.code.name == code)
    assert message in diagnostic.message and diagnostic.span is not None
    lines = text.split("\n")
    place = diagnostic.span.line - 1
    spec = loaded(text).spec
    assert spec is not None
    on_it, above = list(lines), list(lines)
    on_it[place] += f"  // allow {code}: as meant"
    above[place:place] = [f"// allow TUM321, {code}", "// since it is meant"]
    for allowing in ("\n".join(on_it), "\n".join(above)):
        assert code not in _codes_left(allowing)
        allowed = loaded(allowing).spec
        assert allowed is not None
        assert digest(allowed) == digest(spec)


def _codes_left(text: str) -> list[str]:
    return [each.code.name for each in not_allowed(said(text), Source("s", text))]


CLEAN = {
    "the robot alone": robot(),
    "a mission flag": robot("state Done can be no, yes", "action do effects: Done is yes", goal="Done is yes"),
    "a battery of numbers": robot(
        "state B can be 0..9",
        "action charge effects: B is 9 action use preconditions: B > 0 effects: B is 0",
        "rule: B > 3",
    ),
    "a lamp": robot(LAMP, f"{LIT} {DARK}", f"rule: {IN_FIELD} L is on"),
    "a lift that needs its motor": robot(
        "state Lift can be low, high",
        "action up controlled resources: WHEELS effects: Lift is high action down effects: Lift is low",
        "rule: IF Lift is high THEN Place is dock",
    ),
    "a door that is a goal": robot(
        DOOR,
        "action open effects: Door is open action shut preconditions: Door is open effects: Door is shut",
        "rule: IF Door is open THEN Place is dock",
        goal="Door is open",
    ),
    "a rule of several parts": robot(LAMP, f"{LIT} {DARK}", f"rule: {IN_FIELD} L is on AND NOT L is off"),
    "a rule with an alias": robot(
        LAMP,
        f"{LIT} {DARK}",
        f"rule: {IN_FIELD} lit",
        aliases="define lit as L is on AND Place is field",
        config="restoration: bounded",
    ),
    "nothing to reach": robot(goal="true"),
    "a value to start from": robot(
        "state B can be empty, low, ok", "action charge effects: B is ok action use effects: B is low", goal="B is low"
    )
    + "BEGIN START start: B is empty END START",
}
"""What is usual in specifications."""


def _of_this_kind(text: str) -> list[str]:
    codes = [f"TUM{number}" for number in (*range(341, 349), 355)]
    return [each.message for each in said(text) if each.code.name in codes]


@pytest.mark.parametrize("text", CLEAN.values(), ids=CLEAN)
def test_nothing_silly_is_said(text: str) -> None:
    """What is usual in specifications is not remarked."""
    assert _of_this_kind(text) == []


@pytest.mark.parametrize(("failed", "remarked"), [("unknown", False), ("UNKNOWN", False), ("far", True)])
def test_a_sensor_that_fails_is_taken_for_the_worst(failed: str, remarked: bool) -> None:
    """One value and `unknown` may be treated alike, and are then not two values that nothing mentions either."""
    found = {each.code.name for each in said(robot(f"state H can be clear, near, {failed}", rules="rule: H is clear"))}
    assert ("TUM342" in found) == remarked
    assert "TUM343" not in found


def test_errors_cannot_be_allowed() -> None:
    """A comment does not make a mistake right."""
    assert loaded("BEGIN STATE VECTOR\nstate S can be a, a // allow TUM203\nEND STATE VECTOR").spec is None


def test_a_comment_further_up_allows_nothing() -> None:
    """Only what stands right above is about the line."""
    text = robot("// allow TUM341\n\nstate H can be no, yes")
    assert "TUM341" in [each.code.name for each in said(text)]


PAPER = sorted((Path(__file__).parents[2] / "examples").glob("amr*.tum"))


@pytest.mark.parametrize("path", PAPER, ids=lambda path: path.stem)
def test_nothing_is_said_about_the_examples_of_the_paper(path: Path) -> None:
    """Not even a remark."""
    assert _of_this_kind(path.read_text(encoding="utf-8")) == []


COMMANDING = robot(HUMAN, f"{ENTER} {LEAVE}", AWAY)
ROBOTS = [
    ("action enter", "action enter controlled resources: WHEELS"),
    ("effects: Human is here", "effects: Human is here, Place is dock"),
    ("action enter", "action enter preconditions: Place is dock"),
    ("THEN Place is dock", "THEN (Place is dock OR Human is here)"),
    ("goal: Place is dock", "goal: Human is away"),
]


@pytest.mark.parametrize(("old", "new"), ROBOTS)
def test_an_action_that_belongs_to_the_robot_is_no_command(old: str, new: str) -> None:
    """Where it needs a resource, does or needs something else, or is wanted by a rule or goal, it is the robot's."""
    assert old in COMMANDING
    assert "TUM346" in [each.code.name for each in said(COMMANDING)]
    assert "TUM346" not in [each.code.name for each in said(COMMANDING.replace(old, new))]


def test_a_rule_of_several_parts_matters_where_safety_takes_steps() -> None:
    """In one step nothing is remarked; what the command line says of the restoration counts."""
    spec = loaded(robot(rules="rule: IF Place is field THEN Place is dock AND Place is dock")).spec
    assert spec is not None
    assert "TUM347" not in [each.code.name for each in lint(spec)]
    assert "TUM347" in [each.code.name for each in lint(replace(spec, restoration="fair"))]
