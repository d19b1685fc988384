"""The worst case of an execution is what `verify --guarantees` says, and it is an execution."""

from collections.abc import Mapping
from pathlib import Path
from random import Random

import pytest

from tests.generate import random_spec
from tests.profiles import PROFILES
from tests.repo.examples import EXAMPLES, solved
from tests.simulation.campaign import Tally, examine, worst_cases
from tests.simulation.replay import faults
from tests.verify.policies import near_policies
from tumato_symbolic import Realizable
from tumato_symbolic.explain.decision import Decisions
from tumato_symbolic.limits import Context
from tumato_symbolic.policy import as_table
from tumato_symbolic.semantics import ActionSet, State, Trace, all_states, is_valid
from tumato_symbolic.simulation import worst, worst_case
from tumato_symbolic.spec import Ordering, Spec
from tumato_symbolic.verify.guarantees.analyse import guarantees

Rows = Mapping[State, ActionSet]


def _worst(spec: Spec, rows: Rows, starts: list[State], ordering: Ordering) -> Trace:
    trace = worst_case(spec, rows, starts, ordering, Context())
    assert trace is not None
    assert faults(spec, rows, ordering, trace) == []
    assert trace.start in starts
    return trace


@pytest.mark.parametrize("part", range(4))
def test_generated_policies_are_as_bad_as_guaranteed(part: int) -> None:
    """State by state: the same number of steps, or a way that misses the goal. And their runs by chance are runs."""
    tally = Tally()
    for seed in range(part * 50, part * 50 + 50):
        examine(seed, tally)
    assert tally.complaints == []
    assert {"guaranteed", "fair"} <= tally.states.keys()


def test_a_decision_that_is_not_allowed_guarantees_nothing() -> None:
    """Its worst case is replayed like any other; from where it cannot be reached, all is as it is guaranteed."""
    spec, tally = random_spec(560, PROFILES["restoring"]), Tally()
    rows = next(iter(near_policies(spec, "any", Random(560), count=0)))
    rows = {state: chosen for state, chosen in rows.items() if is_valid(spec, state)}
    assert worst_cases(spec, rows, "any", tally) == []
    assert tally.without
    assert tally.states


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.stem)
def test_examples_are_as_bad_as_guaranteed(example: Path) -> None:
    """Of all states together: no more steps than the worst that is guaranteed, or for ever where some are not."""
    spec, outcome = solved(example)
    if not isinstance(outcome, Realizable):
        pytest.skip("there is no policy")
    table = as_table(outcome.policy, 20_000)
    if table is None:
        pytest.skip("too many states to look at one by one")
    policy = Decisions(spec, outcome.policy)
    levels = guarantees(outcome.policy, spec, spec.ordering).levels
    trace = _worst(spec, policy, list(table.rows), spec.ordering)
    if [level.guarantee.kind for level in levels] == ["guaranteed"]:
        assert (trace.end, len(trace.moves)) == ("goal", levels[0].guarantee.steps)
    else:
        assert trace.end == "loop"
    forced = [level for level in levels if level.guarantee.kind == "guaranteed"]
    ends = [_worst(spec, policy, [state], spec.ordering) for state in list(table.rows)[:60]]
    for each in ends:
        assert each.end == "loop" or (forced and len(each.moves) <= (forced[0].guarantee.steps or 0))


def test_too_much_is_not_looked_at(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where more outcomes can follow than the limit, there is no answer."""
    spec, outcome = solved(next(each for each in EXAMPLES if each.stem == "amr"))
    assert isinstance(outcome, Realizable)
    policy, states = Decisions(spec, outcome.policy), list(all_states(spec))
    monkeypatch.setattr(worst, "MOST_OUTCOMES", 10)
    assert worst_case(spec, policy, states, "any", Context()) is None
