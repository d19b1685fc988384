"""What is found of a text is what `synth` finds of it."""

import json
from pathlib import Path

import pytest

from tests.cli.conftest import Cli
from tests.generate import random_text
from tests.profiles import ALL_PROFILES
from tests.sweep.here import AMR, COIN
from tumato_symbolic import Realizable, parse, synthesize
from tumato_symbolic.limits import Context
from tumato_symbolic.sweep import Task, dropped, mutated
from tumato_symbolic.sweep.solving import solved
from tumato_symbolic.sweep.sweeping import differs
from tumato_symbolic.views import counted, difference


@pytest.mark.parametrize("profile", sorted(ALL_PROFILES))
def test_as_synth_does_it(profile: str, cli: Cli, tmp_path: Path) -> None:
    """Verdict, proof, numbers of states and failures, of a variant that is written out."""
    for seed in range(2):
        text = random_text(seed, ALL_PROFILES[profile])
        (tmp_path / "variant.tum").write_text(text)
        theirs = json.loads(cli("synth", "variant.tum", "--output-format", "json").out)
        ours = solved(Task("variant.tum", text)).result
        if theirs["verdict"] == "error":
            codes = [each["code"] for each in theirs["diagnostics"]]
            assert [each["code"] for each in ours["diagnostics"]] == codes  # type: ignore[attr-defined]
            continue
        assert ours["verdict"] == theirs["verdict"]
        assert ours["longest_run"] == theirs["longest_run"]
        assert ours["proof"] == (None if theirs["proof"] is None else theirs["proof"]["verdict"])
        assert ours["states"].items() >= theirs["states"].items()  # type: ignore[attr-defined]
        assert ours["failures"] == [{key: each[key] for key in ("kind", "count")} for each in theirs["failures"]]


def test_what_is_compared_is_what_differs() -> None:
    """The numbers are those of `diff`, for all mutations of a small specification."""
    base = synthesize(parse(COIN.text))
    assert isinstance(base, Realizable)
    for variant in (*dropped(COIN), *mutated(COIN, 30, 0)[0]):
        outcome = synthesize(parse(variant.text(COIN)))
        if isinstance(outcome, Realizable):
            found = difference(base.policy, outcome.policy)
            ours = counted(base.policy, outcome.policy, Context())
            assert (ours.compared, ours.changed) == (found.compared, found.changed)
            newly = [each.states for each in found.changes if each.before.actions is None]
            gone = [each.states for each in found.changes if each.after.actions is None]
            assert (ours.won, ours.lost) == (sum(newly), sum(gone))


def test_what_makes_a_difference() -> None:
    """A verdict, failing states or decisions; not a number of steps or of safe states."""
    base = {"variant": 0, **solved(Task("amr.tum", AMR.text, policy=True)).result}
    against = solved(Task("amr.tum", AMR.text, policy=True)).policy
    found = {}
    for old, new in (
        ("max_plan_length: 5", "max_plan_length: 4"),
        ("max_plan_length: 5", "max_plan_length: 3"),
        ("S_Battery is ok\nEND", "S_Battery is low\nEND"),
        ("duration: 50", "duration: 51"),
        ("BEGIN STATE RULES", "BEGIN STATE RULES rule: S_Battery is ok"),
    ):
        line = solved(Task("amr.tum", AMR.text.replace(old, new), prove=False, against=against)).result
        found[new] = differs(line, base)
    assert list(found.values()) == [False, True, True, False, True]
    one = {"compared": 32, "changed": 1, "lost": 0, "won": 0}
    assert differs({**base, "compared": one}, base) is True
    none = {**base, "verdict": "unrealizable", "failures": [{"kind": "no-plan", "count": 3}]}
    assert differs(none, none) is False
    assert differs({**none, "failures": [{"kind": "no-plan", "count": 4}]}, none) is True
    assert differs(base, None) is None
    assert differs({**base, "verdict": "undecided"}, base) is None
    assert differs({**base, "compared": None}, base) is None


def test_a_limit_and_a_mistake_are_results() -> None:
    """With which limit, and what is wrong where."""
    found = solved(Task("amr.tum", AMR.text, seconds=0.000001)).result
    assert (found["verdict"], "time limit" in str(found["limit"])) == ("undecided", True)
    wrong = solved(
        Task("amr.tum", AMR.text.replace("S_Battery is ok\nEND ACTIONS", "S_Batery is ok\nEND ACTIONS"))
    ).result
    assert wrong["verdict"] == "error"
    assert [(each["code"], each["line"]) for each in wrong["diagnostics"]] == [("TUM201", 63)]  # type: ignore[attr-defined]
    none = solved(
        Task(
            "none",
            "BEGIN STATE VECTOR state a can be x, y END STATE VECTOR BEGIN ASSUMPTIONS assume: false END ASSUMPTIONS",
        )
    )
    assert none.result["verdict"] == "error"
