"""*No part that has all starts has a policy*: states are removed, then one is a start (`docs/certificate.md`)."""

from __future__ import annotations

from collections.abc import Iterator

from tumato_symbolic.limits import Budget
from tumato_symbolic.policy import formula_of
from tumato_symbolic.policy.unrealizability import Conflict, Divided, NoPart, Removal, StartRemoved
from tumato_symbolic.semantics import State, is_start, is_valid, state_text
from tumato_symbolic.semantics.judge import one_of
from tumato_symbolic.spec import And, Formula, Not, Ordering, Spec
from tumato_symbolic.verify.unrealizability.false_claim import FalseClaimError
from tumato_symbolic.verify.unrealizability.obligations import Obligations
from tumato_symbolic.verify.unrealizability.removal import check_removal, removed


def conflicts_of(reason: NoPart) -> Iterator[Conflict]:
    """All conflicts that the argument needs."""
    yield from (part.conflict for part in reason.parts if isinstance(part, Divided))


def check_no_part(reason: NoPart, spec: Spec, ordering: Ordering, budget: Budget) -> Obligations:
    """What was proved. Raises `FalseClaimError` where a claim does not hold, `UndecidedError` where it is left open."""
    proved, left = Obligations(0, 0, 0), dict[int, Formula | None]({0: None})
    for number, part in enumerate(reason.parts):
        if number not in left:
            raise FalseClaimError(f"part {number} is no case of an earlier one")
        after = left[number]
        for place, removal in enumerate(part.removals):
            name = f"removal {place} of part {number}"
            found = check_removal(removal, name, _narrowed(spec, after), ordering, budget.until())
            proved, after = proved.plus(Obligations(0, 0, found)), _left_after(after, removal)
        if isinstance(part, StartRemoved):
            _check_start(part.state, spec, after)
            proved = proved.plus(Obligations(1, 0, 0))
            continue
        for case in part.cases:
            if case.part <= number or case.part in left:
                raise FalseClaimError(f"a case of part {number} is not a part of its own")
            left[case.part] = _both(after, Not(one_of([case.state])))
        _check_cases(part, spec)
        proved = proved.plus(_check_conflict(part.conflict, _narrowed(spec, after), ordering, budget))
    missing = sorted(set(left) - set(range(len(reason.parts))))
    if missing:
        raise FalseClaimError(f"there is no part {missing[0]}")
    return proved


def _left_after(left: Formula | None, removal: Removal) -> Formula:
    return _both(left, Not(formula_of(*removed(removal))))


def _narrowed(spec: Spec, left: Formula | None) -> Spec:
    return spec if left is None else spec.within(left)


def _check_cases(part: Divided, spec: Spec) -> None:
    """Every state of a conflict that is no start has a case."""
    others = {case.state for case in part.cases}
    for state in (part.conflict.choices[start].state for start in part.conflict.starts):
        if not is_start(spec, state) and state not in others:
            raise FalseClaimError(f"the state {state_text(spec, state)} is no start, and there is no case without it")


def _check_start(state: State, spec: Spec, left: Formula | None) -> None:
    """The state is a start, and is not among those that are left."""
    if not is_start(spec, state):
        raise FalseClaimError(f"the state {state_text(spec, state)} is no start, so it need not be decided")
    if left is None or is_valid(spec.within(left), state):
        raise FalseClaimError(f"the state {state_text(spec, state)} is not among those that are removed")


def _check_conflict(conflict: Conflict, spec: Spec, ordering: Ordering, budget: Budget) -> Obligations:
    """The states cannot be served together by what decides these valid states only."""
    from tumato_symbolic.verify.unrealizability.by_solver import check_allowed_steps

    return check_allowed_steps(conflict, spec, ordering, budget)


def _both(left: Formula | None, more: Formula) -> Formula:
    return more if left is None else And((left, more))
