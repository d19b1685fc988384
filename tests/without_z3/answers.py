"""Policies and certificates of the examples and of generated specifications, to be compared with and without Z3."""

from __future__ import annotations

import hashlib
from typing import Literal

from msgspec.structs import replace

from tests.generate import random_spec
from tests.profiles import ALL_PROFILES
from tests.repo.examples import EXAMPLES
from tumato_symbolic import parse
from tumato_symbolic.policy import dumps, unrealizability
from tumato_symbolic.spec import Restoration, Spec
from tumato_symbolic.synthesis import Realizable, Undecided, Unrealizable, synthesize

Answer = tuple[str, Literal["Realizable", "Unrealizable", "Undecided"], str]

_RESTORATIONS: tuple[Restoration, ...] = ("one_step", "one_step", "one_step", "bounded", "fair")


def main(first: str, count: str) -> list[Answer]:
    """Name, kind and digest of every answer; why there is none in place of a digest."""
    found = [_answer(example.name, parse(example.read_text())) for example in EXAMPLES] if first == "0" else []
    names = sorted(ALL_PROFILES)
    for seed in range(int(first), int(first) + int(count)):
        spec = random_spec(seed, ALL_PROFILES[names[seed % len(names)]])
        restoration = _RESTORATIONS[seed % len(_RESTORATIONS)]
        found.append(_answer(f"generated {seed}", replace(spec, restoration=restoration)))
    return found


def _answer(name: str, spec: Spec) -> Answer:
    outcome = synthesize(spec)
    match outcome:
        case Realizable():
            text = dumps(outcome.policy)
        case Unrealizable(certificate=certificate):
            text = "" if certificate is None else unrealizability.dumps(certificate)
            text += repr(outcome.failures)
        case Undecided(limit=limit):
            return name, "Undecided", limit
    kind: Literal["Realizable", "Unrealizable"] = "Realizable" if isinstance(outcome, Realizable) else "Unrealizable"
    return name, kind, hashlib.sha256(text.encode()).hexdigest()
