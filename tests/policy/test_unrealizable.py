"""The certificate of unrealizability: its text, its schema, its numbers."""

import json
import re
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from random import Random
from typing import Literal, get_args

import jsonschema
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.policy.mutations import mutations
from tests.policy.strategies import NAMES, QUICK, action_sets, spec_of, states, vocabularies
from tests.policy.test_bind import shuffled
from tumato_symbolic.diagnostics import UserError
from tumato_symbolic.diagrams import DiagramBuilder, rebuild
from tumato_symbolic.policy import Policy, RankedGoal, Vocabulary, load_claim
from tumato_symbolic.policy import load as load_policy
from tumato_symbolic.policy.records import canonical
from tumato_symbolic.policy.unrealizability import (
    Case,
    Choice,
    Conflict,
    Cube,
    Cut,
    Divided,
    Layers,
    NoAllowedSet,
    NoPart,
    NoPlan,
    NoRestoration,
    Reason,
    Removal,
    StartRemoved,
    Unrealizability,
    Violation,
    ViolationKind,
    bind,
    dumps,
    load,
    loads,
    save,
)
from tumato_symbolic.semantics import State
from tumato_symbolic.spec import Restoration, Spec

SCHEMA = json.loads(Path(__file__).parents[2].joinpath("tumato_symbolic/policy/unrealizable.schema.json").read_text())


@st.composite
def cubes(draw: st.DrawFn, vocabulary: Vocabulary) -> Cube:
    """A cube with any violation that the format can hold."""
    numbers = range(len(vocabulary.actions))
    sets = action_sets(vocabulary)
    kinds: list[ViolationKind] = ["reaction-rule", "idle", "nominal-unsafe"]
    kinds += ["precondition", "unsafe", "falsified"] if numbers else []
    kinds += ["resource", "nominal-conflict"] if len(numbers) > 1 else []
    kind = draw(st.sampled_from(kinds))
    violation = Violation(kind)
    if kind in ("precondition", "resource", "nominal-conflict"):
        size = 1 if kind == "precondition" else 2
        actions = draw(st.lists(st.sampled_from(numbers), min_size=size, max_size=size, unique=True))
        violation = Violation(kind, tuple(actions))
    elif kind == "reaction-rule":
        violation = Violation(kind, rule=draw(NAMES))
    elif kind in ("unsafe", "falsified"):
        effect = st.lists(pairs(vocabulary), max_size=3, unique_by=lambda pair: pair[0])
        effects = st.tuples(st.sampled_from(numbers), effect.map(lambda found: tuple(sorted(found))))
        pending = (draw(st.sampled_from(numbers)),) if kind == "falsified" else ()
        violation = Violation(kind, pending, outcome=tuple(draw(st.lists(effects, max_size=3))))
    return Cube(draw(sets), draw(sets), violation)


def pairs(vocabulary: Vocabulary) -> st.SearchStrategy[tuple[int, int]]:
    """A variable and one of its values."""
    found = [(variable, value) for variable, size in enumerate(vocabulary.sizes) for value in range(size)]
    return st.sampled_from(found)


@st.composite
def layers(draw: st.DrawFn, vocabulary: Vocabulary) -> NoPlan:
    """No plan from a state, with any sets as layers."""
    builder = DiagramBuilder(draw(st.permutations(range(len(vocabulary.sizes)))), (False, True))
    goals = []
    for _ in range(draw(st.integers(0, 3))):
        sets = draw(st.lists(st.frozensets(states(vocabulary), max_size=5), min_size=1, max_size=3))
        roots = [builder.from_table(vocabulary.sizes, dict.fromkeys(found, True), False) for found in sets]
        goals.append((tuple(draw(st.lists(NAMES, max_size=2, unique=True))), names(draw, vocabulary), roots))
    diagram, kept = rebuild(builder.finish(), [root for *_, roots in goals for root in roots])
    left = iter(kept)
    found = tuple(Layers(bodies, executed, tuple(next(left) for _ in roots)) for bodies, executed, roots in goals)
    return NoPlan(draw(states(vocabulary)), diagram, found)


@st.composite
def traps(draw: st.DrawFn, vocabulary: Vocabulary) -> NoRestoration:
    """No restoration from a state, with any set as the trap."""
    builder = DiagramBuilder(draw(st.permutations(range(len(vocabulary.sizes)))), (False, True))
    held = draw(st.frozensets(states(vocabulary), max_size=5))
    root = builder.from_table(vocabulary.sizes, dict.fromkeys(held, True), False)
    diagram, (kept,) = rebuild(builder.finish(), [root])
    return NoRestoration(draw(states(vocabulary)), diagram, kept)


def names(draw: st.DrawFn, vocabulary: Vocabulary) -> tuple[str, ...]:
    """Some actions, by name."""
    some = st.lists(st.sampled_from(vocabulary.actions), unique=True) if vocabulary.actions else st.just([])
    return tuple(draw(some))


@st.composite
def conflicts(draw: st.DrawFn, vocabulary: Vocabulary) -> Conflict:
    """Any choices, cuts and distances."""
    builder = DiagramBuilder(draw(st.permutations(range(len(vocabulary.sizes)))), (None, 0, 1))
    tables = st.dictionaries(states(vocabulary), st.sampled_from([None, 0, 1]), max_size=6)
    drawn = [builder.from_table(vocabulary.sizes, draw(tables), None) for _ in range(draw(st.integers(1, 3)))]
    diagram, roots = rebuild(builder.finish(), drawn)
    goals = tuple(RankedGoal((f"S is v{root}",), names(draw, vocabulary), root) for root in roots)
    goal = st.integers(0, len(goals) - 1)
    options = st.lists(st.tuples(states(vocabulary), goal), max_size=3).map(tuple)
    choices = draw(st.lists(st.builds(Choice, states(vocabulary), options), min_size=1, max_size=4).map(tuple))
    number = st.integers(0, len(choices) - 1)
    some = st.lists(number, min_size=1, max_size=3).map(tuple)
    paths = st.builds(Cut, st.just("path"), goal, some, states(vocabulary))
    loops = st.builds(Cut, st.just("loop"), goal, some, st.none())
    cuts = draw(st.lists(paths | loops, max_size=3).map(tuple))
    return Conflict(draw(some), choices, cuts, diagram, goals)


@st.composite
def removals(draw: st.DrawFn, vocabulary: Vocabulary) -> Removal:
    """Any states, and distances from any goals."""
    builder = DiagramBuilder(draw(st.permutations(range(len(vocabulary.sizes)))), (None, 0, 1))
    tables = st.dictionaries(states(vocabulary), st.sampled_from([None, 0, 1]), max_size=4)
    root, *roots = [builder.from_table(vocabulary.sizes, draw(tables), None) for _ in range(draw(st.integers(1, 3)))]
    goals = tuple(RankedGoal((f"S is v{each}",), names(draw, vocabulary), each) for each in roots)
    kinds: tuple[Literal["no-restoration", "no-plan"], ...] = ("no-restoration", "no-plan")
    return canonical(Removal(draw(st.sampled_from(kinds)), builder.finish(), root, goals))


@st.composite
def parts(draw: st.DrawFn, vocabulary: Vocabulary) -> NoPart:
    """No part with all starts, with any arguments."""
    removed = st.lists(removals(vocabulary), max_size=2).map(tuple)
    cases = st.lists(st.builds(Case, states(vocabulary), st.integers(0, 4)), max_size=2).map(tuple)
    ended = st.builds(StartRemoved, removed, states(vocabulary))
    divided = st.builds(Divided, removed, conflicts(vocabulary), cases)
    return NoPart(draw(st.lists(ended | divided, max_size=3).map(tuple)))


@st.composite
def certificates(draw: st.DrawFn) -> Unrealizability:
    """A certificate of any kind, whatever it is worth."""
    vocabulary = draw(vocabularies())
    none = st.builds(NoAllowedSet, states(vocabulary), st.none() | st.lists(cubes(vocabulary), max_size=4).map(tuple))
    reason = draw(none | layers(vocabulary) | conflicts(vocabulary) | traps(vocabulary) | parts(vocabulary))
    restoration = draw(st.sampled_from(get_args(Restoration)))
    return Unrealizability(vocabulary, draw(st.sampled_from(["any", "first"])), draw(NAMES), reason, restoration)


@cache
def example(kind: str) -> Unrealizability:
    """A small certificate of one kind, the same every time."""
    vocabulary = Vocabulary((("S_Place", ("dock", "hall")), ("S_Load", ("free", "full"))), ("go", "load"))
    builder = DiagramBuilder[bool]((1, 0), (False, True))
    reason: Reason
    if kind == "no-allowed-set":
        cubes = (
            Cube(frozenset((0, 1)), frozenset(), Violation("resource", (0, 1))),
            Cube(frozenset((0,)), frozenset((1,)), Violation("unsafe", outcome=((0, ((0, 1),)),))),
            Cube(frozenset((1,)), frozenset((0,)), Violation("reaction-rule", rule="executing go")),
            Cube(frozenset(), frozenset((0, 1)), Violation("idle")),
        )
        reason = NoAllowedSet((0, 1), cubes)
    elif kind == "no-restoration":
        root = builder.from_table((2, 2), {(0, 1): True, (1, 1): True, (1, 0): True}, False)
        reason = NoRestoration((0, 1), builder.finish(), root)
    elif kind == "no-plan":
        roots = [
            builder.from_table((2, 2), dict.fromkeys(found, True), False) for found in ([(0, 1)], [(1, 1), (0, 0)])
        ]
        reason = NoPlan((0, 0), builder.finish(), (Layers(("S_Load is full",), ("go",), tuple(roots)),))
    else:
        ranks = DiagramBuilder[int | None]((1, 0), (None, 0, 1))
        root = ranks.from_table((2, 2), {(0, 0): 0, (1, 0): 1}, None)
        choices = (Choice((0, 0), (((1, 0), 0),)), Choice((1, 0), ()))
        cuts = (Cut("path", 0, (0, 1), (1, 1)), Cut("loop", 0, (0,), None))
        goals = (RankedGoal(("S_Load is full",), (), root),)
        reason = Conflict((0,), choices, cuts, ranks.finish(), goals)
        if kind == "no-part":
            removal = Removal("no-plan", ranks.finish(), root, goals)
            reason = NoPart((Divided((removal,), reason, (Case((1, 0), 1),)), StartRemoved((removal, removal), (0, 0))))
    return loads(dumps(Unrealizability(vocabulary, "any", "0123abcd", reason)))


KINDS = pytest.mark.parametrize("kind", ["no-allowed-set", "no-restoration", "no-plan", "conflict", "no-part"])


@QUICK
@given(certificates())
def test_a_certificate_survives_its_text(certificate: Unrealizability) -> None:
    """`loads(dumps(c)) == c` for every certificate, and the schema accepts the text."""
    text = dumps(certificate)
    assert loads(text) == certificate
    jsonschema.Draft202012Validator(SCHEMA).validate(json.loads(text))


def test_the_schema_is_a_schema() -> None:
    """`unrealizable.schema.json` is valid JSON Schema 2020-12."""
    jsonschema.Draft202012Validator.check_schema(SCHEMA)


def test_the_examples_in_the_document_are_some() -> None:
    """The certificates shown in `docs/certificate.md` are read, and satisfy the schema."""
    document = Path(__file__).parents[2].joinpath("docs/certificate.md").read_text(encoding="utf-8")
    texts = re.findall(r"```json\n(.*?)```", document, re.DOTALL)
    assert [type(loads(text).reason) for text in texts] == [NoAllowedSet, NoPart]
    for text in texts:
        jsonschema.Draft202012Validator(SCHEMA).validate(json.loads(text))


@QUICK
@given(certificates(), st.randoms(use_true_random=False))
def test_order_of_declaration_never_matters(certificate: Unrealizability, random: Random) -> None:
    """Bound to another order of the same names and back, a certificate says the same, by names and in its diagrams."""
    target = shuffled(certificate.vocabulary, random)
    bound = bind(certificate, spec_of(target))
    assert bound.vocabulary == target
    assert dumps(bind(bound, spec_of(certificate.vocabulary))) == dumps(certificate)
    assert named_states(bound) == named_states(certificate)


def named_states(certificate: Unrealizability) -> list[dict[str, str]]:
    """The states that a certificate lists, value by variable."""
    states, variables = _listed(certificate.reason), certificate.vocabulary.variables
    return [{name: values[value] for (name, values), value in zip(variables, state, strict=True)} for state in states]


def _listed(reason: Reason) -> Iterator[State]:
    match reason:
        case Conflict():
            yield from (choice.state for choice in reason.choices)
        case NoPart(arguments):
            for each in arguments:
                if isinstance(each, StartRemoved):
                    yield each.state
                else:
                    yield from _listed(each.conflict)
                    yield from (case.state for case in each.cases)
        case _:
            yield reason.state


@KINDS
def test_a_file_holds_the_certificate(kind: str, tmp_path: Path) -> None:
    """`save` and `load` are inverse; `load_claim` tells certificates from policies."""
    path = tmp_path / "c.unrealizable.json"
    save(example(kind), path)
    assert load(str(path)) == load_claim(str(path)) == example(kind)
    assert list(tmp_path.iterdir()) == [path]
    proof = Path(__file__).parents[2] / "proofs" / "amr.policy.json"
    assert isinstance(load_claim(str(proof)), Policy)


def test_a_certificate_is_no_policy(tmp_path: Path) -> None:
    """Whoever asks a certificate what to do is told what it is."""
    path = tmp_path / "c.json"
    save(example("no-plan"), path)
    with pytest.raises(UserError, match="TUM502: this is a certificate") as error:
        load_policy(str(path))
    assert "tumato-sym verify" in (error.value.diagnostics[0].help or "")


@pytest.mark.parametrize(
    ("change", "code"),
    [
        (lambda spec: spec_of(Vocabulary(spec.variables[:1], spec.actions)), "TUM503"),
        (lambda spec: spec_of(Vocabulary((spec.variables[0], ("S_Load", ("free",))), spec.actions)), "TUM504"),
        (lambda spec: spec_of(Vocabulary(spec.variables, ("go",))), "TUM505"),
    ],
)
def test_names_that_do_not_fit_are_refused(change: Callable[[Vocabulary], Spec], code: str) -> None:
    """A certificate about other variables, values or actions cannot be bound."""
    certificate = example("conflict")
    with pytest.raises(UserError, match=f"{code}: the certificate"):
        bind(certificate, change(certificate.vocabulary))


@KINDS
@pytest.mark.parametrize("block", range(5))
def test_mutants_end_in_a_certificate_or_a_coded_error(kind: str, block: int, tmp_path: Path) -> None:
    """200 mutants of each kind: read, written and bound, or refused with TUM501 to TUM508."""
    path = tmp_path / "c.json"
    text = dumps(example(kind))
    for seed in range(block * 40, block * 40 + 40):
        path.write_bytes(mutations(text, seed))
        try:
            found = load(str(path))
            assert loads(dumps(found)) == found
            assert dumps(bind(found, spec_of(found.vocabulary))) == dumps(found)
        except UserError as error:
            for diagnostic in error.diagnostics:
                assert diagnostic.code.name in {f"TUM50{number}" for number in (1, 2, 3, 4, 5, 8)}
                assert len(diagnostic.message) < 1000
                assert diagnostic.message.isprintable()
