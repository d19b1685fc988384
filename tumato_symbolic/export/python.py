"""A policy as a module of Python 3.8 or later that needs nothing but the language."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from string import Template
from textwrap import fill

from tumato_symbolic.diagrams import Reference
from tumato_symbolic.export.decisions import MOST_QUESTIONS, Answer, Tree, questions, tree_of
from tumato_symbolic.export.request import Request
from tumato_symbolic.policy import DecisionDiagram, Policy, Vocabulary, as_diagram

_MODULE = Template('''\
"""What to do in a state: the decisions of a policy. Written by `tumato-sym export python`.

$promise
"""

VARIABLES = {
$variables}

ACTIONS = (
$actions)


class UndecidedState(LookupError):
    """The policy says nothing of this state: no action is known to be safe."""


def decide(state):
    """The actions to execute together in a state, a dict of value by variable. An empty tuple means: do nothing.

    Raises UndecidedState where the policy says nothing of the state, and ValueError where it is no state: a variable
    is missing or unknown, or has a value that it cannot have.
    """
    values = _values(state)
$decide

def _values(state):
    if _is_written_out(state):
        return state
    values = {name: str(value) if type(value) is int else value for name, value in state.items()}
    for name in values:
        if name not in VARIABLES:
            raise ValueError("there is no variable {!r}".format(name))
    for name, known in VARIABLES.items():
        if name not in values:
            raise ValueError("{} has no value".format(name))
        if values[name] not in known:
            raise ValueError("{} cannot be {!r}, only one of {}".format(name, values[name], ", ".join(known)))
    return values


def _is_written_out(state):
    if len(state) != len(VARIABLES):
        return False
    for name, known in VARIABLES.items():
        if state.get(name) not in known:
            return False
    return True


def _follow(here, values):
    while type(here) is int:
        variable, below = _QUESTIONS[here]
        here = below[values[variable]]
    return here


# Each asks for the value of a variable, and goes on with the question of a number, or with the answer.
_QUESTIONS = (
$questions)

$roots''')

_BY_TREE = """\
    actions = _follow(_FIRST, values)
    if actions is None:
        raise UndecidedState(state)
    return actions
"""

_BY_ACTION = """\
    if not _follow(_DECIDED, values):
        raise UndecidedState(state)
    return tuple(action for action in ACTIONS if _follow(_EXECUTED[action], values))
"""


def files(request: Request) -> tuple[str]:
    """The text of the module."""
    policy, vocabulary = request.policy, request.policy.vocabulary
    tree = tree_of(policy, MOST_QUESTIONS)
    questions, roots = _by_action(policy) if tree is None else _by_tree(vocabulary, tree)
    text = _MODULE.substitute(
        promise=fill(request.promise, 119),
        variables="".join(f"    {name!r}: {values!r},\n" for name, values in vocabulary.variables),
        actions="".join(f"    {action!r},\n" for action in vocabulary.actions),
        decide=_BY_ACTION if tree is None else _BY_TREE,
        questions="".join(questions),
        roots=roots,
    )
    return (text,)


def _by_tree(vocabulary: Vocabulary, tree: Tree) -> tuple[Iterator[str], str]:
    """The questions, of which answers are tuples of names, or None where nothing is decided."""
    listed = questions(tree)
    numbers = {id(question): number for number, question in enumerate(listed)}

    def shown(here: Tree) -> str:
        if isinstance(here, Answer):
            return repr(None if here.actions is None else tuple(vocabulary.actions[each] for each in here.actions))
        return str(numbers[id(here)])

    lines = (
        _question(vocabulary, number, question.variable, [shown(each) for each in question.below])
        for number, question in enumerate(listed)
    )
    return lines, f"_FIRST = {shown(tree)}\n"


def _by_action(policy: Policy) -> tuple[Iterator[str], str]:
    """The questions of all actions, of which answers are True or False."""
    decisions: DecisionDiagram = as_diagram(policy)
    diagram, vocabulary = decisions.diagram, policy.vocabulary
    base = len(diagram.leaves)

    def shown(reference: Reference) -> str:
        return repr(diagram.leaves[reference]) if reference < base else str(reference - base)

    lines = (
        _question(vocabulary, number, diagram.order[level], [shown(each) for each in below])
        for number, (level, below) in enumerate(diagram.nodes)
    )
    executed = zip(vocabulary.actions, decisions.roots, strict=True)
    roots = "".join(f"    {action!r}: {shown(root)},\n" for action, root in executed)
    return lines, f"_DECIDED = {shown(decisions.defined)}\n_EXECUTED = {{\n{roots}}}\n"


def _question(vocabulary: Vocabulary, number: int, variable: int, below: Sequence[str]) -> str:
    name, values = vocabulary.variables[variable]
    branches = ", ".join(f"{value!r}: {each}" for value, each in zip(values, below, strict=True))
    return f"    ({name!r}, {{{branches}}}),  # {number}\n"
