"""Changed ranks beside policies right and wrong: provers and the stand-alone checker against the explicit meaning."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from random import Random

from msgspec import Struct, field

from tests.checker.standalone import ask
from tests.generate import random_text
from tests.mutants.truth import claims_hold
from tests.profiles import ALL_PROFILES
from tests.ranks.lines import LENGTHS, line, rows_of
from tests.ranks.numbers import CHANGES, KINDS
from tests.verify.policies import Ranks, Rows, certified, exact_ranks, near_policies
from tumato_symbolic import parse
from tumato_symbolic.policy import dumps
from tumato_symbolic.semantics import State, all_states, count_states, is_safe, judge
from tumato_symbolic.spec import Ordering, Spec
from tumato_symbolic.verify import verify
from tumato_symbolic.verify.result import ProverName

TOGETHER: tuple[ProverName, ...] = ("both", "auto")
"""Who is always asked. `both` is Z3 and the walk, and an error where they differ."""

ALONE_EVERY = 8
"""Every so many cases Z3 and the walk are asked alone as well."""

LARGEST = 60
"""The most states of a generated specification that is taken."""


class Case(Struct, frozen=True):
    """Ranks beside a policy, and how they were changed."""

    text: str
    spec: Spec
    rows: Rows
    ranks: Ranks
    kind: str


class Tally(Struct):
    """What was found: `complaints` is empty where every judge says what the explicit meaning says."""

    cases: int = 0
    kinds: Counter[tuple[str, str, bool]] = field(default_factory=Counter)
    complaints: list[str] = field(default_factory=list)

    def add(self, other: Tally) -> None:
        """Count in what another one counted."""
        self.cases += other.cases
        self.kinds += other.kinds
        self.complaints += other.complaints


def examine(seed: int, each: int, folder: Path) -> Tally:
    """Some policies for one specification, each with `each` changed certificates."""
    random, tally = Random(f"ranks {seed}"), Tally()
    for text, rows in _policies(seed, random):
        spec = parse(text)
        exact = exact_ranks(spec, rows, spec.effect_ordering or "any")
        if not any(goal.bodies for goal in exact):
            continue
        for number in range(each):
            kind = KINDS[(seed + number) % len(KINDS)]
            case = Case(text, spec, rows, _changed(spec, exact, kind, random), kind)
            for complaint in _judge(case, folder, tally):
                tally.complaints.append(f"{seed} {kind}: {complaint}")
    return tally


def _policies(seed: int, random: Random) -> Iterator[tuple[str, Rows]]:
    """Two policies for a line; for every fourth seed, those near to a right one for a generated specification."""
    if seed % 4:
        text = line(random, LENGTHS[seed % len(LENGTHS)]).text
        for _ in range(2):
            yield text, rows_of(random, parse(text))
        return
    text = random_text(seed, ALL_PROFILES["restoring"])
    spec = parse(text)
    if count_states(spec) <= LARGEST:
        for rows in near_policies(spec, spec.effect_ordering or "any", random, count=1):
            yield text, rows


def _changed(spec: Spec, exact: Ranks, kind: str, random: Random) -> Ranks:
    """The ranks of one goal changed, or of all."""
    states: list[State] = [state for state in all_states(spec) if is_safe(spec, state)]
    chosen = set(exact) if random.random() < 0.3 else {random.choice(list(exact))}
    return {
        goal: CHANGES[kind](table, states, random) if goal in chosen and states else table
        for goal, table in exact.items()
    }


def _judge(case: Case, folder: Path, tally: Tally) -> Iterator[str]:
    spec, rows = case.spec, case.rows
    ordering: Ordering = spec.effect_ordering or "any"
    judged, policy = judge(spec, rows, ordering), certified(spec, rows, case.ranks)
    wanted = {
        "total": not judged.missing,
        "safe": not judged.not_allowed,
        "goals": not judged.goal_missed,
        "minimal": not judged.not_minimal,
    }
    certificate_holds = claims_hold(policy, spec, dict(rows), ordering)
    tally.cases += 1
    tally.kinds.update((("certificate", case.kind, certificate_holds), *(("policy", *each) for each in wanted.items())))
    alone: tuple[ProverName, ...] = ("z3", "walk") if tally.cases % ALONE_EVERY == 0 else ()
    for prover in (*TOGETHER, *alone):
        try:
            found = verify(policy, spec, prover=prover)
        except RuntimeError as error:
            yield f"{prover}: {error}"
            continue
        verdicts = {result.name: result.verdict for result in found.properties}
        for name, verdict in verdicts.items():
            if verdict != ("proved" if wanted[name] else "refuted"):
                yield f"{prover}: {name} is {verdict}"
        if (found.certificate.status in ("wrong", "set aside")) == certificate_holds:
            yield f"{prover}: that the certificate holds is {certificate_holds}, and it is {found.certificate}"
    answer = ask(folder, dumps(policy), case.text, "--strict")
    if set(answer.failing) != {name for name, holds in wanted.items() if not holds}:
        yield f"checker: {answer.failing} fail, not {wanted}"
    if answer.code != (0 if certificate_holds and all(wanted.values()) else 1):
        yield f"checker: exit {answer.code}, the certificate is {certificate_holds}: {answer.out}"
