"""Decisions as statements of C and of C++: nested `switch`, or a Boolean for each node of the diagrams of a policy."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Protocol

from tumato_symbolic.diagrams import Reference
from tumato_symbolic.export.decisions import MOST_QUESTIONS, Answer, Question, Tree, size_written_out, tree_of
from tumato_symbolic.policy import Policy, as_diagram

MOST_ANSWERS = 1_000
"""Trees with more answers are not written as nested `switch`: each action is a Boolean function instead."""


class Style(Protocol):
    """How a language writes what decisions are made of; variables, values and actions are given by their numbers."""

    def field(self, variable: int) -> str:
        """The value of a variable."""

    def label(self, variable: int, value: int) -> str:
        """A value, as a case of a `switch`."""

    def number(self, variable: int) -> str:
        """The value of a variable as an unsigned number."""

    def answer(self, actions: tuple[int, ...] | None) -> Iterator[str]:
        """Statements that end a decision: these actions, or None where nothing is decided."""

    def answer_by(self, executed: Sequence[str]) -> Iterator[str]:
        """Statements that end a decision: for each action an expression, `true`, `false` or a name."""


def statements(policy: Policy, style: Style) -> Iterator[str]:
    """Lines, without a margin, that end by returning what the policy decides."""
    tree = tree_of(policy, MOST_QUESTIONS)
    if tree is None or size_written_out(tree) > MOST_ANSWERS:
        return _by_functions(policy, style)
    return _by_switch(tree, style)


def _by_switch(tree: Tree, style: Style) -> Iterator[str]:
    if isinstance(tree, Answer):
        yield from style.answer(tree.actions)
        return
    yield f"switch ({style.field(tree.variable)}) {{"
    groups = _largest_last(tree)
    for place, (values, below) in enumerate(groups, 1):
        yield from (f"case {style.label(tree.variable, value)}:" for value in values)
        if place == len(groups):
            yield "default:"
        yield from (f"    {line}" for line in _by_switch(below, style))
    yield "}"


def _largest_last(question: Question) -> list[tuple[tuple[int, ...], Tree]]:
    groups = question.groups()
    largest = max(reversed(groups), key=lambda group: len(group[0]))
    return [*(group for group in groups if group is not largest), largest]


def _by_functions(policy: Policy, style: Style) -> Iterator[str]:
    """A Boolean for every node of the diagrams, those below before those above, without a branch or a loop."""
    decisions = as_diagram(policy)
    diagram, base = decisions.diagram, len(decisions.diagram.leaves)

    def shown(reference: Reference) -> str:
        return ("true" if diagram.leaves[reference] else "false") if reference < base else f"n{reference - base}"

    for variable in sorted({diagram.order[level] for level, _ in diagram.nodes}):
        yield f"const unsigned v{variable} = {style.number(variable)};"
    for number, (level, below) in enumerate(diagram.nodes):
        yield f"const bool n{number} = {_choice(f'v{diagram.order[level]}', [shown(each) for each in below])};"
    yield f"if (!{shown(decisions.defined)}) {{"
    yield from (f"    {line}" for line in style.answer(None))
    yield "}"
    yield from style.answer_by([shown(root) for root in decisions.roots])


def _choice(value: str, below: Sequence[str]) -> str:
    """What follows from each value; the most frequent is for all that are not named."""
    rest = max(dict.fromkeys(below), key=below.count)
    text = rest
    for each in dict.fromkeys(below):
        if each != rest:
            tests = " || ".join(f"{value} == {number}u" for number, found in enumerate(below) if found == each)
            text = f"({tests}) ? {each} : {text}"
    return text
