"""Section 3 of docs/semantics.md: what may be executed together."""

from tests.conformance.asking import Asked, failures, policy, under_both
from tests.conformance.roles import Decider, Refuter, Stepper
from tests.conformance.rules import rule
from tests.conformance.world import BOTH, text, world
from tumato_symbolic.synthesis import Unrealizable, synthesize


@rule("3.1")
def test_every_precondition_of_every_action_holds(stepper: Stepper) -> None:
    """One that fails forbids the whole set, and no other set."""
    actions = "action free nominal effects: y is b action guarded preconditions: x is a, y is a nominal effects: x is b"
    for asked in under_both(stepper, text({"x": "ab", "y": "ab"}, ACTIONS=actions)):
        assert asked.allowed("aa") == ["", "free", "guarded", "free guarded"]
        assert asked.allowed("ab") == asked.allowed("ba") == ["", "free"]


@rule("3.1")
def test_preconditions_are_looked_at_where_a_set_starts(stepper: Stepper) -> None:
    """An effect of another action that makes one false comes too late, and one that makes it true as well."""
    actions = (
        "action spoil preconditions: x is a nominal effects: x is b"
        " action go preconditions: x is a nominal effects: y is b"
    )
    for asked in under_both(stepper, text({"x": "ab", "y": "ab"}, ACTIONS=actions)):
        assert asked.allowed("aa") == ["", "spoil", "go", "spoil go"]
        assert asked.allowed("ba") == [""]


@rule("3.2")
def test_no_two_actions_control_the_same_resource(stepper: Stepper) -> None:
    """Different resources are no conflict, one common among several is."""
    actions = (
        "action drive controlled resources: MOTOR nominal effects: x is b"
        " action lift controlled resources: MOTOR, ARM nominal effects: y is b"
        " action wave controlled resources: ARM nominal effects: x is b"
        " action talk"
    )
    asked_text = text({"x": "ab", "y": "ab"}, RESOURCES="resource MOTOR resource ARM", ACTIONS=actions)
    for asked in under_both(stepper, asked_text):
        alone = ["drive", "lift", "wave", "talk"]
        together = ["drive wave", "drive talk", "lift talk", "wave talk", "drive wave talk"]
        assert asked.allowed("aa") == ["", *alone, *together]


@rule("3.3")
def test_nominal_effects_agree(stepper: Stepper) -> None:
    """Two values for one variable conflict, the same value twice does not; what alternatives say does not count."""
    actions = (
        "action one nominal effects: x is b alternative effects: x is a"
        " action same nominal effects: x is b, y is b alternative effects: x is c"
        " action other nominal effects: x is c alternative effects: x is b"
    )
    for asked in under_both(stepper, text({"x": "abc", "y": "ab"}, ACTIONS=actions)):
        assert asked.allowed("aa") == ["", "one", "same", "other", "one same"]
        assert asked.leads("aa", "one same") == "bb"


@rule("3.4")
def test_every_reaction_rule_holds(stepper: Stepper) -> None:
    """`executing` is being in the set, so that a rule can force and forbid; the state is the one in which it starts."""
    actions = "action go nominal effects: x is b action stop nominal effects: x is a"
    rules = "rule: IF x is b THEN executing stop rule: NOT (x is a AND executing stop)"
    for asked in under_both(stepper, text({"x": "ab"}, ACTIONS=actions, REACTION_RULES=rules)):
        assert asked.allowed("a") == ["", "go"]
        assert asked.allowed("b") == ["stop"]


@rule("3.4")
def test_reaction_rules_tie_actions_together(stepper: Stepper) -> None:
    """`IFONLYIF` between actions, and between an action and the state."""
    actions = "action one action two action beep"
    rules = "rule: executing one IFONLYIF executing two rule: executing beep IFONLYIF x is b"
    for asked in under_both(stepper, text({"x": "ab"}, ACTIONS=actions, REACTION_RULES=rules)):
        assert asked.allowed("a") == ["", "one two"]
        assert asked.allowed("b") == ["beep", "one two beep"]


@rule("3.5")
def test_every_outcome_is_valid_and_safe(stepper: Stepper) -> None:
    """One alternative that breaks a state rule forbids the action, and so does one that breaks an assumption."""
    actions = (
        "action fine nominal effects: x is b"
        " action unsafe nominal effects: x is b alternative effects: x is a alternative effects: x is c"
        " action invalid nominal effects: x is b alternative effects: x is d"
    )
    asked_text = text({"x": "abcd"}, ACTIONS=actions, STATE_RULES="rule: NOT x is c", ASSUMPTIONS="assume: NOT x is d")
    for asked in under_both(stepper, asked_text):
        assert asked.allowed("a") == asked.allowed("b") == ["", "fine"]
        assert asked.allowed("c") == ["fine"]


APART = "rule: NOT (x is b AND y is b)"
"""Each alone is safe, both together are not."""


@rule("3.6", "3.10")
def test_all_nominal_effects_at_once_lead_to_a_safe_state(stepper: Stepper) -> None:
    """Under `first` each effect alone is safe, and the set is not allowed all the same; as it is not under `any`."""
    actions = "action left nominal effects: x is b action right nominal effects: y is b"
    for asked in under_both(stepper, text({"x": "ab", "y": "ab"}, ACTIONS=actions, STATE_RULES=APART)):
        assert asked.leads("aa", "left right") == "bb"
        assert asked.allowed("aa") == ["", "left", "right"]
    for asked in under_both(stepper, text({"x": "ab", "y": "ab"}, ACTIONS=actions)):
        assert asked.allowed("aa") == ["", "left", "right", "left right"]


@rule("3.6")
def test_all_nominal_effects_at_once_lead_to_a_valid_state(stepper: Stepper) -> None:
    """Assumptions count as state rules do."""
    actions = "action left nominal effects: x is b action right nominal effects: y is b"
    assumed = APART.replace("rule", "assume")
    for asked in under_both(stepper, text({"x": "ab", "y": "ab"}, ACTIONS=actions, ASSUMPTIONS=assumed)):
        assert asked.allowed("aa") == ["", "left", "right"]


@rule("3.10")
def test_under_any_the_nominal_successor_is_an_outcome(stepper: Stepper) -> None:
    """What `first` adds as condition 6, `any` has as an outcome: a set that is allowed under `any` is so under both."""
    actions = (
        "action left nominal effects: x is b alternative effects: none"
        " action right nominal effects: y is b action both nominal effects: x is b, y is b"
    )
    for rules in (APART, "rule: IF y is b THEN x is b"):
        asked_text = text({"x": "ab", "y": "ab"}, ACTIONS=actions, STATE_RULES=rules)
        under_any, under_first = (set(asked.allowed("aa")) for asked in under_both(stepper, asked_text))
        assert under_any <= under_first
        assert "left right" not in under_first


LATE = "action left nominal effects: x is b alternative effects: z is b action right nominal effects: y is b"


@rule("3.7", "3.8")
def test_effects_come_one_after_the_other_under_any_and_one_alone_under_first(stepper: Stepper) -> None:
    """An alternative that comes after another action's effect is an outcome under `any` only."""
    asked_text = text({"x": "ab", "y": "ab", "z": "ab"}, ACTIONS=LATE, STATE_RULES="rule: NOT (y is b AND z is b)")
    assert Asked(stepper, asked_text, "first").allowed("aaa") == ["", "left", "right", "left right"]
    assert Asked(stepper, asked_text, "any").allowed("aaa") == ["", "left", "right"]


@rule("3.7")
def test_every_order_counts(stepper: Stepper) -> None:
    """The last effect on a variable stands: a value is unsafe only when its writer comes after the other one."""
    for order in ("one two", "two one"):
        fields = {
            "one": "nominal effects: x is b alternative effects: x is c",
            "two": "nominal effects: x is b, y is b",
        }
        actions = " ".join(f"action {name} {fields[name]}" for name in order.split())
        asked_text = text({"x": "abc", "y": "ab"}, ACTIONS=actions, STATE_RULES="rule: NOT (x is c AND y is b)")
        assert order not in Asked(stepper, asked_text, "any").allowed("aa")
        assert order in Asked(stepper, asked_text, "first").allowed("aa")


@rule("3.7")
def test_every_state_on_the_way_is_an_outcome(stepper: Stepper) -> None:
    """That a later effect would mend a state does not help, and neither does that one never comes."""
    actions = "action open nominal effects: x is b action shut nominal effects: y is b"
    rules = "rule: NOT (x is b AND y is a)"
    for asked in under_both(stepper, text({"x": "ab", "y": "ab"}, ACTIONS=actions, STATE_RULES=rules)):
        assert asked.leads("aa", "open shut") == "bb"
        assert asked.allowed("aa") == ["", "shut"]
        assert asked.allowed("ab") == ["", "open", "shut", "open shut"]


@rule("3.7")
def test_an_action_takes_effect_at_most_once(stepper: Stepper) -> None:
    """Two effects of one action never follow each other, also where another action takes effect between them."""
    throw = "action throw nominal effects: x is b alternative effects: y is b"
    for asked in under_both(stepper, text({"x": "ab", "y": "ab"}, ACTIONS=throw, STATE_RULES=APART)):
        assert asked.allowed("aa") == ["", "throw"]
    more = f"{throw} action undo nominal effects: y is a"
    for asked in under_both(stepper, text({"x": "ab", "y": "ab"}, ACTIONS=more, STATE_RULES=APART)):
        assert asked.allowed("aa") == ["", "throw", "undo", "throw undo"]
    restoring = "action leave nominal effects: x is b alternative effects: x is a, y is b"
    rules = f"{APART} rule: NOT x is c"
    for asked in under_both(stepper, text({"x": "abc", "y": "ab"}, ACTIONS=restoring, STATE_RULES=rules)):
        assert asked.allowed("ca") == ["leave"]


@rule("3.7")
def test_which_actions_still_wait_counts_beside_the_state(stepper: Stepper) -> None:
    """Two actions lead to the same state; after either of them it is the other one that may still take effect."""
    actions = (
        "action one nominal effects: x is b alternative effects: y is b"
        " action two nominal effects: x is b alternative effects: z is b"
    )
    variables = {"x": "ab", "y": "ab", "z": "ab"}
    for rules, together in (
        ("rule: NOT (x is b AND y is b)", False),
        ("rule: NOT (x is b AND z is b)", False),
        ("rule: NOT (y is b AND z is b)", False),
        ("rule: NOT (x is b AND y is b AND z is b)", True),
    ):
        asked = Asked(stepper, text(variables, ACTIONS=actions, STATE_RULES=rules), "any")
        assert asked.allowed("aaa") == ["", "one", "two", *(["one two"] if together else [])]


@rule("3.8")
def test_under_first_any_action_may_be_the_one(stepper: Stepper) -> None:
    """Each effect of each action of the set is looked at, though only one comes."""
    actions = (
        "action left nominal effects: x is b alternative effects: x is c action right nominal effects: y is b"
        " alternative effects: y is c"
    )
    for unsafe, sets in (("x is c", ["", "right"]), ("y is c", ["", "left"]), ("x is c AND y is c", None)):
        asked_text = text({"x": "abc", "y": "abc"}, ACTIONS=actions, STATE_RULES=f"rule: NOT ({unsafe})")
        assert Asked(stepper, asked_text, "first").allowed("aa") == (sets or ["", "left", "right", "left right"])


@rule("3.9")
def test_doing_nothing_is_allowed_only_in_a_safe_state(stepper: Stepper) -> None:
    """Where it leaves everything as it is."""
    asked_text = text(
        {"x": "abc"},
        ACTIONS="action repair nominal effects: x is a",
        STATE_RULES="rule: NOT x is b rule: NOT x is c",
    )
    for asked in under_both(stepper, asked_text):
        assert asked.allowed("a") == ["", "repair"]
        assert asked.allowed("b") == asked.allowed("c") == ["repair"]
        assert asked.leads("a", "") == "a"


@rule("3.9")
def test_an_unsafe_state_is_left_within_one_step(stepper: Stepper) -> None:
    """Two faults are not repaired by two actions: after either one the other fault is still there."""
    actions = "action one effects: x is a action two effects: y is a action both effects: x is a, y is a"
    rules = "rule: x is a rule: y is a"
    for asked in under_both(stepper, text({"x": "ab", "y": "ab"}, ACTIONS=actions, STATE_RULES=rules)):
        assert asked.allowed("bb") == ["both"]
        assert asked.allowed("ba") == ["one", "both", "one both"]


BESIDE = (
    "action repair preconditions: x is b nominal effects: x is a action beep"
    " action blink nominal effects: none alternative effects: none"
)


@rule("3.9")
def test_an_action_without_effects_adds_no_outcome(stepper: Stepper) -> None:
    """It may accompany what restores safety, and restores nothing itself, alone or with others of its kind."""
    for asked in under_both(stepper, text({"x": "ab"}, ACTIONS=BESIDE, STATE_RULES="rule: x is a")):
        assert asked.allowed("b") == ["repair", "repair beep", "repair blink", "repair beep blink"]
        assert asked.allowed("a") == ["", "beep", "blink", "beep blink"]


@rule("3.9")
def test_an_alternative_that_writes_makes_no_change_an_effect(stepper: Stepper) -> None:
    """Then the state itself is an outcome, in which an unsafe state is not left."""
    for effects, together in (("none", True), ("y is b", False)):
        actions = (
            f"action repair nominal effects: x is a action fumble nominal effects: none alternative effects: {effects}"
        )
        for asked in under_both(stepper, text({"x": "ab", "y": "ab"}, ACTIONS=actions, STATE_RULES="rule: x is a")):
            assert asked.allowed("ba") == ["repair", *(["repair fumble"] if together else [])]


@rule("3.9")
def test_what_is_to_accompany_a_restoration_does(decider: Decider) -> None:
    """A rule that wants the message beside the repair leaves a way to safety."""
    wanted = "rule: IF executing repair THEN executing beep"
    asked_text = text({"x": "ab"}, ACTIONS=BESIDE, STATE_RULES="rule: x is a", REACTION_RULES=wanted)
    for ordering in BOTH:
        assert policy(decider, asked_text, ordering) == {"a": "", "b": "repair beep"}


TWICE = text(
    {"x": "stg"},
    ACTIONS="action away preconditions: x is s nominal effects: x is t"
    " action back preconditions: x is t nominal effects: x is s"
    " action on preconditions: x is s nominal effects: x is g",
    GOALS="goal type: priority when x is s then goal: executing away AND x is g",
)
"""From s the goal is met after s, t, s, g: where the run comes back to s, it has to act differently."""


@rule("3.11")
def test_a_run_may_act_differently_where_it_meets_a_state_twice(decider: Decider) -> None:
    """So the state has a plan when it is taken alone, and conflicts with itself: no policy does that."""
    assert failures(decider, TWICE) == {"conflict": "s"}


@rule("3.11")
def test_a_plan_that_meets_a_state_twice_is_a_plan(refuter: Refuter) -> None:
    """A bound of three steps leaves room for it, one of two does not: a certificate that there is none is false."""
    shorter = f"{TWICE}\nBEGIN CONFIG max_plan_length: 2 END CONFIG"
    outcome = synthesize(world(shorter).spec)
    assert isinstance(outcome, Unrealizable) and outcome.certificate is not None
    assert refuter.believes(world(shorter), outcome.certificate)
    assert not refuter.believes(world(shorter.replace("2", "3")), outcome.certificate)


RACE = text(
    {"x": "ab", "y": "ab", "z": "ab"},
    ACTIONS="action spoil nominal effects: x is b alternative effects: y is b"
    " action go preconditions: x is a nominal effects: z is b"
    " action watch preconditions: y is a",
    CONFIG="preconditions: throughout",
)


@rule("3.12")
def test_preconditions_may_have_to_hold_throughout(stepper: Stepper) -> None:
    """Until the action takes effect, whatever the others do; one without effects never does."""
    for asked in under_both(stepper, RACE):
        assert asked.allowed("aaa") == ["", "spoil", "go", "watch", "go watch"]
        assert asked.allowed("aab") == ["", "spoil", "go", "watch", "go watch"]
        assert asked.allowed("baa") == ["", "spoil", "watch"]
    for asked in under_both(stepper, RACE.replace("throughout", "at_start")):
        assert asked.allowed("baa") == ["", "spoil", "watch", "spoil watch"]


@rule("3.12")
def test_what_several_effects_falsify_counts_under_any(stepper: Stepper) -> None:
    """After one of them the precondition still holds, after both it does not; nor in the nominal successor."""
    actions = (
        "action one nominal effects: x is b action two nominal effects: y is b"
        " action go preconditions: x is a OR y is a nominal effects: z is b"
    )
    asked_text = text({"x": "ab", "y": "ab", "z": "ab"}, ACTIONS=actions, CONFIG="preconditions: throughout")
    pairs = ["", "one", "two", "go", "one two", "one go", "two go"]
    assert Asked(stepper, asked_text, "any").allowed("aaa") == pairs
    assert Asked(stepper, asked_text, "first").allowed("aaa") == [*pairs, "one two go"]
