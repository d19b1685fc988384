"""Whatever is fed in ends in diagnostics: never a traceback, never a hang."""

from itertools import islice
from pathlib import Path

import pytest

from tests.syntax.mutations import check, mutations
from tumato_symbolic.diagnostics import Source
from tumato_symbolic.spec import load

EXAMPLES = Path(__file__).parents[2] / "examples"
VECTOR = "BEGIN STATE VECTOR state S can be a, b END STATE VECTOR\n"


def rules(text: str, aliases: str = "") -> str:
    """A state rule after a state vector."""
    return f"{VECTOR}BEGIN ALIASES {aliases} END ALIASES BEGIN STATE RULES rule: {text} END STATE RULES"


def effects(text: str) -> str:
    """Alternative effects over sixty variables."""
    variables = " ".join(f"state S{number} can be a, b, c, d" for number in range(60))
    action = f"BEGIN ACTIONS action go nominal effects: none alternative effects: {text} END ACTIONS"
    return f"BEGIN STATE VECTOR {variables} END STATE VECTOR {action}"


def ranges(count: int, highest: int, rules: str = "", *aliases: str) -> str:
    """Variables with many values each, state rules and aliases about them."""
    variables = " ".join(f"state S{number} can be 0..{highest}" for number in range(count))
    defined = " ".join(f"define a{number} as {each}" for number, each in enumerate(aliases))
    return (
        f"BEGIN STATE VECTOR {variables} END STATE VECTOR "
        f"BEGIN ALIASES {defined} END ALIASES BEGIN STATE RULES {rules} END STATE RULES"
    )


BOMB = "define a0 as S is a " + " ".join(f"define a{n} as a{n - 1} AND a{n - 1}" for n in range(1, 60))
CHAIN = "define a0 as S is a " + " ".join(f"define a{n} as a{n - 1}" for n in range(1, 5000))
LADDER = "define a0 as S is a " + " ".join(f"define a{n} as NOT a{n - 1}" for n in range(1, 5000))
CIRCLE = "define a0 as a4999 " + " ".join(f"define a{n} as a{n - 1}" for n in range(1, 5000))

HOSTILE = {
    "nothing": ("", "TUM301"),
    "white space": (" \n\t\r\n" * 100, "TUM301"),
    "zero bytes": ("\0" * 1000, "TUM104"),
    "noise": ("@#$ %^ " * 10_000, "TUM104"),
    "words": ("a " * 20_000, "TUM105"),
    "parentheses": (rules("(" * 10_000 + "S is a" + ")" * 10_000), "TUM115"),
    "open parentheses": (rules("(" * 10_000), "TUM115"),
    "negations": (rules("NOT " * 10_000 + "S is a"), "TUM115"),
    "mixed nesting": (rules("(NOT NOT NOT (IF S is a THEN " * 60 + "S is a" + "))" * 60), "TUM115"),
    "goal lists": (VECTOR + "BEGIN GOALS goal type: priority " * 5000, "TUM115"),
    "begins": ("BEGIN " * 20_000, "TUM105"),
    "ends": ("END " * 20_000, "TUM105"),
    "values": ("BEGIN STATE VECTOR state S can be " + ", ".join(f"v{n}" for n in range(20_000)), "TUM311"),
    "the same value": ("BEGIN STATE VECTOR state S can be " + "v, " * 20_000 + "v END STATE VECTOR", "TUM203"),
    "an open comment": (VECTOR + "/* " * 50_000, "TUM106"),
    "a long name": (rules("x" * 200_000), "TUM201"),
    "long numbers": (VECTOR + "BEGIN CONFIG max_plan_length: " + "9" * 100_000 + " END CONFIG", "TUM114"),
    "mistakes without end": (rules(" rule: ".join(["S is AND a"] * 3000)), "TUM116"),
    "unknown names without end": (rules(" rule: ".join(f"X{n} is a" for n in range(5000))), "TUM201"),
    "an alias bomb": (rules("a59", BOMB), "TUM308"),
    "an alias ladder": (rules("a4999", LADDER), "TUM308"),
    "an alias circle": (rules("a4999", CIRCLE), "TUM206"),
    "a long range": ("BEGIN STATE VECTOR state S can be 0..999999999999999999 END STATE VECTOR", "TUM311"),
    "many ranges": (ranges(1000, 9999), "TUM311"),
    "a large comparison": (ranges(2, 9999, "rule: S0 < S1"), "TUM308"),
    "large comparisons": (ranges(2, 9999, " ".join(f"rule: S0 < {n}" for n in range(1, 9999))), "TUM308"),
    "large aliases": (ranges(1, 9999, "", *(f"S0 < {n}" for n in range(1, 9999))), "TUM308"),
    "effects without end": (effects(", ".join(f"(S{n} is a OR S{n} is b)" for n in range(60))), "TUM307"),
    "effects hard to find": (effects(", ".join(f"(S{n} is a IFONLYIF S{59 - n} is b)" for n in range(60))), "TUM307"),
}


@pytest.mark.parametrize("name", HOSTILE)
def test_hostile_texts_end_in_a_diagnostic(name: str) -> None:
    """Each kind of hostile text is refused with the code that tells why."""
    text, code = HOSTILE[name]
    assert code in [each.code.name for each in check(text)]


@pytest.mark.parametrize(("name", "has_aliases"), [("an alias bomb", True), ("large comparisons", False)])
def test_what_is_too_large_is_put_down_to_aliases_where_there_are_some(name: str, has_aliases: bool) -> None:
    """Where there are none, the way out speaks of what is written out."""
    found = next(each for each in check(HOSTILE[name][0]) if each.code.name == "TUM308")
    assert ("alias" in found.message + str(found.help)) == has_aliases


def test_a_long_chain_of_aliases_is_harmless() -> None:
    """Aliases that only rename each other add no depth, however many there are."""
    assert load(Source("chain", rules("a4999", CHAIN))).spec is not None


@pytest.mark.parametrize("path", sorted(EXAMPLES.glob("*.tum")), ids=lambda path: path.stem)
def test_damaged_specifications_end_in_diagnostics(path: Path) -> None:
    """Fixed mutants of every example load or are refused; an error comes exactly where there is no specification.

    `make readers` tries thousands.
    """
    text = path.read_text(encoding="utf-8")
    for mutant in islice(mutations(text, 3), max(10, min(30, 100_000 // len(text)))):
        check(mutant)


def test_a_goal_that_breaks_off_before_the_next_block() -> None:
    """A list of goals that ends inside a goal is reported, though the `END` that is missing would not fit there."""
    text = """
BEGIN STATE VECTOR
state S_A can be a, b
END STATE VECTOR
BEGIN GOALS
goal type: priority
when S_A is a then
BEGIN CONFIG
max_plan_length: 5
END CONFIG
"""
    found = load(Source("broken", text))
    assert [each.code.name for each in found.diagnostics if each.severity == "error"] == ["TUM107"]
