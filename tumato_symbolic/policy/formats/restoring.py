"""The section `Restoring` of a certificate: how safety is restored in several steps (`docs/certificate.md`)."""

from __future__ import annotations

from collections.abc import Iterator
from json import dumps as _json
from typing import Any

from tumato_symbolic.diagnostics import Code
from tumato_symbolic.diagrams import Diagram, rebuild
from tumato_symbolic.policy.formats.read_diagrams import read_diagram
from tumato_symbolic.policy.formats.write_diagrams import block, diagram_lines
from tumato_symbolic.policy.records import Deviation, Restoring, Vocabulary
from tumato_symbolic.policy.text import as_list, as_names, as_object, as_text, as_whole, fault, member, show
from tumato_symbolic.semantics import ActionSet, Effort, State

_TITLE = "Certificate.Restoring"


def read_restoring(value: object, vocabulary: Vocabulary) -> Restoring:
    """The section as a record. Raises `UserError`."""
    where = f"`{_TITLE}`"
    section = as_object(value, where)
    order, leaves, nodes = read_diagram(section, _TITLE, vocabulary)
    efforts = tuple(_effort(leaf) for leaf in leaves)
    if len(set(efforts)) != len(efforts):
        raise fault(Code.TUM502, f"`{_TITLE}.Leaves` has an entry twice")
    end = len(leaves) + len(nodes)
    worst, nominal = (as_whole(member(section, name, where), f"`{_TITLE}.{name}`", end) for name in _ROOTS)
    listed = as_list(member(section, "Deviations", where), f"`{_TITLE}.Deviations`")
    deviations = tuple(_deviation(entry, n, vocabulary) for n, entry in enumerate(listed, 1))
    found: Diagram[Effort | None] = Diagram(order, efforts, nodes)
    diagram, roots = rebuild(found, (worst, nominal))
    return Restoring(diagram, roots[0], roots[1], deviations)


_ROOTS = ("Worst", "Nominal")


def _effort(leaf: object) -> Effort | None:
    if leaf is None:
        return None
    here = f"an entry of `{_TITLE}.Leaves`"
    pair = as_list(leaf, here)
    if len(pair) != 2:
        raise fault(Code.TUM502, f"{here} is {show(leaf)}, expected null or a duration and a number of steps")
    return as_whole(pair[0], here), as_whole(pair[1], here)


def _deviation(entry: object, number: int, vocabulary: Vocabulary) -> Deviation:
    here = f"deviation {number} of `{_TITLE}`"
    section = as_object(entry, here)
    better = as_names(member(section, "Better", here), f"`Better` of {here}")
    for name in better:
        if name not in vocabulary.actions:
            raise fault(Code.TUM505, f"`Better` of {here} mentions the unknown action {show(name)}")
    chosen: ActionSet = frozenset(map(vocabulary.actions.index, better))
    state, missed = (_state(section, name, here, vocabulary) for name in ("State", "Missed"))
    return Deviation(state, chosen, missed)


def _state(section: dict[str, Any], name: str, here: str, vocabulary: Vocabulary) -> State:
    named = as_object(member(section, name, here), f"`{name}` of {here}")
    known = dict(vocabulary.variables)
    for variable, value in named.items():
        if variable not in known:
            raise fault(Code.TUM503, f"`{name}` of {here} has the unknown variable {show(variable)}")
        if as_text(value, f"{show(variable)} in `{name}` of {here}") not in known[variable]:
            raise fault(Code.TUM504, f"`{name}` of {here} gives {show(variable)} the unknown value {show(value)}")
    for variable in known:
        if variable not in named:
            raise fault(Code.TUM503, f"`{name}` of {here} has no value for {show(variable)}")
    return tuple(values.index(named[variable]) for variable, values in vocabulary.variables)


def restoring_lines(restoring: Restoring, vocabulary: Vocabulary) -> Iterator[str]:
    """The section as lines of JSON."""
    diagram, roots = rebuild(restoring.efforts, (restoring.worst, restoring.nominal))
    yield '    "Restoring": {'
    yield from (f"  {line}" for line in diagram_lines(diagram, vocabulary))
    for name, root in zip(_ROOTS, roots, strict=True):
        yield f'      "{name}": {root},'
    deviations = (_json(_written(each, vocabulary)) for each in restoring.deviations)
    yield from block('      "Deviations": [', deviations, "      ]")
    yield "    }"


def _written(deviation: Deviation, vocabulary: Vocabulary) -> dict[str, Any]:
    def named(state: State) -> dict[str, str]:
        return {name: values[value] for (name, values), value in zip(vocabulary.variables, state, strict=True)}

    better = [vocabulary.actions[action] for action in sorted(deviation.better)]
    return {"State": named(deviation.state), "Better": better, "Missed": named(deviation.missed)}
