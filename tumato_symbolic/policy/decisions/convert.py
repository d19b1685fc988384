"""From tables to diagrams and back; how many states are decided, and which actions are never executed."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from operator import itemgetter
from typing import TypeAlias

from tumato_symbolic.diagrams import LEAVES, Diagram, DiagramBuilder, Reference, Sets, room_for
from tumato_symbolic.policy.policy import Policy
from tumato_symbolic.policy.records import Certificate, DecisionDiagram, Table, Vocabulary
from tumato_symbolic.semantics import ActionSet, State, actions_of
from tumato_symbolic.spec import Ordering, Spec

Roots: TypeAlias = tuple[Reference, ...]
Branches: TypeAlias = tuple[int, list[Roots]]


def policy_from_rows(
    spec: Spec,
    rows: Mapping[State, ActionSet],
    ordering: Ordering | None = None,
    digest: str | None = None,
    certificate: Certificate | None = None,
) -> Policy:
    """The policy that decides exactly the states of `rows`, in the numbers of `spec`, as a table in row-major order."""
    table = {state: actions_of(spec, chosen) for state, chosen in sorted(rows.items())}
    return Policy(Vocabulary.of(spec), Table(table), ordering, digest, certificate)


def as_diagram(policy: Policy) -> DecisionDiagram:
    """The decisions as a reduced diagram; one made from a table has the order of declaration."""
    if isinstance(policy.decisions, DecisionDiagram):
        return policy.decisions
    rows, sizes = policy.decisions.rows, policy.vocabulary.sizes
    whole = DiagramBuilder[ActionSet | None](range(len(sizes)), (None, *dict.fromkeys(rows.values())))
    root = whole.from_table(sizes, rows, None)
    decided, builder = whole.finish(), DiagramBuilder[bool](range(len(sizes)), (False, True))
    roots = tuple(
        _where(decided, root, [chosen is not None and action in chosen for chosen in decided.leaves], builder)
        for action in range(len(policy.vocabulary.actions))
    )
    defined = _where(decided, root, [chosen is not None for chosen in decided.leaves], builder)
    return DecisionDiagram(builder.finish(), roots, defined)


def _where(
    diagram: Diagram[ActionSet | None], root: Reference, wanted: Sequence[bool], builder: DiagramBuilder[bool]
) -> Reference:
    """The states in which `root` leads to a leaf that is wanted, as a root of what is built."""
    references = [builder.leaf(each) for each in wanted]
    for level, below in diagram.nodes:
        references.append(builder.node(level, tuple([references[child] for child in below])))
    return references[root]


def count_defined(policy: Policy) -> int:
    """How many states the policy decides, exactly."""
    return policy.decisions.count(policy.vocabulary.sizes)


def some_decided(policy: Policy) -> State | None:
    """A state that the policy decides; None where it decides none."""
    decisions, sizes = policy.decisions, policy.vocabulary.sizes
    if isinstance(decisions, Table):
        return next(iter(decisions.rows), None)
    fixed = next((fixed for fixed, _ in _cubes(decisions, sizes)), None)
    return None if fixed is None else tuple(fixed.get(variable, 0) for variable in range(len(sizes)))


def never_executed(policy: Policy) -> tuple[str, ...]:
    """The actions that the policy decides in no state."""
    names, decisions = policy.vocabulary.actions, policy.decisions
    if isinstance(decisions, Table):
        executed = frozenset[int]().union(*decisions.rows.values())
    else:
        sizes, levels = policy.vocabulary.sizes, decisions.diagram.levels()
        executed = frozenset(a for a, root in enumerate(decisions.roots) if _executes(decisions, levels, sizes, root))
    return tuple(name for action, name in enumerate(names) if action not in executed)


def _executes(decisions: DecisionDiagram, levels: Sequence[int], sizes: Sequence[int], action: Reference) -> bool:
    """Whether a root leads to true in some decided state."""
    pending: list[Roots] = [(decisions.defined, action)]
    seen: set[Roots] = set(pending)
    while pending:
        found = decided_at(decisions.diagram, levels, sizes, pending.pop())
        if isinstance(found, frozenset):
            if found:
                return True
        elif found is not None:
            new = set(found[1]) - seen
            seen |= new
            pending += new
    return False


def as_table(policy: Policy, limit: int) -> Table | None:
    """The decisions as rows in row-major order; None where there are more than `limit`."""
    if count_defined(policy) > limit:
        return None
    if isinstance(policy.decisions, Table):
        return policy.decisions
    return Table(_rows(policy.decisions, policy.vocabulary.sizes))


def _rows(decisions: DecisionDiagram, sizes: tuple[int, ...]) -> dict[State, ActionSet]:
    """The decisions in row-major order: the decided states, then for each action those of them where it is executed."""
    tested = decisions.diagram.order
    order = (*tested, *(variable for variable in range(len(sizes)) if variable not in tested))
    place = [order.index(variable) for variable in range(len(order))]
    with room_for(len(order)):
        sets = Sets(order, sizes)
        defined, *executed = sets.take(decisions.diagram, (decisions.defined, *decisions.roots), LEAVES)
        chosen: dict[tuple[int, ...], tuple[int, ...]] = dict.fromkeys(sets.states(defined), ())
        for action, states in enumerate(executed):
            for state in sets.states(sets.both(states, defined)):
                chosen[state] = (*chosen[state], action)
    known = {each: frozenset(each) for each in set(chosen.values())}
    rows = ((tuple([state[level] for level in place]), known[each]) for state, each in chosen.items())
    return dict(sorted(rows, key=itemgetter(0)))


def _cubes(decisions: DecisionDiagram, sizes: tuple[int, ...]) -> Iterator[tuple[dict[int, int], ActionSet]]:
    """Disjoint sets of decided states, given by the variables that are fixed, and the decision of each."""
    diagram = decisions.diagram
    levels = diagram.levels()
    known: dict[Roots, ActionSet | Branches | None] = {}
    pending: list[tuple[Roots, dict[int, int]]] = [((decisions.defined, *decisions.roots), {})]
    while pending:
        roots, fixed = pending.pop()
        if roots not in known:
            known[roots] = decided_at(diagram, levels, sizes, roots)
        found = known[roots]
        if isinstance(found, frozenset):
            yield fixed, found
        elif found is not None:
            variable, branches = found
            pending += [(below, {**fixed, variable: value}) for value, below in enumerate(branches)]


def decided_at(
    diagram: Diagram[bool], levels: Sequence[int], sizes: Sequence[int], roots: Roots
) -> ActionSet | Branches | None:
    """What roots say together: the first of where something is decided, each other one of where its action is executed.

    The decision; None where there is none; or the first variable that matters, and the roots for each of its values.
    `levels` has that of every reference.
    """
    leaves, level = diagram.leaves, min([levels[root] for root in roots])
    if roots[0] < len(leaves) and not leaves[roots[0]]:
        return None
    if level == len(diagram.order):
        return frozenset(action for action, root in enumerate(roots[1:]) if leaves[root])
    variable = diagram.order[level]
    below = [
        diagram.nodes[root - len(leaves)][1] if levels[root] == level else (root,) * sizes[variable] for root in roots
    ]
    return variable, list(zip(*below, strict=True))
