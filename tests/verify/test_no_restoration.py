"""Certificates that safety is never surely restored (`docs/certificate.md`, *no restoration*)."""

from collections.abc import Iterator
from random import Random

import pytest
from msgspec.structs import replace

from tests.restoration.campaign import specifications
from tests.semantics.test_restoration import EDGE, RETRY, VALVES, restoring
from tumato_symbolic import Unrealizable, parse, synthesize
from tumato_symbolic.diagrams import DiagramBuilder
from tumato_symbolic.policy import Vocabulary
from tumato_symbolic.policy.unrealizability import NoRestoration, Unrealizability, dumps, loads
from tumato_symbolic.semantics import (
    State,
    all_states,
    allowed_sets,
    is_safe,
    is_valid,
    level,
    next_states,
    successor,
)
from tumato_symbolic.spec import Ordering, Spec
from tumato_symbolic.verify import UnrealizabilityVerdict, verify_unrealizable


def certified(spec: Spec, ordering: Ordering = "any") -> Unrealizability | None:
    """The certificate that safety is not restored, read from its file, where that is why there is no policy."""
    outcome = synthesize(spec, ordering)
    found = outcome.certificate if isinstance(outcome, Unrealizable) else None
    if found is None or not isinstance(found.reason, NoRestoration):
        return None
    assert loads(dumps(found)) == found
    return found


def judged(spec: Spec, state: State, trap: set[State], ordering: Ordering = "any") -> UnrealizabilityVerdict:
    """The verdict on a trap that anybody may have written."""
    builder = DiagramBuilder[bool](range(len(spec.variables)), (False, True))
    sizes = [len(variable.values) for variable in spec.variables]
    root = builder.from_table(sizes, dict.fromkeys(trap, True), False)
    forged = Unrealizability(Vocabulary.of(spec), ordering, "x", NoRestoration(state, builder.finish(), root))
    return verify_unrealizable(replace(forged, restoration=spec.restoration), spec)


def holds_fast(spec: Spec, state: State, held: set[State], ordering: Ordering) -> bool:
    """Whether a set holds a state for ever, by the definition."""
    trap = {each for each in held if is_valid(spec, each) and level(spec, each) == level(spec, state)}

    def stays(here: State) -> Iterator[bool]:
        for chosen in allowed_sets(spec, here, ordering):
            after = next_states(spec, here, chosen, ordering)
            yield successor(spec, here, chosen) in trap if spec.restoration == "fair" else bool(after & trap)

    unsafe = is_valid(spec, state) and not is_safe(spec, state)
    return unsafe and state in trap and all(all(stays(here)) for here in trap)


@pytest.mark.parametrize("seed", range(5000, 5006))
def test_what_synthesis_writes_is_proved_and_anything_else_is_judged_rightly(seed: int) -> None:
    """Traps of generated specifications, as they are and with states put in or left out."""
    dice = Random(seed)
    for _, spec in specifications(seed):
        if spec.restoration == "one_step":
            continue
        for ordering in ("any", "first"):
            certificate = certified(spec, ordering)
            if certificate is None:
                continue
            verdict = verify_unrealizable(certificate, spec)
            assert (verdict.verdict, verdict.kind, verdict.stale) == ("proved", "no-restoration", False)
            reason = certificate.reason
            assert isinstance(reason, NoRestoration)
            trap = {state for state in all_states(spec) if reason.diagram.evaluate(reason.root, state)}
            for _ in range(4):
                other = dice.choice(list(all_states(spec)))
                changed, state = trap ^ {other}, dice.choice((reason.state, reason.state, other))
                found = judged(spec, state, changed, ordering).verdict
                assert found == ("proved" if holds_fast(spec, state, changed, ordering) else "refuted")


@pytest.mark.parametrize(
    ("spec", "state", "trap", "why"),
    [
        (restoring(RETRY, "bounded"), (1,), {(0,), (1,)}, "is not unsafe"),
        (restoring(RETRY, "bounded"), (0,), {(1,)}, "is not in the trap"),
        (restoring(RETRY, "fair"), (0,), {(0,)}, "leads out of the trap"),
        (restoring(VALVES, "bounded"), (0, 0), {(0, 0), (0, 1)}, "leads out of the trap"),
        (restoring(RETRY, "one_step"), (0,), {(0,)}, "in one step"),
    ],
)
def test_what_is_no_trap_is_refuted(spec: Spec, state: State, trap: set[State], why: str) -> None:
    """With the check that fails."""
    verdict = judged(spec, state, trap)
    assert verdict.verdict == "refuted"
    assert why in (verdict.reason or "")


def test_a_trap_is_one_level() -> None:
    """Higher levels in the diagram mean nothing: to get there is to be restored."""
    spec = replace(parse(EDGE.format(2, 1)), restoration="bounded")
    certificate = certified(spec)
    assert certificate is not None
    everything = set(all_states(spec))
    assert judged(spec, certificate.reason.state, everything).verdict == "proved"  # type: ignore[union-attr]
    severe = replace(parse(EDGE.format(1, 2)), restoration="bounded")
    assert judged(severe, (0, 1), everything).verdict == "refuted"
