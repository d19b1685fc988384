"""A certificate of unrealizability as a file (`docs/certificate.md`)."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from json import dumps as _json
from pathlib import Path
from typing import Any

from tumato_symbolic.diagnostics import Source, UserError
from tumato_symbolic.diagrams import rebuild
from tumato_symbolic.policy.formats import FORMAT_VERSION, UNREALIZABLE, block, diagram_lines, variable_entries
from tumato_symbolic.policy.records import Vocabulary
from tumato_symbolic.policy.text import MAX_BYTES, as_object, parse_json, read_text, save_text, too_large
from tumato_symbolic.policy.unrealizability.read import unrealizability_of
from tumato_symbolic.policy.unrealizability.records import (
    Conflict,
    NoAllowedSet,
    NoPlan,
    NoRestoration,
    Unrealizability,
    Violation,
)
from tumato_symbolic.semantics import State


def loads(text: str, name: str = "certificate") -> Unrealizability:
    """The certificate that `text` describes; `name` is what it is called in messages.

    Raises `UserError` (TUM501 to TUM505, TUM508) for text that is no certificate.
    """
    try:
        return unrealizability_of(as_object(parse_json(text, name), "the certificate"))
    except UserError as error:
        raise UserError(error.diagnostics, error.source or Source(name, "")) from None


def load(path: str) -> Unrealizability:
    """The certificate in the file at `path`; `-` is standard input. Raises `UserError` as `loads` does."""
    return loads(*read_text(path))


def save(certificate: Unrealizability, path: Path) -> None:
    """Write the certificate to `path`, all or nothing. Raises `UserError` (TUM508, TUM510)."""
    save_text(dumps(certificate), path, "certificate")


def dumps(certificate: Unrealizability) -> str:
    """The certificate as JSON text in ASCII, always the same for equal ones.

    Raises `UserError` (TUM508) where the text would be larger than `loads` accepts.
    """
    text = "\n".join(_lines(certificate)) + "\n"
    if len(text) > MAX_BYTES:
        raise too_large("certificate", "certificate")
    return text


def _lines(certificate: Unrealizability) -> Iterator[str]:
    vocabulary = certificate.vocabulary
    yield "{"
    yield f'  "Type": "{UNREALIZABLE}",'
    yield f'  "FormatVersion": {FORMAT_VERSION},'
    yield f'  "SpecificationDigest": {_json(certificate.digest)},'
    yield f'  "EffectOrdering": "{certificate.ordering}",'
    if certificate.restoration != "one_step":
        yield f'  "Restoration": "{certificate.restoration}",'
    yield from block('  "Actions": [', map(_json, vocabulary.actions), "  ],")
    yield from block('  "States": {', variable_entries(vocabulary), "  },")
    yield '  "Reason": {'
    names = _Names(vocabulary)
    match certificate.reason:
        case NoAllowedSet() as reason:
            yield from _no_allowed_set(reason, names)
        case NoRestoration() as reason:
            yield from _no_restoration(reason, vocabulary, names)
        case NoPlan() as reason:
            yield from _no_plan(reason, vocabulary, names)
        case Conflict() as reason:
            yield from _conflict(reason, vocabulary, names)
    yield "  }"
    yield "}"


class _Names:
    """Numbers to names."""

    def __init__(self, vocabulary: Vocabulary) -> None:
        self._vocabulary = vocabulary

    def actions(self, numbers: Iterable[int]) -> list[str]:
        """Actions, in the order given."""
        return [self._vocabulary.actions[number] for number in numbers]

    def assignment(self, pairs: Iterable[tuple[int, int]]) -> dict[str, str]:
        """Value by variable."""
        variables = self._vocabulary.variables
        return {variables[number][0]: variables[number][1][value] for number, value in pairs}

    def state(self, state: State) -> dict[str, str]:
        """Value by variable."""
        return self.assignment(enumerate(state))

    def violation(self, violation: Violation) -> Mapping[str, Any]:
        """The condition with what its kind needs."""
        match violation.kind:
            case "precondition" | "resource" | "nominal-conflict":
                return {"Kind": violation.kind, "Actions": self.actions(violation.actions)}
            case "reaction-rule":
                return {"Kind": violation.kind, "Rule": violation.rule}
            case "unsafe" | "falsified":
                effects = [
                    {"Action": self.actions([action])[0], "Effect": self.assignment(effect)}
                    for action, effect in violation.outcome
                ]
                pending = {"Actions": self.actions(violation.actions)} if violation.kind == "falsified" else {}
                return {"Kind": violation.kind, **pending, "Outcome": effects}
            case _:
                return {"Kind": violation.kind}


def _no_allowed_set(reason: NoAllowedSet, names: _Names) -> Iterator[str]:
    yield '    "Kind": "no-allowed-set",'
    yield f'    "State": {_json(names.state(reason.state))},'
    if reason.cubes is None:
        yield '    "Cubes": null'
        return
    cubes = (
        {
            "Executed": names.actions(sorted(cube.executed)),
            "Idle": names.actions(sorted(cube.idle)),
            "Violation": names.violation(cube.violation),
        }
        for cube in reason.cubes
    )
    yield from block('    "Cubes": [', map(_json, cubes), "    ]")


def _no_restoration(reason: NoRestoration, vocabulary: Vocabulary, names: _Names) -> Iterator[str]:
    yield '    "Kind": "no-restoration",'
    yield f'    "State": {_json(names.state(reason.state))},'
    diagram, (root,) = rebuild(reason.diagram, [reason.root])
    yield from diagram_lines(diagram, vocabulary)
    yield f'    "Root": {root}'


def _no_plan(reason: NoPlan, vocabulary: Vocabulary, names: _Names) -> Iterator[str]:
    yield '    "Kind": "no-plan",'
    yield f'    "State": {_json(names.state(reason.state))},'
    diagram, kept = rebuild(reason.diagram, [root for goal in reason.goals for root in goal.roots])
    roots = iter(kept)
    yield from diagram_lines(diagram, vocabulary)
    goals = [
        {"Bodies": goal.bodies, "Executed": goal.executed, "Layers": [next(roots) for _ in goal.roots]}
        for goal in reason.goals
    ]
    yield from block('    "Goals": [', map(_json, goals), "    ]")


def _conflict(reason: Conflict, vocabulary: Vocabulary, names: _Names) -> Iterator[str]:
    yield '    "Kind": "conflict",'
    yield f'    "Starts": {_json(reason.starts)},'
    choices = (
        {
            "State": names.state(choice.state),
            "Options": [{"Successor": names.state(after), "Goal": goal} for after, goal in choice.options],
        }
        for choice in reason.choices
    )
    yield from block('    "Choices": [', map(_json, choices), "    ],")
    cuts = (
        {
            "Kind": cut.kind,
            "Goal": cut.goal,
            "States": cut.states,
            **({} if cut.end is None else {"End": names.state(cut.end)}),
        }
        for cut in reason.cuts
    )
    yield from block('    "Cuts": [', map(_json, cuts), "    ],")
    diagram, roots = rebuild(reason.distances, [goal.root for goal in reason.goals])
    yield from diagram_lines(diagram, vocabulary)
    goals = [
        {"Bodies": goal.bodies, "Executed": goal.executed, "Root": root}
        for goal, root in zip(reason.goals, roots, strict=True)
    ]
    yield from block('    "Goals": [', map(_json, goals), "    ]")
