"""Random vocabularies, policies and the specifications that they are bound to."""

from hypothesis import settings
from hypothesis import strategies as st

from tumato_symbolic.diagnostics import Span
from tumato_symbolic.diagrams import DiagramBuilder, rebuild
from tumato_symbolic.policy import Certificate, DecisionDiagram, Policy, RankedGoal, Table, Vocabulary, as_diagram
from tumato_symbolic.policy.records import Deviation, Restoring
from tumato_symbolic.spec import Action, Spec, Variable

NAMES = st.text('ab_Z9é "\\\n\x00\u2028🤖', max_size=4)
QUICK = settings(max_examples=50, deadline=None)
HERE = Span(1, 1, 1, 1)
EFFORTS = ((0, 1), (1, 1), (10, 3))


def vocabularies(names=NAMES):
    """One to four variables with one to four values, up to five actions."""
    values = st.lists(names, min_size=1, max_size=4, unique=True).map(tuple)
    variables = st.lists(st.tuples(names, values), min_size=1, max_size=4, unique_by=lambda variable: variable[0])
    return st.builds(Vocabulary, variables.map(tuple), st.lists(names, max_size=5, unique=True).map(tuple))


@st.composite
def tables(draw: st.DrawFn, vocabulary: Vocabulary):
    """Some states with some actions."""
    state = st.tuples(*(st.integers(0, size - 1) for size in vocabulary.sizes))
    numbers = range(len(vocabulary.actions))
    chosen = st.frozensets(st.sampled_from(numbers)) if numbers else st.just(frozenset())
    return Table(draw(st.dictionaries(state, chosen, max_size=12)))


@st.composite
def certificates(draw: st.DrawFn, vocabulary: Vocabulary):
    """Ranks of some states for up to three goals, in canonical form."""
    order = draw(st.permutations(range(len(vocabulary.variables))))
    builder = DiagramBuilder(order, (None, 0, 1, 2))
    state = st.tuples(*(st.integers(0, size - 1) for size in vocabulary.sizes))
    ranks = st.dictionaries(state, st.sampled_from([None, 0, 1, 2]), max_size=8)
    roots = [builder.from_table(vocabulary.sizes, ranks, None) for ranks in draw(st.lists(ranks, max_size=3))]
    diagram, roots = rebuild(builder.finish(), roots)
    executed = draw(st.lists(st.sampled_from(vocabulary.actions), unique=True)) if vocabulary.actions else []
    goals = tuple(RankedGoal((f"S is v{root}",), tuple(sorted(executed)), root) for root in roots)
    return Certificate(diagram, goals, draw(st.none() | restorings(vocabulary)))


@st.composite
def restorings(draw: st.DrawFn, vocabulary: Vocabulary):
    """Efforts of some states, and some deviations, in canonical form."""
    state = st.tuples(*(st.integers(0, size - 1) for size in vocabulary.sizes))
    builder = DiagramBuilder(draw(st.permutations(range(len(vocabulary.variables)))), (None, *EFFORTS))
    efforts = st.dictionaries(state, st.sampled_from([None, *EFFORTS]), max_size=8)
    roots = [builder.from_table(vocabulary.sizes, draw(efforts), None) for _ in range(2)]
    diagram, (worst, nominal) = rebuild(builder.finish(), roots)
    chosen = (
        st.frozensets(st.sampled_from(range(len(vocabulary.actions)))) if vocabulary.actions else st.just(frozenset())
    )
    deviations = draw(st.lists(st.builds(Deviation, state, chosen, state), max_size=2))
    return Restoring(diagram, worst, nominal, tuple(deviations))


@st.composite
def policies(draw, forms=("table", "diagram"), names=NAMES):
    """A policy of one of the forms, with or without our own sections."""
    vocabulary = draw(vocabularies(names))
    table = draw(tables(vocabulary))
    decisions = table if draw(st.sampled_from(forms)) == "table" else reordered(draw, Policy(vocabulary, table))
    return Policy(
        vocabulary,
        decisions,
        draw(st.sampled_from([None, "any", "first"])),
        draw(st.none() | NAMES),
        draw(st.none() | certificates(vocabulary)),
        restoration=draw(st.sampled_from(["one_step", "bounded", "fair"])),
    )


def reordered(draw: st.DrawFn, policy: Policy) -> DecisionDiagram:
    """The decisions as a diagram that tests the variables in a random order."""
    order = draw(st.permutations(range(len(policy.vocabulary.variables))))
    builder = DiagramBuilder(order, (False, True))
    rows, sizes = policy.decisions.rows, policy.vocabulary.sizes
    roots = [
        builder.from_table(sizes, {state: True for state, chosen in rows.items() if action in chosen}, False)
        for action in range(len(policy.vocabulary.actions))
    ]
    defined = builder.from_table(sizes, dict.fromkeys(rows, True), False)
    diagram, kept = rebuild(builder.finish(), (*roots, defined))
    return DecisionDiagram(diagram, kept[:-1], kept[-1])


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
    builder = DiagramBuilder((1, 0), (None, 0, 1, 2))
    ranks = {(0, 1): 0, (1, 1): 1, (0, 0): 2, (1, 0): 2}
    certificate_root = builder.from_table((2, 3), ranks, None)
    certificate = Certificate(builder.finish(), (RankedGoal(("S_Load is full",), ("load",), certificate_root),))
    rows = {(0, 0): frozenset({1}), (0, 1): frozenset(), (1, 0): frozenset({0, 2}), (1, 1): frozenset({0})}
    table = Policy(vocabulary, Table(rows), "any", "0123abcd", certificate)
    return Policy(vocabulary, as_diagram(table), "any", "0123abcd", certificate) if diagram else table
