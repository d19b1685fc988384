"""Who proves what: Z3, the walk, both, or whoever is quicker."""

import subprocess
import sys
from dataclasses import replace

import pytest

from tests.repo.documents import ROOT
from tests.semantics.build import Build, chosen, constraint
from tests.verify.policies import certified, exact_ranks
from tumato_symbolic.policy import as_diagram, policy_from_rows
from tumato_symbolic.semantics import ActionSet, State
from tumato_symbolic.spec import Spec
from tumato_symbolic.verify import PropertyResult, provers, verify
from tumato_symbolic.verify.by_walk.prover import WalkProver

NAMES = ["total", "safe", "goals", "minimal"]


def _ring() -> tuple[Spec, dict[State, ActionSet]]:
    """One variable that goes round; the goal is its first value."""
    build = Build({"x": "abcd"})
    steps = [build.action(f"x={after}", when=[build.atom(f"x={here}")]) for here, after in ("ab", "bc", "cd", "da")]
    spec = build.spec(goals=constraint(build.goal(build.atom("x=a"))))
    return spec, {(number,): chosen(step) for number, step in enumerate(steps)}


def _proved_by(prover: provers.ProverName) -> list[str | None]:
    spec, rows = _ring()
    answer = verify(certified(spec, rows, exact_ranks(spec, rows, "any")), spec, prover=prover)
    assert answer.verdict == "proved"
    assert answer.valid_states == 4
    assert answer.certificate.status == "used"
    return [result.proved_by for result in answer.properties]


def test_the_answer_says_who_proved_what(monkeypatch: pytest.MonkeyPatch) -> None:
    """Each property names its prover; `auto` asks the walk where Z3 does not answer soon, and first for large ranks."""
    assert _proved_by("z3") == ["z3"] * 4
    assert _proved_by("walk") == ["walk"] * 4
    assert _proved_by("both") == ["z3+walk"] * 4
    assert _proved_by("auto") == ["z3"] * 4
    monkeypatch.setattr(provers, "SOON", -1.0)
    assert _proved_by("auto") == ["z3", "walk", "walk", "walk"], "what folds to false needs no time"
    monkeypatch.setattr(provers, "MANY_RANK_NODES", 0)
    assert _proved_by("auto") == ["walk"] * 4


def test_z3_has_the_last_word(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where the walk gives up as well, Z3 may take the time that an obligation has."""
    monkeypatch.setattr(provers, "SOON", -1.0)
    monkeypatch.setattr(WalkProver, "prove", lambda _, name: PropertyResult(name, "undecided", reason="tired"))
    assert _proved_by("auto") == ["z3"] * 4


@pytest.mark.parametrize("prover", ["z3", "walk", "both", "auto"])
def test_no_time_is_undecided(prover: provers.ProverName) -> None:
    """What nobody proves in time is undecided, with a reason."""
    spec, rows = _ring()
    answer = verify(policy_from_rows(spec, rows), spec, prover=prover, timeout=0.0)
    assert [result.verdict for result in answer.properties][1:] == ["undecided"] * 3
    assert all(result.reason for result in answer.properties[1:])


def test_provers_that_disagree_are_a_bug(monkeypatch: pytest.MonkeyPatch) -> None:
    """`both` never chooses between a proof and a refutation; an open answer beside a proof is no proof."""
    spec, rows = _ring()
    policy = policy_from_rows(spec, {**rows, (1,): frozenset()})
    monkeypatch.setattr(WalkProver, "prove", lambda _, name: PropertyResult(name, "proved", 1, "walk"))
    with pytest.raises(RuntimeError, match="disagree"):
        verify(policy, spec, prover="both")
    monkeypatch.setattr(WalkProver, "prove", lambda _, name: PropertyResult(name, "undecided", reason="tired"))
    verdicts = [result.verdict for result in verify(policy, spec, prover="both").properties]
    assert verdicts == ["undecided", "undecided", "refuted", "undecided"]


def test_a_large_diagram_needs_no_certificate(monkeypatch: pytest.MonkeyPatch) -> None:
    """The walk computes the ranks of a diagram of any size; Z3 cannot follow more runs than it can list."""
    from tumato_symbolic.verify import decisions

    monkeypatch.setattr(decisions, "LARGEST_TABLE", 3)
    spec, rows = _ring()
    policy = policy_from_rows(spec, rows)
    policy = replace(policy, decisions=as_diagram(policy))
    assert verify(policy, spec, prover="z3").verdict == "undecided"
    answer = verify(policy, spec)
    assert [(result.name, result.verdict) for result in answer.properties] == [(name, "proved") for name in NAMES]


def test_the_walk_does_without_z3() -> None:
    """With `--prover walk`, Z3 is not even imported."""
    code = (
        "import sys\n"
        "from pathlib import Path\n"
        "from tumato_symbolic.diagnostics import Source\n"
        "from tumato_symbolic.policy import policy_from_rows\n"
        "from tumato_symbolic.spec import load\n"
        "from tumato_symbolic.verify import verify\n"
        "text = Path('examples/amr.tum').read_text(encoding='utf-8')\n"
        "spec = load(Source('amr.tum', text)).spec\n"
        "answer = verify(policy_from_rows(spec, {}), spec, prover='walk')\n"
        "assert answer.verdict == 'refuted'\n"
        "assert 'z3' not in sys.modules and 'dd' not in sys.modules\n"
    )
    subprocess.run([sys.executable, "-c", code], cwd=ROOT, check=True)
