"""A small policy as text: a tree of questions about the state, with the actions at its leaves."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TypeAlias

from tumato_symbolic.semantics import ActionSet, State, action_names, is_safe
from tumato_symbolic.spec import Spec

_Rows: TypeAlias = Sequence[tuple[State, str]]


@dataclass(frozen=True, slots=True)
class _Line:
    depth: int
    question: str
    answer: str | None


def policy_tree(spec: Spec, rows: Mapping[State, ActionSet]) -> list[str]:
    """The decisions, with as few questions as a greedy choice finds; `!` marks states that break a state rule."""
    labelled = [(state, _label(spec, state, chosen)) for state, chosen in rows.items()]
    lines = _tree(spec, labelled, frozenset(range(len(spec.variables))), 0)
    width = max((2 * line.depth + len(line.question) for line in lines), default=0)
    return [_draw(line, width) for line in lines]


def _label(spec: Spec, state: State, chosen: ActionSet) -> str:
    names = ", ".join(action_names(spec, chosen)) or "(nothing)"
    return f"{' ' if is_safe(spec, state) else '!'} {names}"


def _draw(line: _Line, width: int) -> str:
    text = "  " * line.depth + line.question
    return text if line.answer is None else f"{text:<{width}}  {line.answer}"


def _tree(spec: Spec, rows: _Rows, free: frozenset[int], depth: int) -> list[_Line]:
    labels = {label for _, label in rows}
    if len(labels) == 1:
        return [_Line(depth, "always", labels.pop())]
    splits = {variable: _split(rows, variable) for variable in sorted(free)}
    best = min((each for each in splits if len(splits[each]) > 1), key=lambda each: _cost(splits[each]))
    variable = spec.variables[best]
    lines = []
    for values, part in splits[best]:
        question = f"{variable.name} {' or '.join(variable.values[value] for value in values)}"
        below = _tree(spec, part, free - {best}, depth + 1)
        if len(below) == 1:
            lines.append(_Line(depth, question, below[0].answer))
        else:
            lines += [_Line(depth, question, None), *below]
    return lines


def _split(rows: _Rows, variable: int) -> list[tuple[tuple[int, ...], _Rows]]:
    """The rows by value of one variable; values that make no difference to each other stay together."""
    by_value: dict[int, list[tuple[State, str]]] = {}
    for state, label in rows:
        by_value.setdefault(state[variable], []).append((state, label))
    parts: dict[frozenset[tuple[State, str]], tuple[tuple[int, ...], _Rows]] = {}
    for value, part in sorted(by_value.items()):
        rest = frozenset(((*state[:variable], *state[variable + 1 :]), label) for state, label in part)
        values = parts[rest][0] if rest in parts else ()
        parts[rest] = ((*values, value), part)
    return list(parts.values())


def _cost(parts: Sequence[tuple[tuple[int, ...], _Rows]]) -> tuple[int, int]:
    """How many lines a question will need at least: one for every answer that differs below it."""
    distinct = [len({label for _, label in part}) for _, part in parts]
    return sum(distinct) + sum(number > 1 for number in distinct), len(parts)
