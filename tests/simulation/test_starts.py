"""Where an execution may start: in the states that are decided, each as likely as the others."""

from collections import Counter
from itertools import product
from random import Random

import pytest
from msgspec.structs import replace

from tests.generate import random_spec
from tests.profiles import PROFILES
from tests.verify.policies import near_policies
from tumato_symbolic.diagrams import DiagramBuilder
from tumato_symbolic.policy import DecisionDiagram, Policy, Vocabulary, as_diagram, policy_from_rows
from tumato_symbolic.semantics import is_valid
from tumato_symbolic.simulation import Dice, NoStartError, Starts


@pytest.mark.parametrize("stored", ["table", "diagram"])
def test_starts_are_the_decided_states_with_the_given_values(stored: str) -> None:
    """All of them, in order, and each can be drawn; where there is none, that is said."""
    none = 0
    for seed in range(30):
        spec, random = random_spec(seed, PROFILES["restoring"]), Random(seed)
        rows = list(near_policies(spec, "any", random, count=0))[-1]
        policy = policy_from_rows(spec, rows)
        policy = policy if stored == "table" else replace(policy, decisions=as_diagram(policy))
        given = {at: random.randrange(len(spec.variables[at].values)) for at in range(seed % 3)}
        wanted = sorted(s for s in rows if is_valid(spec, s) and all(s[at] == value for at, value in given.items()))
        starts = Starts(spec, policy, given)
        if not wanted:
            none += 1
            with pytest.raises(NoStartError):
                starts.draw(Dice(seed))
            continue
        assert starts.all(10_000) == wanted
        assert starts.all(0) is None
        if len(wanted) <= 12:
            dice = Dice(seed)
            assert {starts.draw(dice) for _ in range(40 * len(wanted))} == set(wanted)
    assert none > 0


def test_a_diagram_is_drawn_from_evenly() -> None:
    """Also where it does not test a variable, and where paths have different lengths."""
    spec = random_spec(3, PROFILES["restoring"])
    sizes = [len(variable.values) for variable in spec.variables]
    states = [s for s in product(*map(range, sizes)) if is_valid(spec, s) and (s[0] == 0 or s[-1] == 0)]
    policy = policy_from_rows(spec, dict.fromkeys(states, frozenset[int]()))
    starts, dice = Starts(spec, replace(policy, decisions=as_diagram(policy)), {}), Dice(5)
    drawn = Counter(starts.draw(dice) for _ in range(200 * len(states)))
    assert set(drawn) == set(states)
    assert min(drawn.values()) > 120
    assert max(drawn.values()) < 300


def test_diagrams_of_any_size_are_drawn_from() -> None:
    """A policy that decides all 10^40 states is drawn from at once, and not listed."""
    spec = random_spec(0, PROFILES["restoring"])
    variables = tuple(replace(spec.variables[0], name=f"S_{at}", values=tuple("0123456789")) for at in range(40))
    large = replace(
        spec, variables=variables, assumptions=(), actions=(), state_rules=(), reaction_rules=(), goals=None
    )
    builder = DiagramBuilder[bool](range(40), (False, True))
    policy = Policy(Vocabulary.of(large), DecisionDiagram(builder.finish(), (), builder.leaf(True)))
    starts = Starts(large, policy, {7: 3})
    state = starts.draw(Dice(1))
    assert len(set(state)) > 5
    assert state[7] == 3
    assert starts.all(200_000) is None
