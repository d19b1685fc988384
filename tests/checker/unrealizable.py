"""Certificates of unrealizability, written by hand, and what the stand-alone checker says of them."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from tests.checker.standalone import Answer, ask
from tumato_symbolic import parse
from tumato_symbolic.spec import digest

Document = dict[str, Any]


def spec_text(places: str, steps: str, rest: str = "", bound: int | None = None) -> str:
    """One variable `P`; `ab` among the steps is an action that leads from `a` to `b`; `rest` holds other blocks."""
    actions = "".join(
        f"action {step} controlled resources: LEGS preconditions: P is {step[0]} nominal effects: P is {step[1]} "
        for step in steps.split()
    )
    config = "" if bound is None else f"BEGIN CONFIG max_plan_length: {bound} END CONFIG "
    return (
        f"BEGIN STATE VECTOR state P can be {', '.join(places)} END STATE VECTOR "
        f"BEGIN RESOURCES resource LEGS END RESOURCES BEGIN ACTIONS {actions} END ACTIONS {rest} {config}"
    )


def certificate(text: str, reason: Document, ordering: str = "any") -> str:
    """A certificate for a specification."""
    spec = parse(text)
    return json.dumps(
        {
            "Type": "unrealizable",
            "SpecificationDigest": digest(spec),
            "EffectOrdering": ordering,
            "Actions": [action.name for action in spec.actions],
            "States": {v.name: {value: n for n, value in enumerate(v.values)} for v in spec.variables},
            "Reason": reason,
        }
    )


def judged(folder: Path, text: str, reason: Document, *options: str, ordering: str = "any") -> Answer:
    """What the checker says of it, strictly."""
    return ask(folder, certificate(text, reason, ordering), text, "--strict", *options)


def assert_proved(answer: Answer) -> None:
    """The certificate is a proof, for this specification."""
    assert answer.code == 0, answer
    assert answer.out.startswith(("effect ordering any", "effect ordering first"))
    assert "unrealizable holds: " in answer.out
    assert "specification: the same" in answer.out


def assert_refuted(answer: Answer, why: str) -> None:
    """It is none, for this reason."""
    assert (answer.code, answer.err) == (1, ""), answer
    assert "unrealizable FAILS: " in answer.out
    assert why in answer.out
