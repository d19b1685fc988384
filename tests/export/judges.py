"""What the tools make of exported policies: whether each accepts a policy, and whether it should."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Final, TypeAlias

import pytest
from msgspec import Struct

from tests.export.c_check import counts, grouped
from tests.export.c_compiler import needs_cc
from tests.export.compiler import Case, Library, needs_coq
from tests.export.esbmc import needs_esbmc, proved
from tests.export.model_checkers import (
    Verdicts,
    needs_nusmv,
    needs_spin,
    needs_storm,
    needs_tla,
    nusmv_verdicts,
    spin_accepts,
    storm_verdicts,
    tla_verdicts,
)
from tests.export.policies import exported
from tumato_symbolic.diagnostics import UserError
from tumato_symbolic.export import coq, promela
from tumato_symbolic.export.request import Request
from tumato_symbolic.export.targets import load
from tumato_symbolic.semantics import Judgement, judge
from tumato_symbolic.verify.result import PropertyName

Accepts: TypeAlias = Callable[[Sequence[Request], Path], list[bool]]
"""Whether a tool accepts each of several policies of one specification."""


class Judge(Struct, frozen=True):
    """A tool; `right` tells what it should accept, and `needs` skips where it is not installed."""

    accepts: Accepts
    right: Callable[[Judgement], bool]
    needs: pytest.MarkDecorator


def disagreements(judge_: Judge, cases: Sequence[Case], folder: Path) -> list[str]:
    """Where a tool does not accept just what is right by the explicit meaning."""
    found = []
    for number, same in enumerate(grouped(cases)):
        place = folder / str(number)
        place.mkdir()
        for case, accepted in zip(same, judge_.accepts([exported(case) for case in same], place), strict=True):
            truth = judge(case.spec, case.rows, case.ordering)
            if accepted != judge_.right(truth):
                found.append(f"{'accepted' if accepted else 'refused'}: {case} {truth}")
    return found


def _by_claims(target: str, verdicts: Verdicts) -> Accepts:
    def accepts(requests: Sequence[Request], folder: Path) -> list[bool]:
        return [all(claims.values()) for claims in verdicts([load(target)(each) for each in requests], folder)]

    return accepts


def _by_spin(requests: Sequence[Request], folder: Path) -> list[bool]:
    return [spin_accepts(promela.files(each)[0], folder) for each in requests]


def _by_c(requests: Sequence[Request], folder: Path) -> list[bool]:
    return [found.code == 0 for found in counts(requests, folder)]


def _by_esbmc(requests: Sequence[Request], folder: Path) -> list[bool]:
    return [proved(each, folder) for each in requests]


def _by_coq(requests: Sequence[Request], _: Path) -> list[bool]:
    texts: list[str | None] = []
    for each in requests:
        try:
            texts.append(coq.files(each)[0])
        except UserError:
            texts.append(None)  # some start has no decision
    answers = iter(Library.shared().answers([text for text in texts if text is not None]))
    return [text is not None and next(answers) for text in texts]


def _is_right(truth: Judgement) -> bool:
    return truth.sound_and_complete


def _is_minimal(truth: Judgement) -> bool:
    return truth.sound_and_complete and truth.minimal


def _is_allowed(truth: Judgement) -> bool:
    """What is proved in C: what has to be decided is, and every decision is allowed."""
    return not (truth.missing or truth.invalid or truth.not_allowed)


JUDGES: Final[Mapping[str, Judge]] = {
    "nusmv": Judge(_by_claims("nusmv", nusmv_verdicts), _is_right, needs_nusmv),
    "spin": Judge(_by_spin, _is_right, needs_spin),
    "storm": Judge(_by_claims("prism", storm_verdicts), _is_right, needs_storm),
    "tla": Judge(_by_claims("tlaplus", tla_verdicts), _is_right, needs_tla),
    "c": Judge(_by_c, _is_right, needs_cc),
    "esbmc": Judge(_by_esbmc, _is_allowed, needs_esbmc),
    "coq": Judge(_by_coq, _is_minimal, needs_coq),
}

_MODELS: tuple[PropertyName, ...] = ("total", "safe", "restoring", "goals")

PROVED: Final[Mapping[str, Sequence[PropertyName]]] = {
    **dict.fromkeys(("nusmv", "spin", "storm", "tla", "c"), _MODELS),
    "esbmc": ("total", "safe"),
    "coq": (*_MODELS, "minimal"),
}
"""What `verify` has to prove of a policy that a tool accepts."""
