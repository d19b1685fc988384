"""The stand-alone checker reads the language as the package does."""

from __future__ import annotations

import pytest

from tests.checker.standalone import checker, sizes
from tumato_symbolic.diagnostics import Source
from tumato_symbolic.semantics import all_states, is_safe, is_valid
from tumato_symbolic.spec import load

STATES = "BEGIN STATE VECTOR\nstate A can be x, y, z\nstate B can be x, y\nEND STATE VECTOR\n"
GO = "BEGIN ACTIONS\naction go\npreconditions: none\nnominal effects: A is x\nEND ACTIONS\n"
BOTH = STATES + "BEGIN RESOURCES\nresource R resource S\nEND RESOURCES\n"


def rule(predicate: str) -> str:
    """A specification with one state rule."""
    return f"{STATES}{GO}BEGIN STATE RULES rule: {predicate} END STATE RULES"


def reaction(predicate: str) -> str:
    """A specification with one reaction rule."""
    return f"{STATES}{GO}BEGIN REACTION RULES rule: {predicate} END REACTION RULES"


def goals(members: str, kind: str = "priority") -> str:
    """A specification with goals."""
    return f"{STATES}{GO}BEGIN GOALS goal type: {kind} {members} END GOALS"


def alias(definitions: str, rest: str = "") -> str:
    """A specification with aliases."""
    return f"{STATES}BEGIN ALIASES {definitions} END ALIASES {GO} {rest}"


def action(*fields: str) -> str:
    """A specification with one action, and resources."""
    return f"{BOTH}BEGIN ACTIONS action go {' '.join(fields)} END ACTIONS"


def config(settings: str) -> str:
    """A specification with settings."""
    return f"{STATES}BEGIN CONFIG {settings} END CONFIG"


def values(words: str) -> str:
    """A specification with one variable."""
    return f"BEGIN STATE VECTOR state Q can be {words} END STATE VECTOR"


MISLEADING = [
    chr(code) for code in (0, 8, 11, 12, 27, 28, 31, 127, 0x85, 0x9F, 0x61C, 0x200E, 0x2028, 0x2029, 0x202E, 0x2069)
]
"""What some editors show as the end of a line, or as a change of direction, and others not at all."""

STRANGE = [*MISLEADING, *(chr(code) for code in (0xA0, 0x1680, 0x2003, 0x200B, 0x202F, 0x3000))]
"""What looks like white space and is none."""

READABLE = [
    STATES,
    STATES
    + "BEGIN ACTIONS END ACTIONS BEGIN GOALS END GOALS BEGIN CONFIG END CONFIG BEGIN STATE RULES END STATE RULES",
    GO + STATES,
    (STATES + GO).replace("\n", "\r\n"),
    STATES + "// the end",
    STATES + "/* a /* b */ // */\n" + GO,
    STATES.replace("can be", "can/**/be//\n "),
    values("true, false, state, goal, rule, none, executing, any, GOALS"),
    values("x") + " BEGIN STATE RULES rule: Q is x rule: NOT NOT Q is x END STATE RULES",
    rule("IF A is x THEN B is x IFONLYIF A is y"),
    rule("A is x OR B is x IFONLYIF A is x AND B is y"),
    rule("(A is x IFONLYIF B is x) IFONLYIF A is y"),
    rule("IF A is x AND B is x OR A is y THEN B is y OR A is y"),
    rule("NOT A is x AND B is y"),
    rule("NOT (A is x AND B is y) OR false"),
    rule("A is x OR B is y AND A is z"),
    rule("(" * 90 + "A is x" + ")" * 90),
    alias("define k as m AND A is x define m as B is x", "BEGIN STATE RULES rule: NOT k END STATE RULES"),
    alias("define rule as A is x", "BEGIN STATE RULES rule: rule rule: NOT rule END STATE RULES"),
    alias("define k as executing go", "BEGIN REACTION RULES rule: k END REACTION RULES"),
    alias("define then as A is x", "BEGIN GOALS goal type: priority when then then goal: NOT then END GOALS"),
    goals(""),
    goals("when A is x then BEGIN GOALS goal type: constraint goal: A is y goal: executing go END GOALS goal : true"),
    goals("BEGIN GOALS goal type: constraint END GOALS"),
    action("alternative effects: A is x OR A is y, B is x", "cost : 3", "effects: B is x", "preconditions: none"),
    action("nominal effects: NOT B is x", "controlled resources: R, S", "alternative effects: none"),
    action("nominal effects: NOT A is x, NOT A is y", "preconditions:", "alternative effects:"),
    action(),
    action("controlled resources: none", "duration: 0"),
    config("max_plan_length: 1 effect_ordering: first"),
    config("max_plan_length:1effect_ordering:any").replace("1e", "1 e"),
    (STATES + GO).replace("\n", "\r"),
    "\ufeff" + STATES,
    STATES + "// größer, \u00a0, \ufeff, \U0001f916",
]

WRONG = [
    "",
    "BEGIN STATE VECTOR END STATE VECTOR",
    "begin state vector state A can be x end state vector",
    STATES + STATES,
    STATES + "BEGIN CONFIG END CONFIG BEGIN CONFIG END CONFIG",
    STATES + "BEGIN STATE RULES rule: A is x END STATE RULES BEGIN STATE RULES rule: A is x END STATE RULES",
    STATES + "BEGIN RULES END RULES",
    STATES + "BEGIN STATE RULES END RULES",
    STATES + "/* never closed",
    STATES + "#",
    values("x,"),
    values("x, x"),
    values("x y"),
    values("AND"),
    values("x state Q can be y"),
    rule("A is w"),
    rule("C is x"),
    rule("a is x"),
    rule("k"),
    rule("A is x,"),
    rule("A is x IFONLYIF B is x IFONLYIF A is y"),
    rule("A is x IFONLYIF IF A is x THEN B is x"),
    rule("IF A is x THEN IF B is x THEN A is y"),
    rule("A is x OR IF A is x THEN B is x"),
    rule("NOT IF A is x THEN B is x"),
    rule("(A is x"),
    rule("executing go"),
    rule("none"),
    reaction("executing A"),
    reaction("executing nobody"),
    reaction("go"),
    alias("define k as k"),
    alias("define k as m define m as k"),
    alias("define k as nobody"),
    alias("define k as A is x define k as A is x"),
    alias("define A as A is x"),
    alias("define go as A is x"),
    alias("define true as A is x"),
    alias("define k as executing go", "BEGIN STATE RULES rule: k END STATE RULES"),
    goals("goal: A is x", "some"),
    goals("goal: A is x, B is x"),
    goals("when A is x then when B is x then goal: true"),
    goals("when executing go then goal: true"),
    STATES + "BEGIN GOALS goal: true END GOALS",
    action("nominal effects: NOT A is x"),
    action("nominal effects: A is x OR B is x"),
    action("nominal effects: A is x, A is y"),
    action("nominal effects: false"),
    action("nominal effects: executing go"),
    action("alternative effects: A is x, A is y"),
    action("preconditions: executing go"),
    action("duration: 1", "cost: 1"),
    action("effects: none", "nominal effects: none"),
    action("duration: -1"),
    action("duration: 10000000000"),
    action("controlled resources: Q"),
    action("preconditions: A is x B is x"),
    action("action go"),
    STATES + "BEGIN ACTIONS action A END ACTIONS",
    STATES + "BEGIN RESOURCES resource R resource R END RESOURCES",
    STATES + "BEGIN RESOURCES resource none END RESOURCES",
    STATES + "BEGIN ASSUMPTIONS assume: executing go END ASSUMPTIONS" + GO,
    STATES + "BEGIN ASSUMPTIONS rule: A is x END ASSUMPTIONS",
    STATES + "BEGIN START start: executing go END START" + GO,
    STATES + "BEGIN START assume: A is x END START",
    config("max_plan_length: 0"),
    config("max_plan_length: 1 max_plan_length: 1"),
    config("effect_ordering: last"),
    config("effect_ordering: any effect_ordering: any"),
    config("plan: 1"),
    config("max_plan_length: 4effect_ordering: any"),
    config("max_plan_length: 4é"),
    config("max_plan_length: -0"),
    action("duration: 4controlled resources: R"),
    action("duration: -0"),
    action("duration: 4."),
    action("duration: ٤"),
    STATES + "\ufeff" + GO,
    "\ufeff\ufeff" + STATES,
    *(STATES + sign + GO for sign in STRANGE),
    *(STATES + f"// a {sign} b\n" + GO for sign in MISLEADING),
    *(STATES + f"/* a {sign} b */" + GO for sign in MISLEADING),
]

RULE_AFTER_COMMENT = STATES + GO + "BEGIN STATE RULES // one{end}rule: A is x\n END STATE RULES"


@pytest.mark.parametrize("text", READABLE)
def test_what_is_readable_means_the_same(text: str) -> None:
    """The package and the checker count the same valid and safe states."""
    spec = load(Source("spec.tum", text)).spec
    assert spec is not None
    valid = [state for state in all_states(spec) if is_valid(spec, state)]
    assert sizes(text) == (len(valid), sum(is_safe(spec, state) for state in valid))


@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_a_comment_ends_with_its_line(end: str) -> None:
    """A line ends with a line feed, a carriage return, or both: the rule on the next one is no part of the comment."""
    text = RULE_AFTER_COMMENT.format(end=end)
    spec = load(Source("spec.tum", text)).spec
    assert spec is not None
    assert [rule.span.line for rule in spec.state_rules] == [11]
    own = checker.resolve(checker.Parser(text).specification())
    assert [line for _, line in own.state_rules] == [11]


@pytest.mark.parametrize("text", WRONG)
def test_what_is_wrong_is_refused(text: str) -> None:
    """A specification with an error is refused by both."""
    assert load(Source("spec.tum", text)).spec is None
    assert sizes(text) is None


def test_no_valid_state_is_refused() -> None:
    """A specification whose assumptions exclude every state has an error."""
    assert sizes(STATES + "BEGIN ASSUMPTIONS assume: A is x AND A is y END ASSUMPTIONS") is None


def test_effects_are_found_without_trying_all_values() -> None:
    """A plain effect on each of many variables is not a search through all their values."""
    names = [f"V{number}" for number in range(40)]
    states = " ".join(f"state {name} can be a, b, c, d" for name in names)
    effects = " AND ".join(f"{name} is b" for name in names)
    text = f"BEGIN STATE VECTOR {states} END STATE VECTOR BEGIN ACTIONS action go effects: {effects} END ACTIONS"
    spec = checker.resolve(checker.Parser(text).specification())
    assert spec.actions["go"].effects_in(()) == [dict.fromkeys(range(40), "b")]


def test_aliases_that_double_end() -> None:
    """Aliases that double thirty times are refused, not expanded."""
    steps = " ".join(f"define k{n + 1} as k{n} AND k{n}" for n in range(30))
    with pytest.raises(checker.Unreadable, match="a predicate has"):
        checker.resolve(checker.Parser(alias(f"define k0 as A is x {steps}")).specification())


@pytest.mark.parametrize(
    ("effects", "left"),
    [("A is x OR B is x", "4 assignments"), ("NOT A is x", "2 assignments"), ("A is x, A is y", "0 assignments")],
)
def test_what_nominal_effects_leave_is_told(effects: str, left: str) -> None:
    """They have to leave one assignment; the message says how many it is."""
    with pytest.raises(checker.Unreadable, match=f"line 8: the nominal effects of `go` leave {left}, not one"):
        checker.read_specification(action(f"nominal effects: {effects}").encode())
