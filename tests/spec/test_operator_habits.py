"""Operators of arithmetic and of time, and functions: what people write who know other languages."""

import pytest

from tests.spec.marked import the, unmark
from tests.spec.test_habits import check_habit, goals, rules
from tests.spec.test_mistakes import action, numeric, rule


def counting(effects: str) -> str:
    """An action with effects on `N`, which is a number."""
    return action(f"effects: {effects}").replace("state S can", "state N can be 0..9 state S can")


COUNTING = [
    ("TUM104", counting("N «+=» 2"), "write `N is N + 2`", counting("N is N + 2")),
    ("TUM104", counting("N «-=» 1"), "write `N is N - 1`", counting("N is N - 1")),
    ("TUM104", counting("N«++»"), "write `N is N + 1`", counting("N is N + 1")),
    ("TUM104", counting("N«--»"), "write `N is N - 1`", counting("N is N - 1")),
    ("TUM104", counting("S is a, N«--»"), "write `N is N - 1`", counting("S is a, N is N - 1")),
    ("TUM105", counting("N «=» N + 1"), "write `N is N + 1`", counting("N is N + 1")),
    ("TUM104", counting("N «:=» N + 1"), "write `is`", counting("N is N + 1")),
    ("TUM105", counting("«increase» N by 3"), "write `N is N + 3`", counting("N is N + 3")),
    ("TUM105", counting("«decrement» N"), "write `N is N - 1`", counting("N is N - 1")),
    (
        "TUM105",
        action("effects: «toggle» S"),
        "`when S is VALUE: S is OTHER`",
        action("effects: none when S is a: S is b"),
    ),
    ("TUM104", counting("N is N «*» 2"), "one clause for each value", counting("none when N is 1: N is 2")),
    ("TUM105", counting("N is N + «N»"), "one clause for each value", counting("none when N is 1: N is 2")),
    ("TUM105", action("effects: S«:» b"), "write `S is b`", action("effects: S is b")),
    ("TUM104", action("effects: S«'» is b"), "`NAME is VALUE`", action("effects: S is b")),
    ("TUM105", action("effects: «next»(S) is b"), "`NAME is VALUE`", action("effects: S is b")),
]

COMPARED = numeric("(N is 1 AND N < 3) OR (N is 2 AND N < 2)")
COMPUTING = [
    ("TUM104", numeric("N «+» 1 > 3"), "compared, not computed", COMPARED),
    ("TUM104", numeric("N > N «-» 1"), "compared, not computed", COMPARED),
    ("TUM104", numeric("N «%» 2 = 0"), "compared, not computed", COMPARED),
    ("TUM104", numeric("N > 2«%»"), "numbers have no unit", numeric("N > 2")),
    ("TUM104", numeric("N «>>» 2"), "write `>`", numeric("N > 2")),
    (
        "TUM105",
        numeric("«count»(N) > 1"),
        "`exactly one NAME in VALUE, VALUE: p`",
        numeric("exactly one V in 1, 2: N is {V}"),
    ),
]

TIMED = [
    ("TUM105", rule("«G» (S is a)"), "leave it out", rule("(S is a)")),
    ("TUM105", rule("«G» S is a"), "leave it out", rule("S is a")),
    ("TUM105", rule("«AG»(S is a)"), "leave it out", rule("(S is a)")),
    ("TUM104", rule("«[]» S is a"), "leave it out", rule("S is a")),
    ("TUM105", rule("«F» (S is a)"), "is a goal: `goal: PREDICATE`", goals("goal type: priority goal: (S is a)")),
    ("TUM105", rule("«X» (S is a)"), "let a variable say what happened before", rule("T is x")),
    ("TUM105", rule("S is a «U» T is x"), "let a variable say what happened before", rule("T is x")),
    ("TUM105", rule("S is a «until» T is x"), "let a variable say what happened before", rule("T is x")),
    (
        "TUM105",
        goals("goal type: priority goal: «reach» S is a"),
        "leave it out",
        goals("goal type: priority goal: S is a"),
    ),
    (
        "TUM104",
        goals("goal type: priority goal: «<>» S is a"),
        "leave it out",
        goals("goal type: priority goal: S is a"),
    ),
    ("TUM105", goals("goal type: priority goal: «maintain» S is a"), "`rule: PREDICATE`", rule("S is a")),
]

VALUES = [
    ("TUM105", rule("S is a «or» b"), "write `S in {a, b}`", rule("S in {a, b}")),
    ("TUM105", rule("T is x «or» y or z"), "write `T in {x, y, z}`", rule("T in {x, y, z}")),
    ("TUM105", rule("T is not x «or» y"), "write `T not in {x, y}`", rule("T not in {x, y}")),
    ("TUM105", rule("T is x «or» y AND S is a"), "write `T in {x, y}`", rule("T in {x, y} AND S is a")),
    ("TUM105", rule("S in «(»a, b)"), "write `S in {a, b}`", rule("S in {a, b}")),
    ("TUM105", rule("S not in «[»a, b]"), "write `S not in {a, b}`", rule("S not in {a, b}")),
    ("TUM105", rule("«in(»S, a)"), "there are no functions", rule("S is a")),
]


@pytest.mark.parametrize(
    ("code", "marked", "way_out", "typed"), [*COUNTING, *COMPUTING, *TIMED, *VALUES], ids=lambda each: str(each)[-60:]
)
def test_an_operator_has_a_way_out(code: str, marked: str, way_out: str, typed: str) -> None:
    """It is one error, at the place, with a way out that says what to write; what it says is read without an error."""
    check_habit(code, marked, way_out, typed)


def test_operators_are_names_where_names_stand() -> None:
    """A variable may be called `G`, `reach` or `next`: what is said about it is about its predicate."""
    for name in ("G", "reach", "next", "count"):
        case = unmark(rule(f"{name} «x»").replace("state S can", f"state {name} can be x state S can"))
        diagnostic = the("TUM105", case.text)
        assert diagnostic.span == case.span
        assert diagnostic.help == f"write `{name} is x`"


def test_two_dashes_begin_a_comment_where_nothing_is_counted() -> None:
    """`--` after a space begins a comment of another language."""
    case = unmark(rules("rule: S is a «--» always"))
    assert the("TUM104", case.text).help == "a comment begins with `//`"
