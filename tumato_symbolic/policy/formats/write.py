"""A policy to JSON text. The format is described in `docs/policy.md`."""

from __future__ import annotations

from collections.abc import Iterator
from json import dumps as _json

from tumato_symbolic.diagrams import rebuild
from tumato_symbolic.policy.formats.read import FORMAT_VERSION
from tumato_symbolic.policy.formats.restoring import restoring_lines
from tumato_symbolic.policy.formats.write_diagrams import block, diagram_lines
from tumato_symbolic.policy.records import Certificate, DecisionDiagram, PolicyFields, Table, Vocabulary
from tumato_symbolic.policy.text import MAX_BYTES, too_large

FRAMEWORK_VERSION = "0.0.0"
"""What policies of Tumato 2.0 carry as `PolicyFrameworkVersion`."""


def fits_table(vocabulary: Vocabulary) -> bool:
    """Whether the table format can hold the policy: a variable named `Actions` would share its key with the actions."""
    return all(name != "Actions" for name, _ in vocabulary.variables)


def policy_text(policy: PolicyFields) -> str:
    """A policy as JSON text in ASCII; a table has to be one that the format can hold (`fits_table`).

    Raises `UserError` (TUM508) where the text would be larger than what is read.
    """
    text = "\n".join(_lines(policy)) + "\n"
    if len(text) > MAX_BYTES:
        raise too_large("policy")
    return text


def _lines(policy: PolicyFields) -> Iterator[str]:
    vocabulary = policy.vocabulary
    yield "{"
    yield f'  "PolicyFrameworkVersion": {_json(FRAMEWORK_VERSION)},'
    yield f'  "Type": "{"policy" if isinstance(policy.decisions, Table) else "policy-diagram"}",'
    yield f'  "FormatVersion": {FORMAT_VERSION},'
    if policy.digest is not None:
        yield f'  "SpecificationDigest": {_json(policy.digest)},'
    if policy.ordering is not None:
        yield f'  "EffectOrdering": "{policy.ordering}",'
    if policy.restoration != "one_step":
        yield f'  "Restoration": "{policy.restoration}",'
    yield from block('  "Actions": [', map(_json, vocabulary.actions), "  ],")
    yield from block('  "States": {', variable_entries(vocabulary), "  },")
    last = "" if policy.certificate is None else ","
    if isinstance(policy.decisions, Table):
        yield from block('  "Policy": [', _rows(policy.decisions, vocabulary), f"  ]{last}")
    else:
        yield from _decisions(policy.decisions, vocabulary, last)
    if policy.certificate is not None:
        yield from _certificate(policy.certificate, vocabulary)
    yield "}"


def variable_entries(vocabulary: Vocabulary) -> Iterator[str]:
    """The entries of `States`."""
    for name, values in vocabulary.variables:
        yield f"{_json(name)}: {_json({value: number for number, value in enumerate(values)})}"


def _rows(table: Table, vocabulary: Vocabulary) -> Iterator[str]:
    cells = [[f"{_json(name)}: {_json(value)}" for value in values] for name, values in vocabulary.variables]
    names = {
        chosen: _json([vocabulary.actions[action] for action in sorted(chosen)]) for chosen in set(table.rows.values())
    }
    for state, chosen in sorted(table.rows.items()):
        shown = ", ".join([values[value] for values, value in zip(cells, state, strict=True)])
        yield f'{{{shown}, "Actions": {names[chosen]}}}'


def _decisions(decisions: DecisionDiagram, vocabulary: Vocabulary, last: str) -> Iterator[str]:
    diagram, roots = rebuild(decisions.diagram, (*decisions.roots, decisions.defined))
    yield '  "Diagram": {'
    yield from diagram_lines(diagram, vocabulary)
    yield f'    "Roots": {_json(dict(zip(vocabulary.actions, roots, strict=False)))},'
    yield f'    "Defined": {roots[-1]}'
    yield f"  }}{last}"


def _certificate(certificate: Certificate, vocabulary: Vocabulary) -> Iterator[str]:
    ranks, roots = rebuild(certificate.ranks, [goal.root for goal in certificate.goals])
    yield '  "Certificate": {'
    yield from diagram_lines(ranks, vocabulary)
    goals = [
        _json({"Bodies": goal.bodies, "Executed": goal.executed, "Root": root})
        for goal, root in zip(certificate.goals, roots, strict=True)
    ]
    yield from block('    "Goals": [', goals, "    ]" if certificate.restoring is None else "    ],")
    if certificate.restoring is not None:
        yield from restoring_lines(certificate.restoring, vocabulary)
    yield "  }"
