"""The tests of every section can fail: with a bug planted in an engine, the test of the rule that it breaks does."""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from itertools import product
from typing import Any

import pytest
from msgspec import Struct
from msgspec.structs import replace

from tests.checker.standalone import checker
from tests.conformance import by_checker, rules, world
from tests.conformance import test_1_states as states
from tests.conformance import test_2_actions as actions
from tests.conformance import test_3_steps as steps
from tests.conformance import test_4_goals as goals
from tests.conformance import test_5_policies as policies
from tests.conformance import test_6_preferences as preferences
from tests.conformance import test_7_none as none
from tests.conformance import test_8_paper as paper
from tests.conformance import test_9_restoring as restoring
from tests.conformance import test_10_severities as severities
from tests.conformance import test_11_guarantees as guarantees
from tests.conformance import test_12_starts as starting
from tests.conformance.by_checker import Checker
from tests.conformance.by_coq import Coq
from tests.conformance.by_engine import Bdd, Explicit
from tests.conformance.by_verify import Z3, States, Walk
from tumato_symbolic.export import coq_specification
from tumato_symbolic.game import routing
from tumato_symbolic.semantics import Guarantee, Prospects, Restorations, holds, is_valid
from tumato_symbolic.semantics import goals as explicit_goals
from tumato_symbolic.semantics import step as explicit_step
from tumato_symbolic.semantics.guarantees import Step as ExplicitStep
from tumato_symbolic.spec import Action, GoalList, Spec
from tumato_symbolic.symbolic import Encoding
from tumato_symbolic.symbolic import goals as symbolic_goals
from tumato_symbolic.symbolic import steps as symbolic_steps
from tumato_symbolic.symbolic.layout import Group
from tumato_symbolic.symbolic.manager import Bdd as Set
from tumato_symbolic.synthesis import parts
from tumato_symbolic.verify.by_diagrams.closed_loop import ClosedLoop
from tumato_symbolic.verify.by_diagrams.efforts import WalkEfforts
from tumato_symbolic.verify.by_diagrams.goals import WalkGoals
from tumato_symbolic.verify.by_states import prover as states_prover
from tumato_symbolic.verify.by_states import steps as states_steps
from tumato_symbolic.verify.by_states.efforts import Efforts
from tumato_symbolic.verify.by_z3 import policy_problem, prover
from tumato_symbolic.verify.by_z3.choice import Choice
from tumato_symbolic.verify.guarantees.prospects import WalkProspects

explicit_judge = import_module("tumato_symbolic.semantics.judge")
taken_alone = import_module("tumato_symbolic.game.alone")
game_restoration = import_module("tumato_symbolic.game.restoration")
refutations = import_module("tumato_symbolic.verify.unrealizability.verdict")
by_solver = import_module("tumato_symbolic.verify.unrealizability.by_solver")


class Bug(Struct, frozen=True):
    """A bug, and the test of a rule that an engine with it fails; `change` puts one thing for another."""

    rule: str
    what: str
    engine: Callable[[], Any]
    home: Any
    name: str
    change: Callable[[Any], Any]
    test: Callable[[Any], None]


def _valid_states(world: Any) -> Any:
    every = map(tuple, product(*world.spec.variables.values()))
    return (state for state in every if world.broken(world.spec.assumptions, state) is None)


def _open(_: Any) -> Any:
    def planted(whole: Any, states: Any) -> Any:
        steps, safe = whole.steps, whole.steps.safe & states
        open_ = replace(steps, valid=states, safe=safe, allowed=steps.allowed & states, tiers=(states, safe))
        active = symbolic_goals.regions(whole.encoding, states)
        return replace(whole, steps=open_, regions=active, targets=tuple(symbolic_goals.targets(open_, active)))

    return planted


def _walk_every_member(walk: Any) -> Any:
    def planted(goal: Any, state: Any) -> Any:
        return walk(replace(goal, kind="constraint") if isinstance(goal, GoalList) else goal, state)

    return planted


def _again(_: Any) -> Any:
    def planted(encoding: Encoding, group: Group, following: Set) -> Set:
        parts = [encoding.executing(a) & encoding.after_every_effect(a, following) for a in group.actions]
        return encoding.manager.union([encoding.idle(group), *parts])

    return planted


def _one_step_more(serves: Any) -> Any:
    def planted(judge: Any, state: Any, chosen: Any) -> bool:
        bound = judge.world.spec.bound
        judge.world.spec.bound = None if bound is None else bound + 1
        try:
            return bool(serves(judge, state, chosen))
        finally:
            judge.world.spec.bound = bound

    return planted


def _last_declared(_: Any) -> Any:
    def planted(encoding: Encoding, relation: Set) -> Set:
        for action in range(len(encoding.spec.actions)):
            with_it = relation & encoding.executing(action)
            relation = with_it | (relation & ~encoding.manager.exists(encoding.all_choice_bits, with_it))
        return relation

    return planted


def _longest(duration: Any) -> Any:
    return lambda spec, chosen: max((duration(spec, frozenset((action,))) for action in chosen), default=0)


def _best_of_all(_: Any) -> Any:
    def planted(restorations: Restorations, state: Any, after: Any) -> Any:
        spec, worst = restorations._spec, restorations.worst
        left = [each for each in after if not explicit_judge.is_safe(spec, each)]
        return min((worst[each] for each in left), default=(0, 0)) if all(each in worst for each in left) else None

    return planted


def _one_step_is_no_better(quality: Any) -> Any:
    def planted(*args: Any) -> Any:
        found = quality(*args)
        return found and (1, found[1])

    return planted


def _all_that_hold(_: Any) -> Any:
    def planted(spec: Spec, state: Any) -> Any:
        return (*spec.assumptions, *(rule for rule in spec.state_rules if holds(rule.formula, state)))

    return planted


def _until_safe(restore: Any) -> Any:
    return lambda work, pairs, here, _: restore(work, pairs, here, work.problem.steps.safe)


def _one_tier(written: Any) -> Any:
    return lambda spec: written(
        replace(spec, state_rules=tuple(replace(rule, severity=1) for rule in spec.state_rules))
    )


def _met_at_once(of: Any) -> Any:
    def planted(prospects: Prospects, step: ExplicitStep) -> Any:
        here = [state for state, known in prospects._steps.items() if known is step]
        return Guarantee("guaranteed", steps=0) if prospects._met.intersection(here) else of(prospects, step)

    return planted


def _nothing_is_nominal(of: Any) -> Any:
    def planted(prospects: Prospects, step: ExplicitStep) -> Any:
        found = of(prospects, step)
        return None if found == Guarantee("nominal") else found

    return planted


def _no_coq_rules(written: Any) -> Any:
    return lambda spec: written(replace(spec, reaction_rules=()))


BUGS = (
    Bug("1.2", "no assumption counts", Z3, policy_problem, "valid_term", lambda _: lambda spec, place: True,
        states.test_a_state_is_valid_when_every_assumption_holds),
    Bug("1.3", "invalid states are safe", Checker, checker.World, "is_safe",
        lambda _: lambda world, state: world.broken(world.spec.state_rules, state) is None,
        states.test_a_state_is_safe_when_it_is_valid_and_every_state_rule_holds),
    Bug("2.5", "alternatives never happen", Walk, Action, "effects",
        lambda _: property(lambda action: (action.nominal,)), actions.test_an_action_may_take_any_of_its_effects),
    Bug("3.2", "resources are shared", States, states_steps.Steps, "may_be_together",
        lambda _: lambda steps, chosen: True, steps.test_no_two_actions_control_the_same_resource),
    Bug("3.4", "no reaction rule counts", Coq, coq_specification, "specification", _no_coq_rules,
        steps.test_every_reaction_rule_holds),
    Bug("3.7", "an action takes effect again", lambda: Bdd("autoref"), symbolic_steps, "_after_effect_of", _again,
        steps.test_an_action_takes_effect_at_most_once),
    Bug("3.8", "`first` is taken for `any`", Z3, prover, "prove_safe",
        lambda prove: lambda problem, _: prove(problem, "any"),
        steps.test_effects_come_one_after_the_other_under_any_and_one_alone_under_first),
    Bug("3.10", "the search forgets the nominal successor", Z3, Choice, "conditions",
        lambda conditions: lambda choice: conditions(choice)[:-1],
        steps.test_all_nominal_effects_at_once_lead_to_a_safe_state),
    Bug("4.4", "a priority list goes on", Explicit, explicit_goals, "_walk", _walk_every_member,
        goals.test_a_priority_list_stops_after_the_first_that_was_entered),
    Bug("4.7", "nothing is ever executed", lambda: Bdd("autoref"), symbolic_goals, "settle",
        lambda settle: lambda body, _: settle(body, frozenset()),
        goals.test_executing_speaks_of_the_first_set_and_the_rest_of_the_state_reached),
    Bug("4.7", "no residual goal holds", Walk, WalkGoals, "reached",
        lambda _: lambda goals, residual: 0,
        goals.test_executing_speaks_of_the_first_set_and_the_rest_of_the_state_reached),
    Bug("5.4", "one step too many is in time", Checker, checker.Judge, "serves", _one_step_more,
        lambda engine: policies.test_a_run_has_at_most_as_many_steps_as_the_bound(engine, 2, True)),
    Bug("5.6", "every cheaper set serves", Explicit, explicit_judge, "better_sets",
        lambda _: lambda spec, policy, state, *others: iter((frozenset(),)),
        lambda engine: policies.test_no_cheaper_set_would_serve(engine, "any")),
    Bug("5.7", "the longest duration counts", States, states_steps, "duration", _longest,
        lambda engine: policies.test_durations_of_a_set_add_up(engine, 4, "left right")),
    Bug("6.1", "more actions are as good", lambda: Bdd("autoref"), routing, "preferred", _last_declared,
        preferences.test_then_the_fewest_actions_then_what_is_declared_first),
    Bug("7.1", "cubes are believed", Checker, checker, "check_no_allowed_set", lambda _: lambda world, reason: "",
        lambda engine: none.test_unrealizability_is_proved_where_it_is_so(engine, "no-allowed-set")),
    Bug("7.3", "conflicts are believed", Z3, by_solver, "check_conflict", lambda _: lambda reason, step: 1,
        lambda engine: none.test_unrealizability_is_proved_where_it_is_so(engine, "conflict")),
    Bug("8.2", "every set takes equally long", States, states_prover, "duration",
        lambda _: lambda spec, chosen: 1, paper.test_stopping_the_conveyor_is_the_minimum),
    Bug("9.2", "rules that hold may be broken", Walk, ClosedLoop, "requirements",
        lambda _: property(lambda model: [(model.valid, model.valid)]),
        restoring.test_no_rule_is_broken_that_was_not_broken_before),
    Bug("9.3", "the best outcome counts", Explicit, Restorations, "_worst_after", _best_of_all,
        lambda engine: restoring.test_efforts_are_compared_by_duration_first(engine, 5, (6, 2))),
    Bug("9.4", "outcomes that go round are fair", Coq, coq_specification, "_RESTORATIONS",
        lambda names: {**names, "bounded": names["fair"]},
        lambda engine: restoring.test_every_outcome_or_the_nominal_one_leads_back(engine, "bounded", {"restoring"})),
    Bug("9.6", "one step is no better than more", States, Efforts, "quality", _one_step_is_no_better,
        lambda engine: restoring.test_the_better_set_is_the_minimum(engine, "one step before more")),
    Bug("9.7", "nobody loses by a better set", Checker, checker.Judge, "losers", lambda _: lambda judge, *pair: [],
        restoring.test_a_worse_decision_may_serve_another_state),
    Bug("9.8", "runs stay in place", lambda: Bdd("autoref"), taken_alone, "_staying_in_place",
        lambda _: lambda problem: problem.false, restoring.test_a_state_has_no_plan_taken_alone),
    Bug("9.8", "traps are believed", Z3, refutations, "check_no_restoration", lambda _: lambda *claim: None,
        lambda engine: restoring.test_that_nothing_leads_back_is_believed_where_it_is_so(engine, "bounded", "as|a")),
    Bug("10.1", "all rules are one tier", Coq, coq_specification, "_tiers", _one_tier,
        severities.test_the_level_counts_the_severest_tiers_that_hold),
    Bug("10.1", "the level is that of the mildest tier", States, states_steps.Steps, "level",
        lambda _: lambda steps, code: len(steps._tiers) if steps.is_safe(code) else 0,
        severities.test_a_severity_holds_for_the_rules_after_it),
    Bug("10.2", "mild rules are kept as well", Explicit, explicit_step, "required_rules", _all_that_hold,
        lambda engine: severities.test_a_milder_rule_may_break_while_a_severer_one_is_broken(
            engine, "bounded", 1, 2, True)),
    Bug("10.3", "efforts are counted until all is safe", lambda: Bdd("autoref"), game_restoration._Work,
        "restore_level", _until_safe, severities.test_efforts_belong_to_a_level),
    Bug("10.3", "only safe states are restored", Walk, WalkEfforts, "by_level",
        lambda _: lambda efforts, region: [(region, efforts._model.safe)], severities.test_efforts_belong_to_a_level),
    Bug("10.4", "goals count everywhere", Checker, checker.World, "reached",
        lambda _: lambda world, goal, state: all(checker.holds(body, state, goal[1]) for body in goal[0]),
        lambda engine: severities.test_goals_count_in_safe_states_only(engine, "bounded")),
    Bug("11.1", "alternatives never happen", Walk, Action, "effects",
        lambda _: property(lambda action: (action.nominal,)), guarantees.test_what_is_not_nominal_is_a_deviation),
    Bug("11.2", "a goal that holds is met at once", Explicit, Prospects, "of", _met_at_once,
        guarantees.test_the_goal_is_met_after_a_step),
    Bug("11.4", "deviations may lead anywhere", Explicit, Prospects, "_nominally",
        lambda nominally: lambda prospects, _: nominally(prospects, frozenset(prospects._steps)),
        guarantees.test_deviations_are_counted_over_the_whole_run),
    Bug("11.5", "nothing is fair", Walk, WalkProspects, "surviving",
        lambda _: property(lambda prospects: [prospects._nominal_layers[-1], prospects._met]),
        guarantees.test_a_fair_state_meets_its_goal_once_deviations_stop),
    Bug("11.6", "what is fair is guaranteed", Walk, WalkProspects, "layers",
        lambda _: property(lambda prospects: [prospects._nominal_layers[-1]]),
        guarantees.test_a_fair_state_meets_its_goal_once_deviations_stop),
    Bug("11.7", "the nominal outcome counts alone", Checker, checker.World, "next_states",
        lambda _: lambda world, state, chosen: {world.successor(state, chosen)},
        guarantees.test_the_worst_number_of_steps),
    Bug("11.8", "what is only nominal is nothing", Explicit, Prospects, "of", _nothing_is_nominal,
        lambda engine: guarantees.test_each_guarantee_implies_the_weaker_ones(engine, "adc", "a", "nominal")),
    Bug("12.1", "every valid state is a start", Explicit, explicit_judge, "is_start", lambda _: is_valid,
        starting.test_without_start_conditions_every_valid_state_is_a_start),
    Bug("12.2", "undecided states are valid as well", Z3, Spec, "validity",
        lambda _: property(lambda spec: spec.assumptions),
        lambda engine: starting.test_no_outcome_of_a_decision_is_undecided(engine, "any")),
    Bug("12.3", "invalid states may be decided", Checker, checker.World, "every_state", lambda _: _valid_states,
        lambda engine: starting.test_every_start_is_decided_and_only_valid_states_are(engine, "first")),
    Bug("12.4", "steps may leave the part", lambda: Bdd("autoref"), parts, "_within", _open,
        lambda engine: starting.test_the_greatest_part_is_decided(engine, "any")),
)  # fmt: skip


@pytest.fixture(autouse=True)
def nothing_is_remembered() -> None:
    """What was read and found before a bug was planted is found anew."""
    world.world.cache_clear()
    by_checker._own.cache_clear()


@pytest.mark.parametrize("bug", BUGS, ids=lambda bug: f"{bug.rule} {bug.what}")
def test_a_planted_bug_is_noticed(bug: Bug, monkeypatch: pytest.MonkeyPatch) -> None:
    """By a test that an engine without it passes."""
    engine = bug.engine()
    if engine.name in rules.MISSING:
        return
    bug.test(engine)
    monkeypatch.setattr(bug.home, bug.name, bug.change(getattr(bug.home, bug.name)))
    with pytest.raises((AssertionError, RuntimeError)):
        bug.test(bug.engine())


def test_bugs_are_planted_in_every_section_and_engine() -> None:
    """At least one each; the backends of dd share their code."""
    assert {bug.rule.partition(".")[0] for bug in BUGS} == {number.partition(".")[0] for number in rules.RULES}
    assert {bug.engine().name for bug in BUGS} >= {engine.name for engine in rules.ENGINES} - {"bdd-cudd"}
    assert {bug.rule for bug in BUGS} <= set(rules.RULES)
