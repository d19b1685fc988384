"""Random vocabularies, policies and the specifications that they are bound to."""

from collections.abc import Mapping, Sequence
from itertools import product

from hypothesis import settings
from hypothesis import strategies as st

from tumato_symbolic.diagnostics import Span
from tumato_symbolic.diagrams import DiagramBuilder, rebuild
from tumato_symbolic.policy import (
    Certificate,
    DecisionDiagram,
    Deviation,
    Policy,
    RankedGoal,
    Restoring,
    Table,
    Vocabulary,
    as_diagram,
    as_table,
)
from tumato_symbolic.semantics import ActionSet, State
from tumato_symbolic.spec import Action, Spec, Variable

NAMES = st.text('ab_Z9é "\\\n\x00\u2028🤖', max_size=4)
QUICK = settings(max_examples=30)
HERE = Span(1, 1, 1, 1)
EFFORTS = ((0, 1), (1, 1), (10, 3))


def vocabularies(names: st.SearchStrategy[str] = NAMES) -> st.SearchStrategy[Vocabulary]:
    """One to four variables with one to four values, up to five actions."""
    values = st.lists(names, min_size=1, max_size=4, unique=True).map(tuple)
    variables = st.lists(st.tuples(names, values), min_size=1, max_size=4, unique_by=lambda variable: variable[0])
    return st.builds(Vocabulary, variables.map(tuple), st.lists(names, max_size=5, unique=True).map(tuple))


@st.composite
def tables(draw: st.DrawFn, vocabulary: Vocabulary) -> Table:
    """Some states with some actions."""
    return Table(draw(st.dictionaries(states(vocabulary), action_sets(vocabulary), max_size=12)))


def states(vocabulary: Vocabulary) -> st.SearchStrategy[State]:
    """Any state."""
    return st.tuples(*(st.integers(0, size - 1) for size in vocabulary.sizes))


def action_sets(vocabulary: Vocabulary) -> st.SearchStrategy[ActionSet]:
    """Any set of actions."""
    numbers = range(len(vocabulary.actions))
    return st.frozensets(st.sampled_from(numbers)) if numbers else st.just(frozenset[int]())


@st.composite
def certificates(draw: st.DrawFn, vocabulary: Vocabulary) -> Certificate:
    """Ranks of some states for up to three goals, in canonical form."""
    order = draw(st.permutations(range(len(vocabulary.variables))))
    builder = DiagramBuilder[int | None](order, (None, 0, 1, 2))
    ranks = st.dictionaries(states(vocabulary), st.sampled_from([None, 0, 1, 2]), max_size=8)
    found = [builder.from_table(vocabulary.sizes, ranks, None) for ranks in draw(st.lists(ranks, max_size=3))]
    diagram, roots = rebuild(builder.finish(), found)
    executed = draw(st.lists(st.sampled_from(vocabulary.actions), unique=True)) if vocabulary.actions else []
    goals = tuple(RankedGoal((f"S is v{root}",), tuple(sorted(executed)), root) for root in roots)
    return Certificate(diagram, goals, draw(st.none() | restorings(vocabulary)))


@st.composite
def restorings(draw: st.DrawFn, vocabulary: Vocabulary) -> Restoring:
    """Efforts of some states, and some deviations, in canonical form."""
    state, chosen = states(vocabulary), action_sets(vocabulary)
    builder = DiagramBuilder(draw(st.permutations(range(len(vocabulary.variables)))), (None, *EFFORTS))
    efforts = st.dictionaries(state, st.sampled_from([None, *EFFORTS]), max_size=8)
    roots = [builder.from_table(vocabulary.sizes, draw(efforts), None) for _ in range(2)]
    diagram, (worst, nominal) = rebuild(builder.finish(), roots)
    deviations = draw(st.lists(st.builds(Deviation, state, chosen, state), max_size=2))
    return Restoring(diagram, worst, nominal, tuple(deviations))


@st.composite
def policies(
    draw: st.DrawFn, forms: Sequence[str] = ("table", "diagram"), names: st.SearchStrategy[str] = NAMES
) -> Policy:
    """A policy of one of the forms, with or without our own sections."""
    vocabulary = draw(vocabularies(names))
    table = draw(tables(vocabulary))
    decisions = table if draw(st.sampled_from(forms)) == "table" else reordered(draw, vocabulary, table)
    return Policy(
        vocabulary,
        decisions,
        draw(st.sampled_from([None, "any", "first"])),
        draw(st.none() | NAMES),
        draw(st.none() | certificates(vocabulary)),
        restoration=draw(st.sampled_from(["one_step", "bounded", "fair"])),
    )


def reordered(draw: st.DrawFn, vocabulary: Vocabulary, table: Table) -> DecisionDiagram:
    """The decisions as a diagram that tests the variables in a random order."""
    order = draw(st.permutations(range(len(vocabulary.variables))))
    builder = DiagramBuilder(order, (False, True))
    rows, sizes = table.rows, vocabulary.sizes
    roots = [
        builder.from_table(sizes, {state: True for state, chosen in rows.items() if action in chosen}, False)
        for action in range(len(vocabulary.actions))
    ]
    defined = builder.from_table(sizes, dict.fromkeys(rows, True), False)
    diagram, kept = rebuild(builder.finish(), (*roots, defined))
    return DecisionDiagram(diagram, kept[:-1], kept[-1])


def rows_of(policy: Policy, most: int = 10_000) -> Mapping[State, ActionSet]:
    """What a policy that decides at most so many states does in each."""
    table = as_table(policy, most)
    assert table is not None
    return table.rows


def diagram_of(policy: Policy) -> DecisionDiagram:
    """The decisions of a policy that holds them as a diagram."""
    assert isinstance(policy.decisions, DecisionDiagram)
    return policy.decisions


def certificate_of(policy: Policy) -> Certificate:
    """The certificate of a policy that has one."""
    assert policy.certificate is not None
    return policy.certificate


def spec_of(vocabulary: Vocabulary) -> Spec:
    """A specification with these names and nothing else."""
    return Spec(
        tuple(Variable(name, values, HERE) for name, values in vocabulary.variables),
        (),
        tuple(Action(name, 0, frozenset(), (), (), (), HERE) for name in vocabulary.actions),
        (),
        (),
        (),
        None,
        (),
        None,
        None,
    )


def amr_like(diagram: bool = False) -> Policy:
    """A small policy with every section, the same every time."""
    vocabulary = Vocabulary(
        (("S_Place", ("dock", "hall")), ("S_Load", ("free", "full", "odd"))), ("go", "load", "stop")
    )
    builder = DiagramBuilder[int | None]((1, 0), (None, 0, 1, 2))
    ranks: dict[State, int | None] = {(0, 1): 0, (1, 1): 1, (0, 0): 2, (1, 0): 2}
    certificate_root = builder.from_table((2, 3), ranks, None)
    certificate = Certificate(builder.finish(), (RankedGoal(("S_Load is full",), ("load",), certificate_root),))
    chosen = [{1}, set[int](), {0, 2}, {0}]
    rows: dict[State, ActionSet] = dict(zip(product(range(2), range(2)), map(frozenset, chosen), strict=True))
    table = Policy(vocabulary, Table(rows), "any", "0123abcd", certificate)
    return Policy(vocabulary, as_diagram(table), "any", "0123abcd", certificate) if diagram else table
