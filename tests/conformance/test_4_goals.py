"""Section 4 of docs/semantics.md: which goals are active, and what is left of them."""

from tests.conformance.asking import Asked, failures, policy
from tests.conformance.roles import Decider, Stepper
from tests.conformance.rules import rule
from tests.conformance.world import text

EVERYWHERE = "aa ab ba bb ca cb"


def goals(stepper: Stepper, block: str, **blocks: str) -> Asked:
    """Six states, with these goals."""
    return Asked(stepper, text({"x": "abc", "y": "ab"}, ACTIONS="action ring action other", GOALS=block, **blocks))


@rule("4.1")
def test_a_simple_goal_is_active_when_the_walk_comes_to_it(stepper: Stepper) -> None:
    """In every state, and its predicate is looked at where it is to be reached."""
    asked = goals(stepper, "goal type: priority goal: x is b AND y is a OR x is c")
    for state in ("aa", "ba", "cb"):
        assert asked.meets(state) == "ba ca cb"


@rule("4.2")
def test_a_conditional_goal_is_entered_where_its_condition_holds(stepper: Stepper) -> None:
    """The condition is looked at in the state itself; where it fails, the next member of a priority list is tried."""
    asked = goals(stepper, "goal type: priority when x is a then goal: x is b when NOT x is c then goal: y is b")
    assert asked.meets("aa") == "ba bb"
    assert asked.meets("ba") == "ab bb cb"
    assert asked.meets("ca") == EVERYWHERE


@rule("4.2")
def test_a_condition_before_a_list_is_that_of_the_whole_list(stepper: Stepper) -> None:
    """Nothing in it counts where it fails."""
    nested = "BEGIN GOALS goal type: constraint goal: x is b goal: y is b END GOALS"
    asked = goals(stepper, f"goal type: constraint when x is a then {nested} goal: NOT x is c")
    assert asked.meets("aa") == "bb"
    assert asked.meets("ba") == "aa ab ba bb"


@rule("4.3")
def test_a_constraint_list_tries_all_its_members(stepper: Stepper) -> None:
    """Also after one that was entered, and after one that was not."""
    asked = goals(stepper, "goal type: constraint goal: NOT x is a when y is b then goal: y is a goal: NOT x is c")
    assert asked.meets("aa") == "ba bb"
    assert asked.meets("ab") == "ba"


@rule("4.4")
def test_a_priority_list_stops_after_the_first_that_was_entered(stepper: Stepper) -> None:
    """What stands behind it does not count."""
    asked = goals(stepper, "goal type: priority when x is a then goal: x is b goal: y is b goal: x is c")
    assert asked.meets("aa") == "ba bb"
    assert asked.meets("ba") == "ab bb cb"


@rule("4.4")
def test_a_nested_list_that_yields_nothing_was_entered(stepper: Stepper) -> None:
    """A list without a condition always is, so that nothing behind it is tried; one whose condition fails is not."""
    for kind in ("priority", "constraint"):
        nested = f"BEGIN GOALS goal type: {kind} when y is b then goal: x is b END GOALS"
        asked = goals(stepper, f"goal type: priority {nested} goal: x is c")
        assert asked.meets("aa") == EVERYWHERE
        assert asked.meets("ab") == "ba bb"
        asked = goals(stepper, f"goal type: priority when x is a then {nested} goal: x is c")
        assert asked.meets("aa") == EVERYWHERE
        assert asked.meets("ba") == "ca cb"


@rule("4.4")
def test_a_list_in_a_list_stops_its_own_walk_only(stepper: Stepper) -> None:
    """A priority list in a constraint list."""
    nested = "BEGIN GOALS goal type: priority goal: NOT x is a goal: x is c END GOALS"
    assert goals(stepper, f"goal type: constraint {nested} goal: y is a").meets("aa") == "ba ca"


@rule("4.5")
def test_where_nothing_is_entered_any_state_will_do(stepper: Stepper) -> None:
    """And without a goal block."""
    for block in ("goal type: priority when x is b then goal: false", "goal type: constraint", ""):
        assert goals(stepper, block).meets("aa") == EVERYWHERE
    assert Asked(stepper, text({"x": "ab"})).meets("a") == "a b"


@rule("4.6")
def test_the_same_predicate_at_two_places_is_one_goal(stepper: Stepper) -> None:
    """Under an alias, in a list, or written out: these states have the same goals to reach."""
    nested = "BEGIN GOALS goal type: constraint goal: Home goal: y is a AND x is a END GOALS"
    block = f"goal type: priority when x is a then goal: y is a AND x is a when x is b then goal: Home {nested}"
    asked = goals(stepper, block, ALIASES="define Home as y is a AND x is a")
    assert asked.meets("ab") == asked.meets("bb") == asked.meets("cb") == "aa"


@rule("4.6")
def test_a_run_stays_where_the_same_predicate_is_active(decider: Decider) -> None:
    """Of two equally long ways the one through a state with the same goals is taken, wherever in the tree they stand.

    The other one is declared first, and where the goal is another one there as well, it is taken.
    """
    actions = " ".join(
        f"action {here}{there} preconditions: x is {here} nominal effects: x is {there}"
        for here, there in ("sp", "sq", "pg", "qg")
    )
    for at_q, taken in (("Home", "sq"), ("NOT x is q", "sp")):
        block = (
            "goal type: priority when x is s then goal: x is g"
            f" when x is q then BEGIN GOALS goal type: constraint goal: {at_q} END GOALS goal: NOT x is p"
        )
        asked = text({"x": "spqg"}, ACTIONS=actions, ALIASES="define Home as x is g", GOALS=block)
        assert policy(decider, asked) == {"s": taken, "p": "pg", "q": "qg", "g": ""}


@rule("4.7", "4.8")
def test_executing_speaks_of_the_first_set_and_the_rest_of_the_state_reached(stepper: Stepper) -> None:
    """Also within one disjunction."""
    for body, with_ring, without in (
        ("x is b OR executing ring", EVERYWHERE, "ba bb"),
        ("executing ring AND x is b", "ba bb", ""),
        ("NOT executing ring", "", EVERYWHERE),
        ("executing ring IFONLYIF x is b", "ba bb", "aa ab ca cb"),
    ):
        asked = goals(stepper, f"goal type: constraint goal: {body}")
        assert asked.meets("aa", "ring") == asked.meets("aa", "ring other") == with_ring
        assert asked.meets("aa", "") == asked.meets("aa", "other") == without


@rule("4.7")
def test_executing_is_met_by_whoever_can_and_by_nobody_else(decider: Decider) -> None:
    """In one step, wherever it leads; where the action is not allowed, the goal has no plan."""
    actions = "action act preconditions: x is a nominal effects: x is b"
    for body, expected in (("executing act OR x is b", {}), ("executing act", {"no-plan": "b"})):
        asked = text({"x": "ab"}, ACTIONS=actions, GOALS=f"goal type: constraint goal: {body}")
        assert failures(decider, asked) == expected
        assert expected or policy(decider, asked) == {"a": "act", "b": ""}


@rule("4.8")
def test_what_remains_depends_on_the_first_set_alone(stepper: Stepper) -> None:
    """Two states with the same active goals have the same residual goal for the same set, and may have others."""
    asked = goals(
        stepper, "goal type: constraint goal: IF executing ring THEN x is c goal: IF executing other THEN y is b"
    )
    for state in ("aa", "bb"):
        assert asked.meets(state, "ring") == "ca cb"
        assert asked.meets(state, "other") == "ab bb cb"
        assert asked.meets(state, "ring other") == "cb"
        assert asked.meets(state) == EVERYWHERE
