"""*No allowed set*: the stand-alone checker accepts cubes that are a proof, and nothing that is one off."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from tests.checker.standalone import Answer
from tests.checker.unrealizable import Document, assert_proved, assert_refuted, judged, spec_text

RULES = """
BEGIN STATE RULES rule: P is a END STATE RULES
BEGIN REACTION RULES
  rule: NOT (executing sing AND executing ring)
  rule: IF P is b THEN executing ring OR executing hop
END REACTION RULES
"""
ACTIONS = """
action hop controlled resources: LEGS effects: P is a alternative effects: P is b
action sing preconditions: P is a effects: none
action ring effects: none alternative effects: P is c
END ACTIONS
"""
STUCK = spec_text("abc", "bc", RULES).replace("END ACTIONS", ACTIONS, 1)
"""Nothing is allowed in `b`, nor in `c`."""

RULE = "(NOT (P is b)) OR ((executing ring) OR (executing hop))"


def cube(executed: str, idle: str, kind: str, **violation: Any) -> Document:
    """A cube and its violation."""
    return {"Executed": executed.split(), "Idle": idle.split(), "Violation": {"Kind": kind, **violation}}


def unsafe(executed: str, idle: str, *effects: str) -> Document:
    """A cube with an outcome: `hop=b` is the action `hop` that takes the effect `P is b`."""
    pairs = [each.split("=") for each in effects]
    return cube(executed, idle, "unsafe", Outcome=[{"Action": name, "Effect": {"P": value}} for name, value in pairs])


PROOF = {
    "idle": cube("", "bc hop sing ring", "reaction-rule", Rule=RULE),
    "bc": unsafe("bc", "", "bc=c"),
    "hop": unsafe("hop", "bc", "hop=b"),
    "ring": unsafe("ring", "bc hop", "ring=c"),
    "sing": cube("sing", "bc hop ring", "precondition", Actions=["sing"]),
}


def proof(**instead: Document | list[Document]) -> list[Document]:
    """The proof with other cubes in place of some."""
    parts = {**PROOF, **instead}
    return [each for part in parts.values() for each in (part if isinstance(part, list) else [part])]


def stuck(folder: Path, cubes: list[Document] | None, state: str = "b", ordering: str = "any") -> Answer:
    """The verdict on cubes for a state."""
    return judged(folder, STUCK, {"Kind": "no-allowed-set", "State": {"P": state}, "Cubes": cubes}, ordering=ordering)


RIGHT = {
    "as it is": proof(),
    "in another order": proof()[::-1],
    "a cube split": proof(bc=[cube("bc hop", "", "resource", Actions=["hop", "bc"]), unsafe("bc", "hop", "bc=c")]),
    "by nominal effects": proof(
        bc=[cube("bc hop", "", "nominal-conflict", Actions=["hop", "bc"]), unsafe("bc", "hop", "bc=c")]
    ),
    "settled otherwise": proof(
        ring=unsafe("ring", "bc hop sing", "ring=c"), sing=cube("sing", "bc hop", "precondition", Actions=["sing"])
    ),
    "nothing done": proof(idle=cube("", "bc hop sing ring", "idle")),
    "an action without effects open": proof(idle=cube("", "bc hop ring", "idle"), sing=[]),
    "an action without effects executed": proof(sing=cube("sing", "bc hop ring", "idle")),
    "no nominal successor": proof(idle=cube("", "bc hop ring sing", "nominal-unsafe")),
    "a rule for open actions": proof(idle=cube("", "bc hop ring", "reaction-rule", Rule=RULE), sing=[]),
}


@pytest.mark.parametrize("ordering", ["any", "first"])
@pytest.mark.parametrize("name", RIGHT)
def test_cubes_that_hold_all_sets_are_a_proof(name: str, ordering: str, tmp_path: Path) -> None:
    """In any order, split or not, whatever condition they name."""
    assert_proved(stuck(tmp_path, RIGHT[name], ordering=ordering))


WRONG = {
    "one is missing": (proof(idle=[]), "do not hold all sets"),
    "one is there twice": (proof(sing=[PROOF["sing"]] * 2), "have a set in common"),
    "one twice in place of another": (proof(idle=PROOF["bc"]), "have a set in common"),
    "two overlap": (proof(hop=unsafe("hop", "", "hop=b")), "have a set in common"),
    "one contradicts itself": (proof(sing=cube("sing", "sing", "idle")), "executes what it leaves idle"),
    "a precondition that holds": (
        proof(hop=cube("hop", "bc", "precondition", Actions=["hop"])),
        "the preconditions hold",
    ),
    "a precondition of another action": (
        proof(hop=cube("hop", "bc", "precondition", Actions=["sing"])),
        "an action that not all sets execute",
    ),
    "two actions of which one is open": (
        proof(hop=cube("hop", "bc", "nominal-conflict", Actions=["hop", "ring"])),
        "an action that not all sets execute",
    ),
    "two actions of which one is idle": (
        proof(hop=cube("hop", "bc", "resource", Actions=["hop", "bc"])),
        "an action that not all sets execute",
    ),
    "nominal effects that agree": (
        proof(
            ring=[
                unsafe("ring", "bc hop sing", "ring=c"),
                cube("ring sing", "bc hop", "nominal-conflict", Actions=["ring", "sing"]),
            ]
        ),
        "the nominal effects of the two agree",
    ),
    "no resource that is shared": (
        proof(
            ring=[
                unsafe("ring", "bc hop sing", "ring=c"),
                cube("ring sing", "bc hop", "resource", Actions=["ring", "sing"]),
            ]
        ),
        "the two share no resource",
    ),
    "a resource of one of the two": (
        proof(hop=[cube("hop sing", "bc", "resource", Actions=["hop", "sing"]), unsafe("hop", "bc sing", "hop=b")]),
        "the two share no resource",
    ),
    "an empty outcome": (proof(bc=unsafe("bc", "")), "not those of different actions"),
    "an action that takes effect twice": (
        proof(hop=unsafe("hop", "bc", "hop=a", "hop=b")),
        "not those of different actions",
    ),
    "an action that takes effect twice alike": (
        proof(hop=unsafe("hop", "bc", *["hop=b"] * 2)),
        "not those of different actions",
    ),
    "an effect that the action has not": (proof(hop=unsafe("hop", "bc", "hop=c")), "does not have the effect"),
    "an outcome that is safe": (proof(hop=unsafe("hop", "bc", "hop=a")), "(P a) is safe"),
    "an unsafe state on the way only": (
        proof(bc=[unsafe("bc hop", "", "bc=c", "hop=a"), unsafe("bc", "hop", "bc=c")]),
        "(P a) is safe",
    ),
    "an outcome of an idle action": (proof(hop=unsafe("hop", "bc", "bc=c")), "not those of different actions"),
    "an outcome of an open action": (proof(hop=unsafe("hop", "bc", "ring=c")), "not those of different actions"),
    "a rule that there is not": (
        proof(idle=cube("", "bc hop sing ring", "reaction-rule", Rule="true")),
        "no such rule",
    ),
    "a rule that holds": (proof(hop=cube("hop", "bc", "reaction-rule", Rule=RULE)), "keeps the rule"),
    "a rule that an open action keeps": (
        proof(idle=cube("", "bc hop sing", "reaction-rule", Rule=RULE), ring=unsafe("ring sing", "bc hop", "ring=c")),
        "{ring} (duration 0) keeps the rule",
    ),
    "idle where an action is open": (
        proof(idle=cube("", "bc hop sing", "idle"), ring=unsafe("ring sing", "bc hop", "ring=c")),
        "doing nothing may be allowed",
    ),
    "idle where an action is executed": (
        proof(ring=cube("ring", "bc hop", "idle")),
        "doing nothing may be allowed",
    ),
    "an effect of an action without effects": (
        proof(sing=cube("sing", "bc hop ring", "unsafe", Outcome=[{"Action": "sing", "Effect": {}}])),
        "`sing` does not have the effect",
    ),
    "nominal effects where an action is open": (
        proof(idle=cube("", "bc hop ring", "nominal-unsafe"), sing=[]),
        "not one nominal successor",
    ),
    "a nominal successor that is safe": (
        proof(
            hop=[
                cube("hop", "bc ring sing", "nominal-unsafe"),
                unsafe("ring hop", "bc", "ring=c"),
                cube("sing hop", "bc ring", "precondition", Actions=["sing"]),
            ]
        ),
        "the nominal successor is safe",
    ),
}


@pytest.mark.parametrize("name", WRONG)
def test_cubes_that_are_no_proof(name: str, tmp_path: Path) -> None:
    """A cube too few or too many, or a violation that is none, is refuted with the reason."""
    cubes, why = WRONG[name]
    assert_refuted(stuck(tmp_path, cubes), why)


def test_a_safe_state_may_do_nothing(tmp_path: Path) -> None:
    """Doing nothing is ruled out in unsafe states only."""
    assert_refuted(
        stuck(tmp_path, proof(idle=cube("", "bc hop sing ring", "idle")), "a"), "doing nothing may be allowed"
    )


def test_only_the_first_effect_counts_under_first(tmp_path: Path) -> None:
    """An outcome of two effects is one under `any` only; and a proof for `any` is none where `first` is written."""
    both = unsafe("hop ring", "bc", "ring=c", "hop=b")
    cubes = proof(hop=[both, unsafe("hop", "bc ring", "hop=b")])
    assert_proved(stuck(tmp_path, cubes))
    assert_refuted(stuck(tmp_path, cubes, ordering="first"), "only the first effect counts")
    reason = {"Kind": "no-allowed-set", "State": {"P": "b"}, "Cubes": proof()}
    writes_first = STUCK + "BEGIN CONFIG effect_ordering: first END CONFIG"
    assert_refuted(judged(tmp_path, writes_first, reason), "under which more sets are allowed")
    assert_proved(judged(tmp_path, writes_first, reason, ordering="first"))
    assert_proved(judged(tmp_path, writes_first, reason, "--effect-ordering", "first"))


def test_without_cubes_the_sets_are_looked_at(tmp_path: Path) -> None:
    """`Cubes` null: every set is tried; one that is allowed is named."""
    assert_proved(stuck(tmp_path, None, "b"))
    assert_proved(stuck(tmp_path, None, "c"))
    assert_refuted(stuck(tmp_path, None, "a"), "in (P a), {} (duration 0) is allowed")


def test_not_all_of_many_sets_and_states_are_looked_at(tmp_path: Path) -> None:
    """Sets that have a fault anyway are not grown, and a claim about one state does not look at the others."""
    numbers = range(40)
    states = " ".join(f"state V{n} can be a, b" for n in numbers)
    actions = " ".join(f"action up{n} effects: V{n} is b alternative effects: V{n - 1} is b" for n in numbers[1:])
    rules = "BEGIN STATE RULES " + " ".join(f"rule: V{n} is a" for n in numbers) + " END STATE RULES"
    text = f"BEGIN STATE VECTOR {states} END STATE VECTOR BEGIN ACTIONS {actions} END ACTIONS {rules}"
    state = {f"V{n}": "b" for n in numbers}
    assert_proved(judged(tmp_path, text, {"Kind": "no-allowed-set", "State": state, "Cubes": None}))
    plan = {"Kind": "no-plan", "State": state, "Order": [], "Leaves": [False, True], "Nodes": [], "Goals": []}
    answer = judged(tmp_path, text, plan)
    assert (answer.code, "holds" in answer.out) == (3, False)
    assert "1,099,511,627,776 states are too many to look at each of them" in answer.err
