"""The stand-alone checker and the package agree on what is right."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.checker.agreement import disagreements
from tests.checker.standalone import ask, checker, sizes
from tests.generate import random_spec, random_text
from tests.profiles import ALL_PROFILES, RESTORING
from tumato_symbolic import Realizable, synthesize
from tumato_symbolic.diagnostics import Source
from tumato_symbolic.policy import dumps
from tumato_symbolic.semantics import all_states, is_safe, is_valid
from tumato_symbolic.spec import canonical_text, load

pytestmark = pytest.mark.usefixtures("read_once")

EXAMPLES = sorted((Path(__file__).parents[2] / "examples").glob("*.tum"))


@pytest.mark.parametrize("profile", ALL_PROFILES)
@pytest.mark.parametrize("start", [0, 10])
def test_judges_agree(profile: str, start: int, tmp_path: Path) -> None:
    """Under both orderings every property fails in as many states as the explicit meaning says."""
    for seed in range(start, start + 6):
        judged, found = disagreements(tmp_path, profile, seed)
        assert judged == 8
        assert not found, "\n".join(found)


def test_certificates_of_the_synthesizer_are_right(tmp_path: Path) -> None:
    """Policies that `synthesize` makes pass with their certificates, also where goals speak of actions."""
    passed = 0
    for seed in range(60):
        spec, text = random_spec(seed, RESTORING), random_text(seed, RESTORING)
        outcome = synthesize(spec)
        if isinstance(outcome, Realizable):
            answer = ask(tmp_path, dumps(outcome.policy), text, "--strict")
            assert answer.code == 0, (seed, answer)
            passed += "certificate: right" in answer.out
    assert passed >= 10


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_examples_mean_the_same(path: Path) -> None:
    """The package and the checker count the same valid and safe states and read the same goals."""
    text = path.read_text(encoding="utf-8")
    spec = load(Source(path.name, text)).spec
    assert spec is not None
    valid = [state for state in all_states(spec) if is_valid(spec, state)]
    assert sizes(text) == (len(valid), sum(is_safe(spec, state) for state in valid))
    own = checker.resolve(checker.Parser(text).specification())
    bodies = {checker.text_of(body, own) for body in checker.bodies_of(own.goals)}
    assert bodies == {canonical_text(spec, body.formula) for body in spec.bodies}
