"""The columns of a sweep: one text solved and its answer proved, compared with the policy of another text."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

from msgspec import to_builtins
from msgspec.structs import replace

from tumato_symbolic.diagnostics import Diagnostic, Source, UserError
from tumato_symbolic.limits import Context, LimitReachedError
from tumato_symbolic.policy import Policy, dumps, loads
from tumato_symbolic.spec import Spec, digest, load
from tumato_symbolic.sweep.tasks import NOTHING, Answer, Task
from tumato_symbolic.synthesis import Realizable, Statistics, SynthesisResult, Unrealizable, synthesize
from tumato_symbolic.synthesis.result import Failure
from tumato_symbolic.verify import verify, verify_unrealizable
from tumato_symbolic.views import counted


def solved(task: Task) -> Answer:
    """The answer to a task; what is wrong with the text, or takes too long, is part of it."""
    context = Context(task.limits)
    try:
        spec = _read(task)
    except UserError as error:
        return Answer({**NOTHING, "verdict": "error", "diagnostics": _said(error.diagnostics)})
    known = {**NOTHING, "digest": digest(spec)}
    try:
        return _solved(task, spec, known, context)
    except UserError as error:
        return Answer({**known, "verdict": "error", "diagnostics": _said(error.diagnostics)})
    except LimitReachedError as limit:
        return Answer({**known, "limit": str(limit)})
    except MemoryError:
        return Answer({**known, "limit": f"memory ran out while {context.stage}"})


def _read(task: Task) -> Spec:
    loaded = load(Source(task.name, task.text))
    if loaded.spec is None:
        raise UserError(tuple(each for each in loaded.diagnostics if each.severity == "error"))
    return loaded.spec if task.restoration is None else replace(loaded.spec, restoration=task.restoration)


def _solved(task: Task, spec: Spec, known: dict[str, object], context: Context) -> Answer:
    outcome = synthesize(spec, task.ordering, policy_format="diagram", context=context.within())
    match outcome:
        case Realizable(policy, statistics):
            known = {**known, "verdict": "realizable", **_counts(statistics)}
        case Unrealizable(failures, statistics, limit=limit):
            known = {**known, "verdict": "unrealizable", **_counts(statistics), "limit": limit}
            known["failures"] = [_failure(each) for each in failures]
        case _:
            return Answer({**known, **_counts(outcome.statistics), "limit": outcome.limit})
    if task.prove:
        known = {**known, **_proved(task, spec, outcome, context)}
    if not isinstance(outcome, Realizable):
        return Answer(known)
    if task.against is not None:
        known["compared"] = _compared(task.against, policy, context)
    wanted = dumps(replace(policy, certificate=None)) if task.policy else None
    return Answer(known, wanted)


def _counts(known: Statistics | None) -> dict[str, object]:
    if known is None:
        return {}
    decided = known.valid if known.part is None else known.part.decided
    counts = {"total": known.total, "valid": known.valid, "safe": known.safe, "unsafe": known.unsafe}
    return {"states": {**counts, "decided": decided}, "longest_run": known.longest_run}


def _failure(failure: Failure) -> dict[str, object]:
    return {"kind": failure.kind, "count": failure.count}


def _proved(task: Task, spec: Spec, outcome: SynthesisResult, context: Context) -> dict[str, object]:
    """The verdict on the answer. A refutation would be a bug of this program, and must not pass as a verdict."""
    if isinstance(outcome, Realizable):
        ordering = outcome.statistics.ordering
        proof = verify(
            outcome.policy, spec, ordering=ordering, prover=task.prover, jobs=1, context=context.within()
        ).verdict
    elif isinstance(outcome, Unrealizable) and outcome.certificate is not None:
        certificate = outcome.certificate
        found = verify_unrealizable(certificate, spec, ordering=certificate.ordering, context=context.within())
        proof = found.verdict
    else:
        return {}
    if proof == "refuted":
        raise AssertionError(f"our own answer for {task.name} is refuted")
    return {"proof": proof}


def _compared(against: str, policy: Policy, context: Context) -> dict[str, object] | None:
    """In how many states the policy decides otherwise than the one in a file; None where that takes too long."""
    try:
        found = counted(_loaded(against), policy, context)
    except LimitReachedError:
        return None
    return dict(to_builtins(found))


@lru_cache(maxsize=2)
def _loaded(text: str) -> Policy:
    return loads(text)


def _said(diagnostics: Sequence[Diagnostic]) -> list[dict[str, object]]:
    return [
        {
            "code": each.code.name,
            "message": each.message,
            "help": each.help,
            "line": None if each.span is None else each.span.line,
            "column": None if each.span is None else each.span.column,
        }
        for each in diagnostics
    ]
