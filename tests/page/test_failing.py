"""What the page finds itself where there is no policy, against the explicit meaning, and what `explain` says."""

from __future__ import annotations

import json
import subprocess
from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import suppress
from functools import cache
from itertools import combinations, islice
from random import Random
from typing import Any

from tests.clauses.generate import random_pair
from tests.explain.oracle import TogetherWhereDefined
from tests.generate import random_spec
from tests.oracle import World as Explicit
from tests.page.judged import NODE, needs_node
from tests.profiles import ALL_PROFILES, INTERACTING
from tests.repo.documents import ROOT
from tests.restoration.campaign import specifications
from tests.restoration.truth import World
from tests.starts.campaign import specifications as with_starts
from tests.starts.truth import greatest
from tumato_symbolic import parse
from tumato_symbolic.diagnostics import Source, UserError
from tumato_symbolic.explain.explain import explain
from tumato_symbolic.explain.explanation import Explanation
from tumato_symbolic.report.html.record import alternatives_record, elements_record, spec_record
from tumato_symbolic.spec import Spec

PROGRAM = ROOT / "tests" / "page" / "failing.mjs"


def answers(questions: Sequence[dict[str, Any]]) -> list[dict[str, Any]]:
    """What the page finds."""
    lines = "\n".join(map(json.dumps, questions))
    ran = subprocess.run([str(NODE), str(PROGRAM)], input=lines, capture_output=True, text=True, check=False)
    assert ran.returncode == 0, ran.stderr
    return [json.loads(line) for line in ran.stdout.splitlines()]


def question(spec: Spec, **more: Any) -> dict[str, Any]:
    """A specification as the page has it."""
    return {"spec": spec_record(spec, Source("a.tum", ""), spec.ordering), **more}


def specs(seed: int) -> Iterator[Spec]:
    """Specifications of every kind."""
    for profile in ALL_PROFILES.values():
        yield random_spec(seed, profile)
    for _, spec in specifications(seed):
        yield spec
    with suppress(UserError):  # clauses may disagree
        yield parse(random_pair(seed).text)


def fails(seeds: Sequence[int], step: int) -> Counter[str | None]:
    """How often states fail in which way; every valid state is compared."""
    asked = [spec for seed in seeds for spec in islice(specs(seed), seed % step, None, step)]
    counts: Counter[str | None] = Counter()
    for spec, found in zip(asked, answers([question(spec) for spec in asked]), strict=True):
        world = World(spec, spec.ordering)
        assert [tuple(state) for state, _ in found["kinds"]] == world.valid
        for state, kind in found["kinds"]:
            assert kind == world.kind(tuple(state)), (spec, state)
            counts[kind] += 1
    return counts


@needs_node
def test_the_page_knows_which_states_fail() -> None:
    """And in which way, as the explicit meaning says it."""
    counts = fails((1, 3), 3)
    assert counts.keys() == {None, "no-allowed-set", "no-restoration", "no-plan"}


@needs_node
def test_the_page_knows_what_no_policy_from_the_starts_decides() -> None:
    """The valid states outside the greatest part in which none fails."""
    asked = [spec for seed in (1, 2) for _, spec in with_starts(seed)]
    lost = 0
    for spec, answer in zip(asked, answers([question(spec) for spec in asked]), strict=True):
        world = World(spec, spec.ordering)
        part, _, _ = greatest(world)
        assert {tuple(state) for state in answer["lost"]} == set(world.valid) - part
        lost += bool(answer["lost"]) and bool(part)
    assert lost > 3


@needs_node
def test_the_page_knows_what_can_be_served_together() -> None:
    """As a search for policies says that has to decide these states alone."""
    asked = [random_spec(seed, INTERACTING) for seed in range(3)]
    random = Random(1)
    told: list[tuple[Explicit, list[tuple[Any, ...]]]] = []
    for spec in asked:
        world = Explicit(spec, spec.ordering)
        pairs = list(combinations(world.valid, 2))
        told.append((world, random.sample(pairs, min(12, len(pairs)))))
    found = answers([question(spec, conflicts=sets) for spec, (_, sets) in zip(asked, told, strict=True)])
    seen = Counter[bool]()
    for (world, sets), answer in zip(told, found, strict=True):
        for states, served in zip(sets, answer["served"], strict=True):
            assert served == (TogetherWhereDefined(world).serve(states) is not None), states
            seen[served] += 1
    assert set(seen) == {True, False}


@cache
def explained() -> list[tuple[Spec, Explanation]]:
    """Specifications without a policy."""
    found = ((spec, explain(spec, spec.ordering, wanted_repairs=0)) for spec in islice(specs(2), 0, None, 2))
    return [(spec, each) for spec, each in found if isinstance(each, Explanation)]


def cores(spec: Spec, explanation: Explanation, *, without: bool) -> list[dict[str, Any]]:
    """The cores of all reasons; `without` their last line."""
    lasting = len({rule.severity for rule in spec.state_rules}) > 1
    return [
        {
            "kind": reason.kind,
            "elements": elements_record(spec, reason.core[:-1] if without else reason.core),
            "states": reason.together or (reason.example,),
        }
        for reason in explanation.reasons
        if (reason.core or not without) and not lasting and not (reason.kind == "conflict" and spec.restores_stepwise)
    ]


@needs_node
def test_the_page_confirms_the_lines_to_blame() -> None:
    """They suffice, and none can be left out; without one of them they do not."""
    for without in (False, True):
        questions = [
            question(spec, alternatives=alternatives_record(spec), cores=cores(spec, each, without=without))
            for spec, each in explained()
        ]
        confirmed = [holds for answer in answers(questions) for holds in answer["cores"]]
        assert len(confirmed) > 4
        assert set(confirmed) == {not without}
