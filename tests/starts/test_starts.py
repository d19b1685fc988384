"""Start states: generated specifications, and what the rooms say of them."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from random import Random

import pytest
from msgspec.structs import replace

from tests.checker.standalone import ask
from tests.explain.oracle import repaired
from tests.printing import print_spec
from tests.starts.campaign import LARGER, SMALL, Tally, examine, specifications
from tumato_symbolic import Realizable, Undecided, Unrealizable, parse, synthesize
from tumato_symbolic.diagnostics import Code, Source, UserError
from tumato_symbolic.explain.additions import NewAction
from tumato_symbolic.explain.explain import explain
from tumato_symbolic.explain.explanation import Explanation, NothingToExplain, Wanted
from tumato_symbolic.explain.writing import with_starts
from tumato_symbolic.policy import as_table, dumps, policy_from_rows, unrealizability
from tumato_symbolic.policy.guarantees import dumps as guarantees_text
from tumato_symbolic.policy.unrealizability import Case, Conflict, Divided, NoPart, StartRemoved, Unrealizability
from tumato_symbolic.semantics import guarantees as explicit_guarantees
from tumato_symbolic.semantics import holds
from tumato_symbolic.semantics.judge import one_of
from tumato_symbolic.simulation import Dice, NoStartError, Starts
from tumato_symbolic.spec import digest
from tumato_symbolic.synthesis import no_part, parts
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


def test_generated_specifications_against_every_closed_set_and_policy(tmp_path: Path) -> None:
    """Verdict, part and policy are those of brute force; every judge agrees, on mutated policies as well.

    `python -m tests.starts` asks about many specifications.
    """
    tally = Tally()
    for name, spec in specifications(9000):
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
    monkeypatch.setattr(parts, "PARTS", 1)
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


LATE = """
BEGIN STATE VECTOR state x can be a, b, c, d END STATE VECTOR
BEGIN ACTIONS
action ab preconditions: x is a nominal effects: x is b alternative effects: x is c
action cd preconditions: x is c nominal effects: x is d
END ACTIONS
BEGIN GOALS goal type: priority when x is d then goal: x is a goal: x in {b, d} END GOALS
BEGIN START start: x is a END START
"""
"""From a the robot may come to c, from there to d, and from d nothing leads to a."""

TIED = """
BEGIN STATE VECTOR state x can be s, l, m, r, L, R END STATE VECTOR
BEGIN ACTIONS
action begin preconditions: x is s nominal effects: x is l alternative effects: x is r
action lm preconditions: x is l nominal effects: x is m
action rm preconditions: x is r nominal effects: x is m
action mL preconditions: x is m nominal effects: x is L
action mR preconditions: x is m nominal effects: x is R
END ACTIONS
BEGIN GOALS
goal type: priority when x is s then goal: x in {l, r} when x is l then goal: x is R when x is r then goal: x is L
END GOALS
BEGIN START start: x is s END START
"""
"""Both states that cannot be served together follow the start."""


def believed(text: str, certificate: Unrealizability, folder: Path) -> tuple[str, str | None, int]:
    """The verdict of `verify` with its reason, and the exit code of the stand-alone checker."""
    found = verify_unrealizable(certificate, parse(text))
    return found.verdict, found.reason, ask(folder, unrealizability.dumps(certificate), text).code


def test_what_fails_later_is_removed_first(tmp_path: Path) -> None:
    """Layer by layer, until a start is removed; each layer is needed, in its order."""
    outcome = synthesize(parse(LATE))
    assert isinstance(outcome, Unrealizable) and outcome.certificate is not None
    assert isinstance(outcome.certificate.reason, NoPart)
    (part,) = outcome.certificate.reason.parts
    assert isinstance(part, StartRemoved) and part.state == (0,) and len(part.removals) == 3
    assert believed(LATE, outcome.certificate, tmp_path) == ("proved", None, 0)
    removals = part.removals
    for others in (removals[1:], removals[:-1], removals[::-1], ()):
        worse = replace(outcome.certificate, reason=NoPart((replace(part, removals=others),)))
        assert believed(LATE, worse, tmp_path)[::2] == ("refuted", 1)
    elsewhere = replace(outcome.certificate, reason=NoPart((replace(part, state=(3,)),)))
    why = "the state x=d is no start, so it need not be decided"
    assert believed(LATE, elsewhere, tmp_path) == ("refuted", why, 1)


def test_goals_that_conflict_among_what_follows_have_a_case_for_each(tmp_path: Path) -> None:
    """A policy leaves out one of the states, and then it cannot serve the start; no case may be missing or shared."""
    outcome = synthesize(parse(TIED))
    assert isinstance(outcome, Unrealizable) and outcome.certificate is not None
    assert isinstance(outcome.certificate.reason, NoPart)
    first, *others = outcome.certificate.reason.parts
    assert isinstance(first, Divided) and not first.removals
    assert first.cases == (Case((1,), 1), Case((3,), 2))
    assert [part.state for part in others if isinstance(part, StartRemoved)] == [(0,), (0,)]
    assert believed(TIED, outcome.certificate, tmp_path) == ("proved", None, 0)
    for cases in (first.cases[:1], (), (Case((1,), 1), Case((3,), 1)), (Case((1,), 0), Case((3,), 2))):
        worse = replace(outcome.certificate, reason=NoPart((replace(first, cases=cases), *others)))
        assert believed(TIED, worse, tmp_path)[::2] == ("refuted", 1)
    for reason in (first.conflict, NoPart((first, others[0])), NoPart(())):
        assert believed(TIED, replace(outcome.certificate, reason=reason), tmp_path)[::2] == ("refuted", 1)


def test_goals_of_starts_that_conflict_have_the_certificate_of_a_conflict(tmp_path: Path) -> None:
    """Nothing is left out for it; where not all of its states are starts, it proves nothing."""
    text = begun("x is l", "x is r")
    outcome = synthesize(parse(text))
    assert isinstance(outcome, Unrealizable) and outcome.certificate is not None
    assert isinstance(outcome.certificate.reason, Conflict)
    assert believed(text, outcome.certificate, tmp_path) == ("proved", None, 0)
    assert believed(begun("x is l"), outcome.certificate, tmp_path)[::2] == ("refuted", 1)


def test_a_certificate_that_would_be_too_large_is_none(monkeypatch: pytest.MonkeyPatch) -> None:
    """The answer stays."""
    monkeypatch.setattr(no_part, "MOST_CASES", 1)
    outcome = synthesize(parse(TIED))
    assert isinstance(outcome, Unrealizable)
    assert (outcome.failures[0].kind, outcome.certificate) == ("conflict", None)


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


def explained(text: str, wanted: Wanted = 3) -> Explanation:
    """Why a text has no policy."""
    found = explain(parse(text), wanted_repairs=wanted)
    assert isinstance(found, Explanation) and not found.left_out
    return found


def test_explain_names_the_starts_that_fail() -> None:
    """Reasons, repairs and the part are about starts; what fails beside them is not told."""
    stuck = CONFLICT.replace("nominal effects: x is L", "nominal effects: x is m")
    found = explained(stuck + "BEGIN START start: x is r start: x is m END START")
    assert [(group.kind, group.count, group.example) for group in found.groups] == [("no-plan", 1, (2,))]
    assert [(reason.kind, reason.count, reason.later) for reason in found.reasons] == [("no-plan", 1, False)]
    assert found.part is not None and (found.part.states, found.part.given_up, found.part.text) == (1, 1, "x is m")
    assert isinstance(explain(parse(begun("x is r"))), NothingToExplain)


def test_a_start_that_fails_for_what_it_leads_to_has_lines_to_blame() -> None:
    """The core holds what leads there, and what fails there; every repair is tried with the starts as they are."""
    found, outcome = explained(LATE), synthesize(parse(LATE))
    assert isinstance(outcome, Unrealizable)
    (failure,), (reason,) = outcome.failures, found.reasons
    assert (failure.kind, failure.states) == ("no-plan", ((0,),))
    assert failure.within is not None
    assert [holds(failure.within, (value,)) for value in range(4)] == [True, True, False, False]
    assert (reason.later, found.omitted, found.part) == (True, 0, None)
    assert [element.kind for element in reason.core] == ["alternative", "precondition"]
    assert any(change.text is None for repair in found.repairs for change in repair.changes)
    for repair in found.repairs:
        changed = repaired(parse(LATE), repair)
        assert changed.starts and isinstance(synthesize(changed), Realizable)


def test_starts_whose_goals_conflict_are_told_which_may_stay() -> None:
    """With a start condition that another text has in the place of its own."""
    text = begun("x is l", "x is r")
    found = explained(text)
    assert found.part is not None
    assert (found.part.states, found.part.given_up, found.part.unique, found.part.text) == (1, 1, False, "x is r")
    narrowed = with_starts(Source("x.tum", text), found.part.text)
    assert "start: x is l" not in narrowed and isinstance(synthesize(parse(narrowed)), Realizable)
    assert found.reasons[0].core and found.repairs and not any(repair.gives_up_safety for repair in found.repairs)


def test_what_is_added_helps_where_starts_lead() -> None:
    """Not in states that fail too, but that no start comes to."""
    text = """
    BEGIN STATE VECTOR state x can be a, b state tyre can be good, flat, torn END STATE VECTOR
    BEGIN ACTIONS
    action go preconditions: x is a, tyre is good nominal effects: x is b alternative effects: tyre is flat
    END ACTIONS
    BEGIN GOALS goal type: priority goal: x is b END GOALS
    BEGIN START start: x is a AND tyre is good END START
    """
    repair = explained(text).repairs[0]
    assert repair.additions == (NewAction(((0,), (1,)), ((1, 0),)),)


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
    assert len(found) == 12 * len({**SMALL, **LARGER}) + 3 and all(spec.starts for spec in found)
