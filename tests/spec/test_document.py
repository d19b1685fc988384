"""`docs/language.md` and `docs/diagnostics.md` say what is the case."""

import re
from pathlib import Path

import pytest

from tests.spec.marked import codes
from tumato_symbolic.diagnostics import Code
from tumato_symbolic.spec import (
    actions,
    cases,
    clauses,
    copies,
    effects,
    lint,
    names,
    parameters,
    predicates,
    resolve,
    values,
)
from tumato_symbolic.syntax import nesting, parser, reading, tokens

DOCS = Path(__file__).parents[2] / "docs"
LANGUAGE = (DOCS / "language.md").read_text(encoding="utf-8")
SNIPPETS = re.findall(r"^```tumato([^\n]*)\n(.*?)^```$", LANGUAGE, re.MULTILINE | re.DOTALL)
WHOLE = "".join(text for marks, text in SNIPPETS if not marks)
WRONG = [(marks.split("error=")[1], text) for marks, text in SNIPPETS if "error=" in marks]
ALONE = [text for marks, text in SNIPPETS if marks == " alone"]

LIMITS = [
    ("bytes of a text", reading.MAX_BYTES),
    ("digits of a number", tokens.MAX_DIGITS),
    ("mistakes in the syntax before reading stops", parser.MAX_SYNTAX_ERRORS),
    ("levels of parentheses, operators and lists of goals", nesting.MAX_NESTING),
    ("levels of a predicate, aliases expanded (an implication counts as two)", predicates.MAX_DEPTH),
    ("atoms and operators of a predicate, aliases expanded", predicates.MAX_TERMS),
    ("atoms and operators of all predicates, aliases expanded", predicates.MAX_TERMS_IN_ALL),
    ("combinations of values of parameters, before conditions", parameters.MAX_COMBINATIONS),
    ("declarations, fields, rules, goals and settings, each copy counted", copies.MAX_DECLARATIONS),
    ("state variables", names.MAX_VARIABLES),
    ("values of a state variable", values.MAX_VALUES),
    ("values of all state variables together", values.MAX_VALUES_IN_ALL),
    ("actions", names.MAX_ACTIONS),
    ("a duration", actions.MAX_DURATION),
    ("`max_plan_length`", resolve.MAX_PLAN_LENGTH),
    ("assignments that one entry of alternative effects denotes", effects.MAX_OUTCOMES),
    ("terms looked at to find what all effects denote", effects.MAX_EFFECT_WORK),
    ("cases of all actions, an action without clauses being one", cases.MAX_CASES),
    ("terms of conditions looked at to find all cases", cases.MAX_CASE_WORK),
    ("terms looked at to find where effects disagree, or leave a range", cases.MAX_SEARCH_WORK),
    ("by how much a relative effect may change a value", clauses.MAX_CHANGE),
    ("assignments up to which a predicate is checked for being always or never true", lint.MAX_DECIDED),
    ("terms looked at in all these checks", lint.MAX_LINT_WORK),
]


def diagnostics_document() -> str:
    """The text that `docs/diagnostics.md` has to have."""
    head = (
        "# Diagnostics\n\n"
        "Every message has a code. A code keeps its meaning for ever. An error stops the work (exit code 2, or 1 for\n"
        "TUM4xx). A warning does not: it says what is probably a mistake. A remark is worth knowing, and mostly as it\n"
        "should be; `check` shows them all, `synth` only what it alone can find. This page is made from\n"
        "`tumato_symbolic/diagnostics/codes.py` and compared with it by a test.\n\n"
        "A warning or remark that is meant can be allowed in the text, by a comment on the line that it is about, or\n"
        "in the comments right above that line. Errors cannot be allowed.\n\n"
        "```\n"
        "state S_Door can be open, shut  // allow TUM345: the door shuts by itself\n"
        "// allow TUM341, TUM344: set by the operator\n"
        "state S_Mode can be manual, automatic\n"
        "```\n\n"
        "TUM342 leaves a value `unknown` out: a sensor that may fail has one, and rules treat it as the worst\n"
        "([modelling.md](modelling.md)). `near` and `unknown` may be treated alike; of `near`, `far` and `unknown` "
        "it names the first two.\n\n"
        "| code | | what it is about |\n|---|---|---|\n"
    )
    return head + "".join(f"| {code.name} | {code.severity} | {code.title} |\n" for code in Code)


def test_the_snippets_are_one_specification() -> None:
    """All snippets together load without an error or a warning."""
    assert codes(WHOLE) == []
    assert ALONE
    assert [codes(text) for text in ALONE] == [["TUM326"]] * len(ALONE)


@pytest.mark.parametrize(("code", "text"), WRONG)
def test_wrong_snippets_are_wrong_as_said(code: str, text: str) -> None:
    """In place of the block of the same name, a snippet marked with an error gives that error."""
    title = text.split("\n", 1)[0].removeprefix("BEGIN ")
    block = re.compile(rf"^BEGIN {title}\n.*?^END {title}\n", re.MULTILINE | re.DOTALL)
    assert code in codes(block.sub(lambda _: text, WHOLE))


def test_every_limit_is_documented() -> None:
    """The table of limits has the values of the constants."""
    for what, value in LIMITS:
        assert f"| {what} | {value:,} |" in LANGUAGE


def test_every_code_is_documented() -> None:
    """The table of codes is the one that the code has."""
    assert (DOCS / "diagnostics.md").read_text(encoding="utf-8") == diagnostics_document()
