"""`verify`: a policy against a specification, believing neither (`docs/certificate.md`)."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import replace

from tumato_symbolic.diagnostics import Code, Diagnostic, UserError
from tumato_symbolic.policy.bind import bind
from tumato_symbolic.policy.convert import as_diagram
from tumato_symbolic.policy.diagram import count_true
from tumato_symbolic.policy.model import Policy, Table
from tumato_symbolic.semantics import is_valid
from tumato_symbolic.spec import Ordering, Spec
from tumato_symbolic.verify.certificate import RankSource
from tumato_symbolic.verify.frame import Frame
from tumato_symbolic.verify.goals_property import prove_goals
from tumato_symbolic.verify.minimal_property import prove_minimal
from tumato_symbolic.verify.result import (
    PROPERTIES,
    CertificateUse,
    OrderingSource,
    PropertyName,
    PropertyResult,
    Refutation,
    Verdict,
    Verification,
)
from tumato_symbolic.verify.solver import UndecidedError
from tumato_symbolic.verify.step_property import prove_safe, prove_total
from tumato_symbolic.verify.terms import conjunction, negation

OBLIGATION_BUDGET = 30.0
"""How many seconds Z3 may think about one obligation."""


def verify(
    policy: Policy,
    spec: Spec,
    *,
    ordering: Ordering | None = None,
    properties: Sequence[str] = PROPERTIES,
    timeout: float | None = OBLIGATION_BUDGET,
    progress: Callable[[str], None] | None = None,
) -> Verification:
    """Prove `policy` for all valid states of `spec`, or refute it with a witness.

    `ordering` overrules what policy and specification say of the order of effects. `properties` are some of `total`,
    `safe`, `goals` and `minimal`. `timeout` limits the time, in seconds, of each obligation (None: no limit); what is
    not proved in time is undecided. `progress` is told what is being proved.

    Raises `UserError` when the names of the policy do not fit the specification, or no state is valid.
    """
    asked = _asked(properties)
    bound = bind(policy, spec)
    judged, source = _ordering(bound, spec, ordering)
    frame = Frame(spec, as_diagram(bound), timeout)
    _require_a_valid_state(frame)
    results: list[PropertyResult] = []
    if source == "policy" and judged == "first" and spec.effect_ordering == "any":
        results.append(PropertyResult("ordering", "refuted", refutation=Refutation("ordering")))
    ranks: RankSource | None = None
    for name in asked:
        if progress is not None:
            progress(f"proving {name}")
        started = time.perf_counter()
        if name in ("goals", "minimal") and ranks is None:
            safe = any(result.name == "safe" and result.verdict == "proved" for result in results)
            ranks = RankSource(frame, bound, judged, safe)
        result = _prove(name, frame, ranks, judged)
        results.append(replace(result, seconds=time.perf_counter() - started))
    return Verification(
        _overall([result.verdict for result in results]),
        tuple(results),
        judged,
        source,
        ranks.use if ranks is not None else CertificateUse("unneeded"),
        _count_valid(frame, bound, results),
    )


def _asked(properties: Sequence[str]) -> list[PropertyName]:
    unknown = [name for name in properties if name not in PROPERTIES]
    if unknown or not properties:
        raise ValueError(f"properties must be some of {', '.join(PROPERTIES)}, not {list(properties)}")
    return [name for name in PROPERTIES if name in properties]


def _ordering(policy: Policy, spec: Spec, argument: Ordering | None) -> tuple[Ordering, OrderingSource]:
    if argument is not None:
        return argument, "command line"
    if policy.ordering is not None:
        return policy.ordering, "policy"
    if spec.effect_ordering is not None:
        return spec.effect_ordering, "specification"
    return "any", "default"


def _require_a_valid_state(frame: Frame) -> None:
    if frame.solver.ask(frame.valid) == "unsat":
        message = "no state satisfies all assumptions, so there is nothing to decide"
        raise UserError((Diagnostic(Code.TUM312, message, help="drop or weaken an assumption"),))


def _prove(name: PropertyName, frame: Frame, ranks: RankSource | None, ordering: Ordering) -> PropertyResult:
    try:
        if name == "total":
            return prove_total(frame)
        if name == "safe" or ranks is None:
            return prove_safe(frame, ordering)
        return prove_goals(frame, ranks) if name == "goals" else prove_minimal(frame, ranks, ordering)
    except UndecidedError as undecided:
        return PropertyResult(name, "undecided", reason=str(undecided))


def _overall(verdicts: list[Verdict]) -> Verdict:
    if "refuted" in verdicts:
        return "refuted"
    return "undecided" if "undecided" in verdicts else "proved"


def _count_valid(frame: Frame, policy: Policy, results: list[PropertyResult]) -> int | None:
    """How many states are valid: known where each of them is decided, and the others can be told apart."""
    if not any(result.name == "total" and result.verdict == "proved" for result in results):
        return None
    decisions = policy.decisions
    if isinstance(decisions, Table):
        return sum(is_valid(frame.spec, state) for state in decisions.rows)
    if frame.solver.ask(conjunction((frame.defined, negation(frame.valid)))) != "unsat":
        return None
    return count_true(decisions.diagram, decisions.defined, policy.vocabulary.sizes)
