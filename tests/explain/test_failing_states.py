"""Tests of what is remembered about failing_states."""

from random import Random

import pytest

from tests.generate import ALL_PROFILES, random_spec
from tumato_symbolic import parse
from tumato_symbolic.explain import failing_states
from tumato_symbolic.explain.conflicts import conflict_core
from tumato_symbolic.explain.elements import Elements
from tumato_symbolic.explain.explain import explain
from tumato_symbolic.explain.explanation import Explanation
from tumato_symbolic.explain.failing_states import FailingStates, failing
from tumato_symbolic.explain.requirements import Requirements
from tumato_symbolic.symbolic import Bdd, available_backend
from tumato_symbolic.synthesis import Unrealizable, repair, synthesize


@pytest.mark.parametrize("profile", ALL_PROFILES)
def test_what_is_remembered_is_so(profile: str) -> None:
    """Asked about one set of elements after another, for all states and for one: the answer is the computed one."""
    random = Random(profile)
    for seed in range(12):
        requirements = Requirements(random_spec(seed, ALL_PROFILES[profile]), "any", available_backend())
        known, encoding = FailingStates(requirements), requirements.encoding
        for _ in range(12):
            share = random.random()
            kept = frozenset(each for each in requirements.elements if random.random() < share)
            expected = failing(requirements, kept, requirements.valid)
            if requirements.valid != requirements.false:
                state = random.choice(list(encoding.states_in(requirements.valid)))
                assert known.fails(state, kept) == encoding.contains(expected, state)
            assert known.failing(kept, requirements.valid) == expected


def test_an_answer_answers_for_more_and_for_less(monkeypatch: pytest.MonkeyPatch) -> None:
    """What fails does when more is kept, and what does not fail does not when less is: nothing is computed again."""
    requirements = Requirements(random_spec(1, ALL_PROFILES["mixed"]), "any", available_backend())
    known = FailingStates(requirements)
    computed: list[Elements] = []

    def counted(requirements: Requirements, kept: Elements, states: Bdd) -> Bdd:
        computed.append(kept)
        return failing(requirements, kept, states)

    monkeypatch.setattr(failing_states, "failing", counted)
    most: Elements = requirements.everything
    least: Elements = frozenset()
    unavoidable = known.failing(least, requirements.valid)
    winning = requirements.valid & ~known.failing(most, requirements.valid)
    assert len(computed) == 2
    for element in requirements.elements:
        assert known.failing(most - {element}, unavoidable) == unavoidable
        assert known.failing(frozenset((element,)), winning) == requirements.false
    assert known.failing(most, requirements.valid) == requirements.valid & ~winning
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
    assert found.unavoidable == "failing"
    assert [[element.kind for element in reason.core] for reason in found.reasons] == [["assumption"]]


def test_a_conflict_that_is_too_hard_is_not_made_smaller(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where no question about a conflict is answered, all elements are to blame: they suffice."""
    spec = random_spec(101314, ALL_PROFILES["interacting"])
    requirements = Requirements(spec, "any", available_backend())
    outcome = synthesize(spec, "any", certify=False)
    assert isinstance(outcome, Unrealizable)
    together = outcome.failures[0].states
    assert len(conflict_core(requirements, together, requirements.everything)) < len(requirements.everything)
    monkeypatch.setattr(repair, "ROUNDS", 0)
    assert conflict_core(requirements, together, requirements.everything) == requirements.everything
