"""How what a policy nominally writes is taken apart: which actions go together, and into how many cases."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from importlib import import_module

import pytest

from tests.semantics.build import Build
from tumato_symbolic.policy import as_diagram, policy_from_rows
from tumato_symbolic.semantics import all_states
from tumato_symbolic.verify.by_diagrams.cases import Cases
from tumato_symbolic.verify.by_diagrams.closed_loop import ClosedLoop
from tumato_symbolic.verify.by_diagrams.functions import TRUE, Function
from tumato_symbolic.verify.by_diagrams.walk import Walk

MODULE = import_module("tumato_symbolic.verify.by_diagrams.cases")
PLACES = "abcdefgh"


def _made(nominal: Sequence[str], executed: Sequence[Mapping[int, str]], variables: str = "xyz") -> Cases:
    """Actions with these nominal effects, each executed in some places: the values of the first variable."""
    build = Build(dict.fromkeys(variables, PLACES))
    for effect in nominal:
        build.action(effect)
    walk = Walk(range(len(variables)), [len(PLACES)] * len(variables))

    def at(places: str) -> Function:
        return walk.by_value(0, [int(place in places) for place in PLACES])

    groups = [{action: at(places) for action, places in group.items()} for group in executed]
    return Cases(build.spec(), walk, TRUE, groups)


def test_an_action_goes_where_there_is_room() -> None:
    """Into the first block, or one of its group; members of a group meet where a policy ignores their resources."""
    groups = [{0: "a", 1: "b", 2: "b", 3: "a"}, {4: "a", 5: "c", 6: "b"}, {7: "c"}]
    made = _made(["y=a"] * 8, groups)
    assert [block.actions for block in made._blocks] == [[0, 1, 5], [2, 3], [4, 6], [7]]


@pytest.mark.parametrize(
    ("most", "nodes", "few"), [(8, 0, True), (7, 0, False), (2, 767, False), (2, 768, True), (4, 383, False)]
)
def test_how_many_cases_are_few(most: int, nodes: int, few: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    """So many for every 64 nodes of a block: here there are three blocks and 2^3 cases."""
    monkeypatch.setattr(MODULE, "MOST_CASES", most)
    found = _made(["x=a", "y=b", "z=c"], [{0: "abcd"}, {1: "abef"}, {2: "aceg"}]).apart(nodes)
    assert all(not case.changed for case in found) == few


def test_what_is_never_written_together_is_no_case(monkeypatch: pytest.MonkeyPatch) -> None:
    """One of two actions is executed everywhere, so that there are two cases of them and a third that always is."""
    monkeypatch.setattr(MODULE, "MOST_CASES", 2)
    found = _made(["x=a", "x=b", "y=c"], [{0: "abcd", 1: "efgh"}, {2: PLACES}]).apart(0)
    assert [(case.writes, case.changed) for case in found] == [({0: 0, 1: 2}, {}), ({0: 1, 1: 2}, {})]


def test_many_cases_are_those_of_one_group(monkeypatch: pytest.MonkeyPatch) -> None:
    """What others write is beside that, also of those that there is room for in the first block."""
    monkeypatch.setattr(MODULE, "MOST_CASES", 0)
    made = _made(["x=a", "x=b", "y=a", "z=d"], [{0: "a", 1: "b"}, {2: "c"}, {3: "bc"}])
    assert made._blocks[0].actions == [0, 1, 2]
    found = made.apart(0)
    assert [(case.writes, set(case.changed)) for case in found] == [({}, {1, 2}), ({0: 0}, set()), ({0: 1}, {2})]


def test_the_largest_group_is_taken_apart_first(monkeypatch: pytest.MonkeyPatch) -> None:
    """Whichever is declared first; of its actions, one writes nothing."""
    monkeypatch.setattr(MODULE, "MOST_CASES", 0)
    build = Build({"x": "abc", "y": "ab"}, resources="R")
    build.action("y=a")
    for effect in ("x=a", "x=b", ""):
        build.action(effect, needs="R")
    spec = build.spec()
    rows = {state: frozenset((0, 1 + state[0])) for state in all_states(spec)}
    model = ClosedLoop(spec, as_diagram(policy_from_rows(spec, rows)), "any")
    assert [case.writes for case in model.cases] == [{}, {0: 0}, {0: 1}]
    assert [case.where for case in model.cases] == [model.policy[number] for number in (3, 1, 2)]


def test_a_policy_that_does_nothing_is_one_case() -> None:
    """There is no block then."""
    (case,) = _made(["x=a"], [{}]).apart(1000)
    assert (case.where, case.writes, case.changed) == (TRUE, {}, {})
