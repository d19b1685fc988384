"""What `verify` does with one file: a policy, or a claim that there is none, against its specification; `--strict`."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, TypeAlias, cast

from msgspec import Struct
from msgspec.structs import replace

from tumato_symbolic.cli.console import write_to
from tumato_symbolic.cli.exits import NO, UNDECIDED, YES
from tumato_symbolic.cli.inputs import errors_in, read_spec
from tumato_symbolic.limits import Context
from tumato_symbolic.policy import Policy
from tumato_symbolic.report.verified import Verified
from tumato_symbolic.verify import verify
from tumato_symbolic.verify.result import stopped
from tumato_symbolic.verify.workers import cores

if TYPE_CHECKING:
    from tumato_symbolic.diagnostics import Diagnostic, Source
    from tumato_symbolic.policy.unrealizability import Unrealizability
    from tumato_symbolic.report.unrealizable import VerifiedUnrealizable
    from tumato_symbolic.spec import Ordering, Restoration, Spec
    from tumato_symbolic.verify import ProverName, UnrealizabilityVerdict, Verification
    from tumato_symbolic.verify.guarantees.result import Guarantees

    Verdict: TypeAlias = Verified | VerifiedUnrealizable


class Criteria(Struct, frozen=True):
    """What a claim is held to: an ordering and a restoration (None: the specification's), properties, and who proves.

    `strict`: its certificate has to hold as well. `guarantees`: what a policy guarantees beyond
    nominal runs is asked as well, with a certificate where there is a file for it.
    """

    ordering: Ordering | None
    restoration: Restoration | None
    properties: tuple[str, ...]
    prover: ProverName
    strict: bool
    guarantees: bool = False
    guarantees_file: str | None = None


def wanted_jobs(asked: int | None) -> int:
    """How many processes may work at a time: as many as the user says, else one on every processor."""
    return asked or cores()


def verify_claim(
    claim: Policy | Unrealizability, path: str, spec_path: str, criteria: Criteria, context: Context, *, jobs: int
) -> Verdict:
    """The claim read from `path` against the specification at `spec_path`.

    Raises `UserError` where the specification cannot be used, or the claim does not fit it.
    """
    context.tell("reading the specification")
    asked = _Asked(path, *read_spec(spec_path, criteria.restoration), criteria, time.perf_counter())
    with errors_in(asked.source):
        if isinstance(claim, Policy):
            return _verify_policy(claim, asked, context, jobs)
        from tumato_symbolic.verify import verify_unrealizable  # loads Z3, which --prover walk does without

        part = context.within(learned=lambda found: context.learn(asked.unrealizable(found)))
        return asked.unrealizable(verify_unrealizable(claim, asked.spec, ordering=criteria.ordering, context=part))


class _Asked(Struct, frozen=True):
    """The file with a claim, what the claim is about, and what it is held to; when proving began, in seconds."""

    path: str
    source: Source
    spec: Spec
    warnings: tuple[Diagnostic, ...]
    criteria: Criteria
    began: float

    def took(self) -> float:
        """How many seconds have passed since."""
        return time.perf_counter() - self.began

    def verified(self, found: object) -> Verified:
        """What there is to say of a policy, from what is known of it."""
        known, strict = cast("Verification", found), self.criteria.strict
        done = Verified(self.source, self.spec, self.path, known, self.warnings, self.took(), strict)
        return replace(done, guarantees=_not_yet(known)) if self.criteria.guarantees else done

    def unrealizable(self, found: object) -> VerifiedUnrealizable:
        """What there is to say of a certificate that there is no policy."""
        from tumato_symbolic.report.unrealizable import VerifiedUnrealizable

        known, strict = cast("UnrealizabilityVerdict", found), self.criteria.strict
        return VerifiedUnrealizable(self.source, self.spec, self.path, known, self.warnings, self.took(), strict)


def _verify_policy(policy: Policy, asked: _Asked, context: Context, jobs: int) -> Verified:
    """The verdict on a policy, with what it guarantees beyond nominal runs, if that is asked."""
    criteria = asked.criteria
    verification = verify(
        policy,
        asked.spec,
        ordering=criteria.ordering,
        restoration=criteria.restoration,
        properties=(*criteria.properties, "restoring") if criteria.strict else criteria.properties,
        prover=criteria.prover,
        jobs=jobs,
        context=context.within(learned=lambda found: context.learn(asked.verified(found))),
    )
    done = asked.verified(verification)
    if not criteria.guarantees or verification.verdict != "proved":
        return done
    context.learn(done)
    from tumato_symbolic.policy.guarantees import dumps
    from tumato_symbolic.verify.guarantees.analyse import guarantees

    certify = criteria.guarantees_file is not None
    found = guarantees(policy, asked.spec, verification.ordering, certify=certify, context=context)
    if found.certificate is not None and criteria.guarantees_file is not None:
        write_to(criteria.guarantees_file, dumps(found.certificate), "certificate")
    return replace(done, guarantees=found, took=asked.took())


def _not_yet(verification: Verification) -> Guarantees:
    """What is said of guarantees before they are looked at."""
    from tumato_symbolic.verify.guarantees.result import Guarantees

    if verification.verdict == "proved":
        return Guarantees("undecided")
    return Guarantees("unproved", reason=f"the policy is {verification.verdict}")


def ended(known: Verdict, why: str) -> Verdict:
    """What was known of a claim when a limit was met."""
    if isinstance(known, Verified):
        known = replace(known, verification=stopped(known.verification, why))
        if known.guarantees is not None and known.guarantees.status == "undecided" and known.guarantees.reason is None:
            known = replace(known, guarantees=replace(known.guarantees, reason=why))
        return known
    return replace(known, found=replace(known.found, reason=why))


def exit_code(done: Verdict) -> int:
    """What a script may conclude: 0 only where all is known and proved, and the certificate passes `--strict`."""
    if done.not_accepted:
        return NO
    if isinstance(done, Verified) and done.guarantees is not None and done.guarantees.status == "undecided":
        return UNDECIDED
    return {"proved": YES, "refuted": NO, "undecided": UNDECIDED}[done.verdict]
