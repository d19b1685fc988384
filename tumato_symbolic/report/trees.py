"""A policy as a tree of questions, and as a table of its answers."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from msgspec import Struct

from tumato_symbolic.diagnostics.cubes import actions_text, shown
from tumato_symbolic.policy import Vocabulary
from tumato_symbolic.report.cubes import named_json
from tumato_symbolic.report.layout import count
from tumato_symbolic.report.rules import SOMETHING_ELSE
from tumato_symbolic.views import Answer, Folded, Label, Question, Row, Tree, rows

UNDECIDED = "(undecided)"
_ANY = "·"


class _Line(Struct, frozen=True):
    """A question and an answer, so deep in the tree."""

    depth: int
    question: str
    answer: str | None


def tree_lines(vocabulary: Vocabulary, tree: Tree) -> list[str]:
    """The questions, indented, with answers in one column; `!` marks unsafe states."""
    lines = list(_lines(vocabulary, tree, 0)) if isinstance(tree, Question) else [_always(vocabulary, tree)]
    width = max(2 * line.depth + len(line.question) for line in lines)
    return [_draw(line, width) for line in lines]


def _draw(line: _Line, width: int) -> str:
    text = "  " * line.depth + line.question
    return text if line.answer is None else f"{text:<{width}}  {line.answer}"


def _always(vocabulary: Vocabulary, leaf: Answer | Folded) -> _Line:
    return _Line(0, "always", _marked(vocabulary, leaf))


def _lines(vocabulary: Vocabulary, question: Question, depth: int) -> Iterator[_Line]:
    name, known = vocabulary.variables[question.variable]
    for branch in question.branches:
        asked = f"{shown(name)} {_alternatives(known, branch.values)}"
        if isinstance(branch.tree, Question):
            yield _Line(depth, asked, None)
            yield from _lines(vocabulary, branch.tree, depth + 1)
        else:
            yield _Line(depth, asked, _marked(vocabulary, branch.tree))


def _alternatives(known: Sequence[str], values: Sequence[int]) -> str:
    """`low or high`."""
    return " or ".join(shown(known[value]) for value in values)


def _marked(vocabulary: Vocabulary, leaf: Answer | Folded) -> str:
    unsafe = isinstance(leaf, Answer) and leaf.label.unsafe
    return f"{'!' if unsafe else ' '} {leaf_text(vocabulary, leaf)}"


def leaf_text(vocabulary: Vocabulary, leaf: Answer | Folded) -> str:
    """What is done at a leaf."""
    return folded_text(leaf.decisions) if isinstance(leaf, Folded) else label_text(vocabulary, leaf.label)


def folded_text(decisions: int) -> str:
    """What stands for a part that is not shown."""
    return f"… {count(decisions, 'different decision')}" if decisions > 1 else "… in some of them"


def label_text(vocabulary: Vocabulary, label: Label) -> str:
    """What is done, by names."""
    if label.other:
        return SOMETHING_ELSE
    if label.actions is None:
        return UNDECIDED
    return actions_text([vocabulary.actions[action] for action in label.actions])


def table_lines(vocabulary: Vocabulary, tree: Tree) -> list[str]:
    """A line for every answer: its states, the values that variables may have, and what is done."""
    listed = rows(tree)
    asked = sorted({variable for row in listed for variable, _ in row.condition})
    head = ["states", *(shown(vocabulary.variables[variable][0]) for variable in asked), "  actions"]
    cells = [[f"{row.leaf.states:,}", *_cells(vocabulary, row, asked), _marked(vocabulary, row.leaf)] for row in listed]
    widths = [max(map(len, column)) for column in zip(head, *cells, strict=True)]
    return [_aligned(line, widths) for line in (head, ["─" * width for width in widths], *cells)]


def _cells(vocabulary: Vocabulary, row: Row, asked: Sequence[int]) -> Iterator[str]:
    """For each variable that some row asks for, the values that it may have."""
    allowed = dict(row.condition)
    for variable in asked:
        known = vocabulary.variables[variable][1]
        yield _alternatives(known, allowed[variable]) if variable in allowed else _ANY


def _aligned(cells: Sequence[str], widths: Sequence[int]) -> str:
    first, *others = zip(cells, widths, strict=True)
    texts = [f"{first[0]:>{first[1]}}", *(f"{text:<{width}}" for text, width in others)]
    return "  ".join(texts).rstrip()


def row_json(vocabulary: Vocabulary, row: Row) -> dict[str, object]:
    """A row for a program; `actions` are null where nothing is decided, and missing where decisions differ."""
    variables = ((*vocabulary.variables[variable], values) for variable, values in sorted(row.condition))
    condition = named_json((name, [known[value] for value in values]) for name, known, values in variables)
    found: dict[str, object] = {"condition": condition, "states": row.leaf.states}
    if isinstance(row.leaf, Folded):
        return {**found, "decisions": row.leaf.decisions}
    label = row.leaf.label
    actions = None if label.actions is None else [vocabulary.actions[action] for action in label.actions]
    return {**found, "actions": actions, "unsafe": label.unsafe}
