"""Many policies through a tool that checks exports: `python -m tests.export.trial nusmv --policies 200`.

`--of generated` takes specifications of every profile and way to restore safety, `mixed` those that mix features, and
`examples` those of the repository: the policy of each, and `--policies` of it with another decision in one state. It
prints how many were right and wrong by the explicit meaning (for examples, by `verify`), and exits with 1 if the tool
says otherwise of any.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from itertools import islice
from pathlib import Path
from random import Random

from msgspec.structs import replace

from tests.export import campaign, mixed
from tests.export.compiler import Case
from tests.export.judges import JUDGES, PROVED, Judge, disagreements
from tests.export.policies import EXAMPLES, example, exported
from tumato_symbolic.policy import as_table, policy_from_rows
from tumato_symbolic.semantics import State, all_states, count_states, is_valid, judge
from tumato_symbolic.spec import Spec
from tumato_symbolic.verify import verify

BATCH = 20
MOST_STATES = 100_000
"""Larger examples are left out: decisions are listed here, state by state."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the trial."""
    parser = argparse.ArgumentParser(prog="python -m tests.export.trial", description=__doc__)
    parser.add_argument("tool", choices=tuple(JUDGES))
    parser.add_argument("--of", choices=("generated", "mixed", "examples"), default="generated")
    parser.add_argument("--policies", type=int, default=200, help="how many; of each example, with --of examples")
    parser.add_argument("--seed", type=int, default=0, help="the first seed (default 0)")
    parser.add_argument("--only", action="append", help="one of the examples, any number of times")
    options = parser.parse_args(arguments)
    tool, started = JUDGES[options.tool], time.monotonic()
    if options.of == "examples":
        bad = sum(_example(options.tool, name, options.policies, options.seed) for name in options.only or EXAMPLES)
    else:
        cases = campaign.cases(options.seed, 6) if options.of == "generated" else mixed.cases(options.seed)
        bad = _all(tool, list(islice(cases, options.policies)))
    print(f"{options.tool}: {bad} disagree; {time.monotonic() - started:.0f} s")
    return 1 if bad else 0


def _all(tool: Judge, cases: Sequence[Case]) -> int:
    bad, right = 0, 0
    for start in range(0, len(cases), BATCH):
        some = cases[start : start + BATCH]
        right += sum(tool.right(judge(case.spec, case.rows, case.ordering)) for case in some)
        with tempfile.TemporaryDirectory() as folder:
            for each in disagreements(tool, some, Path(folder)):
                bad += 1
                print(each, flush=True)
    print(f"{len(cases)} policies, {right} right, {len(cases) - right} wrong")
    return bad


def _example(name: str, of: str, policies: int, seed: int) -> int:
    """How often a tool is wrong about the policy of an example, and about changed ones."""
    made, random, started = example(of), Random(f"{of} {seed}"), time.monotonic()
    if count_states(made.spec) > MOST_STATES:
        print(f"  {of}: {count_states(made.spec):,} states, left out")
        return 0
    table = as_table(made.policy, MOST_STATES)
    assert table is not None
    rows = mixed.by_first_case(made.spec, table.rows)
    cases = [Case(made.spec, each, made.ordering) for each in (rows, *_changed(made.spec, rows, policies, random))]
    said: Counter[str] = Counter()
    for case in cases:
        with tempfile.TemporaryDirectory() as folder:
            (accepted,) = JUDGES[name].accepts([exported(case)], Path(folder))
        right = _is_proved(name, case)
        said[f"{'right' if right else 'wrong'}, {'accepted' if accepted else 'refused'}"] += 1
    print(f"  {of}: {dict(sorted(said.items()))}; {time.monotonic() - started:.0f} s", flush=True)
    return said["right, refused"] + said["wrong, accepted"]


def _is_proved(name: str, case: Case) -> bool:
    policy = replace(policy_from_rows(case.spec, case.rows, case.ordering), restoration=case.spec.restoration)
    found = verify(policy, case.spec, ordering=case.ordering)
    return all(each.verdict == "proved" for each in found.properties if each.name in PROVED[name])


def _changed(spec: Spec, rows: mixed.Rows, policies: int, random: Random) -> Iterator[Mapping[State, frozenset[int]]]:
    """Another decision in one valid state; once in five, none."""
    states = [state for state in all_states(spec) if is_valid(spec, state) and state in rows]
    actions = range(len(spec.cases))
    for number in range(policies):
        state = random.choice(states)
        if number % 5 == 4:
            yield {other: chosen for other, chosen in rows.items() if other != state}
            continue
        chosen = frozenset(random.sample(actions, random.choice((0, 1, 1, 2))))
        yield {**rows, **mixed.by_first_case(spec, {state: chosen})}


if __name__ == "__main__":
    raise SystemExit(main())
