"""A policy, or a part of one, for a person, for a program and as a graph."""

from __future__ import annotations

import shlex
from collections.abc import Iterator, Sequence

from msgspec import Struct

from tumato_symbolic.diagnostics.cubes import actions_text, named_cube_text
from tumato_symbolic.policy import RuleList
from tumato_symbolic.report.cubes import named_json
from tumato_symbolic.report.layout import count
from tumato_symbolic.report.rules import rule_lines, rules_json
from tumato_symbolic.report.trees import row_json, table_lines, tree_lines
from tumato_symbolic.views import Answer, Folded, Row, Selected, Selection, Tree, rows


class Shown(Struct, frozen=True):
    """What a policy file does in the states of a selection. `specification` is the file that says which are valid.

    `selected` are these states, `content` what is shown of them: rules, or a tree in the form of a `table` or not; None
    of no states.
    """

    path: str
    specification: str | None
    selection: Selection
    selected: Selected
    content: RuleList | Tree | None
    table: bool = False

    @property
    def states(self) -> int:
        """How many states are looked at."""
        return self.selected.sets.count(self.selected.states)

    @property
    def decided(self) -> int:
        """How many of them the policy decides."""
        return self.selected.sets.count(self.selected.decided)

    @property
    def is_incomplete(self) -> bool:
        """Whether a limit was met before there were rules for all states."""
        return isinstance(self.content, RuleList) and self.content.left > 0


def as_text(done: Shown) -> str:
    """The report for a person."""
    return "\n".join((*_head(done), *_body(done)))


def title(done: Shown) -> str:
    """What is shown, in one line."""
    return next(_head(done))


def _head(done: Shown) -> Iterator[str]:
    """How many states are looked at, and how many of them are decided."""
    states, decided = done.states, done.decided
    noun = "state" if done.specification is None else "valid state"
    where = _where(done)
    if done.selection.executing:
        chosen = actions_text(done.selection.executing)
        in_states = f"in {count(states, noun)}" if states else "in no state"
        yield f"{done.path} executes {chosen} {in_states}{where}."
        return
    if decided == states:
        yield f"{done.path} decides {'all ' if where and states > 1 else ''}{count(states, noun)}{where}."
        return
    others = "the other one is" if states - decided == 1 else f"the other {states - decided:,} are"
    some = f"{decided:,} of {count(states, noun)}{where}; {others} undecided"
    yield f"{done.path} decides {some if decided else f'none of {count(states, noun)}{where}'}."
    if done.specification is None:
        yield "With the specification, states that its assumptions exclude are left out."


def _where(done: Shown) -> str:
    said = named_cube_text(dict(done.selected.vocabulary.variables), done.selection.values, " and ")
    return f" where {said}" if said else ""


def _body(done: Shown) -> Iterator[str]:
    vocabulary, content = done.selected.vocabulary, done.content
    if content is None or (isinstance(content, RuleList) and not content.rules and not content.left):
        return
    yield ""
    if isinstance(content, RuleList):
        yield from rule_lines(dict(vocabulary.variables), content, done.decided)
        return
    yield from (table_lines if done.table else tree_lines)(vocabulary, content)
    listed = rows(content)
    if any(isinstance(row.leaf, Answer) and row.leaf.label.unsafe for row in listed):
        yield ""
        yield "! marks states that break a state rule."
    yield from _left_out(done, listed)


def _left_out(done: Shown, listed: Sequence[Row]) -> Iterator[str]:
    """How many states are not shown one by one, and how to see them."""
    folded = [row for row in listed if isinstance(row.leaf, Folded)]
    if not folded:
        return
    left = sum(row.leaf.states for row in folded)
    yield ""
    yield (
        f"{count(len(folded), 'line stands', 'lines stand')} for {count(left, 'state')} with different decisions. "
        "--limit N shows more lines, --format rules may say it shorter, and values show a part:"
    )
    yield f"  {command(done, max(folded, key=lambda row: row.leaf.states))}"


def command(done: Shown, row: Row) -> str:
    """The command that shows the states of a row."""
    allowed = dict(done.selection.values)
    for variable, values in row.condition:
        name, known = done.selected.vocabulary.variables[variable]
        allowed[name] = tuple(known[value] for value in values)
    words = [f"{name}={','.join(values)}" for name, values in allowed.items()]
    spec = [] if done.specification is None else [done.specification]
    executing = ["--executing", ",".join(done.selection.executing)] if done.selection.executing else []
    return shlex.join(["tumato-sym", "show", done.path, *spec, *words, *executing])


def as_json(done: Shown) -> dict[str, object]:
    """The report for a program."""
    return {
        "verdict": "undecided" if done.is_incomplete else "ok",
        "policy": done.path,
        "specification": done.specification,
        "where": named_json(done.selection.values),
        "executing": list(done.selection.executing),
        "states": done.decided,
        "undecided": done.states - done.decided,
        **_content_json(done),
    }


def _content_json(done: Shown) -> dict[str, object]:
    content = done.content
    if isinstance(content, RuleList):
        return rules_json(content)
    return {"rows": [] if content is None else [row_json(done.selected.vocabulary, row) for row in rows(content)]}
