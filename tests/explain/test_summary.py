"""Tests of what long cores come to: one sentence, which the explicit meaning bears out."""

import re
from itertools import product

import pytest

from tests.cli.golden import CASES, golden_path
from tests.explain.robots import battery
from tests.generate import PROFILES, random_spec
from tumato_symbolic import parse
from tumato_symbolic.diagnostics import Source
from tumato_symbolic.explain.explain import explain
from tumato_symbolic.explain.explanation import Explanation, Reason
from tumato_symbolic.explain.summary import Summary
from tumato_symbolic.report.explained import Explained, as_text
from tumato_symbolic.report.explained_data import as_json
from tumato_symbolic.semantics import State, allowed_sets, holds, is_valid, successor
from tumato_symbolic.spec import Spec


def _summed_up(text: str) -> tuple[Spec, Explanation, str]:
    spec = parse(text)
    found = explain(spec, wanted_repairs=0)
    assert isinstance(found, Explanation)
    return spec, found, as_text(Explained(Source("x.tum", text), spec, found, (), None, False), False)


def test_a_core_of_many_lines_is_summed_up() -> None:
    """A battery with a move for each level: that nothing charges it away from home, in place of 100 preconditions."""
    spec, found, report = _summed_up(battery(50))
    assert "  because of these 100, taken together:\n    no action raises B while P is away\n" in report
    assert "    no allowed set of actions changes P while B in {b0, b1}\n" in report
    shown = as_json(Explained(Source("x.tum", ""), spec, found, (), None, False))["failures"]
    assert isinstance(shown, list)
    assert shown[0]["summary"] == "no action raises B while P is away"
    assert len(shown[0]["core"]) == 100


def test_equal_lines_of_a_long_core_are_told_once() -> None:
    """With how many there are like them."""
    case = next(case for case in CASES if case.name == "explain-grid5")
    report = golden_path(case).read_text()
    assert re.search(r"grid5.tum:\d+: alternative effects: none \(and \d+ more like this\)", report)


@pytest.mark.parametrize("seed", range(300, 328))
def test_a_summary_is_true(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """In every valid state of its cube, as the explicit meaning has it; and it is about all states of the reason."""
    monkeypatch.setattr("tumato_symbolic.explain.summary.LONG", 0)
    spec = random_spec(seed, list(PROFILES.values())[seed % len(PROFILES)])
    found = explain(spec, wanted_repairs=0)
    for reason in found.reasons if isinstance(found, Explanation) else ():
        if reason.summary is not None:
            assert all(_is_true(spec, reason.summary, state) for state in _valid(spec, reason.summary.where))
            assert set(_states(spec, reason)) <= set(_valid(spec, reason.summary.where))


def _valid(spec: Spec, cube: tuple[tuple[int, ...], ...]) -> list[State]:
    return [state for state in product(*cube) if is_valid(spec, state)]


def _states(spec: Spec, reason: Reason) -> list[State]:
    return [state for cube in reason.cubes for state in _valid(spec, cube)]


def _is_true(spec: Spec, said: Summary, state: State) -> bool:
    if said.by_itself:
        able = (each for each in spec.actions if all(holds(rule.formula, state) for rule in each.preconditions))
        after = [dict(action.nominal).get(said.variable, state[said.variable]) for action in able]
    else:
        sets = allowed_sets(spec, state, spec.ordering)
        after = [successor(spec, state, chosen)[said.variable] for chosen in sets]
    match said.change:
        case "raises":
            return all(value <= state[said.variable] for value in after)
        case "lowers":
            return all(value >= state[said.variable] for value in after)
    return all(value == state[said.variable] or value not in said.values for value in after)
