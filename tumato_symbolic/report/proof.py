"""What was proved and by whom, or a counterexample step by step: in the reports of `synth` and `verify`."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from tumato_symbolic.diagnostics.wording import one_line
from tumato_symbolic.report.layout import Paint, count, enumeration, every, seconds
from tumato_symbolic.report.objections import Place, broken_here, effects_text, objection_text, outcome_json
from tumato_symbolic.semantics import ActionSet, Quality, Run, action_names, duration, in_json
from tumato_symbolic.spec import Ordering, Restoration, Spec
from tumato_symbolic.verify.result import PROVERS, PropertyName, PropertyResult, Refutation, Verification

ORDERINGS: Final[dict[Ordering, str]] = {
    "any": "in any order, one after the other (any)",
    "first": "only the first one counts (first)",
}

_CLAIMS: Final[dict[PropertyName, str]] = {
    "total": "every valid state has a decision",
    "safe": "every decision is allowed: whatever effects occur, no rule is broken",
    "goals": "from every {decided} state, the nominal run reaches the active goals",
    "minimal": "where safety is restored, no cheaper set would do as well",
    "ordering": "the policy was made for the effect ordering that the specification means",
    "restoring": "safety is restored from every unsafe state, {how}",
    "restoration": "the policy was made to restore safety as the specification means",
}

_SEVERAL_STEPS: Final[dict[PropertyName, str]] = {
    "safe": "every decision is allowed: whatever effects occur, no rule is broken that has to be kept",
    "minimal": "no set that may be executed would restore safety better and serve as well",
}
"""What is said instead where safety may take several steps to restore."""

_FROM_STARTS: Final[dict[PropertyName, str]] = {
    "total": "every start has a decision, and so has no state that is not valid",
    "safe": "every decision is allowed: whatever effects occur, no rule is broken, and the next state is decided",
}
"""What is said instead where there are starts."""

_HOW: Final[dict[Restoration | None, str]] = {
    None: "",
    "one_step": "in one step for each severity",
    "bounded": "whatever effects occur",
    "fair": "if nominal effects occur again and again",
}

_STEPS_SHOWN = 12
"""So many steps of a counterexample are shown."""


def proof_text(verification: Verification, valid: int, took: float, paint: Paint) -> str:
    """What is proved of a policy, property by property, and what stayed open."""
    results = verification.properties
    states = states_covered(verification) if verification.from_starts else every(valid, "valid state")
    head = f"{paint.good('Proved')} by {provers(verification)} for {states}, in {seconds(took)}:"
    if verification.verdict != "proved":
        head = f"{paint.doubt('Not everything could be proved')}; it took {seconds(took)}:"
    return "\n".join((head, *(f"  {property_line(result, paint, verification)}" for result in results)))


def states_covered(verification: Verification) -> str:
    """Of which states a verification speaks: `all 64 valid states`, `the 5 of 64 valid states that it decides`."""
    decided, valid = verification.decided_states, verification.valid_states
    if verification.decides_all:
        return "all valid states" if valid is None else every(valid, "valid state")
    if decided is None:
        return "the valid states that it decides"
    if valid is None:
        return f"the {count(decided, 'valid state')} that it decides"
    return f"the {decided:,} of {count(valid, 'valid state')} that it decides"


def provers(verification: Verification) -> str:
    """Who proved what is proved."""
    return prover_names("+".join(result.proved_by for result in verification.properties if result.proved_by))


def prover_names(proved_by: str) -> str:
    """The names of provers, as `z3+walk`, for a person."""
    names = dict.fromkeys(filter(None, proved_by.split("+")))
    return enumeration([PROVERS.get(name, name) for name in names])


def property_line(result: PropertyResult, paint: Paint, verification: Verification) -> str:
    """One property with its verdict."""
    verdict = {
        "proved": paint.good("proved"),
        "refuted": paint.bad("refuted"),
        "undecided": paint.doubt("undecided"),
    }[result.verdict]
    reason = f" ({result.reason})" if result.reason else ""
    prover = f" by {prover_names(result.proved_by)}" if result.proved_by not in (None, "z3") else ""
    width = max(9, *(len(each.name) + 1 for each in verification.properties), len(result.name) + 1)
    return f"{result.name:<{width}}{verdict}{prover}: {claim_of(result, verification)}{reason}"


def claim_of(result: PropertyResult, verification: Verification) -> str:
    """What a property says of the policy."""
    claims = _CLAIMS if verification.restoration is None else _CLAIMS | _SEVERAL_STEPS
    claims = claims | _FROM_STARTS if verification.from_starts else claims
    decided = "valid" if verification.decides_all else "decided"
    return claims[result.name].format(decided=decided, how=_HOW[verification.restoration])


def refutation_text(place: Place, refutation: Refutation) -> str:
    """The state, the decision, and what goes wrong, as one or more lines."""
    if refutation.kind == "restoration":
        return (
            "the policy was made for a weaker way to restore safety than the specification means: synthesize it\n"
            "again, or choose one of them with --restoration"
        )
    if refutation.state is None or refutation.kind == "ordering":
        return (
            "the policy was made for the effect ordering first, under which fewer outcomes count, while the\n"
            "specification means any: synthesize it again, or choose one of them with --effect-ordering"
        )
    state = refutation.state
    lines = [f"in the state {place.state(state)}"]
    if broken := broken_here(place, state):
        lines.append(f"({broken})")
    if refutation.decision is None:
        nothing = "which is a start, the policy decides nothing" if place.spec.starts else "the policy decides nothing"
        return "\n".join((*lines, nothing, *_way_there(place, refutation)))
    lines.append(f"the policy executes {place.actions(refutation.decision)}")
    match refutation:
        case Refutation(kind="invalid"):
            lines.append("although the state is not valid: a policy from the starts decides valid states only")
        case Refutation(kind="not-allowed", objection=objection) if objection is not None:
            lines.append(f"which is not allowed: {objection_text(place, objection, state)}")
        case Refutation(kind="goal-missed", run=run) if run is not None:
            lines += [
                f"but its goal is {place.goals(state)}",
                f"and the run {_ENDS[run.end]}:",
                *_run_lines(place, run),
            ]
        case Refutation(kind="not-restored", run=run):
            lines += _not_restored_lines(place, run)
        case Refutation(kind="not-minimal", cheaper=cheaper) if cheaper is not None:
            lines.append(_better_text(place, refutation, refutation.decision, cheaper))
            lines += _run_lines(place, refutation.run) if refutation.run else []
    return "\n".join(lines)


def _not_restored_lines(place: Place, run: Run | None) -> Iterator[str]:
    """How an unsafe state is never left for a better one."""
    if place.spec.restoration == "fair":
        claim, ends = "after which the nominal run does not restore safety", _NEVER_NOMINALLY
    else:
        claim, ends = "which need not restore safety", _NEVER
    if run is None:
        yield claim
        return
    yield f"{claim}: {ends[run.end]}:"
    yield from _run_lines(place, run)


_NEVER: Final = {
    "loop": "its outcomes and those of later decisions may lead back to a state",
    "undefined": "its outcomes and those of later decisions may lead to where nothing can be done",
}

_NEVER_NOMINALLY: Final = {
    "loop": "it comes back to a state",
    "undefined": "it ends where nothing can be done",
}


def _better_text(place: Place, refutation: Refutation, decision: ActionSet, cheaper: ActionSet) -> str:
    """That another set restores safety better than the decision, and serves as well."""
    spec, better = place.spec, place.actions(cheaper)
    if not spec.restores_stepwise:
        return (
            f"which takes {duration(spec, decision)}; {better} takes {duration(spec, cheaper)}, is allowed, "
            "and its run reaches the goal:"
        )
    if refutation.qualities is None:
        return f"but {better} may be executed, restores safety better, and keeps no run from its goal; its own run:"
    now, then = refutation.qualities
    does = "does not restore safety" if now is None else f"restores safety {_quality_text(now)}"
    return (
        f"which {does}; {better} restores it {_quality_text(then)},\n"
        "may be executed, and keeps no run from its goal; its own run:"
    )


def _quality_text(quality: Quality) -> str:
    kind, (takes, steps) = quality
    verb = "takes" if steps == 1 else "take"
    if kind == 0:
        return f"in one step that takes {takes}"
    if kind == 1:
        return f"in at most {count(steps, 'step')} that {verb} at most {takes}"
    return f"in {count(steps, 'nominal step')} that {verb} {takes}"


def _way_there(place: Place, refutation: Refutation) -> Iterator[str]:
    """How a policy gets to a state that it does not decide, or that it does not."""
    departure = refutation.departure
    if departure is not None:
        yield f"although in {place.state(departure.state)} it executes {place.actions(departure.decision)},"
        yield f"which may lead there: {effects_text(place, departure.outcome)}"
    elif refutation.closed:
        yield "(no run from a decided state gets there: all that decisions may lead to is decided)"


_ENDS: Final = {
    "goal": "reaches it",
    "bound": "does not reach it within max_plan_length",
    "loop": "never reaches it, because it comes back to a state",
    "undefined": "ends in a state without a decision",
}


def _run_lines(place: Place, run: Run) -> list[str]:
    lines = [f"  {place.state(run.states[0])}"]
    steps = list(zip(run.decisions, run.states[1:], strict=True))
    for chosen, state in steps[:_STEPS_SHOWN]:
        lines.append(f"  → {place.actions(chosen)} → {place.state(state)}")
    if len(steps) > _STEPS_SHOWN:
        lines.append(f"  … and {count(len(steps) - _STEPS_SHOWN, 'more step')}")
    return lines


def proof_json(spec: Spec, verification: Verification) -> dict[str, object]:
    """A verification for a program."""
    return {
        "verdict": verification.verdict,
        "properties": {result.name: _property_json(spec, result) for result in verification.properties},
        "effect_ordering": verification.ordering,
        "valid_states": verification.valid_states,
        "decided_states": verification.decided_states,
        "certificate": {"status": verification.certificate.status, "reason": verification.certificate.reason},
        **({} if verification.restoration is None else {"restoration": verification.restoration}),
    }


def _property_json(spec: Spec, result: PropertyResult) -> dict[str, object]:
    return {
        "verdict": result.verdict,
        "proved_by": result.proved_by,
        "obligations": result.obligations,
        "reason": result.reason,
        "seconds": round(result.seconds, 3),
        "refutation": _refutation_json(spec, result.refutation) if result.refutation else None,
    }


def _refutation_json(spec: Spec, refutation: Refutation) -> dict[str, object]:
    state, decision, objection, run = refutation.state, refutation.decision, refutation.objection, refutation.run
    found: dict[str, object] = {
        "kind": refutation.kind,
        "state": in_json(spec, state) if state is not None else None,
        "decision": list(action_names(spec, decision)) if decision is not None else None,
    }
    if refutation.kind == "missing":
        departure = refutation.departure
        found["closed"] = refutation.closed
        found["departure"] = None
        if departure is not None:
            found["departure"] = {
                "state": in_json(spec, departure.state),
                "decision": list(action_names(spec, departure.decision)),
                "outcome": outcome_json(spec, departure.outcome),
            }
    if objection is not None:
        found["objection"] = {
            "kind": objection.kind,
            "actions": [spec.actions[number].name for number in objection.actions],
            "rule": one_line(objection.rule.text) if objection.rule else None,
            "line": objection.rule.span.line if objection.rule else None,
            "outcome": outcome_json(spec, objection.outcome),
        }
    if run is not None:
        found["run"] = {
            "end": run.end,
            "states": [in_json(spec, visited) for visited in run.states],
            "decisions": [list(action_names(spec, chosen)) for chosen in run.decisions],
        }
    if refutation.cheaper is not None and decision is not None:
        found["cheaper"] = list(action_names(spec, refutation.cheaper))
        found["durations"] = {"decision": duration(spec, decision), "cheaper": duration(spec, refutation.cheaper)}
    if refutation.qualities is not None:
        now, then = map(_quality_json, refutation.qualities)
        found["restoring"] = {"decision": now, "cheaper": then}
    return found


def _quality_json(quality: Quality | None) -> dict[str, object] | None:
    if quality is None:
        return None
    kind, (takes, steps) = quality
    return {"how": ("one step", "bounded", "fair")[kind], "duration": takes, "steps": steps}
