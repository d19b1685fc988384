"""What it costs to be told what to do: `python -m benchmarks.deciding` asks the policies of the examples.

For each example: microseconds for one decision by `Policy.decide`, of the policy as a table and as a diagram, and by
the module that `tumato-sym export python` writes; and of how many variables the value is looked at, at most and on
average, where what an export prints is one tree of questions. A dash: larger than that. Beside it, the bars that are
set for the AMR: a microsecond, and no more tests than there are variables. Exits with 1 where one is not kept.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import islice, product
from pathlib import Path
from random import Random
from types import ModuleType

from msgspec import Struct
from msgspec.structs import replace

from tumato_symbolic import parse
from tumato_symbolic.export import python
from tumato_symbolic.export.decisions import MOST_QUESTIONS, Question, Tree, tree_of
from tumato_symbolic.export.request import Request
from tumato_symbolic.policy import Policy, Table, UndecidedState, as_diagram, fitted
from tumato_symbolic.semantics import State

ROOT = Path(__file__).resolve().parents[1]
BAR = 1.0
"""Microseconds for a decision about the AMR."""
STATES = 500
"""So many states of an example are asked about, again and again."""
ROUNDS = 150
"""The best of so many: each lasts about a millisecond, so that some are not interrupted."""

Named = Mapping[str, str]


class Deciding(Struct, frozen=True):
    """What decisions of one policy cost: microseconds each, and tests of a variable (none where there is no tree).

    `table` is missing where a policy is a diagram in its file, because a table would be too large.
    """

    name: str
    variables: int
    most_tests: int | None
    mean_tests: float | None
    table: float | None
    diagram: float
    export: float

    @property
    def kept(self) -> bool:
        """Whether the bars are kept; those of time are the AMR's alone."""
        tests = self.most_tests is None or self.most_tests <= self.variables
        return tests and (self.name != "amr" or max(self.table or 0, self.diagram, self.export) <= BAR)


def main() -> int:
    """One line for every example that has a policy."""
    print(f"{'example':<20}{'variables':>10}{'tests':>7}{'mean':>7}{'table':>9}{'diagram':>9}{'export':>9}{'bar':>7}")
    measured = []
    for path in sorted((ROOT / "proofs").glob("*.policy.json")):
        measured.append(deciding(path.name.removesuffix(".policy.json")))
        print(_line(measured[-1]), flush=True)
    missed = [each.name for each in measured if not each.kept]
    print(f"not kept: {', '.join(missed)}" if missed else "kept")
    return 1 if missed else 0


def deciding(name: str, rounds: int = ROUNDS) -> Deciding:
    """Measure the committed policy of an example."""
    spec = parse((ROOT / "examples" / f"{name}.tum").read_text(encoding="utf-8"))
    policy = fitted(Policy.load(ROOT / "proofs" / f"{name}.policy.json"), spec)
    module = ModuleType(name)
    exec(python.files(Request(policy, spec, spec.ordering, name))[0], module.__dict__)
    states = dict(islice(_decided(policy), STATES))
    asked = list(states.values())
    tree = tree_of(policy, MOST_QUESTIONS)
    return Deciding(
        name,
        len(policy.vocabulary.variables),
        None if tree is None else most_tests(tree),
        None if tree is None else sum(count_tests(tree, state) for state in states) / len(states),
        _microseconds(policy.decide, asked, rounds) if isinstance(policy.decisions, Table) else None,
        _microseconds(replace(policy, decisions=as_diagram(policy)).decide, asked, rounds),
        _microseconds(module.decide, asked, rounds),
    )


def count_tests(tree: Tree, state: State) -> int:
    """How many variables are looked at until a state is decided."""
    count = 0
    while isinstance(tree, Question):
        tree, count = tree.below[state[tree.variable]], count + 1
    return count


def most_tests(tree: Tree) -> int:
    """The most tests on any way through a tree."""
    known: dict[int, int] = {}

    def depth(here: Tree) -> int:
        if not isinstance(here, Question):
            return 0
        if id(here) not in known:
            known[id(here)] = 1 + max(map(depth, here.below))
        return known[id(here)]

    return depth(tree)


def _decided(policy: Policy) -> Iterator[tuple[State, Named]]:
    """Decided states, as numbers and by name, in a random order that is always the same."""
    vocabulary = policy.vocabulary
    states = list(product(*map(range, vocabulary.sizes)))
    for state in Random(1).sample(states, len(states)):
        named = {name: values[value] for (name, values), value in zip(vocabulary.variables, state, strict=True)}
        try:
            policy.decide(named)
        except UndecidedState:
            continue
        yield state, named


def _microseconds(decide: Callable[[Named], object], states: Sequence[Named], rounds: int) -> float:
    """The best mean over all states; where there are few, they are asked about repeatedly."""
    repeated = [*states] * max(1, STATES // len(states))
    best = float("inf")
    for _ in range(rounds):
        began = time.perf_counter()
        for state in repeated:
            decide(state)
        best = min(best, time.perf_counter() - began)
    return best / len(repeated) * 1e6


def _line(each: Deciding) -> str:
    counted = "–" if each.most_tests is None else str(each.most_tests)
    mean = "–" if each.mean_tests is None else f"{each.mean_tests:.1f}"
    table = "–" if each.table is None else f"{each.table:.2f}"
    cells = f"{each.variables:>10}{counted:>7}{mean:>7}{table:>9}{each.diagram:>9.2f}{each.export:>9.2f}"
    return f"{each.name:<20}{cells}" + (f"{BAR:>7.2f}" if each.name == "amr" else "")


if __name__ == "__main__":
    sys.exit(main())
