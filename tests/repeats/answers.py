"""What is answered for a specification, as bytes: the file, and the witness against a spoilt policy."""

from __future__ import annotations

import hashlib
from random import Random

from msgspec.structs import replace

from tests.repeats.specs import crossroads
from tumato_symbolic import parse
from tumato_symbolic.limits import Context
from tumato_symbolic.policy import Policy, Table, dumps, unrealizability
from tumato_symbolic.spec import Spec
from tumato_symbolic.symbolic import Backend
from tumato_symbolic.synthesis import Realizable, Unrealizable, synthesize
from tumato_symbolic.verify import verify

REPAIRING = "repairing decisions where goals interact"

WITNESS_EVERY = 8
"""For every so many seeds Z3 is asked for witnesses as well, which takes longer than the synthesis."""


def is_repaired(seed: int) -> bool:
    """Whether the goals of a specification interact so that decisions are repaired."""
    told: list[str] = []
    synthesize(parse(crossroads(seed)), context=Context(progress=told.append))
    return any(stage.startswith(REPAIRING) for stage in told)


def answer(seed: int, backend: Backend) -> str:
    """The digest of the policy or of the certificate that there is none, and of what Z3 says of a spoilt policy."""
    spec = parse(crossroads(seed))
    outcome = synthesize(spec, backend=backend)
    match outcome:
        case Realizable():
            text = dumps(outcome.policy)
            if seed % WITNESS_EVERY == 0:
                text += _witnesses(spec, outcome.policy, Random(seed))
        case Unrealizable():
            assert outcome.certificate is not None
            text = unrealizability.dumps(outcome.certificate)
        case _:
            text = "undecided"
    return hashlib.sha256(text.encode()).hexdigest()


def _witnesses(spec: Spec, policy: Policy, random: Random) -> str:
    assert isinstance(policy.decisions, Table)
    rows = dict(policy.decisions.rows)
    one, other = random.sample(sorted(rows), 2)
    rows[one] = rows[other]
    results = verify(replace(policy, decisions=Table(rows)), spec, prover="z3").properties
    return repr([replace(result, seconds=0.0) for result in results])
