"""A policy as a graph of questions, in the languages of Graphviz and Mermaid."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from tumato_symbolic.diagnostics.cubes import shown
from tumato_symbolic.policy import Vocabulary
from tumato_symbolic.report.trees import folded_text, label_text
from tumato_symbolic.views import Box


def dot_lines(vocabulary: Vocabulary, boxes: Sequence[Box], title: str) -> Iterator[str]:
    """The graph for `dot`: questions are ellipses, what is done stands in boxes, red in unsafe states."""
    names = {box.reference: f"n{number}" for number, box in enumerate(boxes)}
    yield "digraph policy {"
    yield f'  graph [label={_quoted(title)}, labelloc=t, fontname="Helvetica"];'
    yield '  node [fontname="Helvetica", shape=box, style=filled, fillcolor="#eef4ee"];'
    yield '  edge [fontname="Helvetica", fontsize=10];'
    for box in boxes:
        yield f"  {names[box.reference]} [label={_quoted(box_text(vocabulary, box))}{_DOT_STYLES[_kind(box)]}];"
    for box in boxes:
        for values, below in box.branches:
            label = _quoted(edge_text(vocabulary, box, values))
            yield f"  {names[box.reference]} -> {names[below]} [label={label}];"
    yield "}"


def mermaid_lines(vocabulary: Vocabulary, boxes: Sequence[Box], title: str) -> Iterator[str]:
    """The same as a flowchart of Mermaid, which Markdown shows in many places."""
    names = {box.reference: f"n{number}" for number, box in enumerate(boxes)}
    yield "---"
    yield f"title: {_quoted(title)}"
    yield "---"
    yield "flowchart TD"
    for box in boxes:
        kind = _kind(box)
        before, after = ("{{", "}}") if kind == "question" else ("[", "]")
        yield f"  {names[box.reference]}{before}{_entities(box_text(vocabulary, box))}{after}:::{kind}"
    for box in boxes:
        for values, below in box.branches:
            label = _entities(edge_text(vocabulary, box, values))
            yield f"  {names[box.reference]} -->|{label}| {names[below]}"
    kinds = {_kind(box) for box in boxes}
    yield from (f"  classDef {kind} {style}" for kind, style in _MERMAID_STYLES.items() if kind in kinds)


def box_text(vocabulary: Vocabulary, box: Box) -> str:
    """What stands in a box: the variable that is asked for, what is done, or how much is not shown."""
    if box.variable is not None:
        return shown(vocabulary.variables[box.variable][0])
    return folded_text(box.decisions) if box.label is None else label_text(vocabulary, box.label)


def edge_text(vocabulary: Vocabulary, box: Box, values: Sequence[int]) -> str:
    """The values that lead on from a question, a line for each."""
    known = vocabulary.variables[box.variable][1] if box.variable is not None else ()
    return "\n".join(shown(known[value]) for value in values)


def _kind(box: Box) -> str:
    if box.variable is not None:
        return "question"
    if box.label is None:
        return "folded"
    if box.label.other:
        return "other"
    return "undecided" if box.label.actions is None else "unsafe" if box.label.unsafe else "done"


_DOT_STYLES = {
    "question": ', shape=ellipse, fillcolor="#ffffff"',
    "folded": ', style=dashed, color="#777777"',
    "other": ", style=dotted",
    "undecided": ", style=dotted",
    "unsafe": ', fillcolor="#f6d5d5"',
    "done": "",
}

_MERMAID_STYLES = {
    "question": "fill:#ffffff,stroke:#555555,color:#000000",
    "folded": "fill:#ffffff,stroke:#777777,stroke-dasharray:4,color:#000000",
    "other": "fill:#ffffff,stroke:#ffffff,color:#000000",
    "undecided": "fill:#ffffff,stroke:#777777,stroke-dasharray:1,color:#000000",
    "unsafe": "fill:#f6d5d5,stroke:#555555,color:#000000",
    "done": "fill:#eef4ee,stroke:#555555,color:#000000",
}


def _quoted(text: str) -> str:
    """A text of Graphviz, and of YAML."""
    escaped = text.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n")
    return f'"{escaped}"'


def _entities(text: str) -> str:
    """A text of Mermaid: all that could mean something there is written by its number."""
    numbered = (each if each.isalnum() or each in _PLAIN else f"#{ord(each)};" for each in text)
    return f'"{"".join(numbered).replace(_NEW_LINE, "<br>")}"'


_PLAIN = " _,.…()–"
_NEW_LINE = f"#{ord(chr(10))};"
