"""What `synth` does with one file: a specification is solved, its answer proved and written."""

from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING, Literal, cast

from msgspec.structs import replace

from tumato_symbolic.cli.console import note, write, writing
from tumato_symbolic.cli.options import STANDARD_OUTPUT
from tumato_symbolic.cli.targets import certificate_path
from tumato_symbolic.diagnostics import Code, UserError, not_allowed
from tumato_symbolic.limits import Context
from tumato_symbolic.policy import dumps, save_text
from tumato_symbolic.report.synthesized import Synthesized
from tumato_symbolic.synthesis import Realizable, SynthesisResult, Undecided, Unrealizable, synthesize

if TYPE_CHECKING:
    from tumato_symbolic.policy.unrealizability import Unrealizability
    from tumato_symbolic.report.html.contents import NoPolicyPage, PolicyPage
    from tumato_symbolic.spec import Ordering
    from tumato_symbolic.verify import ProverName, Verification

PolicyFormat = Literal["auto", "table", "diagram"]


def solve(so_far: Synthesized, ordering: Ordering | None, policy_format: PolicyFormat, context: Context) -> Synthesized:
    """The outcome of synthesis."""
    started, warnings = time.perf_counter(), so_far.warnings

    def having(outcome: SynthesisResult) -> Synthesized:
        took = time.perf_counter() - started
        found = (*warnings, *not_allowed(outcome.warnings, so_far.source))
        return replace(so_far, outcome=outcome, warnings=found, solved_in=took)

    return having(
        synthesize(
            so_far.spec,
            ordering,
            policy_format=policy_format,
            context=context.within(learned=lambda outcome: context.learn(having(cast("SynthesisResult", outcome)))),
        )
    )


def prove(so_far: Synthesized, prover: ProverName, jobs: int | None, context: Context, *, wanted: bool) -> Synthesized:
    """With the verdict on our own policy or certificate, where that is wanted.

    A refutation would be a bug of this program, and must not pass as a verdict.
    """
    if wanted and isinstance(so_far.outcome, Realizable):
        return _prove_policy(so_far, so_far.outcome, prover, jobs, context)
    context.learn(_without_policy(so_far))
    if wanted and isinstance(so_far.outcome, Unrealizable) and so_far.outcome.certificate is not None:
        return _prove_certificate(so_far, so_far.outcome.certificate, context)
    return so_far


def _without_policy(done: Synthesized) -> Synthesized:
    """What is reported when a limit is met: a policy is long, and not needed for that."""
    if isinstance(done.outcome, Realizable):
        return replace(done, outcome=Undecided("", done.outcome.statistics, done.outcome.warnings))
    return done


def _prove_policy(
    so_far: Synthesized, outcome: Realizable, prover: ProverName, jobs: int | None, context: Context
) -> Synthesized:
    from tumato_symbolic.verify import verify
    from tumato_symbolic.verify.workers import cores

    started = time.perf_counter()

    def having(proof: object) -> Synthesized:
        return replace(so_far, proof=cast("Verification", proof), proved_in=time.perf_counter() - started)

    proof = verify(
        outcome.policy,
        so_far.spec,
        ordering=outcome.statistics.ordering,
        prover=prover,
        jobs=jobs or cores(),
        context=context.within(learned=lambda found: context.learn(_without_policy(having(found)))),
    )
    if proof.verdict == "refuted":
        raise AssertionError(f"the synthesized policy is refuted: {proof}")
    return having(proof)


def _prove_certificate(so_far: Synthesized, certificate: Unrealizability, context: Context) -> Synthesized:
    from tumato_symbolic.verify import verify_unrealizable

    started = time.perf_counter()
    found = verify_unrealizable(certificate, so_far.spec, ordering=certificate.ordering, context=context.within())
    if found.verdict == "refuted":
        raise AssertionError(f"the certificate that there is no policy is refuted: {found}")
    return replace(so_far, unrealizability=found, proved_in=time.perf_counter() - started)


def write_answer(so_far: Synthesized, context: Context) -> Synthesized:
    """With what may be written: a policy that is proved, or not to be proved; the certificate of unrealizability."""
    outcome = so_far.outcome
    if isinstance(outcome, Realizable) and (so_far.proof is None or so_far.proof.verdict == "proved"):
        context.tell("writing the policy")
        text = dumps(outcome.policy)
        context.check()
        done = replace(so_far, written=True)
        with writing():
            _write_policy(text, so_far.output)
            context.learn(_without_policy(done))
        return done
    if isinstance(outcome, Unrealizable) and outcome.certificate is not None:
        with writing():
            done = replace(so_far, certificate=_write_certificate(outcome.certificate, so_far.output))
            context.learn(done)
        return done
    return so_far


def write_html(done: Synthesized, target: str, context: Context) -> None:
    """Write the page of the answer, where there is one, and say so."""
    from tumato_symbolic.cli.reporting import write_page

    of = answer_page(done, context)
    if of is not None:
        write_page(of, target, context)
        note(f"{target} is written: a page for a browser.")


def answer_page(done: Synthesized, context: Context) -> PolicyPage | NoPolicyPage | None:
    """What a page says of the answer; None where it is no answer, or the policy is not to be written."""
    from tumato_symbolic.cli.reporting import rules_of, why_none
    from tumato_symbolic.report.html.contents import NoPolicyPage, PolicyPage

    spec = done.spec if done.restoration is None else replace(done.spec, restoration=done.restoration)
    match done.outcome:
        case Realizable(policy, statistics) if done.written:
            name = "a policy" if done.output == STANDARD_OUTPUT else done.output
            rules = rules_of(policy, context)
            return PolicyPage(done.source, spec, name, policy, statistics.ordering, done.proof, rules)
        case Unrealizable(statistics=statistics):
            name, ordering = done.certificate or done.source.name, statistics.ordering
            explained = why_none(done.source, spec, ordering, context)
            return NoPolicyPage(done.source, spec, name, ordering, done.unrealizability, explained)
        case _:
            return None


def _write_certificate(certificate: Unrealizability, output: str) -> str | None:
    """Where the certificate was written; None where there is no place for it, or it is too large."""
    from tumato_symbolic.policy.unrealizability import save as save_certificate

    path = certificate_path(output)
    if path is None:
        return None
    try:
        save_certificate(certificate, path)
    except UserError as error:
        if error.diagnostics[0].code is not Code.TUM508:
            raise
        return None
    return str(path)


def _write_policy(text: str, output: str) -> None:
    if output == STANDARD_OUTPUT:
        write(text)
    else:
        save_text(text, Path(output), "policy")
