"""Certificates of unrealizability as files: those that are committed, those that are broken."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.checker import test_conflicts, test_cubes, test_layers
from tests.checker.standalone import CHECKER, ask
from tests.checker.unrealizable import Document, assert_proved, certificate
from tests.policy.mutations import mutations

EXAMPLES = CHECKER.parents[1] / "examples"


@pytest.mark.parametrize("path", sorted(CHECKER.parent.glob("*.unrealizable.json")), ids=lambda path: path.name)
def test_committed_certificates_are_proofs(path: Path, tmp_path: Path) -> None:
    """What `proofs/` holds is accepted; beside another specification it is called stale, which counts when strict."""
    document, name = path.read_text(encoding="utf-8"), path.name.replace(".unrealizable.json", ".tum")
    text = (EXAMPLES / name).read_text(encoding="utf-8")
    assert_proved(ask(tmp_path, document, text, "--strict"))
    other = text + "BEGIN ASSUMPTIONS assume: true END ASSUMPTIONS"
    lenient, strict = (ask(tmp_path, document, other, *options) for options in ((), ("--strict",)))
    assert (lenient.code, strict.code) == (0, 1)
    assert "STALE" in lenient.out


CASES = {
    "cubes": (test_cubes.STUCK, {"Kind": "no-allowed-set", "State": {"P": "b"}, "Cubes": test_cubes.proof()}),
    "layers": (test_layers.line(2), test_layers.layers("ab", "abc")),
    "conflict": (test_conflicts.crossing(2), test_conflicts.conflict(test_conflicts.LOOPS)),
}
EASY = {"P is a END STATE": "true END STATE", "goal: P is d": "goal: true", "goal: P is R": "goal: true"}
"""What makes each realizable."""

BROKEN: dict[str, Callable[[Document], object]] = {
    "no reason": lambda document: document.pop("Reason"),
    "no digest": lambda document: document.pop("SpecificationDigest"),
    "no ordering": lambda document: document.pop("EffectOrdering"),
    "another kind": lambda document: document["Reason"].update(Kind="no-time"),
    "an action less": lambda document: document["Actions"].pop(),
    "a value less": lambda document: document["States"]["P"].popitem(),
}


@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("name", BROKEN)
def test_what_is_no_certificate_is_refused(case: str, name: str, tmp_path: Path) -> None:
    """A file that does not fit the format or the specification is not judged."""
    text, reason = CASES[case]
    document = json.loads(certificate(text, reason))
    BROKEN[name](document)
    answer = ask(tmp_path, json.dumps(document), text)
    assert (answer.code, "holds" in answer.out) == (2, False)
    assert answer.err.startswith("cannot be judged: ")


@pytest.mark.parametrize("case", CASES)
def test_broken_files_end_in_a_verdict_or_a_refusal(case: str, tmp_path: Path) -> None:
    """Whatever is broken, there is no traceback; and what has a policy is never called unrealizable."""
    text, reason = CASES[case]
    easy = text
    for hard, easier in EASY.items():
        easy = easy.replace(hard, easier)
    assert easy != text
    codes = set()
    for seed in range(60):
        broken = mutations(certificate(text, reason), seed).decode(errors="replace")
        codes.add(ask(tmp_path, broken, text).code)
        assert ask(tmp_path, broken, easy).code in (1, 2)
    assert {0, 2} <= codes <= {0, 1, 2}
