"""Where two policies decide otherwise, for a person and for a program."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from tumato_symbolic.diagnostics.cubes import named_cube_text, shown
from tumato_symbolic.report.cubes import named_json
from tumato_symbolic.report.layout import count
from tumato_symbolic.spec import value_of
from tumato_symbolic.views import Change, Decided, Difference

_CHANGES = 20
"""So many changed decisions are told."""

_CUBES = 4
"""So many groups of states are told of each."""


def difference_lines(title: str, found: Difference, noun: str) -> Iterator[str]:
    """What differs, in how many states (which `noun` calls what they are), and what is not shown."""
    names = list(names_lines(found))
    if not found.changed:
        but = ", but their names differ" if names else ""
        yield f"{title}: {count(found.compared, noun)} decided, all alike{but}."
    else:
        yield f"{title}: {found.changed:,} of {count(found.compared, noun)} decided otherwise."
    if names:
        yield from ("", *names)
    for change in found.changes[:_CHANGES]:
        yield from ("", *change_lines(found, change))
    yield from _left(found)


def names_lines(found: Difference) -> Iterator[str]:
    """What only one of them has, and how states are compared then."""
    names = found.names
    for name, values in names.added_variables:
        yield f"+ variable {_declared(name, values)}: an old decision counts for each of its values"
    for name, values in names.removed_variables:
        yield f"- variable {_declared(name, values)}: a new decision counts for each of its values"
    for name, values in names.added_values:
        yield f"+ {_of(name, values)}, of which the old policy knows no state"
    for name, values in names.removed_values:
        yield f"- {_of(name, values)}, of which the new policy knows no state"
    yield from (f"+ action {shown(name)}" for name in names.added_actions)
    yield from (f"- action {shown(name)}" for name in names.removed_actions)


def _declared(name: str, values: Sequence[str]) -> str:
    return f"{shown(name)} ({', '.join(map(shown, values))})"


def _of(name: str, values: Sequence[str]) -> str:
    return f"{'value' if len(values) == 1 else 'values'} {', '.join(map(shown, values))} of {shown(name)}"


def change_lines(found: Difference, change: Change) -> Iterator[str]:
    """`in 3,072 states: {charge} → {}`, and where."""
    yield f"in {count(change.states, 'state')}: {_change_text(change)}"
    yield from (f"  {line}" for line in _where(found, change))


def _change_text(change: Change) -> str:
    return f"{_decided(change.before)} → {_decided(change.after)}"


def _decided(decided: Decided) -> str:
    if not decided.known:
        return "no such state"
    if decided.actions is None:
        return "undecided"
    return f"{{{', '.join((*([] if decided.whole else ['…']), *map(shown, decided.actions)))}}}"


def _where(found: Difference, change: Change) -> Iterator[str]:
    if change.cubes is None:
        yield f"such as {' '.join(f'{name}={value}' for name, value in change.example)}"
        return
    known = dict(found.variables)
    texts = [named_cube_text(known, cube, " and ") for cube in change.cubes]
    if texts == [""]:
        yield "everywhere"
        return
    yield from (f"{'or' if number else 'where'} {text}" for number, text in enumerate(texts[:_CUBES]))
    if len(texts) > _CUBES:
        yield f"or {len(texts) - _CUBES:,} more"


def _left(found: Difference) -> Iterator[str]:
    """What is not shown, and then the changes by action."""
    left = None if found.left is None else found.left + len(found.changes[_CHANGES:])
    if left == 0 and found.limit is None:
        return
    yield ""
    if left:
        yield f"{count(left, 'more kind')} of change {'is' if left == 1 else 'are'} left out. By action:"
    elif left is None:
        yield "The changes are not described one by one. By action:"
    if left or left is None:
        for each in found.by_action:
            parts = [(each.started, "newly executed"), (each.stopped, "no longer executed")]
            said = " and ".join(f"{what} in {count(number, 'state')}" for number, what in parts if number)
            yield f"  {shown(each.action)}: {said}"
    if found.limit is not None:
        yield f"Something is left out: {found.limit}."


def difference_json(found: Difference) -> dict[str, object]:
    """What differs, with values that are numbers as numbers."""
    names = found.names
    return {
        "compared": found.compared,
        "changed": found.changed,
        "names": {
            "added_variables": named_json(names.added_variables),
            "removed_variables": named_json(names.removed_variables),
            "added_values": named_json(names.added_values),
            "removed_values": named_json(names.removed_values),
            "added_actions": list(names.added_actions),
            "removed_actions": list(names.removed_actions),
        },
        "changes": [_change_json(change) for change in found.changes],
        "by_action": [
            {"action": each.action, "started": each.started, "stopped": each.stopped} for each in found.by_action
        ],
        "left": found.left,
        "limit": found.limit,
    }


def _change_json(change: Change) -> dict[str, object]:
    cubes = change.cubes
    return {
        "before": _decided_json(change.before),
        "after": _decided_json(change.after),
        "states": change.states,
        "cubes": None if cubes is None else [named_json(cube) for cube in cubes],
        "example": {name: value_of(value) for name, value in change.example},
    }


def _decided_json(decided: Decided) -> dict[str, object]:
    actions = None if decided.actions is None else list(decided.actions)
    return {"known": decided.known, "whole": decided.whole, "actions": actions}
