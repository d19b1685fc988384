"""Start states: generated specifications, and what the rooms say of them."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from random import Random

import pytest

from tests.checker.standalone import ask
from tests.printing import print_spec
from tests.starts.campaign import LARGER, SMALL, Tally, examine, specifications
from tumato_symbolic import Realizable, Undecided, Unrealizable, parse, synthesize
from tumato_symbolic.diagnostics import Code, UserError
from tumato_symbolic.explain.explain import explain
from tumato_symbolic.explain.explanation import Explanation, NothingToExplain
from tumato_symbolic.policy import as_table, dumps, policy_from_rows
from tumato_symbolic.policy.guarantees import dumps as guarantees_text
from tumato_symbolic.semantics import guarantees as explicit_guarantees
from tumato_symbolic.semantics import holds
from tumato_symbolic.semantics.judge import one_of
from tumato_symbolic.simulation import Dice, NoStartError, Starts
from tumato_symbolic.spec import digest
from tumato_symbolic.synthesis import starts as synthesis_starts
from tumato_symbolic.synthesis.synthesize import PolicyFormat
from tumato_symbolic.verify import verify, verify_unrealizable
from tumato_symbolic.verify.guarantees.analyse import guarantees

CONFLICT = """
BEGIN STATE VECTOR state x can be l, m, r, L, R END STATE VECTOR
BEGIN ACTIONS
action lm preconditions: x is l nominal effects: x is m
action rm preconditions: x is r nominal effects: x is m
action mL preconditions: x is m nominal effects: x is L
action mR preconditions: x is m nominal effects: x is R
END ACTIONS
BEGIN GOALS goal type: priority when x is l then goal: x is R when x is r then goal: x is L END GOALS
"""
"""From l and from r runs pass m, which can lead to one side only."""


def begun(*conditions: str) -> str:
    """The conflict with start conditions."""
    return CONFLICT + "BEGIN START " + " ".join(f"start: {each}" for each in conditions) + " END START"


@pytest.mark.parametrize("seed", range(9000, 9003))
def test_generated_specifications_against_every_closed_set_and_policy(seed: int, tmp_path: Path) -> None:
    """Verdict, part and policy are those of brute force; every judge agrees, on mutated policies as well."""
    tally = Tally()
    for name, spec in specifications(seed):
        for ordering in ("any", "first"):
            tally.complaints += [f"{name} {ordering}: {each}" for each in examine(spec, ordering, tally, tmp_path)]
    assert not tally.complaints
    assert tally.tried


def test_a_text_with_starts_is_read_back() -> None:
    """What is printed means the same, and the starts are part of the digest."""
    for seed in range(20):
        for _, spec in specifications(seed):
            found = parse(print_spec(spec, Random(seed)))
            assert [rule.formula for rule in found.starts] == [rule.formula for rule in spec.starts]
            assert digest(found) == digest(spec)
    assert digest(parse(begun("x is l"))) != digest(parse(CONFLICT)) == digest(parse(begun()))
    assert digest(parse(begun("x is l", "x is m"))) == digest(parse(begun("x is m", "x is l", "x is m")))


def test_without_start_conditions_nothing_changes() -> None:
    """An empty block, or conditions that every valid state satisfies where all can be decided."""
    plain, empty = synthesize(parse(CONFLICT)), synthesize(parse(begun()))
    assert isinstance(plain, Unrealizable) and isinstance(empty, Unrealizable)
    assert plain.failures == empty.failures and empty.certificate == plain.certificate
    everywhere = synthesize(parse(begun("true").replace("goal: x is L", "goal: true")))
    assert isinstance(everywhere, Realizable) and everywhere.statistics.part is not None
    assert (everywhere.statistics.part.decided, everywhere.statistics.part.left_out) == (5, ())


def test_where_goals_conflict_what_is_left_out_is_told() -> None:
    """The state of the conflict without which the starts can be served."""
    outcome = synthesize(parse(begun("x is l")))
    assert isinstance(outcome, Realizable) and outcome.statistics.part is not None
    (left,) = outcome.statistics.part.left_out
    assert (left.kind, left.states) == ("conflict", ((2,),))


def test_an_environment_that_leads_out_is_warned_of() -> None:
    """A variable that no action changes, where another value of it is not decided; not where all values are."""
    asked = """
    BEGIN STATE VECTOR state x can be a, b state wind can be calm, strong END STATE VECTOR
    BEGIN ACTIONS action go preconditions: x is a, wind is calm nominal effects: x is b END ACTIONS
    BEGIN GOALS goal type: priority goal: x is b END GOALS
    BEGIN START start: x is {} END START
    """
    for start, codes in (("a AND wind is calm", [Code.TUM357]), ("b", [Code.TUM357])):
        outcome = synthesize(parse(asked.replace("{}", start)))
        assert isinstance(outcome, Realizable)
        assert [each.code for each in outcome.warnings] == codes
    assert "to 1 state such as x=a wind=strong" in outcome.warnings[0].message
    everywhere = asked.replace("x is a, wind is calm", "x is a").replace("{}", "b")
    outcome = synthesize(parse(everywhere))
    assert isinstance(outcome, Realizable) and not outcome.warnings


def test_too_many_parts_are_undecided(monkeypatch: pytest.MonkeyPatch) -> None:
    """Never a wrong answer: the limit is told."""
    monkeypatch.setattr(synthesis_starts, "PARTS", 1)
    outcome = synthesize(parse(begun("x is l")))
    assert isinstance(outcome, Undecided) and "1 parts of the states" in outcome.limit


def test_starts_that_no_valid_state_satisfies_are_an_error() -> None:
    """In synthesis, and for every prover."""
    spec = parse(begun("x is l AND x is m"))
    with pytest.raises(UserError, match="no valid state is a start"):
        synthesize(spec)
    for prover in ("z3", "walk", "explicit", "both", "auto"):
        with pytest.raises(UserError, match="no valid state is a start"):
            verify(policy_from_rows(spec, {}), spec, prover=prover)


def test_a_policy_is_judged_by_the_part_that_it_decides() -> None:
    """In any form, by every prover; what is counted is what is decided."""
    spec = parse(begun("x is l"))
    for policy_format in ("table", "diagram"):
        outcome = synthesize(spec, policy_format=policy_format)
        assert isinstance(outcome, Realizable)
        for prover in ("z3", "walk", "explicit", "both", "auto"):
            found = verify(outcome.policy, spec, prover=prover)
            assert (found.verdict, found.from_starts, found.decides_all) == ("proved", True, False)
            assert (found.valid_states, found.decided_states, found.certificate.status) == (5, 4, "used")


def test_what_does_not_know_starts_refuses_them() -> None:
    """Proofs that goals conflict."""
    spec, plain = parse(begun("x is l")), synthesize(parse(CONFLICT))
    assert isinstance(plain, Unrealizable) and plain.certificate is not None
    with pytest.raises(UserError, match="does not support START"):
        verify_unrealizable(plain.certificate, spec)


def test_what_is_guaranteed_is_guaranteed_of_decided_states(tmp_path: Path) -> None:
    """The levels are those of the explicit meaning, and the stand-alone checker accepts their certificate."""
    looked_at = 0
    for seed in range(9100, 9110):
        for name, spec in specifications(seed):
            outcome = synthesize(spec, "any")
            table = as_table(outcome.policy, 100) if isinstance(outcome, Realizable) else None
            if not isinstance(outcome, Realizable) or table is None or name.startswith("larger"):
                continue
            found = guarantees(outcome.policy, spec, "any", certify=True)
            truth = Counter(explicit_guarantees(spec.within(one_of(table.rows)), table.rows, "any").values())
            counts: Counter[str] = Counter()
            for level in found.levels:
                counts[level.guarantee.kind] += level.states
            assert counts == Counter(each.kind for each in truth.elements() if each is not None)
            assert found.certificate is not None
            (tmp_path / "guarantees.json").write_text(guarantees_text(found.certificate))
            options = ("--effect-ordering", "any", "--guarantees", str(tmp_path / "guarantees.json"))
            answer = ask(tmp_path, dumps(outcome.policy), print_spec(spec, Random(0)), *options)
            assert answer.code == 0, answer.out
            looked_at += 1
    assert looked_at > 3


@pytest.mark.parametrize("policy_format", ["table", "diagram"])
def test_executions_start_in_starts(policy_format: PolicyFormat) -> None:
    """Not in what is decided besides; where no start has the given values, that is said."""
    spec = parse(begun("x is l"))
    outcome = synthesize(spec, policy_format=policy_format)
    assert isinstance(outcome, Realizable)
    assert Starts(spec, outcome.policy, {}).all(10) == [(0,)]
    assert {Starts(spec, outcome.policy, {}).draw(Dice(seed)) for seed in range(20)} == {(0,)}
    with pytest.raises(NoStartError, match="decides no start"):
        Starts(spec, outcome.policy, {0: 1}).draw(Dice(0))


def test_explain_names_the_starts_that_fail() -> None:
    """The lines to blame are those of starts that fail at once; what is left out is said."""
    stuck = CONFLICT.replace("nominal effects: x is L", "nominal effects: x is m")
    found = explain(parse(stuck + "BEGIN START start: x is r start: x is m END START"))
    assert isinstance(found, Explanation)
    assert [(group.kind, group.count, group.example) for group in found.groups] == [("no-plan", 1, (2,))]
    assert [each.stage for each in found.left_out] == ["part", "repairs"]
    assert [(reason.kind, reason.count) for reason in found.reasons] == [("no-plan", 1)] and not found.omitted
    assert isinstance(explain(parse(begun("x is r"))), NothingToExplain)


def test_a_start_that_fails_for_what_it_leads_to_has_no_lines_to_blame() -> None:
    """It is counted, and `synth` says which step is left out."""
    asked = """
    BEGIN STATE VECTOR state x can be a, b, c END STATE VECTOR
    BEGIN ACTIONS action go preconditions: x is a nominal effects: x is b alternative effects: x is c END ACTIONS
    BEGIN GOALS goal type: priority goal: x is b END GOALS
    BEGIN START start: x is a END START
    """
    found, outcome = explain(parse(asked)), synthesize(parse(asked))
    assert isinstance(found, Explanation) and isinstance(outcome, Unrealizable)
    assert (found.failing_states, found.reasons, found.omitted) == (1, (), 1)
    (failure,) = outcome.failures
    assert (failure.kind, failure.states, outcome.certificate) == ("no-plan", ((0,),), None)
    assert failure.within is not None and [holds(failure.within, (value,)) for value in range(3)] == [True, True, False]


def test_the_policy_of_a_part_is_a_table_with_its_states_only() -> None:
    """A state that is left out has no row."""
    outcome = synthesize(parse(begun("x is r")))
    assert isinstance(outcome, Realizable)
    table = as_table(outcome.policy, 10)
    assert table is not None and sorted(table.rows) == [(1,), (2,), (3,), (4,)]


def test_the_generator_makes_what_is_asked() -> None:
    """Every profile has specifications with starts, in every restoration."""
    found = [spec for seed in range(12) for _, spec in specifications(seed)]
    assert {spec.restoration for spec in found} == {"one_step", "bounded", "fair"}
    assert len(found) == 12 * len({**SMALL, **LARGER}) and all(spec.starts for spec in found)
