"""A certificate of what a policy guarantees beyond nominal runs, as a file (`docs/certificate.md`)."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from json import dumps as _json
from pathlib import Path

from tumato_symbolic.diagrams import Diagram, Reference, rebuild
from tumato_symbolic.policy.formats import FORMAT_VERSION, block, diagram_lines, variable_entries
from tumato_symbolic.policy.records import Vocabulary
from tumato_symbolic.policy.text import save_text
from tumato_symbolic.spec import Ordering, Restoration

GUARANTEES = "guarantees"
"""The `Type` of such a file."""


@dataclass(frozen=True, slots=True)
class CertifiedGoal:
    """A residual goal, as in `RankedGoal`, with the ranks of its fixpoints.

    `surviving` has a root for each of `W_0, W_1, …, W_ω`: the number of nominal steps to the goal, None outside.
    `forced` leads to the worst number of steps in `G`.
    """

    bodies: tuple[str, ...]
    executed: tuple[str, ...]
    surviving: tuple[Reference, ...]
    forced: Reference


@dataclass(frozen=True, slots=True)
class CertifiedLevel:
    """A level with the number of its states, and cubes of them: for some variables the values that they may have."""

    level: str
    steps: int | None
    deviations: int | None
    states: int
    cubes: tuple[dict[str, list[str]], ...] | None


@dataclass(frozen=True, slots=True)
class GuaranteesCertificate:
    """All that is claimed, for one specification, ordering and restoration."""

    vocabulary: Vocabulary
    digest: str
    ordering: Ordering
    restoration: Restoration
    ranks: Diagram[int | None]
    goals: tuple[CertifiedGoal, ...]
    levels: tuple[CertifiedLevel, ...]


def save(certificate: GuaranteesCertificate, path: Path) -> None:
    """Write the certificate to `path`, all or nothing. Raises `UserError` (TUM510)."""
    save_text(dumps(certificate), path, "certificate")


def dumps(certificate: GuaranteesCertificate) -> str:
    """The certificate as JSON text in ASCII, always the same for equal ones."""
    return "\n".join(_lines(certificate)) + "\n"


def _lines(certificate: GuaranteesCertificate) -> Iterator[str]:
    vocabulary = certificate.vocabulary
    roots = [root for goal in certificate.goals for root in (*goal.surviving, goal.forced)]
    diagram, renewed = rebuild(certificate.ranks, roots)
    known = dict(zip(roots, renewed, strict=True))
    yield "{"
    yield f'  "Type": "{GUARANTEES}",'
    yield f'  "FormatVersion": {FORMAT_VERSION},'
    yield f'  "SpecificationDigest": {_json(certificate.digest)},'
    yield f'  "EffectOrdering": "{certificate.ordering}",'
    yield f'  "Restoration": "{certificate.restoration}",'
    yield from block('  "Actions": [', map(_json, vocabulary.actions), "  ],")
    yield from block('  "States": {', variable_entries(vocabulary), "  },")
    yield '  "Ranks": {'
    yield from diagram_lines(diagram, vocabulary)
    goals = (
        _json(
            {
                "Bodies": goal.bodies,
                "Executed": goal.executed,
                "Surviving": [known[root] for root in goal.surviving],
                "Forced": known[goal.forced],
            }
        )
        for goal in certificate.goals
    )
    yield from block('    "Goals": [', goals, "    ]")
    yield "  },"
    levels = (
        _json(
            {
                "Level": each.level,
                "Steps": each.steps,
                "Deviations": each.deviations,
                "States": each.states,
                "Cubes": each.cubes,
            }
        )
        for each in certificate.levels
    )
    yield from block('  "Levels": [', levels, "  ]")
    yield "}"
