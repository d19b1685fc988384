"""The decisions of a policy as one shared tree of questions, and as a list of rules: what targets print."""

from __future__ import annotations

from typing import TypeAlias

from msgspec import Struct

from tumato_symbolic.diagrams import EVERYTHING, LEAVES, Sets, room_for
from tumato_symbolic.policy import DecisionDiagram, Policy, Roots, Vocabulary, as_diagram, decided_at, minimal_rules
from tumato_symbolic.semantics import ActionSet

MOST_QUESTIONS = 20_000
"""Larger trees are of no use: each action has a diagram of its own then."""


class Answer(Struct, frozen=True):
    """What is done: a set of actions, by their numbers in order; None where the policy does not decide."""

    actions: tuple[int, ...] | None


class Question(Struct, frozen=True, eq=False):
    """Which value a variable has; `below` goes on with what follows from each."""

    variable: int
    below: tuple[Tree, ...]

    def groups(self) -> list[tuple[tuple[int, ...], Tree]]:
        """The different trees below, each with the values that lead to it."""
        found: dict[int, list[int]] = {}
        for value, tree in enumerate(self.below):
            found.setdefault(id(tree), []).append(value)
        return [(tuple(values), self.below[values[0]]) for values in found.values()]


Tree: TypeAlias = Answer | Question
"""Equal parts are the same object."""


def tree_of(policy: Policy, most: int) -> Tree | None:
    """All decisions in one tree; None where it takes more than `most` different questions.

    Policies for many independent things have none of a useful size: there, use one diagram for each action
    (`as_diagram`).
    """
    decisions = as_diagram(policy)
    with room_for(len(decisions.diagram.order)):
        builder = _Builder(policy, most)
        try:
            return builder.at((decisions.defined, *decisions.roots))
        except _TooLarge:
            return None


class _TooLarge(Exception):  # noqa: N818 - no error: some policies have no small tree
    """A tree was given up."""


class _Builder:
    def __init__(self, policy: Policy, most: int) -> None:
        self._diagram = as_diagram(policy).diagram
        self._sizes = policy.vocabulary.sizes
        self._levels = self._diagram.levels()
        self._most = most
        self._known: dict[Roots, Tree] = {}
        self._answers: dict[ActionSet | None, Answer] = {}
        self._questions: dict[tuple[int, ...], Question] = {}

    def at(self, roots: Roots) -> Tree:
        """The tree of what some roots say together."""
        found = self._known.get(roots)
        if found is None:
            said = decided_at(self._diagram, self._levels, self._sizes, roots)
            if isinstance(said, tuple):
                variable, branches = said
                found = self._question(variable, tuple([self.at(each) for each in branches]))
            else:
                found = self._answers.setdefault(said, Answer(None if said is None else tuple(sorted(said))))
            self._known[roots] = found
            if len(self._known) > self._most:
                raise _TooLarge
        return found

    def _question(self, variable: int, below: tuple[Tree, ...]) -> Tree:
        if all(each is below[0] for each in below):
            return below[0]
        return self._questions.setdefault((variable, *map(id, below)), Question(variable, below))


def questions(tree: Tree) -> list[Question]:
    """Every different question once, those below before those above."""
    done: dict[int, Question] = {}
    pending = [tree]
    while pending:
        here = pending[-1]
        below = here.below if isinstance(here, Question) and id(here) not in done else ()
        waiting = [each for each in below if isinstance(each, Question) and id(each) not in done]
        if waiting:
            pending += reversed(waiting)
        else:
            pending.pop()
            if isinstance(here, Question):
                done.setdefault(id(here), here)
    return list(done.values())


def size_written_out(tree: Tree) -> int:
    """How many answers the tree has when nothing is shared, and equal answers of one question are given once."""
    sizes: dict[int, int] = {}
    for question in questions(tree):
        sizes[id(question)] = sum(sizes.get(id(below), 1) for _, below in question.groups())
    return sizes.get(id(tree), 1)


class DecisionRule(Struct, frozen=True):
    """A rule of an ordered list of which the first that matches decides: where it matches, and what is done then.

    `condition` gives the values, by name, that some variables may have. `actions` is None where nothing is decided.
    """

    condition: tuple[tuple[str, tuple[str, ...]], ...]
    actions: tuple[str, ...] | None


def rules_of(policy: Policy) -> tuple[DecisionRule, ...]:
    """A short list of rules that says of every state what the policy says; its last rule matches always.

    Raises `UserError` (TUM508) where there is none.
    """
    found = minimal_rules(_with_undecided(policy))
    return tuple(DecisionRule(rule.condition, None if _UNDECIDED in rule.actions else rule.actions) for rule in found)


_UNDECIDED = ""
"""Takes the place of an action where nothing is decided; no action has that name."""


def _with_undecided(policy: Policy) -> Policy:
    """The policy that decides every state: where this one does not, it does `_UNDECIDED` and nothing else."""
    decisions, vocabulary = as_diagram(policy), policy.vocabulary
    with room_for(len(decisions.diagram.order)):
        sets = Sets(decisions.diagram.order, vocabulary.sizes)
        *executed, defined = sets.take(decisions.diagram, (*decisions.roots, decisions.defined), LEAVES)
        roots = [*(sets.both(each, defined) for each in executed), sets.without(EVERYTHING, defined)]
        diagram, (*roots, every) = sets.as_diagram([*roots, EVERYTHING])
    total = DecisionDiagram(diagram, tuple(roots), every)
    return Policy(Vocabulary(vocabulary.variables, (*vocabulary.actions, _UNDECIDED)), total)
