"""A bug in a judge's own code, in `w`, in `Keep`, in a level or in a deviation, is noticed on a handful of policies."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import pytest
from msgspec import Struct

from tests.checker.standalone import ask, checker
from tests.export.compiler import SOURCES, needs_coq
from tests.mutants import by_coq
from tests.semantics.test_restoration import EDGE, OVERRIDE, VALVES
from tests.verify.several_steps import Efforts, Rows, certified, exact
from tests.verify.test_planted_restoring import DROPS, EDGE_ROWS, LANDS, RISKY, SWAP, VALVES_ROWS
from tests.verify.test_restoring_claims import LISTED, ROWS, T, X
from tumato_symbolic import parse
from tumato_symbolic.policy import Deviation, Policy, dumps
from tumato_symbolic.spec import Restoration, Spec
from tumato_symbolic.verify import ProverName, verify
from tumato_symbolic.verify.by_diagrams import stepwise
from tumato_symbolic.verify.by_diagrams.efforts import WalkEfforts
from tumato_symbolic.verify.by_diagrams.steps import Steps as DiagramSteps
from tumato_symbolic.verify.by_states.efforts import Efforts as StateEfforts
from tumato_symbolic.verify.by_states.runs import Runs
from tumato_symbolic.verify.by_states.steps import Steps as StateSteps
from tumato_symbolic.verify.by_z3.best_property import Deviations
from tumato_symbolic.verify.by_z3.efforts import Efforts as Z3Efforts
from tumato_symbolic.verify.by_z3.encoding import valid_term
from tumato_symbolic.verify.by_z3.tier_terms import Tiers

ONLY_DROPS = re.sub(r"action land.*\n", "", RISKY)
DROPS_AGAIN: Rows = {(0,): frozenset((0,)), (1,): frozenset((1,)), (2,): frozenset()}
CROSSES_FIRST = {**ROWS, T: frozenset((1,))}


class Case(Struct, frozen=True):
    """A policy with a certificate, true or not where `worst` or `deviations` say so, and whether both are right."""

    text: str
    restoration: Restoration
    rows: Rows
    right: bool
    worst: Efforts | None = None
    deviations: Sequence[Deviation] | None = None

    @property
    def full_text(self) -> str:
        """With the restoration in it."""
        return f"{self.text} BEGIN CONFIG restoration: {self.restoration} END CONFIG\n"

    @property
    def spec(self) -> Spec:
        """What the text says."""
        return parse(self.full_text)

    @property
    def policy(self) -> Policy:
        """With its certificate."""
        ranks, worst, nominal, deviations = exact(self.spec, self.rows, "any")
        worst = worst if self.worst is None else self.worst
        deviations = deviations if self.deviations is None else list(self.deviations)
        return certified(self.spec, self.rows, (ranks, worst, nominal, deviations))


RIVAL = frozenset((1,))
CASES = {
    "w": (
        Case(ONLY_DROPS, "bounded", DROPS_AGAIN, True),
        Case(ONLY_DROPS, "bounded", DROPS_AGAIN, False,
             worst={(0,): (1, 1), (1,): (9, 1)}),
        Case(RISKY, "bounded", LANDS, True),
        Case(RISKY, "bounded", DROPS, False),
    ),
    "Keep": (
        Case(VALVES, "bounded", VALVES_ROWS, True),
        Case(SWAP, "bounded", VALVES_ROWS, False),
    ),
    "level": (
        Case(VALVES, "bounded", VALVES_ROWS, True),
        Case(EDGE.format(1, 2), "one_step", EDGE_ROWS, True),
        Case(EDGE.format(2, 1), "one_step", EDGE_ROWS, False),
        Case(EDGE.format(1, 2), "bounded", EDGE_ROWS, True),
        Case(EDGE.format(1, 2), "bounded", EDGE_ROWS, False, worst={(0, 0): (1, 1), (0, 1): (2, 1), (1, 0): (1, 1)}),
    ),
    "deviation": (
        Case(OVERRIDE, "bounded", ROWS, True),
        Case(OVERRIDE, "bounded", ROWS, True, deviations=[]),
        Case(OVERRIDE, "bounded", ROWS, False, deviations=[Deviation(T, RIVAL, T)]),
        Case(OVERRIDE, "bounded", ROWS, False, deviations=[*LISTED, Deviation(T, RIVAL, X)]),
        Case(OVERRIDE, "bounded", CROSSES_FIRST, False),
        Case(OVERRIDE.partition("BEGIN GOALS")[0], "bounded", ROWS, False),
    ),
}  # fmt: skip
"""What a bug in each of them makes a judge take for what it is not."""


def by_prover(prover: ProverName) -> Callable[[Case, Path], bool]:
    """What `verify --strict` accepts."""

    def accepts(case: Case, _: Path) -> bool:
        answer = verify(case.policy, case.spec, prover=prover)
        assert answer.verdict != "undecided"
        return answer.verdict == "proved" and answer.certificate.status in ("used", "incomplete")

    return accepts


def by_checker(case: Case, folder: Path) -> bool:
    """What `proofs/checker.py --strict` accepts."""
    return ask(folder, dumps(case.policy), case.full_text, "--strict").code == 0


JUDGES = {"z3": by_prover("z3"), "diagrams": by_prover("walk"), "states": by_prover("explicit"), "checker": by_checker}


class Bug(Struct, frozen=True):
    """In the code of a judge, `change` puts one thing for another."""

    judge: str
    where: str
    what: str
    home: Any
    name: str
    change: Callable[[Any], Any]


def _nominal_only(steps: str) -> Callable[[Any], Any]:
    """The states after a step that are not restored yet: of the nominal one alone."""

    def change(_: Any) -> Any:
        def planted(efforts: Any, here: Any, chosen: Any) -> Any:
            known = getattr(efforts, steps)
            after = known.successor(here, chosen) if steps == "world" else known.after(here, chosen)
            return {after} - {after if known.restored(here, after) else None}

        return planted

    return change


BUGS = (
    Bug("z3", "w", "an effort exceeds nothing", Z3Efforts, "_exceeds", lambda _: lambda efforts, after: False),
    Bug("z3", "Keep", "no rule is kept", Tiers, "kept", lambda _: lambda tiers, after: valid_term(tiers._spec, after)),
    Bug("z3", "level", "mild rules are restored alone", Tiers, "restored",
        lambda restored: lambda tiers, after: restored(tiers, after) if len(tiers.levels) < 3 else False),
    Bug("z3", "deviation", "every run is lost", Deviations, "_loses", lambda _: lambda deviations, *claim: True),
    Bug("diagrams", "w", "alternatives never happen", WalkEfforts, "worst_next",
        lambda _: lambda efforts, number: efforts._walk.compose(
            number, efforts._model.successor(efforts._model.chosen))),
    Bug("diagrams", "Keep", "no rule is kept", DiagramSteps, "requirements",
        lambda _: property(lambda steps: [(steps.valid, steps.valid)])),
    Bug("diagrams", "level", "only what is safe is restored", WalkEfforts, "by_level",
        lambda _: lambda efforts, region: [(region, efforts._model.safe)]),
    Bug("diagrams", "deviation", "no run is lost", stepwise.Stepwise, "_spoils_any",
        lambda _: lambda judge, state, chosen: False),
    Bug("states", "w", "alternatives never happen", StateEfforts, "unrestored", _nominal_only("_steps")),
    Bug("states", "Keep", "no rule is kept", StateSteps, "_required", lambda _: lambda steps, code: 0),
    Bug("states", "level", "the mildest tier that holds counts", StateSteps, "level",
        lambda _: lambda steps, code: len(steps._tiers) if steps.is_safe(code) else 0),
    Bug("states", "deviation", "no run is lost", Runs, "losing", lambda _: lambda runs, *pair: iter(())),
    Bug("checker", "w", "alternatives never happen", checker.Restoring, "open_after", _nominal_only("world")),
    Bug("checker", "Keep", "no rule is kept", checker.World, "required",
        lambda required: lambda world, state: required(world, state) if world.is_safe(state) else frozenset()),
    Bug("checker", "level", "the mildest tier that holds counts", checker.World, "level",
        lambda level: lambda world, state: level(world, state) if world.is_safe(state) else 0),
    Bug("checker", "deviation", "no run is lost", checker.Judge, "losers", lambda _: lambda judge, *pair: []),
)  # fmt: skip


@pytest.mark.parametrize("judge", JUDGES)
def test_a_judge_knows_right_from_wrong(judge: str, tmp_path: Path) -> None:
    """A false `w`, a step that breaks `Keep`, severities the wrong way round, a false deviation: all are refused."""
    for cases in CASES.values():
        for case in cases:
            assert JUDGES[judge](case, tmp_path) == case.right


@pytest.mark.parametrize("bug", BUGS, ids=lambda bug: f"{bug.judge}, {bug.where}: {bug.what}")
def test_a_bug_in_a_judge_is_noticed(bug: Bug, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """With it the judge takes some right policy for wrong, or a wrong one for right, or contradicts itself."""
    monkeypatch.setattr(bug.home, bug.name, bug.change(getattr(bug.home, bug.name)))
    assert any(_errs(JUDGES[bug.judge], case, tmp_path) for case in CASES[bug.where])


def _errs(accepts: Callable[[Case, Path], bool], case: Case, folder: Path) -> bool:
    try:
        return accepts(case, folder) != case.right
    except RuntimeError:
        return True


IN_COQ = {
    "w": ("| Bounded => decided (entry (worst known) s) &&& is_told (entry (worst known)) next_fine s A",
          "| Bounded => decided (entry (worst known) s) &&& is_told (entry (worst known)) nominally_fine s A"),
    "Keep": ("fun t => is_valid t &&& forallb (holds t []) rules", "fun t => is_valid t"),
    "level": ("now <? level spec t", "now <=? level spec t"),
    "deviation": ("if is_valid t then serves pi t (pi t) else true", "true ||| is_valid t"),
}  # fmt: skip
"""What stands in Checker.v, and what is put for it."""


@needs_coq
def test_a_bug_in_the_checker_in_coq_is_noticed(tmp_path: Path) -> None:
    """By what it computes. (And by the proof that it computes what is meant, `make proofs`, which takes longer.)"""
    source = (SOURCES / "Checker.v").read_text(encoding="utf-8")
    imports, code = "\n".join(re.findall(r"^From .*$", source, re.MULTILINE)), re.sub(r"(?m)^From .*$", "", source)
    text = [imports]
    told = {where: [each for each in cases if each.deviations is None] for where, cases in CASES.items()}
    for where, (once, then) in IN_COQ.items():
        assert code.count(once) == 1, f"Checker.v reads otherwise now: {once}"
        asked = [*by_coq.written([_question(case) for case in told[where]])]
        text += [f"Module Right_{where}.", *asked, f"End Right_{where}."]
        text += [f"Module Planted_{where}.", code.replace(once, then), *asked, f"End Planted_{where}."]
    found = iter(by_coq.answers("\n".join(text), tmp_path))
    for where, cases in told.items():
        right, planted = ([next(found) for _ in cases] for _ in range(2))
        assert right == [case.right for case in cases], where
        assert right != planted, where


def _question(case: Case) -> by_coq.Question:
    """With the efforts that are claimed, where they are others than the policy's own."""
    return list(by_coq.questions(case.policy, case.spec))[-1]
