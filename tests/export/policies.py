"""Policies to export: those of the examples, random ones, and some with nasty names."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import product
from pathlib import Path
from random import Random

from msgspec.structs import replace

from tests.export.compiler import Case
from tests.repo.documents import ROOT
from tumato_symbolic import parse
from tumato_symbolic.diagrams import DiagramBuilder, rebuild
from tumato_symbolic.export.request import Request
from tumato_symbolic.policy import DecisionDiagram, Policy, Table, UndecidedState, fitted, policy_from_rows
from tumato_symbolic.semantics import ActionSet, State
from tumato_symbolic.spec import Spec

EXAMPLES = tuple(path.name.removesuffix(".policy.json") for path in sorted((ROOT / "proofs").glob("*.policy.json")))


def example(name: str, *, diagram: bool = False) -> Request:
    """The committed policy of an example; as a diagram where that is asked for."""
    spec = parse((ROOT / "examples" / f"{name}.tum").read_text(encoding="utf-8"))
    policy = fitted(Policy.load(ROOT / "proofs" / f"{name}.policy.json"), spec)
    return Request(as_some_diagram(policy, Random(name)) if diagram else policy, spec, spec.ordering, "policy")


def request(spec: Spec, rows: Mapping[State, ActionSet], name: str = "policy") -> Request:
    """Decisions for a specification."""
    return Request(policy_from_rows(spec, rows), spec, spec.ordering, name)


def exported(case: Case) -> Request:
    """What is exported of a case."""
    return replace(request(case.spec, case.rows), ordering=case.ordering)


def as_some_diagram(policy: Policy, random: Random) -> Policy:
    """The same decisions as a diagram that tests the variables in a random order."""
    if not isinstance(policy.decisions, Table):
        return policy
    sizes, rows = policy.vocabulary.sizes, policy.decisions.rows
    builder = DiagramBuilder(random.sample(range(len(sizes)), len(sizes)), (False, True))
    executed = range(len(policy.vocabulary.actions))
    roots = [
        builder.from_table(sizes, {state: action in chosen for state, chosen in rows.items()}, False)
        for action in executed
    ]
    defined = builder.from_table(sizes, dict.fromkeys(rows, True), False)
    diagram, kept = rebuild(builder.finish(), (*roots, defined))
    return replace(policy, decisions=DecisionDiagram(diagram, kept[:-1], kept[-1]))


def random_request(seed: int, spec: Spec | None = None) -> Request:
    """Random decisions in some of the states of a random specification, as a table or as a diagram."""
    random = Random(seed)
    spec = spec or random_names(random)
    states = list(product(*(range(len(variable.values)) for variable in spec.variables)))
    decided = [state for state in states if random.random() < random.choice((0.5, 1.0))]
    sets = [frozenset(n for n in range(len(spec.actions)) if random.random() < 0.4) for _ in range(4)]
    made = request(spec, {state: random.choice(sets) for state in decided})
    return replace(made, policy=as_some_diagram(made.policy, random)) if seed % 2 else made


def random_names(random: Random) -> Spec:
    """A specification of nothing but names: random, or nasty."""
    names = random.sample(NASTY, random.randint(1, 4))
    values = [", ".join(random.sample((*NASTY, *NUMBERS), random.randint(1, 5))) for _ in names]
    actions = random.sample([each for each in NASTY if each not in names], random.choice((0, 1, 3, 5)))
    if random.random() < 0.2:
        actions += [f"filler_{number}" for number in range(70)]
    return written(dict(zip(names, values, strict=True)), actions)


def written(variables: Mapping[str, str], actions: list[str]) -> Spec:
    """A specification that declares these, and says nothing else."""
    states = "".join(f"state {name} can be {values}\n" for name, values in variables.items())
    done = "".join(f"action {name} nominal effects: none\n" for name in actions)
    return parse(f"BEGIN STATE VECTOR\n{states}END STATE VECTOR\nBEGIN ACTIONS\n{done}END ACTIONS\n")


NASTY = (
    *("int", "class", "state", "actions", "decide", "INVALID", "H", "words", "linux", "unix", "NULL", "bool", "self"),
    *("_Bool", "__LINE__", "_x", "x", "x_x", "a", "a_b", "b", "b_c", "A_B", "A_b", "n0", "v0", "None", "def", "lambda"),
    *("executes", "status", "action", "ACTION_COUNT", "main", "MODULE", "VAR", "proctype", "atomic", "Next", "EXTENDS"),
    *("module", "init", "case", "esac", "next", "self_", "in", "xor", "union", "phase", "pc", "waiting", "assert"),
    *("waiting_x", "executed_a", "kept_0", "active_0", "first_b", "rule", "acting", "valid", "met", "TRUE"),
)
"""Names that are words of some language, words of ours, or alike once they are put together."""

NUMBERS = ("0", "1", "-1", "10", "m1", "_1")


def decisions(made: Request) -> Iterator[tuple[State, tuple[str, ...] | None]]:
    """What `decide` says in every state, in the order of the states; None where it is undecided."""
    vocabulary = made.policy.vocabulary
    for state in product(*(range(size) for size in vocabulary.sizes)):
        named = {name: values[value] for (name, values), value in zip(vocabulary.variables, state, strict=True)}
        try:
            yield state, made.policy.decide(named)
        except UndecidedState:
            yield state, None


def expected_lines(made: Request) -> list[str]:
    """What a driver has to print of every state: `undecided`, or `decided` and the numbers of the actions."""
    numbers = {name: number for number, name in enumerate(made.policy.vocabulary.actions)}
    return [
        "undecided" if actions is None else " ".join(["decided", *(str(numbers[each]) for each in actions)])
        for _, actions in decisions(made)
    ]


def write(folder: Path, made: Request, texts: tuple[str, ...], endings: tuple[str, ...]) -> list[Path]:
    """The files of an export."""
    paths = [folder / f"{made.name}{ending}" for ending in endings]
    for path, text in zip(paths, texts, strict=True):
        path.write_text(text, encoding="utf-8")
    return paths
