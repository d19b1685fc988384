"""Policies of one action at a time, where the sets of several are too many: right wherever they are given."""

from __future__ import annotations

from functools import partial
from importlib import import_module
from pathlib import Path

import pytest

from benchmarks.rescue import responders
from tests.checker.standalone import ask
from tests.generate import random_spec
from tests.profiles import ALL_PROFILES
from tumato_symbolic import Realizable, Unrealizable, parse, synthesize
from tumato_symbolic.diagnostics import Code, UserError
from tumato_symbolic.limits import Context
from tumato_symbolic.policy import as_table, dumps
from tumato_symbolic.policy.unrealizability import dumps as certificate_text
from tumato_symbolic.semantics import judge
from tumato_symbolic.spec import Ordering, Spec
from tumato_symbolic.symbolic import Encoding, Steps, available_backend, build_steps, few_steps
from tumato_symbolic.synthesis import SynthesisResult
from tumato_symbolic.verify import ProverName, verify, verify_unrealizable

pipeline = import_module("tumato_symbolic.synthesis.synthesize")
problems = import_module("tumato_symbolic.game.problem")

PROVERS: tuple[ProverName, ...] = ("z3", "walk", "explicit")
SEEDS = range(20)

BOTH_OR_NEITHER = """
BEGIN STATE VECTOR
state S_Left can be down, up
state S_Right can be down, up
END STATE VECTOR
BEGIN ACTIONS
action lift_left
  preconditions: S_Left is down, S_Right is down
  nominal effects: S_Left is up
action lift_right
  preconditions: S_Left is down, S_Right is down
  nominal effects: S_Right is up
action level_left
  preconditions: S_Left is up, S_Right is down
  nominal effects: S_Left is down
action level_right
  preconditions: S_Right is up, S_Left is down
  nominal effects: S_Right is down
END ACTIONS
BEGIN GOALS
goal type: priority
goal: S_Left is up AND S_Right is up
END GOALS
"""

GUARDED = """
BEGIN STATE VECTOR
state S_Place can be dock, aisle, store
state S_Lamp can be off, on
state S_Stock can be empty, full
state S_Door can be open, shut
END STATE VECTOR
BEGIN ACTIONS
for P in dock, aisle, store
  action to_{P}
    duration: 2
    nominal effects: S_Place is {P}
end for
action lamp
  nominal effects: S_Lamp is on
action fill
  preconditions: S_Place is store
  nominal effects: S_Stock is full
action shut
  nominal effects: S_Door is shut
END ACTIONS
BEGIN REACTION RULES
rule: IF executing fill THEN executing lamp
END REACTION RULES
BEGIN STATE RULES
rule: NOT (S_Place is aisle AND S_Door is open)
END STATE RULES
BEGIN GOALS
goal type: constraint
goal: S_Stock is full
goal: S_Door is shut
END GOALS
"""


@pytest.fixture
def few_only(monkeypatch: pytest.MonkeyPatch) -> None:
    """Have `synthesize` look for a policy of one action at a time first, however few sets there are."""

    def steps(encoding: Encoding, ordering: Ordering, most: int | None) -> Steps:
        if most is None or encoding.spec.restores_stepwise:
            return build_steps(encoding, encoding.spec, ordering)
        return few_steps(encoding, encoding.spec, ordering)

    monkeypatch.setattr(problems, "_steps", steps)


def remarks(outcome: SynthesisResult) -> list[str]:
    """What is said of sets that are too many."""
    return [each.message for each in outcome.warnings if each.code == Code.TUM358]


def is_right(spec: Spec, outcome: Realizable, ordering: Ordering) -> bool:
    """Whether a policy is right by the explicit meaning and by every prover."""
    table = as_table(outcome.policy, outcome.statistics.valid)
    assert table is not None
    judged = judge(spec, table.rows, ordering)
    proofs = [verify(outcome.policy, spec, ordering=ordering, prover=prover) for prover in PROVERS]
    proved = all(proof.verdict == "proved" and proof.certificate.status == "used" for proof in proofs)
    return judged.sound_and_complete and judged.minimal and proved


@pytest.mark.parametrize("profile", ALL_PROFILES)
@pytest.mark.parametrize("ordering", ["any", "first"])
def test_no_verdict_is_wrong(profile: str, ordering: Ordering, monkeypatch: pytest.MonkeyPatch) -> None:
    """The verdict is that of the search among all sets, and a policy of one action at a time is right and minimal."""
    for seed in SEEDS:
        spec = random_spec(seed, ALL_PROFILES[profile])
        try:
            full = synthesize(spec, ordering, certify=False, diagnose=False)
        except UserError:
            continue
        with monkeypatch.context() as patched:
            patched.setattr(problems, "_steps", lambda encoding, order, _: few_steps(encoding, encoding.spec, order))
            few = synthesize(spec, ordering, certify=False, diagnose=False)
        assert type(few) is type(full)
        if isinstance(few, Unrealizable) and isinstance(full, Unrealizable):
            assert few.failures == full.failures
        if isinstance(few, Realizable) and few.statistics.one_at_a_time:
            assert is_right(spec, few, ordering)
            assert few.statistics.longest_run is not None
            assert full.statistics is not None
            assert full.statistics.longest_run is not None
            assert few.statistics.longest_run >= full.statistics.longest_run


def test_sets_that_are_too_many_are_left_alone(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """Beyond the limit a policy executes one action at a time, is right, and comes with the remark; not below."""
    spec = parse(responders(2, True))
    whole = synthesize(spec)
    assert not remarks(whole)
    monkeypatch.setattr(pipeline, "MOST_NODES", 1000)
    outcome = synthesize(spec)
    assert isinstance(outcome, Realizable)
    assert len(remarks(outcome)) == 1
    assert is_right(spec, outcome, "any")
    table = as_table(outcome.policy, outcome.statistics.valid)
    assert table is not None
    assert max(map(len, table.rows.values())) == 1
    assert ask(tmp_path, dumps(outcome.policy), responders(2, True)).code == 0


def test_which_machine_helps_whom_takes_little_to_prove(monkeypatch: pytest.MonkeyPatch) -> None:
    """One machine acts at a time, so the proof looks at each action by itself, and not at all machines together."""
    monkeypatch.setattr(pipeline, "MOST_NODES", 20_000)
    spec = parse(responders(3, True))
    outcome = synthesize(spec)
    assert isinstance(outcome, Realizable)
    assert remarks(outcome)
    steps = import_module("tumato_symbolic.verify.by_diagrams.steps")
    monkeypatch.setattr(steps, "Walk", partial(steps.Walk, most_steps=20_000))
    answer = verify(outcome.policy, spec, prover="walk")
    assert answer.verdict == "proved"
    assert answer.certificate.status == "used"


def test_both_backends_give_up_alike(monkeypatch: pytest.MonkeyPatch) -> None:
    """Nodes are counted alike on both backends, so the same specification gives the same policy, byte for byte."""
    monkeypatch.setattr(pipeline, "MOST_NODES", 1000)
    found = [synthesize(parse(responders(2, True)), backend=each) for each in ("autoref", available_backend())]
    policies = {dumps(each.policy) for each in found if isinstance(each, Realizable)}
    assert len(policies) == 1
    assert all(map(remarks, found))


@pytest.mark.usefixtures("few_only")
def test_several_actions_at_once_are_found_all_the_same() -> None:
    """Where one action at a time does not do, all sets are looked at, and that is said."""
    learned: list[object] = []
    outcome = synthesize(parse(BOTH_OR_NEITHER), context=Context(learned=learned.append))
    assert isinstance(outcome, Realizable)
    assert not outcome.statistics.one_at_a_time
    assert "no policy of one action at a time" in remarks(outcome)[0]
    assert not [each for each in learned if isinstance(each, Unrealizable)]


@pytest.mark.usefixtures("few_only")
@pytest.mark.parametrize("ordering", ["any", "first"])
def test_what_reaction_rules_ask_for_goes_along(ordering: Ordering) -> None:
    """A set has what reaction rules ask for beside its one action, and the cheapest set of all restores safety."""
    spec = parse(GUARDED)
    outcome = synthesize(spec, ordering)
    assert isinstance(outcome, Realizable)
    assert outcome.statistics.one_at_a_time
    assert is_right(spec, outcome, ordering)
    state = {"S_Place": "store", "S_Lamp": "off", "S_Stock": "empty", "S_Door": "open"}
    assert set(outcome.policy.decide(state)) == {"fill", "lamp"}
    assert outcome.policy.decide({**state, "S_Place": "aisle"}) == ("shut",)


@pytest.mark.usefixtures("few_only")
def test_a_part_of_a_goal_that_cannot_be_reached_is_enough(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """That there is no policy is found without all sets, with exactly the states that fail, and it is proved."""
    text = responders(2, False)
    spec = parse(text)
    with monkeypatch.context() as patched:
        patched.setattr(pipeline, "with_all_sets", None)
        outcome = synthesize(spec)
    assert isinstance(outcome, Unrealizable)
    assert outcome.certificate is not None
    assert verify_unrealizable(outcome.certificate, spec).verdict == "proved"
    assert ask(tmp_path, certificate_text(outcome.certificate), text).code == 0
    monkeypatch.undo()
    full = synthesize(spec)
    assert isinstance(full, Unrealizable)
    assert outcome.failures == full.failures


@pytest.mark.usefixtures("few_only")
def test_a_plan_bound_is_kept() -> None:
    """Where one subgoal after the other takes too long, the shortest runs of single actions are looked for."""
    bounded = responders(2, True) + "\nBEGIN CONFIG\nmax_plan_length: {}\nEND CONFIG\n"
    for bound in (40, 12):
        spec = parse(bounded.format(bound))
        outcome = synthesize(spec)
        assert isinstance(outcome, Realizable)
        assert outcome.statistics.longest_run is not None
        assert outcome.statistics.longest_run <= bound
        assert verify(outcome.policy, spec).verdict == "proved"


@pytest.mark.usefixtures("few_only")
def test_from_the_starts_all_valid_states_are_decided() -> None:
    """With starts the policy decides all valid states, or is looked for among all sets."""
    spec = parse(GUARDED + "\nBEGIN START\nstart: S_Place is dock\nEND START\n")
    outcome = synthesize(spec)
    assert isinstance(outcome, Realizable)
    assert outcome.statistics.one_at_a_time
    assert outcome.statistics.part is not None
    assert outcome.statistics.part.decided == outcome.statistics.valid == 24
    assert verify(outcome.policy, spec).verdict == "proved"
