"""Canonical texts and digests depend on the meaning, not on how it is written down."""

from pathlib import Path

import pytest

from tests.spec.marked import loaded
from tumato_symbolic.spec import And, Constant, Executing, Formula, Iff, Is, Not, Or, Spec, canonical_text, digest

AMR = (Path(__file__).parents[2] / "examples" / "amr.tum").read_text(encoding="utf-8")


def spec(text: str) -> Spec:
    """The specification of a text without errors."""
    found = loaded(text)
    assert found.spec is not None, found.diagnostics
    return found.spec


BATTERY_GOAL = "when S_Battery is low then goal: S_Battery is ok"
BATTERY = "state S_Battery can be low, ok\n"
LOAD = "state S_Load can be loaded, free\n"
CHARGE = AMR[AMR.index("action charge") : AMR.index("END ACTIONS")]
FINE = "BEGIN ALIASES define fine as S_Battery is ok END ALIASES"

SAME = [
    ("a comment", AMR + "// well"),
    ("layout", " ".join(line.split("//")[0] for line in AMR.split("\n"))),
    ("an alias", AMR.replace("goal: S_Battery is ok", "goal: fine") + FINE),
    ("order of resources", AMR.replace("resource MOTORS\n", "").replace("END RES", "resource MOTORS END RES")),
    ("order of values", AMR.replace("can be low, ok", "can be ok, low")),
    ("order of variables", AMR.replace(BATTERY + LOAD, LOAD + BATTERY)),
    ("order of actions", AMR.replace(CHARGE, "").replace("BEGIN ACTIONS\n", "BEGIN ACTIONS\n" + CHARGE)),
    ("the effect ordering", AMR.replace("max_plan_length: 5", "max_plan_length: 5 effect_ordering: first")),
    ("an unused resource", AMR.replace("resource MOTORS", "resource MOTORS resource SPARE")),
]

OTHER = [
    ("a duration", AMR.replace("duration: 50", "duration: 51")),
    ("the bound", AMR.replace("max_plan_length: 5", "max_plan_length: 6")),
    ("no bound", AMR.replace("max_plan_length: 5", "")),
    ("order of goals", AMR.replace(BATTERY_GOAL, "").replace("END GOALS", f"{BATTERY_GOAL} END GOALS")),
    ("the kind of goals", AMR.replace("priority", "constraint")),
    ("a rule", AMR.replace("THEN S_Conveyor is off\n", "THEN S_Conveyor is on\n")),
    ("a value", AMR.replace("can be low, ok", "can be low, ok, full")),
    ("an alternative", AMR.replace("alternative effects: S_Location is corridor", "")),
    ("a resource", AMR.replace("resources: MOTORS, CONVEYOR", "resources: MOTORS", 1)),
]


@pytest.mark.parametrize(("what", "text"), SAME, ids=[what for what, _ in SAME])
def test_the_digest_ignores(what: str, text: str) -> None:
    """What leaves the meaning alone leaves the digest alone."""
    assert text != AMR, what
    assert digest(spec(text)) == digest(spec(AMR))


@pytest.mark.parametrize(("what", "text"), OTHER, ids=[what for what, _ in OTHER])
def test_the_digest_tells_apart(what: str, text: str) -> None:
    """What changes the meaning changes the digest."""
    assert text != AMR, what
    assert digest(spec(text)) != digest(spec(AMR))


def test_canonical_texts_keep_the_structure() -> None:
    """Formulas with different structure have different texts, also where they are equivalent."""
    amr = spec(AMR)
    low, loaded_ = Is(1, 0), Is(2, 0)
    formulas: list[Formula] = [
        Constant(True), Constant(False), low, Not(low), And((low, loaded_)), And((loaded_, low)), Or((low, loaded_)),
        And((low, And((low, low)))), And((And((low, low)), low)), And((low, low, low)), Iff(low, loaded_),
        Iff(Iff(low, low), low), Iff(low, Iff(low, low)), Not(Not(low)), Executing(0),
        Not(And((low, low))), And((Not(low), low)),
    ]  # fmt: skip
    assert len({canonical_text(amr, each) for each in formulas}) == len(formulas)
    assert canonical_text(amr, And((low, Executing(7)))) == "(S_Battery is low) AND (executing charge)"
