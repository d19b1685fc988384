"""Section 2 of docs/semantics.md: actions and what their effects denote."""

from tests.conformance.asking import Asked, faults, under_both
from tests.conformance.roles import Judge, Reader, Stepper
from tests.conformance.rules import rule
from tests.conformance.world import text


@rule("2.1")
def test_every_part_of_an_action_may_be_left_out(stepper: Stepper) -> None:
    """Then it may be executed anywhere, beside anything, and changes nothing."""
    asked = Asked(stepper, text({"x": "ab"}, ACTIONS="action idle action go nominal effects: x is b"))
    for state in "ab":
        assert asked.allowed(state) == ["", "idle", "go", "idle go"]
        assert asked.leads(state, "idle") == state


@rule("2.1")
def test_preconditions_and_alternatives_are_as_many_as_are_written(stepper: Stepper) -> None:
    """A comma between preconditions is an AND; each of several alternatives is one more thing that may happen."""
    actions = (
        "action both preconditions: x is a, y is a"
        " action other nominal effects: x is a alternative effects: x is b alternative effects: x is c"
    )
    for asked in under_both(stepper, text({"x": "abc", "y": "ab"}, ACTIONS=actions)):
        assert [asked.allows(state, "both") for state in ("aa", "ab", "ba", "bb")] == [True, False, False, False]
    for outcome in "abc":
        rules = f"rule: NOT (x is {outcome} AND y is a)"
        for asked in under_both(stepper, text({"x": "abc", "y": "ab"}, ACTIONS=actions, STATE_RULES=rules)):
            assert [asked.allows(state, "other") for state in ("aa", "bb")] == [False, True]


@rule("2.1")
def test_a_duration_that_is_not_written_is_zero(judge: Judge) -> None:
    """Of two ways out the one without a duration is shorter than the one that takes 1."""
    asked = text(
        {"x": "ab"},
        STATE_RULES="rule: x is a",
        ACTIONS="action quick effects: x is a action slow cost: 1 effects: x is a",
    )
    assert faults(judge, asked, {"a": "", "b": "slow"}) == {"minimal"}
    assert faults(judge, asked, {"a": "", "b": "quick"}) == set()


@rule("2.2")
def test_effects_change_what_they_mention_and_nothing_else(stepper: Stepper) -> None:
    """Whatever predicate singles out one assignment; a value may be written that is there already."""
    asked = Asked(
        stepper,
        text(
            {"x": "ab", "y": "abc"},
            ACTIONS="action one nominal effects: x is b"
            " action two nominal effects: NOT x is b, IF x is a THEN y is c"
            " action nothing nominal effects: none"
            " action empty nominal effects: alternative effects: none",
        ),
    )
    for before, one, two in (("aa", "ba", "ac"), ("bb", "bb", "ac"), ("ac", "bc", "ac")):
        assert asked.leads(before, "one") == one
        assert asked.leads(before, "two") == two
        assert asked.leads(before, "nothing") == asked.leads(before, "empty") == asked.leads(before, "") == before


@rule("2.3")
def test_nominal_effects_denote_exactly_one_assignment(reader: Reader) -> None:
    """To the variables that they mention: none and two are errors."""
    for effects, refused in (
        ("NOT x is a", True),
        ("NOT x is a, NOT x is b", False),
        ("x is a, x is b", True),
        ("x is a OR y is a", True),
        ("x is a AND y is a", False),
        ("NOT y is a", False),
    ):
        asked = text({"x": "abc", "y": "ab"}, ACTIONS=f"action go nominal effects: {effects}")
        assert reader.refuses(asked) is refused, effects


@rule("2.4")
def test_alternative_effects_denote_one_assignment_or_more(reader: Reader) -> None:
    """Several are no error, none is."""
    for effects, refused in (("NOT x is a", False), ("x is b", False), ("x is a, x is b", True)):
        actions = f"action go nominal effects: x is a alternative effects: {effects}"
        assert reader.refuses(text({"x": "abc"}, ACTIONS=actions)) is refused, effects


@rule("2.4")
def test_each_assignment_of_an_alternative_is_an_outcome(stepper: Stepper) -> None:
    """`NOT x is a` stands for two; a variable that it does not mention keeps its value in both."""
    actions = "action go nominal effects: x is a alternative effects: NOT x is a"
    for outcome, start, is_allowed in (("b", "aa", False), ("c", "aa", False), ("b", "ab", True), ("c", "ab", True)):
        rules = f"rule: NOT (x is {outcome} AND y is a)"
        for asked in under_both(stepper, text({"x": "abc", "y": "ab"}, ACTIONS=actions, STATE_RULES=rules)):
            assert asked.allows(start, "go") is is_allowed


@rule("2.5")
def test_an_action_is_without_effects_when_none_mentions_a_variable(stepper: Stepper) -> None:
    """Only then it may be executed where the state has to be left; writing what is there already is an effect."""
    for fields, beside in (
        ("", True),
        ("nominal effects: none alternative effects: none", True),
        ("nominal effects: y is a", False),
        ("nominal effects: none alternative effects: y is a", False),
    ):
        actions = f"action repair nominal effects: x is a action other {fields}"
        for asked in under_both(stepper, text({"x": "ab", "y": "ab"}, ACTIONS=actions, STATE_RULES="rule: x is a")):
            assert asked.allowed("ba") == ["repair", *(["repair other"] if beside else [])]


@rule("2.5")
def test_an_action_may_take_any_of_its_effects(stepper: Stepper) -> None:
    """The nominal one and every alternative one can happen; where it nominally leads, the nominal one alone says."""
    actions = "action go nominal effects: x is b alternative effects: x is c alternative effects: none"
    for unsafe, is_allowed in (("a", False), ("b", False), ("c", False), ("d", True)):
        rules = f"rule: NOT (x is {unsafe} AND y is b)"
        variables = {"x": "abcd", "y": "ab"}
        for asked in under_both(stepper, text(variables, ACTIONS=actions, STATE_RULES=rules)):
            assert asked.leads("aa", "go") == "ba"
            assert asked.allows("aa", "go")
            assert asked.allows("ab", "go") is is_allowed


@rule("2.6")
def test_clauses_are_read_where_the_action_starts(stepper: Stepper) -> None:
    """What holds there adds to what stands before all clauses, also when another action takes effect first."""
    actions = (
        "action go nominal effects: x is b when y is a: z is b when x is b AND y is b: z is c"
        " alternative effects: none when y is b: x is c"
        " action other nominal effects: y is b"
    )
    variables = {"x": "abc", "y": "ab", "z": "abc"}
    for asked in under_both(stepper, text(variables, ACTIONS=actions, STATE_RULES="rule: NOT x is c")):
        assert [asked.leads(state, "go") for state in ("aaa", "aba", "bba")] == ["bab", "bba", "bbc"]
        assert [asked.allows(state, "go") for state in ("aaa", "aba")] == [True, False]
        assert asked.allows("aaa", "go other")
        assert asked.leads("aaa", "go other") == "bbb"


@rule("2.7")
def test_relative_effects_stay_within_the_values(stepper: Stepper) -> None:
    """Each value has its own result; beyond the largest and the smallest the value stays there."""
    actions = (
        "action up nominal effects: n is n + 2 action down nominal effects: n is n - 1"
        " action some nominal effects: none when y is a: n is n + 1"
    )
    asked = Asked(stepper, text({"n": "0123", "y": "ab"}, ACTIONS=actions))
    for name, ends in (("up", "2333"), ("down", "0012"), ("some", "1233")):
        assert "".join(asked.leads(f"{start}a", name)[0] for start in range(4)) == ends
    assert "".join(asked.leads(f"{start}b", "some")[0] for start in range(4)) == "0123"
