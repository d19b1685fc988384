"""Specifications that mix features: starts, clauses, severities, several steps, preconditions that last."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import count
from random import Random

from msgspec.structs import replace

from tests.clauses.generate import random_pair
from tests.export.compiler import Case
from tests.starts.campaign import mutants, with_starts
from tumato_symbolic.diagnostics import Source
from tumato_symbolic.policy import Table, as_table
from tumato_symbolic.semantics import ActionSet, State, actions_of, all_states, allowed_sets, cases_in, is_valid
from tumato_symbolic.spec import Ordering, Spec, load
from tumato_symbolic.synthesis import Realizable, synthesize

FROM_STARTS = (27, 37)
"""Seeds of specifications of which a policy decides only a part of the valid states."""

Rows = Mapping[State, ActionSet]


def mixed(seed: int, most_states: int = 60) -> list[Case]:
    """The policy of one specification and wrong ones, by cases; none where effects disagree, or it is too large.

    Where there is no policy, only wrong ones. Most have starts.
    """
    random = Random(f"mixed {seed}")
    spec = load(Source("mixed", random_pair(seed).text)).spec
    if spec is None or sum(1 for _ in all_states(spec)) > most_states:
        return []
    if not spec.starts and random.random() < 0.75:
        spec = with_starts(spec, random)
    spec = replace(spec, preconditions=random.choice(("at_start", "throughout")))
    ordering: Ordering = random.choice(("any", "first"))
    rows = _decisions(spec, ordering, random)
    changed = [by_case(spec, wrong) for _, wrong in mutants(spec, rows, ordering, random)]
    return [Case(spec, each, ordering) for each in (rows, *changed)]


def cases(first_seed: int) -> Iterator[Case]:
    """Those of all seeds, without end."""
    for seed in count(first_seed):
        yield from mixed(seed)


def by_case(spec: Spec, rows: Rows) -> Rows:
    """Decisions of actions, of which any case is given, by the cases that are meant."""
    return {state: cases_in(spec, actions_of(spec, chosen), state) for state, chosen in rows.items()}


def _decisions(spec: Spec, ordering: Ordering, random: Random) -> Rows:
    outcome = synthesize(spec, ordering)
    if isinstance(outcome, Realizable):
        table = as_table(outcome.policy, 10_000)
        assert isinstance(table, Table)
        return by_first_case(spec, table.rows)
    found: dict[State, ActionSet] = {}
    for state in all_states(spec):
        if is_valid(spec, state):
            sets = list(allowed_sets(spec, state, ordering))
            found[state] = random.choice(sets) if sets else frozenset()
    return found


def by_first_case(spec: Spec, rows: Rows) -> Rows:
    """Decisions by the numbers of actions, by the cases that are meant."""
    return {state: cases_in(spec, chosen, state) for state, chosen in rows.items()}
