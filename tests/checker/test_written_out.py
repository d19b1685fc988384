"""The stand-alone checker reads sets, comparisons, quantifiers and copies as the text that they stand for."""

# ruff: noqa: E501 - the texts of one pair stand on a line each

from __future__ import annotations

import pytest

from tests.checker.standalone import checker
from tests.readers.meaning import deep
from tests.shorthand import shorthand

STATES = """BEGIN STATE VECTOR
state P can be dock, hall, yard
state N can be 0, 1, 2, 3
state M can be 3, 1, 0
state L can be 5
state D_r1 can be yes, no
state D_r2 can be yes, no
state D_r3 can be yes, no
END STATE VECTOR
"""


def digest(text: str) -> str:
    """The digest that the checker computes."""
    with deep():
        found: str = checker.digest(checker.read_specification(text.encode()))
    return found


def rule(predicate: str) -> str:
    """A specification with one state rule."""
    return f"{STATES}BEGIN STATE RULES rule: {predicate} END STATE RULES"


def block(title: str, entries: str) -> str:
    """A specification with one more block."""
    return f"{STATES}BEGIN {title} {entries} END {title} "


def goals(members: str) -> str:
    """A specification with goals."""
    return block("GOALS", f"goal type: priority {members}")


PREDICATES = [
    ("P is not dock", "NOT P is dock"),
    ("P in {dock}", "P is dock"),
    ("P in {dock} AND P is hall", "P is dock AND P is hall"),
    ("P in { yard, dock }", "P is dock OR P is yard"),
    ("P in {yard, dock, yard}", "P is dock OR P is yard"),
    ("P in {dock, hall, yard}", "P is dock OR P is hall OR P is yard"),
    ("P not in {yard, dock}", "NOT (P is dock OR P is yard)"),
    ("P not in {yard}", "NOT P is yard"),
    ("P in {yard, dock} OR N is 1", "(P is dock OR P is yard) OR N is 1"),
    ("NOT P is not dock", "NOT NOT P is dock"),
    ("N in {2..3}", "N is 2 OR N is 3"),
    ("N in {3, 0..1, 1..1}", "N is 0 OR N is 1 OR N is 3"),
    ("M in {-7..1}", "M is 1 OR M is 0"),
    ("N in {-100000000000000000..2}", "N is 0 OR N is 1 OR N is 2"),
    ("N = 2", "N is 2"),
    ("N != 2", "NOT N is 2"),
    ("N<2", "N is 0 OR N is 1"),
    ("N <= 2", "N is 0 OR N is 1 OR N is 2"),
    ("M > 0", "M is 3 OR M is 1"),
    ("N >= 3", "N is 3"),
    ("N < 0", "false"),
    ("N >= -4", "true"),
    ("N > 17 OR N < 1", "false OR N is 0"),
    ("L = 5", "L is 5"),
    ("L != 5", "NOT L is 5"),
    ("L >= 5", "true"),
    ("N < M", "(N is 0 AND (M is 3 OR M is 1)) OR (N is 1 AND M is 3) OR (N is 2 AND M is 3)"),
    ("M > N", "(M is 3 AND (N is 0 OR N is 1 OR N is 2)) OR (M is 1 AND N is 0)"),
    ("M >= N", "M is 3 OR (M is 1 AND (N is 0 OR N is 1)) OR (M is 0 AND N is 0)"),
    ("L < N", "false"),
    ("N < L", "N is 0 OR N is 1 OR N is 2 OR N is 3"),
    ("N = M", "(N is 0 AND M is 0) OR (N is 1 AND M is 1) OR (N is 3 AND M is 3)"),
    ("M != N", "(M is 3 AND NOT N is 3) OR (M is 1 AND NOT N is 1) OR (M is 0 AND NOT N is 0)"),
    ("N != M", "(N is 0 AND NOT M is 0) OR (N is 1 AND NOT M is 1) OR N is 2 OR (N is 3 AND NOT M is 3)"),
    ("L = L", "L is 5"),
    ("L != L", "false"),
    ("all R in r1, r2: D_{R} is yes", "D_r1 is yes AND D_r2 is yes"),
    ("all R in r1, r2: D_{R} is yes OR P is dock", "(D_r1 is yes OR P is dock) AND (D_r2 is yes OR P is dock)"),
    ("some R in {r3, r1}: NOT D_{R} is yes", "NOT D_r3 is yes OR NOT D_r1 is yes"),
    ("some R in r2: D_{R} is yes", "D_r2 is yes"),
    ("some R in {r2}: D_{R} is yes", "D_r2 is yes"),
    (
        "exactly one R in r1, r2, r3: D_{R} is yes",
        "(D_r1 is yes AND NOT D_r2 is yes AND NOT D_r3 is yes) OR (D_r2 is yes AND NOT D_r1 is yes AND NOT D_r3 is yes)"
        " OR (D_r3 is yes AND NOT D_r1 is yes AND NOT D_r2 is yes)",
    ),
    ("exactly one R in r1: D_{R} is yes", "D_r1 is yes"),
    ("exactly one R in r1 where R != r1: D_{R} is yes", "false"),
    ("some R in r1 where R != r1: D_{R} is yes", "false"),
    ("all R in r1 where R != r1: D_{R} is yes OR nobody", "true"),
    ("all R in r1, r2, r3 where R != r2: D_{R} is yes", "D_r1 is yes AND D_r3 is yes"),
    (
        "all A in r1, r2, r3, B in {r1, r2, r3} where A < B: D_{A} is yes OR D_{B} is yes",
        "(D_r1 is yes OR D_r2 is yes) AND (D_r1 is yes OR D_r3 is yes) AND (D_r2 is yes OR D_r3 is yes)",
    ),
    (
        "all A in 1..3, B in 1..3 where A+1 = B: N is {A} OR N is {B}",
        "(N is 1 OR N is 2) AND (N is 2 OR N is 3)",
    ),
    ("some F in 0..2 where F >= 1, F <= 1: N is {F+1} OR N is {F-1}", "N is 2 OR N is 0"),
    ("P is dock AND all R in r1, r2: D_{R} is yes OR N is 1", "P is dock AND ((D_r1 is yes OR N is 1) AND (D_r2 is yes OR N is 1))"),
    ("NOT all R in r1: D_{R} is yes AND N is 1", "NOT (D_r1 is yes AND N is 1)"),
    ("all R in r1: D_{R} is yes IFONLYIF N is 1", "D_r1 is yes IFONLYIF N is 1"),
    ("IF some R in r1, r2: D_{R} is yes THEN N is 1", "IF D_r1 is yes OR D_r2 is yes THEN N is 1"),
    ("(some R in r1, r2: D_{R} is yes) AND N is 1", "(D_r1 is yes OR D_r2 is yes) AND N is 1"),
    (
        "all R in r1, r2: some F in 0..1: D_{R} is yes OR N is {F}",
        "((D_r1 is yes OR N is 0) OR (D_r1 is yes OR N is 1)) AND ((D_r2 is yes OR N is 0) OR (D_r2 is yes OR N is 1))",
    ),
    ("all V in dock, hall: P in {{V}, yard}", "(P is dock OR P is yard) AND (P is hall OR P is yard)"),
    ("all F in 1..2: N in {{F}..3}", "(N is 1 OR N is 2 OR N is 3) AND (N is 2 OR N is 3)"),
    ("all F in 1..2: N < {F}", "N is 0 AND (N is 0 OR N is 1)"),
    ("all F in 1..2: N is {F}", "N is 1 AND N is 2"),
]  # fmt: skip
"""Predicates, and what they stand for."""

ROBOTS = "BEGIN ALIASES define ROBOTS as {r1, r2, r3} END ALIASES"

TEXTS = [
    (
        STATES.replace("state N can be 0, 1, 2, 3", "state N can be 0..3").replace("state L can be 5", "state L can be 5..5"),
        STATES,
    ),
    (
        "BEGIN STATE VECTOR state S can be -2..0, on, 7 for R in r1, r2 state S_{R} can be {R}, at_{R} end for END STATE VECTOR",
        "BEGIN STATE VECTOR state S can be -2, -1, 0, on, 7 state S_r1 can be r1, at_r1 state S_r2 can be r2, at_r2 END STATE VECTOR",
    ),
    (
        "BEGIN STATE VECTOR for F in 1..2 state S_{F} can be 0..{F} end for END STATE VECTOR",
        "BEGIN STATE VECTOR state S_1 can be 0, 1 state S_2 can be 0, 1, 2 END STATE VECTOR",
    ),
    (  # one word in braces is that word, whatever list has the name
        "BEGIN STATE VECTOR for R in {ROBOTS} state S_{R} can be a, b end for END STATE VECTOR " + ROBOTS,
        "BEGIN STATE VECTOR state S_ROBOTS can be a, b END STATE VECTOR",
    ),
    (
        block("STATE RULES", "for R in ROBOTS where R > r1 rule: D_{R} is yes end for severity: 2 rule: N is 1") + ROBOTS,
        block("STATE RULES", "rule: D_r2 is yes rule: D_r3 is yes severity: 2 rule: N is 1"),
    ),
    (
        block("STATE RULES", "for R in ROBOTS, Q in r1, r2, r3 where R < Q rule: D_{R} is yes OR D_{Q} is yes end for") + ROBOTS,
        block("STATE RULES", "rule: D_r1 is yes OR D_r2 is yes rule: D_r1 is yes OR D_r3 is yes rule: D_r2 is yes OR D_r3 is yes"),
    ),
    (
        block("ALIASES", "for F in 0..2 define low_{F} as N in {0..{F}} end for define k as low_1"),
        STATES,
    ),
    (
        block("ALIASES", "for F in 0..2 define low_{F} as N in {0..{F}} end for")
        + "BEGIN ASSUMPTIONS for F in 0..1 for G in 0..1 where G = F assume: low_{F} OR low_{G+1} end for end for END ASSUMPTIONS",
        block("ASSUMPTIONS", "assume: N is 0 OR (N is 0 OR N is 1) assume: (N is 0 OR N is 1) OR (N is 0 OR N is 1 OR N is 2)"),
    ),
    (
        block("RESOURCES", "for R in r1, r2 resource MOTOR_{R} end for")
        + "BEGIN ACTIONS for R in r1, r2, D in 3 action go_{R} duration: {D} controlled resources: MOTOR_{R} preconditions:"
        " nominal effects: D_{R} is yes end for action rest END ACTIONS",
        block("RESOURCES", "resource MOTOR_r1 resource MOTOR_r2")
        + "BEGIN ACTIONS action go_r1 duration: 3 controlled resources: MOTOR_r1 nominal effects: D_r1 is yes"
        " action go_r2 duration: 3 controlled resources: MOTOR_r2 nominal effects: D_r2 is yes action rest END ACTIONS",
    ),
    (
        block("ACTIONS", "action go for V in hall, yard where V != yard alternative effects: P is {V} end for duration: 2"
              " for F in 1 for G in 2 action go_{F}_{G} preconditions: none end for end for"),
        block("ACTIONS", "action go alternative effects: P is hall duration: 2 action go_1_2"),
    ),
    (
        block("ACTIONS", "for R in r1 action go_{R} effects: end for action on preconditions: for R in r2 effects: N is 2 end for"),
        block("ACTIONS", "action go_r1 action on effects: N is 2"),
    ),
    (
        block("ACTIONS", "for R in r1, r2 action go_{R} end for")
        + "BEGIN REACTION RULES rule: all R in r1, r2: NOT executing go_{R} END REACTION RULES",
        block("ACTIONS", "action go_r1 action go_r2")
        + "BEGIN REACTION RULES rule: NOT executing go_r1 AND NOT executing go_r2 END REACTION RULES",
    ),
    (
        goals("for R in r1, r2 when N > 2 then goal: D_{R} is yes BEGIN GOALS goal type: constraint for F in 1..2 goal: N is {F}"
              " end for END GOALS end for goal: P is dock"),
        goals("when N is 3 then goal: D_r1 is yes BEGIN GOALS goal type: constraint goal: N is 1 goal: N is 2 END GOALS"
              " when N is 3 then goal: D_r2 is yes BEGIN GOALS goal type: constraint goal: N is 1 goal: N is 2 END GOALS"
              " goal: P is dock"),
    ),
    (block("CONFIG", "for F in 6 max_plan_length: {F} end for"), block("CONFIG", "max_plan_length: 6")),
    (block("STATE RULES", "for R in r1, r2 where R = r1, R = r2 rule: nobody is {R} end for"), STATES),
    (block("STATE RULES", "for R in r1 end for"), STATES),
]  # fmt: skip
"""Texts with copies, and written out."""

OLD = [
    "BEGIN STATE VECTOR state all can be in, not, for state some can be not END STATE VECTOR BEGIN ALIASES define to as all is in"
    " define end as all is not define for as end define where as some is not END ALIASES BEGIN ACTIONS action not preconditions: all"
    " is not action in preconditions: for action go effects: all is not duration: 3 END ACTIONS BEGIN STATE RULES rule: all is not"
    " rule: some is not OR for rule: end END STATE RULES BEGIN GOALS goal type: priority when all is not then goal: all is not when to"
    " then goal: for END GOALS",
]
"""The new words are names wherever they were."""

WRONG_PREDICATES = [
    "P is not", "P is not nowhere", "P in {}", "P in {dock", "P in dock", "P in {nowhere}", "P in {dock, 1}", "P in {1..2}", "P not {dock}",
    "P in{dock}", "P is in {dock}", "N in {4..9}", "N in {2..1}", "N in {dock..2}", "N in {0..1..2}", "N is 4", "N = 4", "N != 4",
    "N is 01", "N is -0", "N is +1", "N is - 1", "N < 01", "N < -0", "N < +3", "N < P", "P < N", "P < 3", "P = dock", "P != 3", "N < nobody",
    "N < 1234567890123456789", "3 < N", "N < 2 < 3", "N == 2", "N is {F}", "N is 3{", "N is {3}", "D_{R} is yes", "N is 1.0", "N = 1.0",
    "all R in r1, r2 D_{R} is yes", "all R in r1: ", "all R: N is 1", "all in r1: N is 1", "all R in : N is 1", "all R in r1, r1: N is 1",
    "all R in r1, R in r2: N is 1", "all R in r1: all R in r2: N is 1", "all R in 2..1: N is 1", "all R in r1, r4: D_{R} is yes",
    "all R in r1: D_{Q} is yes", "all R in r1: D_{R+1} is yes", "all R in r1: D_{ R } is yes", "all F in 1: N is {F + 1}",
    "all F in 0: D_{F-1} is yes", "all F in 1: N is {F+01}", "all F in 1: N is 0{F}", "all F in a{F}: N is 1", "all F in 1..{F}: N is 1",
    "all F in 1: all G in 1..{F}: N is 1", "all is in r1: N is 1", "all for in r1: N is 1", "exactly two R in r1: N is 1",
    "exactly one R in r1: N is 4", "all R in true: {R}", "all R in AN: P is dock {R}D P is hall", "all R in r1 where: N is 1",
    "all R in r1 where R: N is 1", "all R in r1 where R = r2: N is 1", "all R in r1 where Q = R: N is 1", "all R in r1 where r1 = r1: N is 1",
    "all R in r1 where R < 1: N is 1", "all F in 1 where F < r1: N is 1", "all R in r1 where R+1 = 2: N is 1", "all F in 1 where F < 01: N is 1",
    "all F in 1 where F + 1 < 2: N is 1", "all F in 1 where 2 +1 = F: N is 1", "all A in r1, B in r1, r2 where A < B: N is 1",
    "all R in r1 where {R} = r1: N is 1", "all R in r1 where R = r1 AND R = r1: N is 1", "all R in r1 where R != r1: D_{Q} is yes",
    "all R in r1 where R != r1: D_{R} is", "N is 1 OR IF all R in r1: N is 1 THEN N is 1", "all A in 1..1001, B in 1..1000: N is 1",
    "all F in 1..1000001: N is 1",
]  # fmt: skip
"""Predicates with a mistake."""

NEVER = "for Q in r1 where Q != Q"
WRONG_TEXTS = [
    *(
        f"{STATES}BEGIN STATE RULES {NEVER} {header} rule: N is 1 end for end for END STATE RULES"
        for header in (
            "for R in r1, r1",
            "for R in 2..1",
            "for R in 0..b",
            "for R in r1 where R = r2",
            "for R in r1 where S = 1",
            "for R in 1 where R+01 > 1",
            "for R in 1 where R+0 > 1",
            "for Q in r1",
            "for R in Q where {R} = 1",
        )
    ),
    f"{STATES}BEGIN STATE RULES {NEVER} rule: N is 01 end for END STATE RULES",
    f"{STATES}BEGIN STATE RULES rule: all Q in r1 where Q != Q: some R in r1, r1: N is 1 END STATE RULES",
    "BEGIN STATE VECTOR state S can be 3..1 END STATE VECTOR",
    "BEGIN STATE VECTOR state S can be 0..10000 END STATE VECTOR",
    "BEGIN STATE VECTOR state S can be 0..5000, 10000..15000 END STATE VECTOR",
    "BEGIN STATE VECTOR state S can be 0..999999999999999999 END STATE VECTOR",
    "BEGIN STATE VECTOR state S can be 0..2, 1 END STATE VECTOR",
    "BEGIN STATE VECTOR state S can be a..b END STATE VECTOR",
    "BEGIN STATE VECTOR state S can be 007 END STATE VECTOR",
    "BEGIN STATE VECTOR state S can be -0 END STATE VECTOR",
    "BEGIN STATE VECTOR state S can be {a} END STATE VECTOR",
    "BEGIN STATE VECTOR state 3 can be a END STATE VECTOR",
    "BEGIN STATE VECTOR for R in r1, r2 state S can be {R} end for END STATE VECTOR",
    "BEGIN STATE VECTOR for R in r1, r2 state S_{R} can be {R} END STATE VECTOR",
    "BEGIN STATE VECTOR for R in r1, r2 state S_{R} can be {R} end for end for END STATE VECTOR",
    "BEGIN STATE VECTOR for R in true state {R} can be a end for END STATE VECTOR",
    "BEGIN STATE VECTOR for F in 1..101 state S_{F} can be 0..9999 end for END STATE VECTOR",
    "for R in r1 BEGIN STATE VECTOR state S_{R} can be a END STATE VECTOR end for",
    block("STATE RULES", "for R in r1 severity: 2 rule: D_{R} is yes end for"),
    block("STATE RULES", "for R in r1 for R in r2 rule: D_{R} is yes end for end for"),
    block("STATE RULES", "for R in r1 rule: D_{R} is yes end"),
    block("STATE RULES", "for A in 1..1001, B in 1..1000 where A = B end for"),
    block("STATE RULES", "for A in r1 " * 101 + "end for " * 101),
    block("STATE RULES", " ".join(f"for A{n} in r1" for n in range(101)) + " end for" * 101),
    block("STATE RULES", "rule: end for"),
    block("ALIASES", "define k as {}"),
    block("ALIASES", "define k as {a, a}"),
    block("ALIASES", "define k as {a} define k as {b}"),
    block("ALIASES", "define k as {a} define k as P is dock"),
    block("ALIASES", "define P as {a}"),
    block("ALIASES", "for R in r1 define k as {a} end for"),
    block("ALIASES", "for R in r1 define k_{R} as {a} end for"),
    block("ALIASES", "define k as {a}") + "BEGIN STATE RULES rule: k END STATE RULES",
    block("ALIASES", "for R in r1, r2 define k as P is dock end for"),
    block("ACTIONS", "action go for V in hall, yard effects: P is {V} end for"),
    block("ACTIONS", "action go for V in hall effects: P is {V} action on end for"),
    block("ACTIONS", "for V in hall effects: P is {V} end for"),
    block("ACTIONS", "for F in 1..2 action go_{F} duration: {F-2} end for"),
    block("ACTIONS", "for R in r1 action go_{R} duration: {R} end for"),
    block("CONFIG", "for F in 0..1 max_plan_length: {F} end for"),
    block("CONFIG", "for F in 1..2 max_plan_length: {F} end for"),
    block("CONFIG", "max_plan_length: +3"),
    goals("for R in r1, r2 goal: D_{R} is yes"),
    block("GOALS", "for R in r1, r2 goal type: priority goal: D_{R} is yes end for"),
]
"""Texts with a mistake."""


@pytest.mark.parametrize(("short", "long"), [(rule(one), rule(other)) for one, other in PREDICATES] + TEXTS)
def test_it_is_read_as_it_is_written_out(short: str, long: str) -> None:
    """Both texts have one digest."""
    assert digest(short) == digest(long)


@pytest.mark.parametrize("text", OLD)
def test_the_new_words_are_names(text: str) -> None:
    """Files that were right before are right, and mean the same."""
    spec = checker.read_specification(text.encode())
    assert list(spec.actions) == ["not", "in", "go"]
    assert len(spec.state_rules) == 3
    assert len(spec.aliases) == 4


@pytest.mark.parametrize("text", [*map(rule, WRONG_PREDICATES), *WRONG_TEXTS])
def test_it_is_refused(text: str) -> None:
    """A mistake is found, whatever is a limit at once."""
    with deep(), pytest.raises(checker.Unreadable):
        checker.read_specification(text.encode())


def test_a_rule_in_a_copy_keeps_its_line() -> None:
    """Each copy of a rule stands where it was written."""
    spec = checker.read_specification(
        (STATES + "BEGIN STATE RULES\nfor R in r1, r2\nrule: D_{R} is yes\nend for\nEND STATE RULES").encode()
    )
    assert [line for _, line in spec.state_rules] == [12, 12]


def test_what_is_too_much_is_refused_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """Entries are counted while they come, terms before they do."""
    many = block("RESOURCES", "for A in 1..10, B in 1..10 resource R_{A}_{B} end for")
    monkeypatch.setattr(checker, "MOST_ENTRIES", 107)
    assert len(checker.read_specification(many.encode()).resources) == 100
    monkeypatch.setattr(checker, "MOST_ENTRIES", 106)
    with pytest.raises(checker.Unreadable, match="more than 106 entries"):
        checker.read_specification(many.encode())
    wide = "BEGIN STATE VECTOR state W can be 0..9999 state V can be 0..9999 END STATE VECTOR BEGIN STATE RULES rule: {} END STATE RULES"
    for predicate in ("all F in 1..10: W in {0..9999}", "W < V", "exactly one F in 1..300: V = {F}"):
        with pytest.raises(checker.Unreadable, match="when it is written out"):
            checker.read_specification(wide.replace("{}", predicate).encode())
    monkeypatch.setattr(checker, "MOST_TERMS_IN_ALL", 100)
    aliases = block("ALIASES", "for A in 1..21 define k_{A} as N >= 0 AND P in {dock, hall} end for")
    with pytest.raises(checker.Unreadable, match="all predicates together"):
        checker.read_specification(aliases.encode())


@pytest.mark.parametrize("block_of_seeds", range(4))
def test_random_texts_are_read_as_they_are_written_out(block_of_seeds: int) -> None:
    """Texts in short have the digest of those in full."""
    for seed in range(block_of_seeds * 10, block_of_seeds * 10 + 10):
        short, long = shorthand(seed)
        assert digest(short) == digest(long), seed
