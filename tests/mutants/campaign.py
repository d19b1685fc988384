"""Mutants of one specification and its policy, each through all provers and held against the truth."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterator
from contextlib import suppress
from copy import deepcopy
from pathlib import Path
from random import Random
from typing import Literal

from msgspec import Struct, field

from tests.checker.standalone import ask
from tests.clauses.generate import random_pair
from tests.generate import random_text
from tests.mutants import by_coq, policies, specs
from tests.mutants.truth import is_right
from tests.profiles import ALL_PROFILES
from tumato_symbolic import Realizable, parse, synthesize
from tumato_symbolic.diagnostics import UserError
from tumato_symbolic.policy import Policy, dumps, loads
from tumato_symbolic.semantics import all_states, count_states, is_start
from tumato_symbolic.spec import Spec, digest
from tumato_symbolic.verify import ProverName, verify

CLAUSES = "clauses"
"""The profile of specifications with conditional and relative effects, and with starts."""

LARGEST = 60
"""The most states of a specification that is taken."""

PROVERS: tuple[ProverName, ...] = ("z3", "walk", "explicit")
TIERS = (*PROVERS, "checker")
Answer = Literal["accepted", "rejected", "undecided"]


class Mutant(Struct, frozen=True):
    """A policy file beside a specification, and what was changed."""

    kind: str
    document: policies.Document
    spec: str


class Tally(Struct):
    """What was found: `complaints` is empty where every tier knows right from wrong."""

    mutants: int = 0
    right: int = 0
    unreadable: int = 0
    kinds: Counter[tuple[str, bool]] = field(default_factory=Counter)
    forms: Counter[str] = field(default_factory=Counter)
    modes: Counter[str] = field(default_factory=Counter)
    undecided: Counter[str] = field(default_factory=Counter)
    by_coq: Counter[str] = field(default_factory=Counter)
    disagreements: int = 0
    complaints: list[str] = field(default_factory=list)

    def add(self, other: Tally) -> None:
        """Count in what another one counted."""
        self.mutants += other.mutants
        self.right += other.right
        self.unreadable += other.unreadable
        self.kinds += other.kinds
        self.forms += other.forms
        self.modes += other.modes
        self.undecided += other.undecided
        self.by_coq += other.by_coq
        self.disagreements += other.disagreements
        self.complaints += other.complaints


def examine(profile: str, seed: int, count: int, folder: Path) -> Tally:
    """Up to `count` mutants of one specification, none where it is too large or not realizable."""
    text, tally = text_of(profile, seed), Tally()
    bases = bases_of(text)
    for mutant in _mutants(bases, text, Random(f"{profile} {seed}"), count) if bases else ():
        tally.complaints += [f"{profile} {seed} {mutant.kind}: {each}" for each in judge(mutant, text, tally, folder)]
    return tally


def text_of(profile: str, seed: int) -> str:
    """The specification of a seed."""
    return random_pair(seed).text if profile == CLAUSES else random_text(seed, ALL_PROFILES[profile])


def bases_of(text: str) -> list[policies.Document]:
    """The policy of a specification in both forms; none where it is too large, not realizable or in error."""
    try:
        spec, bases = parse(text), list[policies.Document]()
    except UserError:
        return []
    forms: tuple[Literal["table", "diagram"], ...] = ("table", "diagram")
    for form in forms if count_states(spec) <= LARGEST else ():
        outcome = synthesize(spec, policy_format=form)
        if not isinstance(outcome, Realizable):
            return []
        bases.append(json.loads(dumps(outcome.policy)))
    return bases


def _mutants(bases: list[policies.Document], text: str, random: Random, count: int) -> Iterator[Mutant]:
    """At most so many: in two of five the policy is changed, in one the certificate, in two the specification."""
    for _ in range(count):
        document, lines = deepcopy(random.choice(bases)), text.splitlines()
        which = random.choice(("policy", "policy", "certificate", "meaning", "layout"))
        if which in ("meaning", "layout"):
            kind, change = random.choice([*(specs.MEANT if which == "meaning" else specs.LAYOUT).items()])
            change(lines, random)
            if which == "meaning" and random.random() < 0.7:
                renew_digest(document, lines)
        else:
            form = policies.TABLE if document["Type"] == "policy" else policies.DIAGRAM
            kind, mutate = random.choice([*(form if which == "policy" else policies.CERTIFICATE).items()])
            mutate(document, random)
        if document not in bases or lines != text.splitlines():
            yield Mutant(f"{which}: {kind}", document, "\n".join(lines) + "\n")


def renew_digest(document: policies.Document, lines: list[str]) -> None:
    """Pretend that the policy was made for the changed specification: nothing is stale then, but perhaps false."""
    with suppress(UserError):
        document["SpecificationDigest"] = digest(parse("\n".join(lines) + "\n"))


def judge(
    mutant: Mutant, original: str, tally: Tally, folder: Path, for_coq: list[by_coq.Question] | None = None
) -> Iterator[str]:
    """Complaints about one mutant. One whose specification is in error, or has no valid start, is no mutant.

    What Coq is to be asked is added to `for_coq`.
    """
    try:
        spec = parse(mutant.spec)
    except UserError:
        return
    if not any(is_start(spec, state) for state in all_states(spec)):
        return
    tally.mutants += 1
    tally.forms[mutant.document["Type"]] += 1
    if mutant.kind.startswith("layout") and digest(spec) != digest(parse(original)):
        yield "the digest depends on the layout"
    try:
        policy = loads(json.dumps(mutant.document))
    except UserError:
        tally.unreadable += 1
        if ask(folder, json.dumps(mutant.document), mutant.spec, "--strict").code == 0:
            yield "checker accepts what is no policy"
        return
    right = is_right(policy, spec)
    tally.right += right
    tally.kinds[mutant.kind, right] += 1
    if for_coq is not None:
        for_coq += by_coq.questions(policy, spec)
    answers: dict[str, Answer] = {prover: _verified(policy, spec, prover) for prover in PROVERS}
    answers["checker"] = _checked(mutant.document, mutant.spec, folder)
    if spec.restores_stepwise:
        tally.modes[f"{spec.restoration}, {len(spec.tiers)} tiers"] += 1
        if answers["walk"] == "undecided":  # it says where it gives up, and the others decide
            tally.undecided["walk"] += 1
            del answers["walk"]
    tally.disagreements += len(set(answers.values())) > 1
    for tier, answer in answers.items():
        if answer != ("accepted" if right else "rejected"):
            yield f"{tier}: {answer} what is {'right' if right else 'wrong'}"


def _verified(policy: Policy, spec: Spec, prover: ProverName) -> Answer:
    """What `tumato-sym verify --strict --prover …` answers."""
    found = verify(policy, spec, prover=prover)
    if found.verdict == "refuted" or found.certificate.status in ("stale", "wrong"):
        return "rejected"
    return "accepted" if found.verdict == "proved" else "undecided"


def _checked(document: policies.Document, text: str, folder: Path) -> Answer:
    """What `proofs/checker.py --strict` answers."""
    answer = ask(folder, json.dumps(document), text, "--strict")
    return {0: "accepted", 1: "rejected"}.get(answer.code, "undecided")  # type: ignore[return-value]
