"""Copies and quantifiers mean what the text written out means, and mistakes in them are told in the user's line."""

import pytest

from tests.spec.copied import differs
from tests.spec.marked import FULL, VECTOR, codes, loaded, unmark
from tumato_symbolic.spec import And, Constant, Formula, Is, Not, Or
from tumato_symbolic.syntax.nesting import MAX_NESTING

A, B = Is(0, 0), Is(0, 1)


def test_short_and_written_out_texts_mean_the_same() -> None:
    """Same digest, same numbers, same formulas, in the same order."""
    assert not [seed for seed in range(60) if differs(seed)]


def formula(predicate: str) -> Formula:
    """What a state rule means."""
    found = loaded(f"{FULL}BEGIN STATE RULES rule: {predicate} END STATE RULES").spec
    assert found is not None
    return found.state_rules[0].formula


@pytest.mark.parametrize(
    ("predicate", "meaning"),
    [
        ("all V in a, b: S is {V}", And((A, B))),
        ("some V in {a, b}: S is {V}", Or((A, B))),
        ("exactly one V in a, b: S is {V}", Or((And((A, Not(B))), And((B, Not(A)))))),
        ("all V in a, b where V != a: S is {V}", B),
        ("all V in {a}: S is {V}", A),
        ("all V in a, b where V != a, V != b: S is {V}", Constant(True)),
        ("some V in a, b where V != a, V != b: S is {V}", Constant(False)),
        ("S is a AND all V in a, b: S is {V} OR S is a", And((A, And((Or((A, A)), Or((B, A))))))),
        ("NOT some V in a, b: S is {V}", Not(Or((A, B)))),
    ],
)
def test_quantifiers_are_written_out(predicate: str, meaning: Formula) -> None:
    """In the order of the values; the body goes as far as it can."""
    assert formula(predicate) == meaning


def test_soft_words_stay_names() -> None:
    """`for`, `in`, `all` and the like name values, variables and aliases where no copies can be meant."""
    text = """BEGIN STATE VECTOR state for can be end, all state all can be some, one, not END STATE VECTOR
    BEGIN ALIASES define end as for is end define exactly as all is not define some as all is one END ALIASES
    BEGIN ACTIONS action where preconditions: for is end, end, exactly nominal effects: for is all
    action in preconditions: action one nominal effects: all is some END ACTIONS
    BEGIN STATE RULES rule: end OR exactly OR some OR NOT end OR all in {some} END STATE RULES"""
    found = loaded(text).spec
    assert found is not None
    assert [each.name for each in found.actions] == ["where", "in", "one"]


def rules(text: str) -> str:
    """State rules in a complete specification."""
    return f"{FULL}BEGIN STATE RULES {text} END STATE RULES"


MISTAKES = [
    ("TUM201", rules("for V in a, b rule: S is «{W}» end for"), "the parameters are `V`"),
    ("TUM201", rules("rule: S is «{W}»"), "inside `for`"),
    ("TUM201", rules("for V in a, b where V != «c» rule: S is {V} end for"), "the values are `a` and `b`"),
    ("TUM202", rules("for V in a, c rule: S is «{V}» end for"), "its values are"),
    ("TUM203", rules("for V in a, «a» rule: S is {V} end for"), "remove one"),
    ("TUM203", rules("for V in a, b for «V» in a, b rule: S is {V} end for end for"), "another name"),
    ("TUM205", rules("for «where» in a rule: S is {where} end for"), "another name"),
    ("TUM113", rules("for N in 1..2 rule: «{N}» is a end for"), None),
    ("TUM316", rules("for V in a rule: S is «{V+1}» end for"), "only parameters that are numbers"),
    (
        "TUM316",
        rules("for V in a, b, W in b, a where «V < W» rule: S is {V} OR S is {W} end for"),
        "places in one list",
    ),
    ("TUM316", rules("for N in 1..2 for V in «x{N}», a rule: S is {V} end for end for"), None),
    ("TUM114", rules("for N in 1..2 where N«+01» > 2 rule: S is a end for"), "write `+1`"),
    ("TUM114", rules("for N in 1..2 where N«-0» > 1 rule: S is a end for"), "leave it out"),
    ("TUM114", rules("for N in 1..2 rule: S_{N«+01»} is a end for"), "write `+1`"),
    ("TUM114", rules("for V in a where V != V rule: S is «03» end for"), "write `3`"),
    ("TUM314", rules("for V in a where V != V for N in «2..1» rule: S is a end for end for"), "write `1..2`"),
    ("TUM201", rules("for V in a where V != V for N in 1..2 where N < «x» rule: S is a end for end for"), "values are"),
    ("TUM203", rules("for V in a where V != V for W in b, «b» rule: S is {W} end for end for"), "remove one"),
    ("TUM314", rules("for N in «2..1» rule: S is a end for"), "write `1..2`"),
    ("TUM311", rules("for N in 1..2000, M in 1..2000 rule: S_{N} is {M} end for"), "fewer parameters"),
    ("TUM311", rules("for N in «1..99999999999» rule: S_{N} is a end for"), "fewer parameters"),
]


@pytest.mark.parametrize(("code", "marked", "way_out"), MISTAKES, ids=lambda each: str(each)[-50:])
def test_a_mistake_is_told_once_in_its_line(code: str, marked: str, way_out: str | None) -> None:
    """One error at the place in the text, however many copies have it."""
    case = unmark(marked)
    (found,) = [each for each in loaded(case.text).diagnostics if each.severity == "error"]
    assert found.code.name == code
    assert case.span is None or found.span == case.span
    assert way_out is None or way_out in (found.help or "")


def test_the_message_says_which_copy_and_how_many_more() -> None:
    """The first one in the order of the copies."""
    found = loaded(rules("for V in a, c, d, N in 1..2 rule: S is {V} OR {N} is a end for"))
    assert "TUM113" in [each.code.name for each in found.diagnostics]
    (found_value,) = [
        each
        for each in loaded(rules("for V in a, c, d rule: S is {V} end for")).diagnostics
        if each.severity == "error"
    ]
    assert found_value.message == "`S` has no value `c` (with V = c, and 1 more copy)"


def test_a_name_that_comes_out_twice_names_both() -> None:
    """The second copy is to blame, a note shows the first."""
    copied = "for A in x, y, B in y, x state S_{A}_{B} can be a state S_x_y can be b end for"
    text = f"BEGIN STATE VECTOR {copied} END STATE VECTOR"
    found = [each for each in loaded(text).diagnostics if each.code.name == "TUM203"]
    assert found
    assert "(with A = x, B = y" in found[0].message


def test_parameters_without_use_and_copies_without_number() -> None:
    """Warnings, once each."""
    text = rules("for V in a, b, W in a, b where V != V rule: S is {V} end for")
    assert sorted(codes(text)) == ["TUM329", "TUM330"]


def test_the_text_of_a_copy_has_the_values_of_its_parameters() -> None:
    """Reports show what was copied as it would be written."""
    found = loaded(rules("for V in a, b rule: NOT (S is {V} AND T is z) end for")).spec
    assert found is not None
    assert [each.text for each in found.state_rules] == ["NOT (S is a AND T is z)", "NOT (S is b AND T is z)"]


def nested(depth: int) -> str:
    """Copies in copies."""
    opened = "".join(f"for P{number} in a " for number in range(depth))
    return rules(f"{opened} rule: S is {{P0}} {'end for ' * depth}")


HOSTILE = [
    ("TUM311", rules("for N in 1..900000 rule: S is a end for")),
    ("TUM311", rules("".join(f"for P{n} in 1..10 " for n in range(60)) + "rule: S is a" + " end for" * 60)),
    ("TUM311", rules("rule: exactly one N in 1..3000: S is a")),
    ("TUM311", rules("for N in 1..1000 rule: all M in 1..999 where M != N: S is a OR S is b end for")),
    ("TUM115", nested(MAX_NESTING + 1)),
    ("TUM115", nested(5000)),
]


@pytest.mark.parametrize(("code", "text"), HOSTILE, ids=[str(number) for number in range(len(HOSTILE))])
def test_hostile_copies_end_in_a_diagnostic(code: str, text: str) -> None:
    """Counted before anything is made."""
    assert code in [each.code.name for each in loaded(text).diagnostics]


def test_a_mistake_in_a_copy_does_not_hide_others() -> None:
    """The syntax of what follows is read on."""
    text = f"{VECTOR} BEGIN STATE RULES for V in a, b rule: S is rule: S is {{V}} end for rule: S b END STATE RULES"
    assert [each.code.name for each in loaded(text).diagnostics] == ["TUM105", "TUM105"]


def test_a_quantifier_of_one_copy_stands_where_it_was_written() -> None:
    """Its rule begins with it, as where there are several copies."""
    found = loaded(rules("rule: (all V in a:\nS is {V})")).spec
    assert found is not None
    (rule,) = found.state_rules
    assert rule.text == "(all V in a: S is {V})"
