"""Changed policies before the judge of the page and before the explicit one: what each finds wrong, state by state."""

from __future__ import annotations

import json
import shutil
import subprocess
from collections import Counter
from collections.abc import Iterator, Sequence
from itertools import islice
from pathlib import Path
from random import Random
from typing import Any

import pytest
from msgspec import Struct, field

from tests.clauses.generate import random_pair
from tests.generate import random_text
from tests.mutants import campaign, stepwise
from tests.mutants.truth import Rows, decisions
from tests.printing import print_spec
from tests.profiles import ALL_PROFILES
from tests.starts.campaign import specifications
from tumato_symbolic import parse
from tumato_symbolic.diagnostics import Source, UserError
from tumato_symbolic.policy import Policy, fitted, loads
from tumato_symbolic.report.html.record import policy_record, spec_record
from tumato_symbolic.semantics import Judgement, State, all_states, is_valid, judge
from tumato_symbolic.spec import Spec

JUDGE = Path(__file__).with_name("judge.mjs")
NODE = shutil.which("node")

needs_node = pytest.mark.skipif(NODE is None, reason="node is not installed: the judge of the page is not run here")


class Asked(Struct, frozen=True):
    """A policy, right or wrong, for a specification."""

    name: str
    spec: Spec
    policy: Policy

    @property
    def rows(self) -> Rows:
        """Its decisions, by cases."""
        return decisions(self.policy, self.spec)

    @property
    def question(self) -> str:
        """What the judge of the page is asked."""
        spec, policy = self.spec, fitted(self.policy, self.spec)
        record = {"spec": spec_record(spec, Source("test.tum", ""), spec.ordering)}
        return json.dumps(record | {"policy": policy_record(policy, "policy.json")})


class Tally(Struct):
    """How many policies were judged, and what the judges found wrong; `complaints` where they differ."""

    judged: int = 0
    wrong: int = 0
    faults: Counter[str] = field(default_factory=Counter)
    complaints: list[str] = field(default_factory=list)


def texts(seed: int) -> Iterator[tuple[str, str]]:
    """Specifications of every kind: each profile, several steps and severities, clauses, starts."""
    random = Random(seed)
    for profile in ALL_PROFILES:
        yield profile, random_text(seed, ALL_PROFILES[profile])
    yield from stepwise.texts(seed)
    yield "clauses", random_pair(seed).text
    for name, spec in specifications(seed):
        yield f"starts {name}", print_spec(spec, random)


def asked(seed: int, each: int, step: int = 1) -> Iterator[Asked]:
    """Up to so many changed policies of every specification of a seed that has a policy and is not too large.

    With a `step`, of every second specification, or third, or so.
    """
    for name, text in islice(texts(seed), seed % step, None, step):
        try:
            bases = campaign.bases_of(text)
        except UserError:  # clauses may disagree
            continue
        random, made = Random(f"{name} {seed}"), 0
        for mutant in stepwise._mutants(bases, text, random, 4 * each) if bases else ():
            try:
                spec = parse(mutant.spec)
                policy = loads(json.dumps(mutant.document))
                fitted(policy, spec)
            except UserError:
                continue
            if made == each:
                break
            if any(is_valid(spec, state) for state in all_states(spec)):
                made += 1
                yield Asked(f"{name}, seed {seed}: {mutant.kind}", spec, policy)


def compare(questions: Sequence[Asked], tally: Tally) -> None:
    """Ask both judges all of it."""
    lines = "\n".join(each.question for each in questions)
    command = [str(NODE), str(JUDGE)]
    answer = subprocess.run(command, input=lines, capture_output=True, text=True, check=False)
    assert answer.returncode == 0, answer.stderr
    for each, line in zip(questions, answer.stdout.splitlines(), strict=True):
        ours = _found(judge(each.spec, each.rows, each.spec.ordering))
        theirs = {
            name: sorted(map(_plain, found)) if isinstance(found, list) else found
            for name, found in json.loads(line).items()
        }
        faults = [name for name, found in ours.items() if name not in ("longest_run", "faulty") and found]
        tally.judged += 1
        tally.wrong += bool(faults)
        tally.faults.update(faults)
        tally.complaints += [
            f"{each.name}: {name}: semantics {ours[name]}, the page {theirs[name]}"
            for name in ours
            if ours[name] != theirs[name]
        ]


def _plain(found: Any) -> Any:
    return tuple(map(_plain, found)) if isinstance(found, list) else found


def _found(judgement: Judgement) -> dict[str, Any]:
    def states(found: Sequence[State]) -> list[State]:
        return sorted(found)

    wrong = {
        *(state for state, _ in (*judgement.not_allowed, *judgement.goal_missed)),
        *(*judgement.missing, *judgement.invalid, *judgement.not_restored),
        *(state for state, _ in judgement.not_minimal),
    }
    return {
        "faulty": sorted(wrong),
        "missing": states(judgement.missing),
        "invalid": states(judgement.invalid),
        "not_allowed": sorted((state, objection.kind) for state, objection in judgement.not_allowed),
        "goal_missed": sorted((state, run.end) for state, run in judgement.goal_missed),
        "not_minimal": states([state for state, _ in judgement.not_minimal]),
        "not_restored": states(judgement.not_restored),
        "longest_run": judgement.longest_run,
    }
