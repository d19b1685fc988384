"""`verify`: a policy against a specification, believing neither (`docs/certificate.md`)."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

from tumato_symbolic.diagnostics import Code, Diagnostic, UserError
from tumato_symbolic.policy.bind import bind
from tumato_symbolic.policy.model import Policy
from tumato_symbolic.spec import Ordering, Spec
from tumato_symbolic.verify.children import can_fork
from tumato_symbolic.verify.provers import make_prover
from tumato_symbolic.verify.result import (
    PROPERTIES,
    OrderingSource,
    PropertyName,
    PropertyResult,
    ProverName,
    Refutation,
    Verdict,
    Verification,
)

OBLIGATION_BUDGET = 30.0
"""How many seconds Z3 may think about one obligation, and the walk about one property."""


def verify(
    policy: Policy,
    spec: Spec,
    *,
    ordering: Ordering | None = None,
    properties: Sequence[str] = PROPERTIES,
    prover: ProverName = "auto",
    timeout: float | None = OBLIGATION_BUDGET,
    jobs: int = 1,
    progress: Callable[[str], None] | None = None,
) -> Verification:
    """Prove `policy` for all valid states of `spec`, or refute it with a witness.

    `ordering` overrules what policy and specification say of the order of effects. `properties` are some of `total`,
    `safe`, `goals` and `minimal`. `prover` is `z3`; `walk`, which does without Z3; `both`, which must agree; or `auto`:
    Z3 for what it answers soon, the walk for the rest. `timeout` limits the time, in seconds, of each obligation of Z3
    and of each property of the walk (None: no limit); what is not proved in time is undecided. Up to `jobs`
    processes work at a time, where the proof is large and the platform can fork; the answer is the same. `progress` is
    told what is being proved.

    Raises `UserError` when the names of the policy do not fit the specification, or no state is valid.
    """
    asked = _asked(properties)
    bound = bind(policy, spec)
    judged, source = _ordering(bound, spec, ordering)
    chosen = make_prover(prover, spec, bound, judged, timeout)
    if not chosen.has_valid_state():
        message = "no state satisfies all assumptions, so there is nothing to decide"
        raise UserError((Diagnostic(Code.TUM312, message, help="drop or weaken an assumption"),))
    results: list[PropertyResult] = []
    if source == "policy" and judged == "first" and spec.effect_ordering == "any":
        results.append(PropertyResult("ordering", "refuted", refutation=Refutation("ordering")))
    ahead: Mapping[PropertyName, float] = {}

    def begin(name: PropertyName) -> None:
        if progress is not None:
            progress(f"proving {name}")

    together = [name for name in asked if name != "total"]
    for name in asked:
        if name in together[:1]:
            ahead = chosen.ahead(together, jobs if can_fork() else 1, begin)
        begin(name)
        started = time.perf_counter()
        result = chosen.prove(name)
        results.append(replace(result, seconds=ahead.get(name, 0.0) + time.perf_counter() - started))
    verdict = _overall([result.verdict for result in results])
    return Verification(verdict, tuple(results), judged, source, chosen.use, chosen.valid_states())


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


def _overall(verdicts: list[Verdict]) -> Verdict:
    if "refuted" in verdicts:
        return "refuted"
    return "undecided" if "undecided" in verdicts else "proved"
