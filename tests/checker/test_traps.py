"""Certificates that safety is never restored, as they are written and changed: the checker and the package agree."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from random import Random

import pytest
from msgspec.structs import replace

from tests.checker.standalone import ask
from tests.checker.stepwise import stepwise_spec, ways
from tests.printing import print_spec
from tests.semantics.test_restoration import VALVES, restoring
from tests.verify.test_no_restoration import certified, holds_fast
from tumato_symbolic.diagrams import DiagramBuilder
from tumato_symbolic.policy.unrealizability import NoRestoration, dumps
from tumato_symbolic.semantics import all_states
from tumato_symbolic.spec import Ordering, Restoration
from tumato_symbolic.verify import verify_unrealizable

CASES: list[tuple[Restoration, int]] = [
    ("bounded", 1),
    ("bounded", 2),
    ("bounded", 3),
    ("fair", 1),
    ("fair", 2),
    ("fair", 3),
]
ORDERINGS: tuple[Ordering, ...] = ("any", "first")


@pytest.mark.parametrize(("restoration", "tiers"), CASES)
def test_traps(restoration: Restoration, tiers: int, tmp_path: Path) -> None:
    """As synthesis writes them, and with a state put in or left out, or another state that they are about."""
    met = Counter[bool]()
    for seed in range(40):
        dice, draw = Random(seed), ways if seed % 2 else stepwise_spec
        spec = draw(seed, restoration, tiers)
        text, states = print_spec(spec, dice), list(all_states(spec))
        for ordering in ORDERINGS:
            certificate = certified(spec, ordering)
            if certificate is None or not isinstance(certificate.reason, NoRestoration):
                continue
            options = "--effect-ordering", ordering, "--strict"
            assert ask(tmp_path, dumps(certificate), text, *options).code == 0
            reason = certificate.reason
            trap = {state for state in states if reason.diagram.evaluate(reason.root, state)}
            for _ in range(5):
                held, state = trap ^ {dice.choice(states)}, dice.choice((reason.state, reason.state, *states[:2]))
                builder = DiagramBuilder[bool](range(len(spec.variables)), (False, True))
                sizes = [len(variable.values) for variable in spec.variables]
                root = builder.from_table(sizes, dict.fromkeys(held, True), False)
                changed = NoRestoration(state, builder.finish(), root)
                answer = ask(tmp_path, dumps(replace(certificate, reason=changed)), text, *options)
                holds = holds_fast(spec, state, held, ordering)
                assert (answer.code == 0) == holds, (seed, ordering, state, held, answer)
                met[holds] += 1
        if min(met[True], met[False]) >= 6:
            break
    assert min(met[True], met[False]) >= 6, met


def test_a_trap_is_no_reason_where_one_step_restores(tmp_path: Path) -> None:
    """As for the package: it may well be that no set is allowed there, but that is another certificate."""
    stuck = VALVES.replace("is closed\nEND ACTIONS", "is open\nEND ACTIONS")
    certificate = certified(restoring(stuck, "bounded"))
    assert certificate is not None
    for restoration, code in (("bounded", 0), ("one_step", 1)):
        answer = ask(tmp_path, dumps(certificate), stuck, "--restoration", restoration)
        assert answer.code == code, answer
        verdict = verify_unrealizable(certificate, restoring(stuck, restoration)).verdict  # type: ignore[arg-type]
        assert verdict == ("refuted" if code else "proved")
