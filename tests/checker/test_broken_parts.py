"""Certificates of unrealizability with a part that does not fit: the checker refuses to judge them, and says which."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from tests.checker.standalone import ask
from tests.checker.test_unrealizable import CASES
from tests.checker.unrealizable import certificate

GONE = object()
BROKEN: list[tuple[str, str, object, str]] = [
    # cubes: which part, what stands there instead, and what is said
    ("cubes", "Cubes", GONE, "there is no `Cubes`"),
    ("cubes", "Cubes", 3, "`Cubes` is a list"),
    ("cubes", "Cubes", {}, "`Cubes` is a list"),
    ("cubes", "Cubes", [3], "`Cubes` is a list of objects"),
    ("cubes", "State", GONE, "`State` is an object from variables to values"),
    ("cubes", "State", ["b"], "`State` is an object from variables to values"),
    ("cubes", "State", {"P": "b", "Q": "b"}, "`State` is an object from variables to values"),
    ("cubes", "State", {}, "`State` has not a value for every variable"),
    ("cubes", "State P", "z", "`State`: `P` has no value 'z'"),
    ("cubes", "State P", 1, "`State`: `P` has no value '1'"),
    ("cubes", "State P", ["b"], "`State`: `P` has no value ['b']"),
    ("cubes", "Cubes 0 Executed", GONE, "`Executed` is a list of different names"),
    ("cubes", "Cubes 0 Executed", "bc", "`Executed` is a list of different names"),
    ("cubes", "Cubes 1 Executed", ["bc", "bc"], "`Executed` is a list of different names"),
    ("cubes", "Cubes 1 Executed", ["bc", "fly"], "`Executed` has an unknown action"),
    ("cubes", "Cubes 0 Idle", GONE, "`Idle` is a list of different names"),
    ("cubes", "Cubes 0 Idle", ["bc", "hop", "sing", "ring", "fly"], "`Idle` has an unknown action"),
    ("cubes", "Cubes 0 Violation", GONE, "`Violation` is an object"),
    ("cubes", "Cubes 0 Violation", ["idle"], "`Violation` is an object"),
    ("cubes", "Cubes 0 Violation Kind", GONE, "there is no violation None"),
    ("cubes", "Cubes 0 Violation Kind", "boredom", "there is no violation 'boredom'"),
    ("cubes", "Cubes 0 Violation Rule", 3, "`Rule` is a text"),
    ("cubes", "Cubes 1 Violation Outcome", GONE, "`Outcome` is a list"),
    ("cubes", "Cubes 1 Violation Outcome", ["bc"], "`Outcome` is a list of objects"),
    ("cubes", "Cubes 1 Violation Outcome 0 Action", GONE, "`Action` is an action"),
    ("cubes", "Cubes 1 Violation Outcome 0 Action", "fly", "`Action` is an action"),
    ("cubes", "Cubes 1 Violation Outcome 0 Action", ["bc"], "`Action` is an action"),
    ("cubes", "Cubes 1 Violation Outcome 0 Effect", GONE, "`Effect` is an object from variables to values"),
    ("cubes", "Cubes 1 Violation Outcome 0 Effect Q", "a", "`Effect` is an object from variables to values"),
    ("cubes", "Cubes 1 Violation Outcome 0 Effect P", "z", "`Effect`: `P` has no value 'z'"),
    ("cubes", "Cubes 4 Violation Actions", GONE, "`Actions` is a list of different names"),
    ("cubes", "Cubes 4 Violation Actions", [], "a violation `precondition` names 1 action"),
    ("cubes", "Cubes 4 Violation Actions", ["sing", "hop"], "a violation `precondition` names 1 action"),
    ("cubes", "Cubes 4 Violation Actions", ["fly"], "`Actions` has an unknown action"),
    ("cubes", "Cubes 4 Violation", {"Kind": "resource", "Actions": ["sing"]}, "a violation `resource` names 2 actions"),
    (
        "cubes",
        "Cubes 4 Violation",
        {"Kind": "nominal-conflict", "Actions": ["sing", "hop", "bc"]},
        "a violation `nominal-conflict` names 2 actions",
    ),
    # layers
    ("layers", "State", {}, "`State` has not a value for every variable"),
    ("layers", "Order", GONE, "a diagram has not all of `Order`, `Leaves` and `Nodes`"),
    ("layers", "Order", "P", "`Order` is wrong"),
    ("layers", "Order", ["P", "P"], "`Order` is wrong"),
    ("layers", "Order", ["P", "Q"], "`Order` is wrong"),
    ("layers", "Leaves", [], "`Leaves` is wrong"),
    ("layers", "Leaves", "01", "`Leaves` is wrong"),
    ("layers", "Leaves", [0, 1], "`Leaves` is not [false, true]"),
    ("layers", "Leaves", [True, False], "`Leaves` is not [false, true]"),
    ("layers", "Nodes", {}, "`Nodes` is wrong"),
    ("layers", "Nodes 0", {}, "node 2 is wrong"),
    ("layers", "Nodes 0", [0, [0, 1, 1]], "node 2 is wrong"),
    ("layers", "Nodes 1", [0, [0, 1, 1, 3]], "node 3 is wrong"),
    ("layers", "Nodes 1", [0, [0, 1, 1, 2]], "node 3 is wrong"),
    ("layers", "Nodes 1", [1, [0, 1, 1, 1]], "node 3 is wrong"),
    ("layers", "Nodes 1", [False, [0, 1, 1, 1]], "node 3 is wrong"),
    ("layers", "Goals", GONE, "`Goals` is a list"),
    ("layers", "Goals", [3], "`Goals` is a list of objects"),
    ("layers", "Goals 0 Layers", GONE, "`Layers` is a list"),
    ("layers", "Goals 0 Layers", [], "there is a goal without layers"),
    ("layers", "Goals 0 Layers", [2, 4], "a root is wrong"),
    ("layers", "Goals 0 Layers", [True, 3], "a root is wrong"),
    ("layers", "Goals 0 Bodies", GONE, "an entry of `Goals` is no goal"),
    ("layers", "Goals 0 Executed", GONE, "an entry of `Goals` is no goal"),
    ("layers", "Goals 0 Bodies", "P is d", "`Bodies` is no list of different names"),
    ("layers", "Goals 0 Bodies", ["P is d", "P is d"], "`Bodies` is no list of different names"),
    ("layers", "Goals 0 Executed", [1], "`Executed` is no list of different names"),
    ("layers", "Goals 0 Executed", ["fly"], "there are no such actions: ['fly']"),
    # conflict
    ("conflict", "Leaves", [0, 1, 2, None, 0], "`Leaves` are not different numbers"),
    ("conflict", "Leaves", [0, 1, 2, None, -3], "`Leaves` are not different numbers"),
    ("conflict", "Leaves", [0, True, 2, None, 3], "`Leaves` are not different numbers"),
    ("conflict", "Goals", GONE, "`Goals` is a list"),
    ("conflict", "Goals 0 Root", GONE, "a root is wrong"),
    ("conflict", "Goals 0 Root", 7, "a root is wrong"),
    ("conflict", "Goals 0 Executed", ["fly"], "there are no such actions: ['fly']"),
    ("conflict", "Choices", GONE, "`Choices` is a list"),
    ("conflict", "Choices 0", [], "`Choices` is a list of objects"),
    ("conflict", "Choices 0 State", {}, "`State` has not a value for every variable"),
    ("conflict", "Choices 0 Options", GONE, "`Options` is a list"),
    ("conflict", "Choices 0 Options 0", 1, "`Options` is a list of objects"),
    ("conflict", "Choices 0 Options 0 Successor", GONE, "`Successor` is an object from variables to values"),
    ("conflict", "Choices 0 Options 0 Goal", GONE, "`Goal` is the number of a goal"),
    ("conflict", "Choices 0 Options 0 Goal", 3, "`Goal` is the number of a goal"),
    ("conflict", "Choices 0 Options 0 Goal", False, "`Goal` is the number of a goal"),
    ("conflict", "Starts", GONE, "`Starts` is a list"),
    ("conflict", "Starts", [0, 5], "`Starts` is a list of numbers below 5"),
    ("conflict", "Cuts", GONE, "`Cuts` is a list"),
    ("conflict", "Cuts 0", 1, "`Cuts` is a list of objects"),
    ("conflict", "Cuts 0 Kind", "ring", "a cut is a `path`, a `loop`, or `outcomes`"),
    ("conflict", "Cuts 0 Kind", GONE, "a cut is a `path`, a `loop`, or `outcomes`"),
    ("conflict", "Cuts 0 Kind", "path", "a path has an `End`, and no other cut has one"),
    ("conflict", "Cuts 0 End", {"P": "l"}, "a path has an `End`, and no other cut has one"),
    ("conflict", "Cuts 0", {"Kind": "outcomes", "States": [0]}, "outcomes have no `Goal`, and `Back` is a number"),
    ("conflict", "Cuts 0", {"Kind": "outcomes", "States": [0], "Back": 0, "Goal": 0}, "outcomes have no `Goal`"),
    ("conflict", "Choices 0 Outcomes", 3, "`Outcomes` is a list"),
    ("conflict", "Choices 0 Outcomes", [], "`Outcomes` has an entry for every option"),
    ("conflict", "Choices 0 Outcomes", [3, 3], "`Outcomes` is a list of lists"),
    ("conflict", "Cuts 0 States", GONE, "`States` is a list"),
    ("conflict", "Cuts 0 States", [], "there is a cut without states"),
    ("conflict", "Cuts 0 States", [0, 5], "`States` is a list of numbers below 5"),
    ("conflict", "Cuts 0 Goal", 3, "`Goal` is the number of a goal"),
    ("conflict", "Cuts 0", {"Kind": "path", "Goal": 0, "States": [0], "End": {}}, "`End` has not a value for every"),
]


@pytest.mark.parametrize(("case", "place", "instead", "why"), BROKEN)
def test_a_part_that_does_not_fit(case: str, place: str, instead: object, why: str, tmp_path: Path) -> None:
    """It is missing, of another type, names what there is not, or is a number too large."""
    text, reason = CASES[case]
    document = json.loads(certificate(text, reason))
    *way, last = (int(key) if key.isdigit() else key for key in place.split())
    part: Any = document["Reason"]
    for key in way:
        part = part[key]
    if instead is GONE:
        del part[last]
    else:
        part[last] = instead
    answer = ask(tmp_path, json.dumps(document), text)
    assert (answer.code, "holds" in answer.out) == (2, False), answer
    assert f"cannot be judged: {why}" in answer.err


@pytest.mark.parametrize("reason", [None, [], "no time"])
def test_a_reason_is_an_object(reason: object, tmp_path: Path) -> None:
    """Whatever else it is, it is not judged."""
    text, _ = CASES["layers"]
    document = json.loads(certificate(text, {}))
    answer = ask(tmp_path, json.dumps({**document, "Reason": reason}), text)
    assert (answer.code, "cannot be judged: `Reason` is an object" in answer.err) == (2, True)
