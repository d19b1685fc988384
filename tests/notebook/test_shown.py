"""What policies and results say of themselves, in one line and in the output of a cell."""

from __future__ import annotations

import re
from itertools import product
from typing import Any
from xml.etree import ElementTree

import pytest
from hypothesis import given
from hypothesis import strategies as st
from msgspec.structs import replace

from tests.repo.documents import ROOT
from tumato_symbolic import Policy, Realizable, Undecided, Unrealizable, Verification, parse, synthesize, verify
from tumato_symbolic.limits import Context, Limits
from tumato_symbolic.notebook.failing import failing_html, merged
from tumato_symbolic.policy import Table, Vocabulary, as_diagram, minimal_rules

ODD = Policy(
    Vocabulary((("<i>a</i>", ("&amp;", '"')),), ("<script>", "stop")),
    Table({(0,): frozenset({0}), (1,): frozenset({1})}),
)
"""Names that mean something in HTML."""


def example(name: str) -> Any:
    """What synthesis says of an example."""
    return synthesize(parse((ROOT / "examples" / name).read_text()))


def text_of(html: str) -> list[str]:
    """The texts of HTML, which has to be well-formed."""
    return [text for text in ElementTree.fromstring(html).itertext() if text]


def test_a_policy_in_one_line() -> None:
    """How many states and names it has, and its form; nothing of its rows."""
    assert repr(ODD) == "<Policy: 2 states decided, 1 variable, 2 actions, a table>"
    assert (
        repr(replace(ODD, decisions=as_diagram(ODD))) == "<Policy: 2 states decided, 1 variable, 2 actions, a diagram>"
    )


def test_results_in_one_line() -> None:
    """The verdict first."""
    found = example("amr.tum")
    assert repr(found) == "<Realizable: a policy for 32 valid states, 24 of them safe, runs of up to 4 steps>"
    assert repr(example("two_robots.tum")) == (
        "<Unrealizable: no set of actions is allowed in 112 states; with a certificate>"
    )
    spec = parse((ROOT / "examples" / "amr.tum").read_text())
    assert repr(verify(found.policy, spec)) == ("<Verification: proved (total, safe, goals, minimal), 32 valid states>")
    assert repr(Undecided("the time limit of 1 s was met", None)) == "<Undecided: the time limit of 1 s was met>"
    assert repr(Undecided("no time", found.statistics)) == "<Undecided: no time; 32 valid states>"


def test_rich_shows_the_same_line() -> None:
    """And not every row and every failing state, of which there are thousands."""
    rich = pytest.importorskip("rich.pretty", reason="it comes with import-linter")
    found, failing = example("amr.tum"), example("two_robots.tum")
    proved = verify(found.policy, parse((ROOT / "examples" / "amr.tum").read_text()))
    for each in (found, found.policy, failing, failing.failures[0], proved, Undecided("no time", found.statistics)):
        assert rich.pretty_repr(each, max_width=1_000) == repr(each)


def test_a_proof_says_by_whom() -> None:
    """Each property with its prover, by name."""
    spec = parse((ROOT / "examples" / "amr.tum").read_text())
    texts = text_of(verify(example("amr.tum").policy, spec)._repr_html_())
    assert texts[:3] == ["Proved", "32 valid states", "property"]
    assert texts[texts.index("safe") :][:3] == ["safe", "proved", "by Z3"]


def refuted() -> Verification:
    """The verdict on a policy of the AMR that does nothing where it should charge."""
    spec = parse((ROOT / "examples" / "amr.tum").read_text())
    policy = example("amr.tum").policy
    charge = policy.vocabulary.actions.index("charge")
    rows = {state: chosen - {charge} for state, chosen in policy.decisions.rows.items()}
    return verify(replace(policy, decisions=Table(rows)), spec)


def test_a_refutation() -> None:
    """The refuted properties come first, and each says how it fails."""
    found = refuted()
    assert repr(found) == "<Verification: refuted (goals), proved (total, safe, minimal), 32 valid states>"
    texts = text_of(found._repr_html_())
    assert texts[0] == "Refuted"
    name, verdict, how = texts[texts.index("goals") :][:3]
    assert (name, verdict) == ("goals", "refuted")
    state = r"S_Location=\w+ S_Battery=low S_Load=\w+ S_Conveyor=\w+"
    assert re.fullmatch(rf"goal-missed in {state}, where it executes stop_conveyor", how)


def test_which_states_fail() -> None:
    """In groups by names, with their numbers, and one state."""
    texts = text_of(example("two_robots.tum")._repr_html_())
    assert "No set of actions is allowed in 112 states." in texts
    at = texts.index(
        "S_Loc0 in {corridor, charger} AND S_Conv0 is on AND S_Loc1 in {corridor, charger} AND S_Conv1 is on"
    )
    assert texts[at - 1] == "64"
    assert any(text.startswith("for example S_Loc0=corridor S_Bat0=low") for text in texts)
    assert "others" not in texts


def test_of_many_groups_the_largest_are_shown() -> None:
    """What is not shown is counted."""
    spec = parse("BEGIN STATE VECTOR " + " ".join(f"state v{n} can be a, b" for n in range(6)) + " END STATE VECTOR")
    odd = [state for state in product((0, 1), repeat=6) if sum(state) % 2]
    texts = text_of(failing_html(spec, [("It fails.", 40, odd)]))
    assert texts.count("1") == 8
    assert texts[texts.index("others") - 1] == "32"


@given(st.lists(st.tuples(*3 * [st.integers(0, 2)]), unique=True))
def test_groups_hold_the_states_each_once(states: list[tuple[int, ...]]) -> None:
    """And nothing else."""
    assert sorted(state for cube in merged(states) for state in product(*cube)) == sorted(states)


def test_the_rules_of_a_policy() -> None:
    """All of them, each with its actions, as `show` says them."""
    policy = example("amr.tum").policy
    texts = text_of(policy._repr_html_())
    assert texts[0] == "Policy: 32 states decided"
    rules = minimal_rules(policy)
    assert texts[-3:] == [str(len(rules)), "otherwise", ", ".join(rules[-1].actions)]
    assert "S_Location is charger AND S_Battery is low AND S_Conveyor is off" in texts


def test_names_are_escaped() -> None:
    """A name may be any text."""
    html = ODD._repr_html_()
    assert "<script>" not in html
    assert "<i>" not in html
    assert {"<script>", "<i>a</i> is &amp;"} <= set(text_of(html))


def test_what_is_left_out_is_said() -> None:
    """Beyond some dozens of rules, their number; without a short list, why there is none."""
    values = tuple(map(str, range(60)))
    many = Policy(
        Vocabulary((("S", values),), tuple(f"a{value}" for value in values)),
        Table({(value,): frozenset({value}) for value in range(60)}),
    )
    texts = text_of(many._repr_html_())
    assert "20 more rules: tumato_symbolic.policy.minimal_rules(policy)" in texts
    assert "41" not in texts


@pytest.mark.parametrize("name", ["amr.tum", "two_robots.tum"])
def test_only_the_bar_has_a_colour(name: str) -> None:
    """Text is legible wherever the notebook's own is."""
    found = example(name)
    assert isinstance(found, Realizable | Unrealizable)
    html = found._repr_html_()
    assert html.count("#") == html.count("border-left:4px solid #")
    assert "color" not in html.replace("border-collapse", "")
    title = text_of(html)[0]
    assert title == type(found).__name__


def test_a_result_without_proof_does_not_look_proved() -> None:
    """What synthesis found says that it is not proved yet."""
    assert any("Not proved yet" in text for text in text_of(example("amr.tum")._repr_html_()))


def test_rules_take_no_longer_than_someone_waits(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where time is up, the states that no rule decides are counted."""
    monkeypatch.setattr("tumato_symbolic.notebook.policies.Context", lambda _: Context(Limits(seconds=0.0)))
    texts = text_of(example("amr.tum").policy._repr_html_())
    assert any("time limit" in text for text in texts)
