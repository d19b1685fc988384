"""A claim, a policy or that there is none, against its specification: what `verify` does with one file."""

from __future__ import annotations

import time
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, TypeAlias, cast

from tumato_symbolic.cli.exits import NO, UNDECIDED, YES
from tumato_symbolic.cli.inputs import errors_in, read_spec
from tumato_symbolic.limits import Context
from tumato_symbolic.policy import Policy
from tumato_symbolic.report.verified import Verified
from tumato_symbolic.verify import verify
from tumato_symbolic.verify.children import cores
from tumato_symbolic.verify.result import stopped

if TYPE_CHECKING:
    from tumato_symbolic.policy.unrealizable import Unrealizability
    from tumato_symbolic.report.unrealizable import Disproved
    from tumato_symbolic.spec import Ordering, Restoration
    from tumato_symbolic.verify import ProverName, UnrealizabilityVerdict, Verification

    Judged: TypeAlias = Verified | Disproved


@dataclass(frozen=True, slots=True)
class Criteria:
    """What a claim is held to: an ordering and a restoration (None: the specification's), properties, and who proves.

    `strict`: its certificate has to hold as well.
    """

    ordering: Ordering | None
    restoration: Restoration | None
    properties: tuple[str, ...]
    prover: ProverName
    strict: bool


def wanted_jobs(asked: int | None) -> int:
    """How many processes may work at a time: as many as the user says, else one on every processor."""
    return asked or cores()


def judge(
    claim: Policy | Unrealizability, path: str, spec_path: str, criteria: Criteria, context: Context, *, jobs: int
) -> Judged:
    """The claim read from `path` against the specification at `spec_path`.

    Raises `UserError` where the specification cannot be used, or the claim does not fit it.
    """
    context.tell("reading the specification")
    source, spec, warnings = read_spec(spec_path, criteria.restoration)
    started = time.perf_counter()

    def verified(found: object) -> Verified:
        took = time.perf_counter() - started
        return Verified(source, spec, path, cast("Verification", found), warnings, took, criteria.strict)

    with errors_in(source):
        if isinstance(claim, Policy):
            verification = verify(
                claim,
                spec,
                ordering=criteria.ordering,
                restoration=criteria.restoration,
                properties=criteria.properties,
                prover=criteria.prover,
                jobs=jobs,
                context=context.within(learned=lambda found: context.learn(verified(found))),
            )
            return verified(verification)
        from tumato_symbolic.report.unrealizable import Disproved
        from tumato_symbolic.verify import verify_unrealizable  # loads Z3, which --prover walk does without

        def disproved(found: object) -> Disproved:
            took = time.perf_counter() - started
            verdict = cast("UnrealizabilityVerdict", found)
            return Disproved(source, spec, path, verdict, warnings, took, criteria.strict)

        part = context.within(learned=lambda found: context.learn(disproved(found)))
        return disproved(verify_unrealizable(claim, spec, ordering=criteria.ordering, context=part))


def ended(known: Judged, why: str) -> Judged:
    """What was known of a claim when a limit was met."""
    if isinstance(known, Verified):
        return replace(known, verification=stopped(known.verification, why))
    return replace(known, found=replace(known.found, reason=why))


def exit_code(done: Judged) -> int:
    """What a script may conclude: 0 only where all is proved, and the certificate passes `--strict`."""
    if done.not_accepted:
        return NO
    return {"proved": YES, "refuted": NO, "undecided": UNDECIDED}[done.verdict]
