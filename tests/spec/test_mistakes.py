"""Every mistake has its code, its place and a way out."""

import pytest

from tests.spec.marked import FULL, VECTOR, codes, loaded, the, unmark


def rule(predicate: str) -> str:
    """A state rule in a complete specification."""
    return f"{FULL}BEGIN STATE RULES\nrule: {predicate}\nEND STATE RULES\n"


def action(fields: str, before: str = "") -> str:
    """An action in a specification with a state vector and one resource."""
    return f"{VECTOR} {before} BEGIN RESOURCES resource R END RESOURCES\nBEGIN ACTIONS action act {fields}\nEND ACTIONS"


def config(settings: str) -> str:
    """A CONFIG block in a complete specification."""
    return f"{FULL}BEGIN CONFIG {settings} END CONFIG"


def numeric(text: str) -> str:
    """A state rule beside a variable `N` with the values 0 to 3."""
    return rule(text).replace("state T can", "state N can be 0..3 state T can")


MISTAKES = [
    ("TUM104", rule("S «==» a"), "write `is`"),
    ("TUM104", rule("S is a «&&» S is b"), "write `AND`"),
    ("TUM104", rule("S«\u00a0»is a"), "write a plain space"),
    ("TUM104", rule("S is a «\ufeff» AND S is b"), "write a plain space"),
    ("TUM104", rule("S is a // over\n /* and\n  out«\u2028»rule: S is b */"), "some editors begin a line there"),
    ("TUM104", rule("S is a // «\u202e»b si S"), "change the direction"),
    ("TUM105", rule("S is a «S» is b"), None),
    ("TUM105", f"{FULL}BEGIN STATE RULES rule: S is «END» STATE RULES", None),
    ("TUM105", rule("S is a«,» S is b"), "write `AND`"),
    ("TUM105", rule("(S is a «rule»: S is a"), None),
    ("TUM105", rule("S is a AND «AND» S is b"), None),
    ("TUM105", f"{VECTOR} BEGIN «GOAL» END GOALS", "did you mean `BEGIN GOALS`?"),
    ("TUM105", f"{VECTOR} BEGIN STATE «RULE» END STATE RULES", "did you mean `BEGIN STATE RULES`?"),
    ("TUM105", f"{VECTOR} BEGIN GOALS «when» S is a then goal: true END GOALS", "goal type: priority"),
    ("TUM105", f"{VECTOR} BEGIN GOALS goal«:» S is a END GOALS", "goal type: priority"),
    ("TUM105", action("duration «10»"), "write `duration:`"),
    ("TUM105", action("nominal «efects»: none"), "did you mean `effects`?"),
    ("TUM105", action("nominal effects: S is a, «nominal» effects: S is a"), None),
    ("TUM105", config("«max_plan_lenght»: 4"), "did you mean `max_plan_length`?"),
    ("TUM104", config("max_plan_length «=» 4"), "write `:`"),
    ("TUM105", rule("S «b»"), "write `S is b`"),
    ("TUM105", f"{VECTOR} BEGIN «STAT» RULES rule: S is a END STATE RULES", "did you mean `BEGIN STATE RULES`?"),
    ("TUM105", f"{VECTOR} BEGIN «THINGS» END THINGS", "the blocks are"),
    ("TUM105", f"{VECTOR} BEGIN GOALS goal type: «all» goal: S is a END GOALS", None),
    ("TUM105", config("effect_ordering: «last»"), "effect_ordering: any"),
    ("TUM105", config("preconditions: «none»"), None),
    ("TUM105", "BEGIN STATE VECTOR state S«:» a END STATE VECTOR", "state NAME can be VALUE"),
    ("TUM105", "BEGIN STATE VECTOR state S can be a, «END» STATE VECTOR", None),
    ("TUM105", f"{VECTOR} «rule»: S is a", None),
    ("TUM106", f"{VECTOR} «/*» never closed", "close it with `*/`"),
    ("TUM107", f"{VECTOR} BEGIN GOALS goal type: priority «BEGIN» CONFIG END CONFIG", "write `END GOALS`"),
    ("TUM107", "BEGIN STATE VECTOR state S can be a «BEGIN» CONFIG END CONFIG", "write `END STATE VECTOR`"),
    ("TUM107", "BEGIN STATE VECTOR state S can be a«»", "write `END STATE VECTOR`"),
    ("TUM108", f"{VECTOR} BEGIN ACTIONS «END ACTION»", "write `END ACTIONS`"),
    ("TUM108", f"{VECTOR} BEGIN STATE RULES «END REACTION RULES»", "write `END STATE RULES`"),
    ("TUM109", rule("S is a IFONLYIF S is b «IFONLYIF» T is x"), "(p IFONLYIF q) IFONLYIF r"),
    ("TUM110", rule("IF S is a THEN «IF» S is b THEN T is x"), "(IF p THEN q)"),
    ("TUM110", rule("S is a AND «IF» S is b THEN T is x"), "(IF p THEN q)"),
    ("TUM110", rule("IF S is a «IFONLYIF» S is b THEN T is x"), "(p IFONLYIF q)"),
    ("TUM111", rule("S is a «and» S is b"), "did you mean `AND`?"),
    ("TUM111", rule("«not» S is b"), "did you mean `NOT`?"),
    ("TUM111", rule("«if» S is b THEN S is a"), "did you mean `IF`?"),
    ("TUM111", rule("IF S is b «then» S is a"), "did you mean `THEN`?"),
    ("TUM111", f"{VECTOR} «begin» CONFIG END CONFIG", "did you mean `BEGIN`?"),
    (
        "TUM112",
        f"{VECTOR} BEGIN GOALS goal type: priority when S is a then «when» S is b then goal: true END GOALS",
        "when p AND q then",
    ),
    ("TUM113", "BEGIN STATE VECTOR state «2fast» can be a END STATE VECTOR", "a name is a letter"),
    ("TUM113", "BEGIN STATE VECTOR state S can be «naïve» END STATE VECTOR", "a name is a letter"),
    ("TUM114", action("duration: «2.5»"), "a whole number"),
    ("TUM114", action("duration: «4controlled» resources: R"), "a whole number"),
    ("TUM114", action("duration: «-0»"), "a whole number"),
    ("TUM114", action(f"duration: «{'9' * 5000}»"), "at most 18 digits"),
    ("TUM201", rule("«Q» is a"), "the state variables are `S` and `T`"),
    ("TUM201", rule("«S_Battry» is a").replace("state S can", "state S_Battery can be u state S can"), "`S_Battery`"),
    ("TUM201", rule("«unheard»"), "there is no alias at all"),
    ("TUM201", action("controlled resources: «RR»"), "did you mean `R`?"),
    ("TUM201", f"{FULL}BEGIN REACTION RULES rule: executing «gos» END REACTION RULES", "did you mean `go`?"),
    ("TUM202", rule("S is «A»"), "did you mean `a`?"),
    ("TUM202", rule("S is «closed»"), "its values are `a` and `b`"),
    ("TUM203", "BEGIN STATE VECTOR state S can be a, b, «a» END STATE VECTOR", "remove one"),
    ("TUM203", "BEGIN STATE VECTOR state S can be a state «S» can be a END STATE VECTOR", "remove one"),
    ("TUM204", f"{VECTOR} BEGIN RESOURCES resource «S» END RESOURCES", "choose another name"),
    ("TUM205", f"{VECTOR} BEGIN ALIASES define «true» as S is a END ALIASES", "choose another name"),
    ("TUM206", f"{VECTOR} BEGIN ALIASES define «p» as p OR S is a END ALIASES", "never itself"),
    ("TUM206", f"{VECTOR} BEGIN ALIASES define «p» as q define q as p END ALIASES", "never itself"),
    ("TUM207", rule("«S»"), "write `S is a`"),
    ("TUM207", rule("«go»"), "write `executing go`"),
    ("TUM207", rule("«R» is a"), None),
    ("TUM301", "«»", "BEGIN STATE VECTOR"),
    ("TUM301", "«»BEGIN CONFIG END CONFIG", "BEGIN STATE VECTOR"),
    ("TUM301", "«BEGIN STATE VECTOR» END STATE VECTOR", "BEGIN STATE VECTOR"),
    ("TUM302", f"{VECTOR} BEGIN CONFIG END CONFIG «BEGIN CONFIG» END CONFIG", "join the two blocks"),
    ("TUM303", action("duration: 1 «cost: 2»"), "remove one"),
    ("TUM303", action("effects: S is a «nominal effects: S is a»"), "join them"),
    ("TUM303", config("max_plan_length: 4 «max_plan_length: 5»"), "remove one"),
    ("TUM303", config("preconditions: throughout «preconditions: throughout»"), "remove one"),
    ("TUM304", rule("«executing go»"), "reaction rules and goal bodies"),
    ("TUM304", action("preconditions: NOT «executing act»"), "reaction rules and goal bodies"),
    ("TUM304", action("nominal effects: S is a, «executing act»"), "reaction rules and goal bodies"),
    ("TUM305", action("«nominal effects: S is a OR S is b»"), "alternative effects"),
    ("TUM305", action("«nominal effects: NOT T is x»"), "alternative effects"),
    ("TUM305", action("«nominal effects: S is a, S is b»"), "exactly one"),
    ("TUM306", action("«alternative effects: S is a, NOT S is a»"), "has to be possible"),
    ("TUM309", action("«duration: -1»"), "whole numbers"),
    ("TUM310", config("«max_plan_length: 0»"), "one step or more"),
    ("TUM105", numeric("N in {«}»"), None),
    ("TUM114", "BEGIN STATE VECTOR state N can be 0, «007» END STATE VECTOR", "write `7`"),
    ("TUM114", "BEGIN STATE VECTOR state N can be 0, «+3» END STATE VECTOR", "such as `3`"),
    ("TUM114", "BEGIN STATE VECTOR state N can be «-0», 3 END STATE VECTOR", "such as `0`"),
    ("TUM114", "BEGIN STATE VECTOR state N can be «2.5» END STATE VECTOR", "a whole number"),
    ("TUM114", numeric("N is «03»"), "write `3`"),
    ("TUM114", numeric("N in {0..«03»}"), "write `3`"),
    ("TUM202", numeric("N is «7»"), "its values are `0`"),
    ("TUM202", numeric("N is not «x»"), "its values are `0`"),
    ("TUM202", numeric("N = «7»"), "its values are `0`"),
    ("TUM202", numeric("N != «7»"), "its values are `0`"),
    ("TUM202", numeric("N in {1, «5..9»}"), "its values are `0`"),
    ("TUM202", rule("S not in {a, «c»}"), "its values are `a` and `b`"),
    ("TUM203", "BEGIN STATE VECTOR state N can be 0..5, «5..7» END STATE VECTOR", "remove one"),
    ("TUM311", "BEGIN STATE VECTOR state N can be 0, «1..10000» END STATE VECTOR", "split"),
    ("TUM314", "BEGIN STATE VECTOR state N can be «3..1» END STATE VECTOR", "write `1..3`"),
    ("TUM314", "BEGIN STATE VECTOR state N can be 1..«b» END STATE VECTOR", "from one number to another"),
    ("TUM314", numeric("N in {«3..1»}"), "write `1..3`"),
    ("TUM315", rule("S «=» a"), "write `S is a`"),
    ("TUM315", rule("S «!=» a"), "write `S is not a`"),
    ("TUM315", rule("S «<» 3"), "the values of `S` are `a` and `b`"),
    ("TUM315", numeric("N «>=» S"), "the values of `S` are `a` and `b`"),
    ("TUM201", numeric("N < «M»"), "the state variables are"),
]


@pytest.mark.parametrize(("code", "marked", "way_out"), MISTAKES, ids=lambda each: str(each)[:60])
def test_a_mistake_is_reported_where_it_is(code: str, marked: str, way_out: str | None) -> None:
    """The code, the span, and the way out of each mistake; there is no specification then."""
    case = unmark(marked)
    diagnostic = the(code, case.text)
    assert diagnostic.span == case.span
    assert way_out is None or way_out in (diagnostic.help or "")
    assert loaded(case.text).spec is None


@pytest.mark.parametrize(("code", "marked", "way_out"), MISTAKES, ids=lambda each: str(each)[:60])
def test_one_mistake_is_one_error(code: str, marked: str, way_out: str | None) -> None:
    """A mistake has no consequences that are reported as errors of their own."""
    errors = [each for each in loaded(unmark(marked).text).diagnostics if each.severity == "error"]
    assert [each.code.name for each in errors] == [code]


def test_both_places_of_a_duplicate_are_shown() -> None:
    """The second declaration is to blame, a note shows the first."""
    text = "BEGIN STATE VECTOR\nstate S can be a\nstate S can be b\nEND STATE VECTOR"
    diagnostic = the("TUM203", text)
    assert diagnostic.span is not None
    assert diagnostic.span.line == 3
    assert [note.span.line for note in diagnostic.notes] == [2]


def test_executing_through_an_alias_shows_both_places() -> None:
    """The use of the alias is to blame, a note shows where the alias says `executing`."""
    alias = "BEGIN ALIASES define p as q define q as executing go END ALIASES\n"
    diagnostic = the("TUM304", unmark(rule("S is a OR p") + alias).text)
    assert diagnostic.span is not None
    assert diagnostic.span.end_column - diagnostic.span.column == len("p")
    assert diagnostic.notes[0].span.end_column - diagnostic.notes[0].span.column == len("executing go")


def test_several_mistakes_are_reported_in_one_run() -> None:
    """Syntax errors in several items, and errors in names beside them, come out together, in the order of the text."""
    text = (
        "BEGIN STATE VECTOR state S can be a, a END STATE VECTOR\n"
        "BEGIN STATE RULES\nrule: S is a AND\nrule: Q is a\nrule: S is a and S is a\nrule: S is zz\nEND STATE RULE\n"
        "BEGIN CONFIG max_plan_length: 0 END CONFIG"
    )
    assert codes(text) == ["TUM203", "TUM105", "TUM201", "TUM111", "TUM202", "TUM108", "TUM310"]


def test_every_item_with_a_mistake_is_reported() -> None:
    """Each broken rule of many is reported once, and only it."""
    broken = ["S is", "S is a OR", "NOT", "", "S b", "executing", "S is a)", "(S is a", "IF S is a", "a is b c"]
    lines = "".join(f"rule: {each}\nrule: S is a\n" for each in broken)
    text = f"{VECTOR}\nBEGIN STATE RULES\n{lines}END STATE RULES\n"
    errors = [each.code.name for each in loaded(text).diagnostics]
    assert errors == ["TUM105"] * len(broken)


def test_what_a_syntax_error_hides_is_not_missed() -> None:
    """A name that was declared in a passage that could not be read is not reported as unknown."""
    text = "BEGIN STATE VECTOR state S can can a END STATE VECTOR BEGIN STATE RULES rule: S is a END STATE RULES"
    assert codes(text) == ["TUM105"]


def test_remaining_assignments_are_listed() -> None:
    """Nominal effects that leave a choice say which."""
    message = the("TUM305", action("nominal effects: T is x OR T is z")).message
    assert "`T is x`; `T is z`" in message
