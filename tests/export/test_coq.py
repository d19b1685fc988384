"""The theorem file: its shape, and (where Coq is installed) that it compiles exactly for right policies."""

from __future__ import annotations

from pathlib import Path

import pytest
from msgspec.structs import replace

from tests.export.cases import agrees, generated, is_right, rows_of
from tests.export.compiler import Case, Library, needs_coq
from tests.oracle import World
from tests.profiles import ALL_PROFILES
from tests.semantics.build import Build, chosen, priority, rules
from tumato_symbolic import parse
from tumato_symbolic.diagnostics import Code, UserError
from tumato_symbolic.export.coq import MOST_STATES, export
from tumato_symbolic.policy import Table, as_diagram, load, policy_from_rows
from tumato_symbolic.semantics import ActionSet, State, count_states, is_safe, judge
from tumato_symbolic.spec import Constant, Ordering, Spec

ROOT = Path(__file__).parents[2]


ORDERINGS: tuple[Ordering, Ordering] = ("any", "first")

RACE = """
BEGIN STATE VECTOR state Place can be here, there state Held can be no, yes END STATE VECTOR
BEGIN ACTIONS
action drive preconditions: Place is here nominal effects: Place is there
action take preconditions: Place is here nominal effects: Held is yes
END ACTIONS
BEGIN GOALS goal type: priority when Place is here then goal: Place is there AND Held is yes END GOALS
"""


def example(name: str) -> Spec:
    return parse((ROOT / "examples" / f"{name}.tum").read_text(encoding="utf-8"))


@pytest.fixture(scope="module")
def amr() -> Case:
    spec = example("amr")
    policy = load(str(ROOT / "proofs" / "amr.policy.json"))
    assert isinstance(policy.decisions, Table)
    return Case(spec, policy.decisions.rows, "any")


def test_the_file_states_the_theorem_and_prints_what_it_rests_on(amr: Case) -> None:
    """The last command prints the assumptions; the ordering is the one that was asked for."""
    text = amr.text
    assert text.endswith("Print Assumptions policy_is_right.\n")
    assert "sound_and_complete spec Any (policy_of decisions) /\\ minimal spec Any (policy_of decisions)" in text
    assert "check spec First decisions no_efforts = true" in replace(amr, ordering="first").text
    assert "Admitted" not in text


def test_the_specification_is_written_in_numbers_and_explained_in_comments(amr: Case) -> None:
    """A reader finds every name and every rule as it was written, beside its numbers."""
    text = amr.text
    assert "sizes := [4; 2; 2; 2];" in text
    assert "     0 S_Location: 0 corridor, 1 charger, 2 workstation_1, 3 workstation_2\n" in text
    assert "    (* 4 receive_workpiece *)\n    {| duration := 3%N; resources := [0; 1];\n" in text
    assert "alternatives := [[(2, 1); (3, 0)]; [(2, 1); (3, 1)]] |}" in text
    assert "    (* IF S_Location is corridor OR S_Location is charger THEN S_Conveyor is off *)\n" in text
    assert "    Or [Not (Or [Is 0 0; Is 0 1]); Is 3 1]\n" in text
    assert "      (* when S_Battery is low *)\n      (When (Is 1 0)\n" in text
    assert "max_plan_length := Some 5%N;\n  restored_in := OneStep;\n  throughout := false;\n" in text
    assert "  starts := [];\n  part := fun _ => true\n|}." in text
    assert text.count("Leaf") == 32


def test_a_diagram_gives_the_same_file_as_its_table(amr: Case) -> None:
    """What is exported are the decisions, not the form of the policy."""
    policy = policy_from_rows(amr.spec, amr.rows)
    assert export(replace(policy, decisions=as_diagram(policy)), amr.spec, "any") == amr.text


def test_texts_of_rules_cannot_end_their_comment(amr: Case) -> None:
    """Whatever a rule's text holds, it stays inside one comment of one line."""
    hostile = replace(amr.spec.state_rules[0], text='a *) Axiom f : False. (* "b (*)\nc')
    text = replace(amr, spec=replace(amr.spec, state_rules=(hostile,))).text
    line = next(line for line in text.splitlines() if "Axiom" in line)
    assert line == "    (* a * ) Axiom f : False. ( * 'b ( * ) c *)"


def test_a_policy_that_leaves_a_valid_state_undecided_is_an_error(amr: Case) -> None:
    """There is nothing to prove about a policy that is not total."""
    rows = dict(amr.rows)
    del rows[0, 0, 0, 1]
    with pytest.raises(UserError) as error:
        export(policy_from_rows(amr.spec, rows), amr.spec, "any")
    (diagnostic,) = error.value.diagnostics
    assert diagnostic.code is Code.TUM502
    assert "S_Location is corridor, S_Battery is low, S_Load is loaded, S_Conveyor is off" in diagnostic.message


def test_too_many_states_are_an_error(amr: Case) -> None:
    """The checker goes through all states; where these are too many, the exporter says so."""
    count = MOST_STATES.bit_length()
    variables = "\n".join(f"state S{number} can be a, b" for number in range(count))
    spec = parse(f"BEGIN STATE VECTOR\n{variables}\nEND STATE VECTOR")
    assert count_states(spec) > MOST_STATES
    with pytest.raises(UserError) as error:
        export(policy_from_rows(spec, {(0,) * count: frozenset()}), spec, "any")
    (diagnostic,) = error.value.diagnostics
    assert diagnostic.code is Code.TUM508
    assert "proofs/checker.py" in str(diagnostic.help)


def test_a_policy_for_another_specification_is_an_error(amr: Case) -> None:
    """The policy is bound to the specification by names."""
    with pytest.raises(UserError) as error:
        export(policy_from_rows(amr.spec, amr.rows), example("coin"), "any")
    assert error.value.diagnostics[0].code is Code.TUM503


def test_states_that_are_not_valid_need_no_decision() -> None:
    """A decision in an invalid state is not exported either."""
    text = "BEGIN STATE VECTOR\nstate S can be a, b\nEND STATE VECTOR\n"
    spec = parse(f"{text}BEGIN ASSUMPTIONS\nassume: S is a\nEND ASSUMPTIONS")
    total = policy_from_rows(spec, {(0,): frozenset(), (1,): frozenset()})
    assert "Node [Leaf d0; Leaf none]" in export(total, spec, "any")
    assert export(total, spec, "any") == export(policy_from_rows(spec, {(0,): frozenset()}), spec, "any")


@needs_coq
def test_the_theorem_of_the_amr_compiles_and_rests_on_nothing(amr: Case, library: Library) -> None:
    """The policy of the paper's example is proved right, without axioms."""
    answer = library.compile(amr.text)
    assert answer.returncode == 0, answer.stderr
    assert answer.stdout.strip() == "Closed under the global context"


@needs_coq
def test_a_changed_decision_is_refused(amr: Case, library: Library) -> None:
    """The exporter judges nothing: the file of a wrong policy is written, and Coq refuses it."""
    wrong = replace(amr, rows={**amr.rows, (1, 0, 0, 1): frozenset()})
    answer = library.compile(wrong.text)
    assert answer.returncode != 0
    assert "true" in answer.stderr


@needs_coq
def test_an_undecided_state_is_refused(amr: Case, library: Library) -> None:
    """A hole in the table is no empty decision."""
    text = amr.text.replace("Leaf d0", "Leaf none", 1)
    assert library.compile(text).returncode != 0


@needs_coq
def test_preconditions_may_have_to_hold_throughout(library: Library) -> None:
    """Driving away while the hand takes: right where the hand has to be there at the start only."""
    spec = parse(RACE)
    both, nothing = frozenset((0, 1)), frozenset[int]()
    together: dict[State, ActionSet] = {(0, 0): both, (0, 1): both, (1, 0): nothing, (1, 1): nothing}
    lasting = replace(spec, preconditions="throughout")
    cases = [Case(each, together, ordering) for each in (spec, lasting) for ordering in ORDERINGS]
    assert [is_right(case) for case in cases] == [True, True, False, False]
    assert library.checks(cases) == [True, True, False, False]


@needs_coq
def test_a_restoring_set_that_is_not_the_cheapest_is_refused(amr: Case, library: Library) -> None:
    """Minimality is part of the theorem: an allowed set that serves, but longer than needed, does not pass."""
    world, rows = World(amr.spec, "any"), dict(amr.rows)
    state: State = (0, 1, 0, 0)
    assert not is_safe(amr.spec, state)
    dearer = [{**rows, state: option.chosen} for option in world.options[state] if option.chosen != rows[state]]
    sound = [changed for changed in dearer if judge(amr.spec, changed, "any").sound_and_complete]
    assert sound
    assert not any(library.checks([Case(amr.spec, changed, "any") for changed in sound]))


@needs_coq
def test_the_checker_agrees_with_the_explicit_meaning(library: Library) -> None:
    """`check` answers `true` for right policies, of generated specifications of every profile, and for no others.

    It does so where the ordering, or the bound, makes the difference, which it does in few that are generated. Of more:
    `python -m tests.export.trial coq`.
    """
    sample = {profile: [each for n in range(14) for each in generated(profile, n, 4)] for profile in ALL_PROFILES}
    agrees({**sample, **_by_ordering(), "by bound": [_in_two_steps(1), _in_two_steps(2)]}, library)


def _by_ordering() -> dict[str, list[Case]]:
    """What is right under `first` may be wrong under `any`."""
    spec = example("concurrent")
    rows = {ordering: rows_of(spec, ordering) for ordering in ORDERINGS}
    from_starts = replace(spec, starts=rules(Constant(True)))
    return {
        kind: [Case(each, rows["first"], "first"), Case(each, rows["first"], "any"), Case(each, rows["any"], "any")]
        for kind, each in (("by ordering", spec), ("by ordering, from starts", from_starts))
    }


def _in_two_steps(bound: int) -> Case:
    """A policy that takes two, and this bound."""
    build = Build({"x": "abc"})
    a, b, c = map(build.atom, ("x=a", "x=b", "x=c"))
    one, two = build.action("x=b", when=[a]), build.action("x=c", when=[b])
    rows: dict[State, ActionSet] = {(0,): chosen(one), (1,): chosen(two), (2,): chosen()}
    return Case(build.spec(priority(build.goal(c)), bound=bound), rows, "any")


@needs_coq
@pytest.mark.parametrize("planted", ["Lemma gap : False. Proof. Admitted.", "Axiom gap : False."])
def test_the_build_refuses_gaps(planted: str, tmp_path: Path) -> None:
    """`make` fails on a proof that is not finished and on an axiom, used or not."""
    library = Library.copy_to(tmp_path)
    path = tmp_path / "Semantics.v"
    path.write_text(path.read_text(encoding="utf-8") + planted + "\n", encoding="utf-8")
    assert library.build().returncode != 0
