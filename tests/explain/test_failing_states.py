"""Tests of what is remembered about failing_states."""

from random import Random

import pytest

from tests.generate import ALL_PROFILES, random_spec
from tumato_symbolic import parse
from tumato_symbolic.explain import failing_states
from tumato_symbolic.explain.conflicts import conflict_core
from tumato_symbolic.explain.demands import Demands
from tumato_symbolic.explain.elements import Elements
from tumato_symbolic.explain.explain import explain
from tumato_symbolic.explain.explanation import Explanation
from tumato_symbolic.explain.failing_states import FailingStates, failing
from tumato_symbolic.symbolic import Bdd
from tumato_symbolic.synthesis import Unrealizable, repair, synthesize


@pytest.mark.parametrize("profile", ALL_PROFILES)
def test_what_is_remembered_is_so(profile: str) -> None:
    """Asked about one set of elements after another, for all states and for one: the answer is the computed one."""
    random = Random(profile)
    for seed in range(12):
        demands = Demands(random_spec(seed, ALL_PROFILES[profile]), "any", "autoref")
        known, encoding = FailingStates(demands), demands.encoding
        for _ in range(12):
            share = random.random()
            kept = frozenset(each for each in demands.elements if random.random() < share)
            expected = failing(demands, kept, demands.valid)
            if demands.valid != demands.false:
                state = random.choice(list(encoding.states_in(demands.valid)))
                assert known.fails(state, kept) == encoding.contains(expected, state)
            assert known.failing(kept, demands.valid) == expected


def test_an_answer_answers_for_more_and_for_less(monkeypatch: pytest.MonkeyPatch) -> None:
    """What fails does when more is kept, and what does not fail does not when less is: nothing is computed again."""
    demands = Demands(random_spec(1, ALL_PROFILES["mixed"]), "any", "autoref")
    known = FailingStates(demands)
    computed: list[Elements] = []

    def counted(demands: Demands, kept: Elements, states: Bdd) -> Bdd:
        computed.append(kept)
        return failing(demands, kept, states)

    monkeypatch.setattr(failing_states, "failing", counted)
    most: Elements = demands.everything
    least: Elements = frozenset()
    hopeless = known.failing(least, demands.valid)
    winning = demands.valid & ~known.failing(most, demands.valid)
    assert len(computed) == 2
    for element in demands.elements:
        assert known.failing(most - {element}, hopeless) == hopeless
        assert known.failing(frozenset((element,)), winning) == demands.false
    assert known.failing(most, demands.valid) == demands.valid & ~winning
    assert len(computed) == 2


def test_what_no_repair_drops_is_named_first() -> None:
    """The precondition alone would do as a reason, but dropping it does not help."""
    text = """
        BEGIN STATE VECTOR state S_Place can be hall, dock state S_Door can be shut, open END STATE VECTOR
        BEGIN ACTIONS action go preconditions: S_Door is open nominal effects: S_Place is dock END ACTIONS
        BEGIN ASSUMPTIONS assume: NOT (S_Place is dock AND S_Door is shut) END ASSUMPTIONS
        BEGIN GOALS goal type: priority goal: S_Place is dock END GOALS
        """
    found = explain(parse(text))
    assert isinstance(found, Explanation)
    assert found.hopeless == "failing"
    assert [[element.kind for element in reason.core] for reason in found.reasons] == [["assumption"]]


def test_a_conflict_that_is_too_hard_is_not_made_smaller(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where no question about a conflict is answered, all elements are to blame: they suffice."""
    spec = random_spec(101314, ALL_PROFILES["interacting"])
    demands = Demands(spec, "any", "autoref")
    outcome = synthesize(spec, "any", certify=False)
    assert isinstance(outcome, Unrealizable)
    together = outcome.failures[0].states
    assert len(conflict_core(demands, together, demands.everything)) < len(demands.everything)
    monkeypatch.setattr(repair, "ROUNDS", 0)
    assert conflict_core(demands, together, demands.everything) == demands.everything
