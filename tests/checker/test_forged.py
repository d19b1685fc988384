"""Forged certificates of no, steps and ranks, by the stand-alone checker: right exactly where the text says so."""

from __future__ import annotations

from pathlib import Path
from random import Random

import pytest
from msgspec.structs import replace

from tests.checker.standalone import ask
from tests.printing import formula_text, print_spec
from tests.semantics import literal
from tests.unrealizability import certified as certificate_of
from tests.verify.forgeries import forged
from tests.verify.literal_unrealizable import Meaning, is_proof
from tests.verify.policies import certified
from tests.verify.test_forged_ranks import along, decrease, exact
from tests.verify.test_forged_ranks import forged as forged_ranks
from tests.verify.test_forged_steps import SPECS, compatible, forbidding, writers
from tests.verify.test_forged_unrealizable import CONFLICTS, knotted
from tests.verify.test_unrealizable_by_hand import line, stuck
from tumato_symbolic.policy import dumps, policy_from_rows
from tumato_symbolic.policy.unrealizability import bind
from tumato_symbolic.policy.unrealizability import dumps as dumps_no
from tumato_symbolic.semantics import Residual
from tumato_symbolic.spec import Is, Ordering, Spec

ORDERINGS: tuple[Ordering, ...] = ("any", "first")


def text_of(spec: Spec) -> str:
    """The specification as a user would write it."""
    names = [(variable.name, variable.values) for variable in spec.variables]
    actions = []
    for action in spec.actions:
        entries = []
        for entry in action.alternatives:
            (effect,) = entry.outcomes
            written = [formula_text(Is(*pair), names) for pair in effect]
            entries.append(replace(entry, text=", ".join(written) or "none"))
        actions.append(replace(action, alternatives=tuple(entries)))
    return print_spec(replace(spec, actions=tuple(actions)), Random(0))


UNREALIZABLE: dict[str, tuple[Spec, Ordering]] = {
    **{name: (spec, "any") for name, (spec, _) in CONFLICTS.items()},
    "one step too far": (line(1), "any"),
    "two steps too far": (line(2), "any"),
    "never": (replace(line(), actions=line().actions[:2]), "any"),
    "stuck": (stuck()[1], "any"),
    "knotted": (knotted(), "any"),
    "knotted, first": (knotted(), "first"),
}


@pytest.mark.parametrize("name", UNREALIZABLE)
def test_forged_certificates_of_no(name: str, tmp_path: Path) -> None:
    """A certificate that was changed by one thing holds exactly where all its claims do."""
    spec, ordering = UNREALIZABLE[name]
    certificate = certificate_of(spec, ordering)
    assert certificate is not None
    meaning, text = Meaning(spec, ordering), text_of(spec)
    everything = [certificate, *forged(certificate, literal.states(spec))]
    right = 0
    chosen = [certificate, *Random(1).sample(everything, min(24, len(everything)))]
    for each in chosen:
        answer = ask(tmp_path, dumps_no(each), text, "--effect-ordering", ordering)
        assert (answer.code == 0) == is_proof(meaning, bind(each, spec)), (each.reason, answer)
        right += answer.code == 0
    assert 0 < right < len(chosen)


@pytest.mark.parametrize("ordering", ORDERINGS)
def test_every_outcome_is_found_and_no_other(ordering: Ordering, tmp_path: Path) -> None:
    """A decision fails *safe* exactly where the one forbidden state is an outcome."""
    plain, start = writers().spec(), (0, 0)
    for chosen in compatible(plain):
        ends = literal.outcomes(plain, start, chosen, ordering)
        for state in literal.states(plain)[1:]:
            spec = forbidding(plain, state)
            wrong = state in ends or state == literal.successor(plain, start, chosen)
            policy = dumps(policy_from_rows(spec, {start: chosen}))
            answer = ask(tmp_path, policy, text_of(spec), "--effect-ordering", ordering)
            assert answer.failing.get("safe", 0) == wrong, (chosen, state)


@pytest.mark.parametrize("ordering", ORDERINGS)
def test_every_decision_is_judged_as_written(ordering: Ordering, tmp_path: Path) -> None:
    """In how many states each property fails, for one set of actions everywhere."""
    for spec in SPECS:
        text = text_of(spec)
        valid = [state for state in literal.states(spec) if literal.valid(spec, state)]
        for chosen in literal.sets(spec):
            if len(chosen) > 3:
                continue
            broken = [state for state in valid if [*literal.broken(spec, state, chosen, ordering)]]
            policy = dumps(policy_from_rows(spec, dict.fromkeys(valid, chosen)))
            answer = ask(tmp_path, policy, text, "--effect-ordering", ordering)
            assert answer.failing.get("safe", 0) == len(broken)
            assert answer.failing.get("total", 0) == 0


@pytest.mark.parametrize("bound", [None, 3, 4])
def test_forged_ranks(bound: int | None, tmp_path: Path) -> None:
    """Strictly, ranks that do not decrease to the goal or exceed the bound are wrong, though the policy is right."""
    spec, policy = along(3, bound)
    goal = Residual(frozenset((0,)), frozenset())
    met = set()
    for table in forged_ranks(spec, exact(spec, policy)):
        answer = ask(tmp_path, dumps(certified(spec, policy, {goal: table})), text_of(spec), "--strict")
        needed = [literal.successor(spec, state, policy[state]) for state in policy]
        late = bound is not None and any(table.get(state, 0) >= bound for state in needed)
        right = decrease(spec, policy, table) and not late
        assert ("wrong" in answer.out.lower()) == (not right), (table, answer.out)
        met.add(right)
    assert met == {True, False}
