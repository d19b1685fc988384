"""`verify`: proves or refutes a policy against a specification (`docs/certificate.md`)."""

from __future__ import annotations

import time
from collections.abc import Iterator, Mapping, Sequence

from msgspec.structs import replace

from tumato_symbolic.diagnostics import Code, Diagnostic, UserError
from tumato_symbolic.limits import Budget, Context, LimitReachedError
from tumato_symbolic.limits.processes import can_fork
from tumato_symbolic.policy import Policy, bind, judged_within, made_for_less, restores_less
from tumato_symbolic.semantics import all_states, count_states, is_valid
from tumato_symbolic.spec import Ordering, Restoration, Spec
from tumato_symbolic.verify.closure import with_departure
from tumato_symbolic.verify.decisions import LARGEST_TABLE, Decisions
from tumato_symbolic.verify.portfolio import Prover, make_prover
from tumato_symbolic.verify.result import (
    PROPERTIES,
    CertificateUse,
    OrderingSource,
    PropertyName,
    PropertyResult,
    ProverName,
    Refutation,
    Verdict,
    Verification,
    properties_of,
    stopped,
)
from tumato_symbolic.verify.undecided import OBLIGATION_BUDGET


def verify(
    policy: Policy,
    spec: Spec,
    *,
    ordering: Ordering | None = None,
    restoration: Restoration | None = None,
    properties: Sequence[str] = PROPERTIES,
    prover: ProverName = "auto",
    timeout: float | None = OBLIGATION_BUDGET,
    jobs: int = 1,
    context: Context | None = None,
) -> Verification:
    """Prove `policy` for all valid states of `spec`, or refute it with a witness.

    `ordering` overrules what the specification says of the order of effects; where there is none, a policy that
    was made for `first` is refuted if the specification means `any`. `restoration` overrules how safety is restored;
    where there is none, a policy that was made for a weaker way is refuted. `properties` are some of `total`, `safe`,
    `restoring` (asked where safety may take several steps to restore), `goals` and `minimal`. `prover` is `z3`; `walk`,
    which does without Z3; `both`, which must agree; or `auto`: Z3 for what it answers soon, the walk for the rest.
    `timeout` limits the time, in seconds, of each obligation of Z3 and of each property of the walk (None: no limit);
    what is not proved in time is undecided. Up to `jobs` processes work at a time, where the proof is large and the
    platform can fork; the answer is the same. `context` limits the whole; it is told what is being proved, and learns
    after every property what the answer would be if a limit were met now.

    Raises `UserError` when the names of the policy do not fit the specification, or no state is valid.
    """
    if restoration is not None:
        spec = replace(spec, restoration=restoration)
    context, asked = context or Context(), _asked(properties, spec)
    bound = bind(policy, spec)
    spec = judged_within(spec, bound)
    decisions = Decisions(spec, bound)
    so_far = _nothing_known(spec, ordering)
    results = list(_made_for_less(bound, spec, ordering, restoration))
    try:
        _learn(context, so_far, results, asked)
        context.tell("looking for a valid state")
        chosen = make_prover(prover, spec, bound, so_far.ordering, Budget(timeout, context))
        if not chosen.has_valid_state():
            raise UserError((_nothing_to_decide(spec),))
        for result in _results(chosen, asked, jobs if can_fork() else 1, context):
            results.append(result)
            so_far = replace(so_far, certificate=chosen.use)
            _learn(context, so_far, results, asked)
            if result.refutation is not None and result.refutation.kind == "missing" and not spec.starts:
                refutation = with_departure(result.refutation, spec, decisions, so_far.ordering, context)
                results[-1] = replace(result, refutation=refutation)
        context.tell("counting the valid states")
        return _counted(_with(so_far, results), decisions, spec, chosen.valid_states())
    except LimitReachedError as limit:
        return stopped(_with(so_far, results, asked), str(limit))


def _nothing_known(spec: Spec, ordering: Ordering | None) -> Verification:
    """The answer before anything is asked."""
    used, source = _ordering(spec, ordering)
    answer = Verification("undecided", (), used, source, CertificateUse("unneeded"), None, spec=spec)
    if spec.starts:
        answer = replace(answer, from_starts=True)
    return replace(answer, restoration=spec.restoration) if spec.restores_stepwise else answer


def _made_for_less(
    policy: Policy, spec: Spec, ordering: Ordering | None, restoration: Restoration | None
) -> Iterator[PropertyResult]:
    """That a policy was made for less than the specification means, where nothing overrules that."""
    if ordering is None and made_for_less(policy, spec):
        yield PropertyResult("ordering", "refuted", refutation=Refutation("ordering"))
    if restoration is None and restores_less(policy, spec):
        yield PropertyResult("restoration", "refuted", refutation=Refutation("restoration"))


def _nothing_to_decide(spec: Spec) -> Diagnostic:
    if spec.starts:
        message = "no valid state is a start, so there is nothing to decide"
        return Diagnostic(Code.TUM317, message, help="weaken the start conditions, or an assumption")
    message = "no state satisfies all assumptions, so there is nothing to decide"
    return Diagnostic(Code.TUM312, message, help="drop or weaken an assumption")


def _results(prover: Prover, asked: Sequence[PropertyName], jobs: int, context: Context) -> Iterator[PropertyResult]:
    """The verdicts on the properties, one after the other. Raises `LimitReachedError`."""
    spent: Mapping[PropertyName, float] = {}
    together = [name for name in asked if name != "total"]

    def begin(name: PropertyName) -> None:
        context.tell(f"proving {name}")

    for name in asked:
        if name in together[:1]:
            spent = prover.prove_parts(together, jobs, begin)
        begin(name)
        started = time.perf_counter()
        result = prover.prove(name)
        if result.verdict == "undecided":
            context.check()
        yield replace(result, seconds=spent.get(name, 0.0) + time.perf_counter() - started)


def _with(so_far: Verification, results: Sequence[PropertyResult], asked: Sequence[PropertyName] = ()) -> Verification:
    """The answer with these results, and no verdict on what else was asked."""
    done = {result.name for result in results}
    every = (*results, *(PropertyResult(name, "undecided") for name in asked if name not in done))
    return replace(so_far, verdict=_overall([result.verdict for result in every]), properties=every)


def _counted(answer: Verification, decisions: Decisions, spec: Spec, valid: int | None) -> Verification:
    """The answer with the numbers of valid and of decided states; one by one where that is cheap, else unknown."""
    if answer.decides_all:
        return replace(answer, valid_states=valid, decided_states=valid)
    if valid is None and count_states(spec) <= LARGEST_TABLE:
        valid = sum(is_valid(spec, state) for state in all_states(spec))
    if spec.starts and valid is not None:  # only what is decided is looked at
        return replace(answer, valid_states=_valid_at_all(spec), decided_states=valid)
    rows = decisions.rows
    decided = None if rows is None else len(rows)
    if spec.starts:
        return replace(answer, valid_states=_valid_at_all(spec), decided_states=decided)
    return replace(answer, valid_states=valid, decided_states=decided)


def _valid_at_all(spec: Spec) -> int | None:
    """How many states are valid, decided or not; None where there are too many to look at."""
    if count_states(spec) > LARGEST_TABLE:
        return None
    return sum(is_valid(spec.whole, state) for state in all_states(spec))


def _learn(
    context: Context, so_far: Verification, results: Sequence[PropertyResult], asked: Sequence[PropertyName]
) -> None:
    context.learn(_with(so_far, results, asked))


def _asked(properties: Sequence[str], spec: Spec) -> list[PropertyName]:
    unknown = [name for name in properties if name not in PROPERTIES]
    if unknown or not properties:
        raise ValueError(f"properties must be some of {', '.join(PROPERTIES)}, not {list(properties)}")
    return [name for name in properties_of(spec) if name in properties]


def _ordering(spec: Spec, argument: Ordering | None) -> tuple[Ordering, OrderingSource]:
    if argument is not None:
        return argument, "command line"
    return spec.ordering, "default" if spec.effect_ordering is None else "specification"


def _overall(verdicts: list[Verdict]) -> Verdict:
    if "refuted" in verdicts:
        return "refuted"
    return "undecided" if "undecided" in verdicts else "proved"
