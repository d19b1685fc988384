"""The report of `synth`: counts, the verdict, failures, commands to go on with; JSON and findings."""

from __future__ import annotations

import shlex

from msgspec import Struct

from tumato_symbolic.diagnostics import Diagnostic, Source
from tumato_symbolic.policy import never_executed, some_decided
from tumato_symbolic.report.failures import FAILURE_CODES, failure_json, failure_line, failure_text, left_out_lines
from tumato_symbolic.report.findings import Finding, finding_json, findings_of, undecided
from tumato_symbolic.report.layout import Paint, count, every, seconds
from tumato_symbolic.report.objections import Place
from tumato_symbolic.report.pictured import drawn, never_executed_lines
from tumato_symbolic.report.proof import ORDERINGS, proof_json, proof_text, provers
from tumato_symbolic.report.restorable import restorable_json, restorable_lines
from tumato_symbolic.report.restored import restored_json, restored_text
from tumato_symbolic.spec import Ordering, Restoration, Spec
from tumato_symbolic.synthesis.result import Realizable, Statistics, SynthesisResult, Undecided, Unrealizable
from tumato_symbolic.verify.result import UnrealizabilityVerdict, Verification


class Synthesized(Struct, frozen=True):
    """An outcome with everything that its report needs. Times are in seconds.

    `proof` is None where there was nothing to prove, or where proving was declined; `written` tells whether the
    policy is in `output` (`-` is the standard output). Where the specification is unrealizable, `unrealizability` is
    the verdict on the certificate, and `certificate` the file that it was written to. `cut_short` is why the report is
    a short one: a limit was met. `restoration` overrules the specification's.
    """

    source: Source
    spec: Spec
    outcome: SynthesisResult
    proof: Verification | None
    warnings: tuple[Diagnostic, ...]
    output: str
    written: bool
    solved_in: float = 0.0
    proved_in: float = 0.0
    unrealizability: UnrealizabilityVerdict | None = None
    certificate: str | None = None
    cut_short: str | None = None
    restoration: Restoration | None = None

    @property
    def place(self) -> Place:
        """The specification and its file."""
        return Place(self.spec, self.source.name)


def as_text(done: Synthesized, colour: bool) -> str:
    """The report for a person."""
    paint = Paint(colour)
    match done.outcome:
        case Realizable():
            parts = _realizable(done, done.outcome, paint)
        case Unrealizable():
            parts = _unrealizable(done, done.outcome, paint)
        case Undecided():
            parts = _undecided(done, done.outcome, paint)
    return "\n\n".join(parts)


def _undecided(done: Synthesized, outcome: Undecided, paint: Paint) -> list[str]:
    statistics = outcome.statistics
    parts = ["\n".join((_states(statistics), *_engine(statistics)))] if statistics else []
    if done.proof is not None and statistics is not None:
        parts.append(proof_text(done.proof, statistics.valid, done.proved_in, paint))
    if done.written:
        verdict = f"{done.source.name} is {paint.good('realizable')}. The rest of the report is left out"
        return [f"{verdict}: {outcome.limit}.", *parts, f"{done.output} is written."]
    found = "a policy was found, and not proved; " if done.proof is not None else ""
    return [
        f"{done.source.name}: {paint.doubt('undecided')}: {found}{outcome.limit}.",
        *parts,
        f"No policy was written.{_kept(done)}",
    ]


def _kept(done: Synthesized) -> str:
    return "" if done.output == "-" else f" An existing {done.output} was left unchanged."


def _states(statistics: Statistics) -> str:
    excluded = statistics.total - statistics.valid
    assumed = f", {excluded:,} excluded by assumptions" if excluded else ", all valid"
    return f"  {count(statistics.total, 'state')}{assumed}: {statistics.safe:,} safe, {statistics.unsafe:,} unsafe"


def _engine(statistics: Statistics) -> list[str]:
    """That the diagrams were those of pure Python, where that is so."""
    if statistics.backend == "cudd":
        return []
    return [
        "  diagrams: in pure Python, since CUDD is not available here; slower, with the same answer",
        "            (dd brings CUDD for Linux on x86-64 and Python 3.11 to 3.13)",
    ]


def _realizable(done: Synthesized, outcome: Realizable, paint: Paint) -> list[str]:
    statistics = outcome.statistics
    bound = done.spec.max_plan_length
    longest = f"  longest run to a goal: {statistics.longest_told}"
    longest += "" if bound is None else f" (max_plan_length: {bound})"
    verdict = (
        f"is {paint.good('realizable')}: the policy decides" if done.written else "may be realizable: a policy decides"
    )
    head = [
        f"{done.source.name} {verdict} {_decided(statistics)}. Found in {seconds(done.solved_in)}.",
        _states(statistics),
        longest,
        *never_executed_lines(outcome.policy),
        *restored_text(statistics),
        f"  effects: {ORDERINGS[statistics.ordering]}",
        *_engine(statistics),
    ]
    picture = drawn(done.spec, outcome.policy, _show(done), restores=statistics.unsafe > 0)
    parts = ["\n".join(head), *_left_out(done, statistics), picture]
    if done.proof is None:
        parts.append(paint.doubt("Not proved: --no-verify was given."))
    else:
        parts.append(proof_text(done.proof, statistics.valid, done.proved_in, paint))
    return [*parts, _next(done, outcome)]


def _decided(statistics: Statistics) -> str:
    """Which states the policy decides."""
    part = statistics.part
    if part is None or part.decided == statistics.valid:
        return every(statistics.valid, "valid state")
    return (
        f"{part.decided:,} of {count(statistics.valid, 'valid state')}, "
        f"with {every(part.starts, 'start')} and all that can follow"
    )


def _left_out(done: Synthesized, statistics: Statistics) -> list[str]:
    """What the policy does not decide, as a paragraph."""
    lines = [] if statistics.part is None else left_out_lines(done.place, statistics.part)
    return ["\n".join(lines)] if lines else []


def _show(done: Synthesized) -> str:
    """The command that shows what the policy does."""
    file = done.output if done.written and done.output != "-" else "POLICY"
    return f"tumato-sym show {shlex.quote(file)} {shlex.quote(done.source.name)}"


def _next(done: Synthesized, outcome: Realizable) -> str:
    if not done.written:
        return "The policy was not written. With --no-verify it would be written without a proof."
    if done.output == "-":
        return "The policy is on the standard output."
    file, example = shlex.quote(done.output), some_decided(outcome.policy)
    state = "VARIABLE=VALUE …" if example is None else done.place.state(example)
    lines = [f"{done.output} is written. Next:", f"  tumato-sym decide {file} {state}"]
    overrule = _overruling(done, outcome.statistics.ordering)
    return "\n".join((*lines, f"  tumato-sym verify {file} {shlex.quote(done.source.name)}{overrule}"))


def _overruling(done: Synthesized, ordering: Ordering) -> str:
    """The options that `verify` needs to judge by something else than what the specification says."""
    restoration = "" if done.restoration is None else f" --restoration {done.restoration}"
    return restoration if ordering == done.spec.ordering else f" --effect-ordering {ordering}{restoration}"


def _unrealizable(done: Synthesized, outcome: Unrealizable, paint: Paint) -> list[str]:
    failing = sum(failure.count for failure in outcome.failures if failure.kind != "conflict")
    part = outcome.statistics.part
    asked = count(outcome.statistics.valid, "valid state") if part is None else count(part.starts, "start")
    verdict = f"{done.source.name} is {paint.bad('not realizable')}"
    if failing:
        verdict += f": {failing:,} of {asked} {'fails' if failing == 1 else 'fail'}."
    elif part is not None:
        verdict += ": each start alone has a plan, but no policy works for all of them."
    else:
        verdict += ": each state alone has a plan, but no policy works for all of them."
    verdict += f" Found in {seconds(done.solved_in)}."
    effects = f"  effects: {ORDERINGS[outcome.statistics.ordering]}"
    head = [verdict, _states(outcome.statistics), effects, *_engine(outcome.statistics)]
    ordering = outcome.statistics.ordering
    if done.cut_short is None:
        shown = [failure_text(done.place, failure, ordering) for failure in outcome.failures]
        if outcome.restorability is not None:
            shown.append("\n".join(restorable_lines(done.place, outcome.restorability)))
    else:
        shown = [failure_line(done.place, failure) for failure in outcome.failures]
        shown.append(f"The rest of the report is left out: {done.cut_short}.")
    written = "\n".join((f"No policy was written.{_kept(done)}", *_certified(done, outcome, paint)))
    why = "says why, line by line, and which changes would give a policy"
    explain = f"`tumato-sym explain {shlex.quote(done.source.name)}` {why}."
    return ["\n".join(head), *shown, f"{written}\n{explain}"]


def _certified(done: Synthesized, outcome: Unrealizable, paint: Paint) -> list[str]:
    """What became of the certificate that there is no policy."""
    lines, ordering = [], outcome.statistics.ordering
    if outcome.limit is not None and done.certificate is None:
        lines.append(paint.doubt(f"It is not proved that there is none: {outcome.limit}."))
    elif outcome.certificate is None:
        lines.append(paint.doubt("It is not proved that there is none: this answer has no certificate yet."))
    if done.unrealizability is not None:
        from tumato_symbolic.report.unrealizable import proof_line

        proved = done.unrealizability.verdict == "proved"
        lines.append(
            f"{paint.good('Proved')}: {proof_line(done.spec, done.unrealizability)}."
            if proved
            else f"{paint.doubt('The certificate could not be proved')}: {done.unrealizability.reason}."
        )
    if done.certificate is None:
        return lines
    if done.unrealizability is None:
        lines.append(paint.doubt("Its certificate is not proved: --no-verify was given."))
    files = f"{shlex.quote(done.certificate)} {shlex.quote(done.source.name)}"
    verify = f"  tumato-sym verify {files}{_overruling(done, ordering)}"
    return [*lines, f"{done.certificate} is written. Next:", verify]


def as_json(done: Synthesized) -> dict[str, object]:
    """The report for a program."""
    outcome, statistics = done.outcome, done.outcome.statistics
    failures = outcome.failures if isinstance(outcome, Unrealizable) else ()
    return {
        "verdict": _verdict(done),
        "specification": done.source.name,
        "effect_ordering": statistics.ordering if statistics else None,
        "states": {
            "total": statistics.total,
            "valid": statistics.valid,
            "safe": statistics.safe,
            "unsafe": statistics.unsafe,
        }
        if statistics
        else None,
        "longest_run": statistics.longest_run if statistics else None,
        **({"one_at_a_time": True} if statistics and statistics.one_at_a_time else {}),
        **({"never_executed": never_executed(outcome.policy)} if isinstance(outcome, Realizable) else {}),
        **restored_json(statistics),
        **_starts_json(done.spec, statistics),
        "policy": done.output if done.written else None,
        "certificate": done.certificate,
        "failing_states": sum(failure.count for failure in failures if failure.kind != "conflict"),
        "failures": [failure_json(done.spec, failure) for failure in failures],
        **(restorable_json(done.place, outcome.restorability) if isinstance(outcome, Unrealizable) else {}),
        "limit": _limit(done),
        "proof": _proof_json(done),
        "seconds": {"synthesis": round(done.solved_in, 3), "proof": round(done.proved_in, 3)},
        "backend": statistics.backend if statistics else None,
        "warnings": [finding_json(warning, done.source.name) for warning in done.warnings],
    }


def _starts_json(spec: Spec, statistics: Statistics | None) -> dict[str, object]:
    """What is decided from the starts, where there are any; what could be, where there is no policy."""
    part = None if statistics is None else statistics.part
    if part is None:
        return {}
    left_out = [failure_json(spec, failure) for failure in part.left_out]
    return {"starts": {"count": part.starts, "decided_states": part.decided, "left_out": left_out}}


def _proof_json(done: Synthesized) -> dict[str, object] | None:
    if done.unrealizability is not None:
        from tumato_symbolic.report.unrealizable import verdict_json

        return verdict_json(done.spec, done.unrealizability)
    return proof_json(done.spec, done.proof) if done.proof is not None else None


def _verdict(done: Synthesized) -> str:
    if isinstance(done.outcome, Unrealizable):
        return "unrealizable"
    return "realizable" if done.written else "undecided"


def _limit(done: Synthesized) -> str | None:
    if isinstance(done.outcome, Undecided | Unrealizable):
        return done.outcome.limit
    return "the proof met its limits" if _verdict(done) == "undecided" else None


def findings(done: Synthesized) -> list[Finding]:
    """Warnings at their lines, failures, and one notice or error with the verdict."""
    file, outcome = done.source.name, done.outcome
    found = findings_of(done.warnings, file)
    match _verdict(done):
        case "realizable":
            proved = "not proved (--no-verify)" if done.proof is None else f"proved by {provers(done.proof)}"
            found.append(Finding("notice", f"realizable, {proved}", file))
        case "undecided":
            found.append(undecided(str(_limit(done)), file))
    if isinstance(outcome, Unrealizable):
        ordering = outcome.statistics.ordering
        for failure in outcome.failures:
            text = failure_line(done.place, failure) if done.cut_short else failure_text(done.place, failure, ordering)
            found.append(Finding("error", f"not realizable: {text}", file, code=FAILURE_CODES[failure.kind]))
    return found
