"""Who proves what: Z3, the walk, explicit-state checking, both, or whoever is quicker."""

import subprocess
import sys

import pytest
from msgspec.structs import replace

from tests.repo.documents import ROOT
from tests.semantics.build import Build, chosen, constraint
from tests.verify.policies import certified, exact_ranks
from tumato_symbolic.limits import Context, Limits
from tumato_symbolic.policy import as_diagram, policy_from_rows
from tumato_symbolic.semantics import ActionSet, State
from tumato_symbolic.spec import Spec
from tumato_symbolic.verify import PropertyName, PropertyResult, ProverName, portfolio, verify
from tumato_symbolic.verify.by_diagrams.prover import WalkProver

NAMES = ["total", "safe", "goals", "minimal"]


def _ring() -> tuple[Spec, dict[State, ActionSet]]:
    """One variable that goes round; the goal is its first value."""
    build = Build({"x": "abcd"})
    steps = [build.action(f"x={after}", when=[build.atom(f"x={here}")]) for here, after in ("ab", "bc", "cd", "da")]
    spec = build.spec(goals=constraint(build.goal(build.atom("x=a"))))
    return spec, {(number,): chosen(step) for number, step in enumerate(steps)}


def _proved_by(prover: ProverName) -> list[str | None]:
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
    assert _proved_by("explicit") == ["explicit"] * 4
    assert _proved_by("auto") == ["z3"] * 4
    monkeypatch.setattr(portfolio, "SOON", -1.0)
    assert _proved_by("auto") == ["z3", *["explicit"] * 3], "what folds to false needs no time"
    monkeypatch.setattr(portfolio, "LITTLE", -1)
    assert _proved_by("auto") == ["z3", "walk", "walk", "walk"]
    monkeypatch.setattr(portfolio, "MANY_RANK_NODES", 0)
    assert _proved_by("auto") == ["walk"] * 4


def test_long_runs_of_a_diagram_are_for_the_walk(monkeypatch: pytest.MonkeyPatch) -> None:
    """Many different ranks keep Z3 busy; a table is listed sooner."""
    spec, rows = _ring()
    table = certified(spec, rows, exact_ranks(spec, rows, "any"))
    for most, first in ((2, "walk"), (100, "z3")):
        monkeypatch.setattr(portfolio, "MANY_RANKS", most)
        diagram = verify(replace(table, decisions=as_diagram(table)), spec)
        assert [result.proved_by for result in diagram.properties] == [first] * 4
        assert [result.proved_by for result in verify(table, spec).properties] == ["z3"] * 4


def _tired(_: object, name: PropertyName, *__: object) -> PropertyResult:
    return PropertyResult(name, "undecided", reason="tired")


def test_z3_is_asked_again(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where there is much to look at and the walk gives up as well, Z3 may take the time that an obligation has."""
    monkeypatch.setattr(portfolio, "SOON", -1.0)
    monkeypatch.setattr(portfolio, "LITTLE", -1)
    monkeypatch.setattr(WalkProver, "prove", _tired)
    assert _proved_by("auto") == ["z3"] * 4


@pytest.mark.parametrize("little", [True, False])
def test_where_there_is_little_to_look_at_the_walk_does_not_try_for_long(
    little: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Large ranks: the walk may remember few results, then more, and explicit-state checking comes between.

    Once that has proved `safe`, it is the first.
    """
    asked: list[int | None] = []

    def tired(_: object, name: PropertyName, most: int | None = None) -> PropertyResult:
        asked.append(most)
        return _tired(_, name)

    monkeypatch.setattr(portfolio, "MANY_RANK_NODES", 0)
    monkeypatch.setattr(portfolio, "FIRST_TURN", (30, 8 if little else 7))  # 4 states: before and after one effect each
    monkeypatch.setattr(WalkProver, "prove", tired)
    assert _proved_by("auto") == ["explicit"] * 4
    assert asked == ([30] if little else [30, portfolio.SOON_REMEMBERED]) * 2


def test_where_ranks_are_large_z3_is_asked_early_for_safe_only(monkeypatch: pytest.MonkeyPatch) -> None:
    """It does not mind many orders of effects, but ranks that count; in the end it is asked for all."""
    from tumato_symbolic.verify.by_z3.prover import Z3Prover

    asked: list[tuple[str, float | None]] = []

    def tired(_: object, name: PropertyName, within: float | None = None) -> PropertyResult:
        asked.append((name, within))
        return _tired(_, name)

    monkeypatch.setattr(portfolio, "MANY_RANK_NODES", 0)
    monkeypatch.setattr(portfolio, "LITTLE", -1)
    monkeypatch.setattr(portfolio, "FIRST_TURN", (30, -1))
    monkeypatch.setattr(WalkProver, "prove", _tired)
    monkeypatch.setattr(Z3Prover, "prove", tired)
    assert _proved_by("auto") == ["explicit"] * 4
    assert asked == [("total", None), ("safe", portfolio.SOON), ("safe", None), ("goals", None), ("minimal", None)]


def test_the_explicit_meaning_has_the_last_word(monkeypatch: pytest.MonkeyPatch) -> None:
    """However much there is to look at, what Z3 and the walk leave open is looked up state by state."""
    from tumato_symbolic.verify.by_z3.prover import Z3Prover

    def tired(_: object, name: PropertyName, within: float = 0.0) -> PropertyResult:
        return _tired(_, name)

    monkeypatch.setattr(portfolio, "LITTLE", -1)
    monkeypatch.setattr(WalkProver, "prove", _tired)
    monkeypatch.setattr(Z3Prover, "prove", tired)
    assert _proved_by("auto") == ["explicit"] * 4


def test_what_even_the_explicit_meaning_leaves_open(monkeypatch: pytest.MonkeyPatch) -> None:
    """More decided states than it looks at: undecided, and every reason is told."""
    from tumato_symbolic.verify.by_states import prover

    monkeypatch.setattr(prover, "LARGEST_TABLE", 3)
    spec, rows = _ring()
    answer = verify(policy_from_rows(spec, rows), spec, prover="explicit")
    assert [result.verdict for result in answer.properties] == ["undecided"] * 4
    assert "too many to list" in (answer.properties[0].reason or "")


def test_the_explicit_meaning_heeds_the_time_limit() -> None:
    """The limit of the whole is the only one."""
    spec, rows = _ring()
    context = Context(Limits(0.0))
    answer = verify(policy_from_rows(spec, rows), spec, prover="explicit", context=context)
    assert answer.verdict == "undecided"
    assert verify(policy_from_rows(spec, rows), spec, prover="explicit", timeout=0.0).verdict == "proved"


@pytest.mark.parametrize("prover", ["z3", "walk", "both"])
def test_no_time_is_undecided(prover: ProverName) -> None:
    """What nobody proves in time is undecided, with a reason."""
    spec, rows = _ring()
    answer = verify(policy_from_rows(spec, rows), spec, prover=prover, timeout=0.0)
    assert [result.verdict for result in answer.properties][1:] == ["undecided"] * 3
    assert all(result.reason for result in answer.properties[1:])


def test_portfolio_that_disagree_are_a_bug(monkeypatch: pytest.MonkeyPatch) -> None:
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


@pytest.mark.parametrize("prover", ["walk", "explicit"])
def test_these_do_without_z3(prover: ProverName) -> None:
    """With `--prover walk` or `explicit`, Z3 is not even imported."""
    code = (
        "import sys\n"
        "from pathlib import Path\n"
        "from tumato_symbolic.diagnostics import Source\n"
        "from tumato_symbolic.policy import policy_from_rows\n"
        "from tumato_symbolic.spec import load\n"
        "from tumato_symbolic.verify import verify\n"
        "text = Path('examples/amr.tum').read_text(encoding='utf-8')\n"
        "spec = load(Source('amr.tum', text)).spec\n"
        f"answer = verify(policy_from_rows(spec, {{}}), spec, prover='{prover}')\n"
        "assert answer.verdict == 'refuted'\n"
        "assert 'z3' not in sys.modules and 'dd' not in sys.modules\n"
    )
    subprocess.run([sys.executable, "-c", code], cwd=ROOT, check=True)
