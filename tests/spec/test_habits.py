"""What people write who know other languages: each has a way out, and what it proposes is read when it is typed."""

import pytest

from tests.spec.marked import FULL, VECTOR, loaded, the, unmark
from tests.spec.test_mistakes import action, config, numeric, rule


def goals(text: str) -> str:
    """A list of goals after a state vector."""
    return f"{VECTOR}\nBEGIN GOALS\n{text}\nEND GOALS\n"


def reaction(predicate: str) -> str:
    """A reaction rule in a complete specification."""
    return f"{FULL}BEGIN REACTION RULES\nrule: {predicate}\nEND REACTION RULES\n"


def vector(text: str) -> str:
    """A state vector alone."""
    return f"BEGIN STATE VECTOR {text} END STATE VECTOR"


def rules(text: str) -> str:
    """A block of state rules in a complete specification."""
    return f"{FULL}BEGIN STATE RULES\n{text}\nEND STATE RULES\n"


PREDICATES = [
    ("TUM105", rule("«WHEN» S is a THEN T is x"), "write `IF p THEN q`", rule("IF S is a THEN T is x")),
    ("TUM105", rule("«when» S is a then T is x"), "write `IF p THEN q`", rule("IF S is a THEN T is x")),
    ("TUM105", rule("«Whenever» (S is a) THEN T is x"), "write `IF p THEN q`", rule("IF (S is a) THEN T is x")),
    ("TUM105", rule("T is x «WHEN» S is a"), "`IF p THEN q`", rule("IF S is a THEN T is x")),
    ("TUM105", rule("T is x «IF» S is a"), "`IF p THEN q`", rule("IF S is a THEN T is x")),
    ("TUM105", rule("S is a «THEN» T is x"), "begin with `IF`", rule("IF S is a THEN T is x")),
    ("TUM105", rule("T is x «UNLESS» S is a"), "write `IF NOT (p) THEN q`", rule("IF NOT (S is a) THEN T is x")),
    (
        "TUM105",
        rule("IF S is a THEN T is x «ELSE» T is y"),
        "write `(IF p THEN q) AND (IF NOT (p) THEN r)`",
        rule("(IF S is a THEN T is x) AND (IF NOT (S is a) THEN T is y)"),
    ),
    (
        "TUM105",
        rule("IF S is a THEN T is x «else» IF S is b THEN T is y"),
        "write `(IF p THEN q) AND (IF NOT (p) THEN r)`",
        rule("(IF S is a THEN T is x) AND (IF NOT (S is a) THEN (IF S is b THEN T is y))"),
    ),
    ("TUM105", rule("S is a «implies» T is x"), "write `IF p THEN q`", rule("IF S is a THEN T is x")),
    ("TUM104", rule("S is a «=>» T is x"), "write `IF p THEN q`", rule("IF S is a THEN T is x")),
    ("TUM104", rule("S is a «->» T is x"), "write `IF p THEN q`", rule("IF S is a THEN T is x")),
    ("TUM105", rule("S is a «iff» T is x"), "write `IFONLYIF`", rule("S is a IFONLYIF T is x")),
    ("TUM105", rule("S is a «XOR» T is x"), "`NOT (p IFONLYIF q)`", rule("NOT (S is a IFONLYIF T is x)")),
    ("TUM105", rule("«always» S is a"), "leave it out", rule("S is a")),
    ("TUM105", rule("«never» (S is a AND T is x)"), "write `NOT (PREDICATE)`", rule("NOT (S is a AND T is x)")),
    ("TUM104", rule("S is a «&&» S is b"), "write `AND`", rule("S is a AND S is b")),
    ("TUM104", rule("S is a «||» S is b"), "write `OR`", rule("S is a OR S is b")),
    ("TUM104", rule("«!»S is a"), "write `NOT`", rule("NOT S is a")),
    ("TUM104", rule("S «==» a"), "write `is`", rule("S is a")),
    ("TUM104", numeric("N «==» N"), "write `=`", numeric("N = N")),
    ("TUM104", rule("S «:=» a"), "write `is`", rule("S is a")),
    ("TUM104", action("effects: S «:=» a"), "write `is`", action("effects: S is a")),
    ("TUM104", action("effects: S «<-» a"), "write `is`", action("effects: S is a")),
    ("TUM105", action("effects: «set» S to b"), "write `S is b`", action("effects: S is b")),
    ("TUM105", rule("S «equals» a"), "write `S is a`", rule("S is a")),
    ("TUM105", rule("S «isn»'t a"), "write `is not`", rule("S is not a")),
    ("TUM111", rule("S is a «and» S is b"), "`AND`", rule("S is a AND S is b")),
    ("TUM111", rule("«not» (S is b)"), "`NOT`", rule("NOT (S is b)")),
    ("TUM105", f"{FULL}BEGIN STATE RULES rule: (S is a «END» STATE RULES", "write `)`", rule("(S is a)")),
    ("TUM105", rule("S is a«)»"), "leave it out", rule("S is a")),
    ("TUM104", rule("«[»S is a]"), "write `(`", rule("(S is a)")),
    ("TUM104", rule('S is «"»a"'), "leave the quotes out", rule("S is a")),
    (
        "TUM104",
        rule("S«.»x is a"),
        "write `S_x`",
        rule("S_x is a").replace("state S can", "state S_x can be a state S can"),
    ),
    ("TUM105", reaction("executing«(»go)"), "write `executing go`", reaction("executing go")),
    ("TUM105", reaction("IF S is a THEN NOT «execute» go"), "write `executing go`", reaction("NOT executing go")),
]

VALUES = [
    ("TUM201", rule("S is a OR «b»"), "write `S in {a, b}`", rule("S in {a, b}")),
    ("TUM201", rule("T is x OR «y» OR z"), "write `T in {x, y, z}`", rule("T in {x, y, z}")),
    ("TUM201", rule("NOT T is x OR «y»"), "write `T not in {x, y}`", rule("T not in {x, y}")),
    ("TUM201", rule("T is not x OR «y»"), "write `T not in {x, y}`", rule("T not in {x, y}")),
    ("TUM201", rule("T is x AND «y»"), "write `T in {x, y}`", rule("T in {x, y}")),
    ("TUM201", action("preconditions: T is x, «y»"), "write `T in {x, y}`", action("preconditions: T in {x, y}")),
    ("TUM201", rule("«y»"), "did you mean `T is y`?", rule("T is y")),
    ("TUM105", rule("S is a«,» b"), "write `S in {a, b}`", rule("S in {a, b}")),
    ("TUM105", rule("S is «either» a or b"), "write `S in {VALUE, VALUE}`", rule("S in {a, b}")),
    ("TUM105", rule("S is «one» of a, b"), "write `S in {VALUE, VALUE}`", rule("S in {a, b}")),
    ("TUM105", rule("S is «{»a, b}"), "write `S in {a, b}`", rule("S in {a, b}")),
    ("TUM105", rule("S is «in» {a, b}"), "write `S in {a, b}`", rule("S in {a, b}")),
    ("TUM105", rule("S is not «in» {a}"), "write `S not in {a}`", rule("S not in {a}")),
    ("TUM105", rule("S is «NOT» in {a}"), "write `S not in {VALUE, VALUE}`", rule("S not in {a}")),
    ("TUM105", rule("S in «a, b»"), "write `S in {a, b}`", rule("S in {a, b}")),
    (
        "TUM105",
        action("preconditions: S in «a», T is x"),
        "write `S in {a}`",
        action("preconditions: S in {a}, T is x"),
    ),
    ("TUM105", numeric("N is «1..3»"), "write `N in {1..3}`", numeric("N in {1..3}")),
    ("TUM105", numeric("N is not «1..3»"), "write `N not in {1..3}`", numeric("N not in {1..3}")),
    ("TUM105", numeric("N in «1..3»"), "write `N in {1..3}`", numeric("N in {1..3}")),
    ("TUM105", numeric("N in «1, 3»"), "write `N in {1, 3}`", numeric("N in {1, 3}")),
    ("TUM105", numeric("N is «>» 1"), "write `N > 1`", numeric("N > 1")),
    ("TUM105", numeric("N is not «>» 1"), "write `N <= 1`", numeric("N <= 1")),
    ("TUM105", numeric("N is «greater» than 1"), "write `N > 1`", numeric("N > 1")),
    ("TUM105", numeric("N is «at» least 2"), "write `N >= 2`", numeric("N >= 2")),
    ("TUM105", numeric("N is «at» most 2"), "write `N <= 2`", numeric("N <= 2")),
    ("TUM104", numeric("N «=>» 1"), "write `>=`", numeric("N >= 1")),
    ("TUM104", numeric("N «=<» 1"), "write `<=`", numeric("N <= 1")),
    ("TUM104", rule("S «<>» a"), "write `is not`", rule("S is not a")),
    ("TUM105", numeric("«1» < N"), "write `N > 1`", numeric("N > 1")),
    ("TUM105", numeric("«0» <= N < 3"), "write `N >= 0 AND N < 3`", numeric("N >= 0 AND N < 3")),
    ("TUM105", numeric("N > 0 AND «<» 3"), "write `N < 3`", numeric("N > 0 AND N < 3")),
    ("TUM105", rule("S is a «>» T is x"), "a variable stands before `>`", numeric("N > 1")),
    ("TUM315", rule("S «>» a"), "only numbers are compared", rule("S is not a")),
    ("TUM105", rule("«forall» R in a, b: S is {R}"), "write `all NAME in", rule("all R in a, b: S is {R}")),
    ("TUM105", rule("«for all» R in a, b: S is {R}"), "write `all NAME in", rule("all R in a, b: S is {R}")),
    ("TUM105", rule("«exists» R in a, b: S is {R}"), "write `some NAME in", rule("some R in a, b: S is {R}")),
    ("TUM105", rule("«none» R in a, b: S is {R}"), "write `NOT some NAME in", rule("NOT some R in a, b: S is {R}")),
    (
        "TUM105",
        rule("exactly «1» R in a, b: S is {R}"),
        "write `exactly one NAME in",
        rule("exactly one R in a, b: S is {R}"),
    ),
    (
        "TUM105",
        rule("«at» most one R in a, b: S is {R}"),
        "where A < B: NOT (p AND q)`",
        rule("all A in a, b, B in a, b where A < B: NOT (S is {A} AND S is {B})"),
    ),
]

ENTRIES = [
    ("TUM104", f"{FULL}«#» a comment for END\n", "a comment begins with `//`", f"{FULL}// a comment for END\n"),
    ("TUM104", f"«#» The state\n{FULL}", "a comment begins with `//`", f"// The state\n{FULL}"),
    ("TUM104", rule("S is a «--» because"), "a comment begins with `//`", rule("S is a // because")),
    ("TUM104", rule("S is a«;»"), "leave it out", rule("S is a")),
    ("TUM104", rule("S is a«.»"), "leave it out", rule("S is a")),
    ("TUM104", action("duration: 10«;»"), "leave it out", action("duration: 10")),
    ("TUM104", config("max_plan_length: 3«;»"), "leave it out", config("max_plan_length: 3")),
    ("TUM104", vector("state S can be a, b«;»"), "leave it out", vector("state S can be a, b")),
    ("TUM104", vector("state S can be a«;» b, c"), "write `,`", vector("state S can be a, b, c")),
    ("TUM104", action("effects: S is a«;» T is x"), "write `,`", action("effects: S is a, T is x")),
    ("TUM104", rule("S is a«;» T is x"), "write `AND`", rule("S is a AND T is x")),
    ("TUM105", vector("state S can be a «or» b"), "write `,`", vector("state S can be a, b")),
    ("TUM104", vector("state S can be a «|» b"), "write `,`", vector("state S can be a, b")),
    ("TUM105", vector("state S can be a «b»"), "write `,` before it", vector("state S can be a, b")),
    ("TUM105", vector("state S can be «{»a, b}"), "leave the braces out", vector("state S can be a, b")),
    ("TUM105", vector("state N «in» 1..3"), "`state NAME can be 0..3`", vector("state N can be 1..3")),
    ("TUM105", vector("state N can be 0 «to» 3"), "write `0..3`", vector("state N can be 0..3")),
    ("TUM105", vector("state N can be 0«-3»"), "write `0..3`", vector("state N can be 0..3")),
    ("TUM104", vector("state N can be 0«...»3"), "write `..`", vector("state N can be 0..3")),
    ("TUM104", vector("state S can be a«-»b"), "write `a_b`", vector("state S can be a_b")),
    ("TUM105", vector("«S» can be a, b"), "write `state NAME can be VALUE, VALUE`", vector("state S can be a, b")),
    (
        "TUM113",
        vector("state «1..3» can be a"),
        "write `for N in 1..3 state NAME_{N} can be VALUE, VALUE end for`",
        vector("for N in 1..3 state S_{N} can be a, b end for"),
    ),
    (
        "TUM113",
        f"{VECTOR} BEGIN RESOURCES resource «M_1..3» END RESOURCES",
        "write `for N in 1..3 resource NAME_{N} end for`",
        f"{VECTOR} BEGIN RESOURCES for N in 1..3 resource M_{{N}} end for END RESOURCES",
    ),
    (
        "TUM113",
        f"{VECTOR} BEGIN ACTIONS action go controlled resources: «1..3» END ACTIONS",
        "write `controlled resources: NAME_1, NAME_2`",
        action("controlled resources: R"),
    ),
    (
        "TUM113",
        reaction("executing «1..2»"),
        "write `some N in 1..2: executing NAME_{N}`",
        reaction("some N in 1..2: executing go_{N}").replace(
            "action go", "for N in 1..2 action go_{N} effects: none end for action go"
        ),
    ),
    (
        "TUM105",
        action("«timeout»: 10"),
        "`alternative effects: none`",
        action("effects: S is a alternative effects: none"),
    ),
    (
        "TUM105",
        action("effects: S is a «timeout»: 10"),
        "`alternative effects: none`",
        action("alternative effects: none"),
    ),
    ("TUM105", action("«time»: 10"), "write `duration: 10`", action("duration: 10")),
    ("TUM105", action("duration: 10 «s»"), "leave it out", action("duration: 10")),
    ("TUM105", action("«resources»: R"), "write `controlled resources: NAME`", action("controlled resources: R")),
    ("TUM105", action("«requires»: S is a"), "write `preconditions: PREDICATE`", action("preconditions: S is a")),
    ("TUM105", action("«post»: S is a"), "write `nominal effects: PREDICATE`", action("nominal effects: S is a")),
    (
        "TUM105",
        action("«failure»: S is a"),
        "write `alternative effects: PREDICATE`",
        action("alternative effects: S is a"),
    ),
    ("TUM105", action("«probability»: 3"), "there are no probabilities", action("alternative effects: S is a")),
    ("TUM105", action("«colour»: red"), "the fields of an action are `duration:`", action("duration: 1")),
    ("TUM105", config("«timeout»: 10"), "on the command line", config("max_plan_length: 10")),
    ("TUM105", config("«depth»: 10"), "the settings are `max_plan_length:`", config("max_plan_length: 10")),
    (
        "TUM105",
        f"{VECTOR} BEGIN ACTIONS action go«:» effects: none END ACTIONS",
        "`action go`",
        action("effects: none"),
    ),
    (
        "TUM105",
        f"{VECTOR} BEGIN ACTIONS «go» effects: none END ACTIONS",
        "write `action NAME`",
        action("effects: none"),
    ),
    ("TUM105", rules("«IF» S is a THEN T is x"), "write `rule: PREDICATE`", rule("IF S is a THEN T is x")),
    ("TUM105", rules("«never»: S is a"), "write `rule: NOT (PREDICATE)`", rule("NOT (S is a)")),
    ("TUM105", rules("rule «1»: S is a"), "leave it out: rules have no names", rule("S is a")),
    (
        "TUM105",
        f"{VECTOR} BEGIN ASSUMPTIONS «rule»: S is a END ASSUMPTIONS",
        "write `assume: PREDICATE`",
        f"{VECTOR} BEGIN ASSUMPTIONS assume: S is a END ASSUMPTIONS",
    ),
    (
        "TUM105",
        f"{VECTOR} BEGIN ALIASES «alias» p as S is a END ALIASES",
        "write `define NAME as PREDICATE`",
        f"{VECTOR} BEGIN ALIASES define p as S is a END ALIASES",
    ),
]

CONDITIONAL = action("nominal effects: when S is a: T is x")
TWO_CLAUSES = action("nominal effects: when S is a: T is x when S is b: T is y")
EFFECTS = [
    ("TUM305", action("«nominal effects: IF S is a THEN T is x»"), "write `when CONDITION: EFFECT`", CONDITIONAL),
    ("TUM105", action("nominal effects: when S is a: T is x«,» when S is b: T is y"), "leave it out", TWO_CLAUSES),
    (
        "TUM105",
        action("nominal effects: T is x«,» when S is a: S is b"),
        "leave it out",
        action("nominal effects: T is x when S is a: S is b"),
    ),
    ("TUM105", action("nominal effects: T is x «IF» S is a"), "write `when CONDITION: EFFECT`", CONDITIONAL),
    ("TUM105", action("nominal effects: «if» S is a then T is x"), "write `when CONDITION: EFFECT`", CONDITIONAL),
    ("TUM105", action("nominal effects: when S is a «then» T is x"), "write `when CONDITION: EFFECT`", CONDITIONAL),
    (
        "TUM105",
        f"{VECTOR} BEGIN ACTIONS action act effects: T is x when S is a «END» ACTIONS",
        "write `when CONDITION: EFFECT`",
        CONDITIONAL,
    ),
    (
        "TUM105",
        action("alternative effects: S is a «WHEN» T is x"),
        "write `when CONDITION: EFFECT`",
        action("alternative effects: when T is x: S is a"),
    ),
    (
        "TUM201",
        action("alternative effects: S is a, «none»"),
        "a line of its own, `alternative effects: none`",
        action("alternative effects: S is a alternative effects: none"),
    ),
    (
        "TUM105",
        action("alternative effects: «none», S is a"),
        "a line of its own: `alternative effects: none`",
        action("alternative effects: none alternative effects: S is a"),
    ),
    (
        "TUM201",
        action("nominal effects: S is a OR «none»"),
        "a line of its own, `alternative effects: none`",
        action("nominal effects: S is a alternative effects: none"),
    ),
    ("TUM201", action("preconditions: S is a, «none»"), "leave it out", action("preconditions: S is a")),
    ("TUM201", action("controlled resources: R, «none»"), "leave it out", action("controlled resources: R")),
    ("TUM201", action("alternative effects: «nothing»"), "write `none`", action("alternative effects: none")),
    ("TUM105", action("alternative effects: «no change»"), "write `none`", action("alternative effects: none")),
]

GOALS = [
    (
        "TUM105",
        goals("goal type: «sequence» goal: S is a goal: S is b"),
        "`when NOT p then goal: p` before `when NOT q then goal: q`",
        goals("goal type: priority when NOT S is a then goal: S is a when NOT S is b then goal: S is b"),
    ),
    (
        "TUM105",
        goals("goal type: «all» goal: S is a"),
        "`constraint`: all goals",
        goals("goal type: constraint goal: S is a"),
    ),
    (
        "TUM105",
        goals("«priority»: goal: S is a"),
        "write `goal type: priority`",
        goals("goal type: priority goal: S is a"),
    ),
    (
        "TUM105",
        goals("goal type: priority «IF» S is a THEN goal: T is x"),
        "write `when PREDICATE then goal: PREDICATE`",
        goals("goal type: priority when S is a then goal: T is x"),
    ),
    (
        "TUM105",
        goals("goal type: priority when S is a«:» goal: T is x"),
        "write `when PREDICATE then goal: PREDICATE`",
        goals("goal type: priority when S is a then goal: T is x"),
    ),
    (
        "TUM105",
        goals("goal type: priority when S is a then «T» is x"),
        "write `goal:` after `then`",
        goals("goal type: priority when S is a then goal: T is x"),
    ),
    (
        "TUM105",
        goals("goal type: priority «S» is a"),
        "write `goal: PREDICATE`",
        goals("goal type: priority goal: S is a"),
    ),
]

BLOCKS = [
    (
        "TUM105",
        f"{VECTOR} BEGIN «INIT» S is a END INIT",
        "did you mean `BEGIN START`?",
        f"{VECTOR} BEGIN START start: S is a END START",
    ),
    (
        "TUM105",
        f"{VECTOR} BEGIN START «S» is a END START",
        "write `start: PREDICATE`",
        f"{VECTOR} BEGIN START start: S is a END START",
    ),
    (
        "TUM111",
        "«begin state vector» state S can be a END STATE VECTOR",
        "`BEGIN STATE VECTOR`",
        vector("state S can be a"),
    ),
    (
        "TUM111",
        "BEGIN STATE VECTOR state S can be a «end state vector»",
        "`END STATE VECTOR`",
        vector("state S can be a"),
    ),
    ("TUM108", f"{VECTOR} BEGIN GOALS goal type: priority «END»", "write `END GOALS`", goals("goal type: priority")),
    ("TUM107", f"{VECTOR} BEGIN GOALS goal type: priority«»", "write `END GOALS`", goals("goal type: priority")),
    ("TUM105", goals("") + "«END»", "leave it out: no block is open", goals("")),
    (
        "TUM105",
        "«STATE» VECTOR state S can be a END STATE VECTOR",
        "write `BEGIN STATE VECTOR`",
        vector("state S can be a"),
    ),
    ("TUM105", f"{VECTOR} «rule»: S is a", "`BEGIN STATE RULES` … `END STATE RULES`", rule("S is a")),
    ("TUM105", f"{VECTOR} BEGIN «RULES» rule: S is a END RULES", "`BEGIN REACTION RULES`?", rule("S is a")),
    ("TUM105", "BEGIN STATE VECTOR«:» state S can be a END STATE VECTOR", "leave it out", vector("state S can be a")),
]

ONE_ACTION = f"{VECTOR} BEGIN ACTIONS action go effects: S is a action stay effects: none END ACTIONS"
BLOCKS += [
    (
        "TUM105",
        f"{VECTOR} BEGIN ACTIONS «BEGIN ACTION» go effects: S is a END ACTION action stay effects: none END ACTIONS",
        "write `action NAME`",
        ONE_ACTION,
    ),
    ("TUM104", vector("state S can be «[»a, b]"), "leave it out", vector("state S can be a, b")),
    ("TUM105", vector("state S can be «(»a, b)"), "leave it out", vector("state S can be a, b")),
    ("TUM105", vector("state S can be a, b «default» a"), "`BEGIN START`", vector("state S can be a, b")),
    ("TUM104", action("duration: «[»1, 3] effects: none"), "write one number", action("duration: 3 effects: none")),
    ("TUM105", rules("rule: S is a «T» is x"), "write `AND`", rules("rule: S is a AND T is x")),
]

COPIED = rules("for V in a, b rule: S is not {V} end for")
COPIES = [
    (
        "TUM107",
        f"{FULL}BEGIN STATE RULES for V in a, b rule: S is not {{V}} «END» STATE RULES",
        "write `end for`",
        COPIED,
    ),
    ("TUM107", rules("for V in a, b rule: S is not {V} «end»"), "write `end for`", COPIED),
    ("TUM111", rules("for V in a, b rule: S is not {V} «END FOR»"), "write `end for`", COPIED),
    ("TUM105", rules("for V in a, b«:» rule: S is not {V} end for"), "leave it out", COPIED),
    ("TUM105", rules("for V «=» a, b rule: S is not {V} end for"), "write `in`", COPIED),
    ("TUM105", rules("for «each» V in a, b rule: S is not {V} end for"), "`for V in VALUE, VALUE`", COPIED),
    (
        "TUM105",
        rules("for V in a, b «if» V = a rule: S is not {V} end for"),
        "write `where`",
        rules("for V in a, b where V = a rule: S is not {V} end for"),
    ),
]

LISTED = "BEGIN ALIASES define FAR as {b} END ALIASES "
ANY_LISTED = LISTED + rules("rule: some V in FAR: S is {V}")
PARAMETERS = [
    ("TUM201", rules("for V in a, b rule: S is a OR «V» is b end for"), "write `{V}`", COPIED),
    ("TUM202", rules("for V in a, b rule: S is not «V» end for"), "write `{V}`: parameters stand in braces", COPIED),
    ("TUM202", rules("rule: all V in a, b: S is not «V»"), "write `{V}`", rules("rule: all V in a, b: S is not {V}")),
    ("TUM202", LISTED + rules("rule: S is «FAR»"), "write `some V in FAR: S is {V}`", ANY_LISTED),
    ("TUM202", LISTED + rules("rule: S in {«FAR»}"), "write `some V in FAR: S is {V}`", ANY_LISTED),
    ("TUM105", LISTED + rules("rule: S in «FAR»"), "write `some V in FAR: S is {V}`", ANY_LISTED),
    (
        "TUM105",
        LISTED + rules("rule: S not in «FAR»"),
        "write `all V in FAR: S is not {V}`",
        LISTED + rules("rule: all V in FAR: S is not {V}"),
    ),
    ("TUM113", f"BEGIN ALIASES define FAR as «2» END ALIASES {FULL}", "`define FAR as {2}`", LISTED + FULL),
]

HABITS = [*PREDICATES, *VALUES, *ENTRIES, *EFFECTS, *GOALS, *BLOCKS, *COPIES, *PARAMETERS]


def check_habit(code: str, marked: str, way_out: str, typed: str) -> None:
    """One error, at the marked place, with a way out; what it says to type is read without an error."""
    case = unmark(marked)
    diagnostic = the(code, case.text)
    assert diagnostic.span == case.span
    assert way_out in (diagnostic.help or "")
    errors = [each for each in loaded(case.text).diagnostics if each.severity == "error"]
    assert errors == [diagnostic]
    assert not [each for each in loaded(typed).diagnostics if each.severity == "error"]


@pytest.mark.parametrize(("code", "marked", "way_out", "typed"), HABITS, ids=lambda each: str(each)[-60:])
def test_a_habit_has_a_way_out(code: str, marked: str, way_out: str, typed: str) -> None:
    """It is one error, at the place, with a way out that says what to write; what it says is read without an error."""
    check_habit(code, marked, way_out, typed)


def test_words_of_other_languages_are_names_where_names_stand() -> None:
    """A variable may be called `set`, `when` or `always`: what is said about it is about its predicate."""
    for name in ("set", "when", "always", "at", "one"):
        text = rule(f"{name} «x»").replace("state S can", f"state {name} can be x state S can")
        case = unmark(text)
        diagnostic = the("TUM105", case.text)
        assert diagnostic.span == case.span
        assert diagnostic.help == f"write `{name} is x`"


def test_a_comment_of_another_language_is_passed_over_whole() -> None:
    """What stands on the line after `#` is not read as declarations, and the next line is."""
    text = "BEGIN STATE VECTOR\n# BEGIN state T can be END\nstate S can be a\n# END STATE VECTOR\nEND STATE VECTOR"
    assert [each.code.name for each in loaded(text).diagnostics] == ["TUM104", "TUM104"]


def test_values_that_stand_alone_are_one_mistake() -> None:
    """The message stands at the first of them, and names them all."""
    found = loaded(rule("T is x OR y OR z")).diagnostics
    assert [each.help for each in found] == ["write `T in {x, y, z}`"]
