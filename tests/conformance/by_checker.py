"""The stand-alone checker, which reads the text by itself."""

from __future__ import annotations

from functools import lru_cache
from json import loads
from typing import Any

from tests.checker.standalone import checker
from tests.conformance.roles import Rows
from tests.conformance.world import REMEMBERED, World
from tumato_symbolic.policy import guarantees, policy_from_rows
from tumato_symbolic.policy.unrealizability import Unrealizability, dumps
from tumato_symbolic.semantics import ActionSet, Effort, Guarantee, State
from tumato_symbolic.spec import Ordering
from tumato_symbolic.verify.guarantees.analyse import guarantees as analysed


class Checker:
    """`proofs/checker.py`."""

    name = "checker"

    def refuses(self, text: str) -> bool:
        """When it is read, or its valid states are listed."""
        try:
            checker.Judge(checker.World(checker.read_specification(text.encode()), "any"), lambda _: None)
        except checker.Unreadable:
            return True
        return False

    def valid(self, world: World, state: State) -> bool:
        """`World.is_valid`."""
        return bool(_own(world.text, world.ordering).is_valid(_values(world, state)))

    def safe(self, world: World, state: State) -> bool:
        """`World.is_safe`."""
        return bool(_own(world.text, world.ordering).is_safe(_values(world, state)))

    def allowed(self, world: World, state: State, chosen: ActionSet) -> bool:
        """`World.objection`, which `World.allowed_sets` has to agree with."""
        own, here, each = _own(world.text, world.ordering), _values(world, state), _names(world, chosen)
        found = own.objection(here, each) is None
        assert (each in set(own.allowed_sets(here))) == found, "its search differs"
        return found

    def successor(self, world: World, state: State, chosen: ActionSet) -> State:
        """`World.successor`."""
        after = _own(world.text, world.ordering).successor(_values(world, state), _names(world, chosen))
        return _numbers(world, after)

    def meets(self, world: World, state: State, chosen: ActionSet, there: State) -> bool:
        """`World.reached`."""
        own = _own(world.text, world.ordering)
        return bool(own.reached(own.residual_goal(_values(world, state), _names(world, chosen)), _values(world, there)))

    def faults(self, world: World, rows: Rows) -> set[str]:
        """`Judge.verdicts`."""
        decisions = {_values(world, state): _names(world, chosen) for state, chosen in rows.items()}
        judge = checker.Judge(_own(world.text, world.ordering), decisions.get)
        return {name for name, (states, _) in judge.verdicts().items() if states}

    def following(self, world: World, state: State, chosen: ActionSet) -> set[State]:
        """`World.next_states`."""
        found = _own(world.text, world.ordering).next_states(_values(world, state), _names(world, chosen))
        return {_numbers(world, values) for values in found}

    def level(self, world: World, state: State) -> int:
        """`World.level`."""
        return int(_own(world.text, world.ordering).level(_values(world, state)))

    def efforts(self, world: World, rows: Rows) -> dict[State, Effort]:
        """`Restoring.worst`."""
        decided = {_values(world, state): _names(world, chosen) for state, chosen in rows.items()}
        worst = checker.Restoring(_own(world.text, world.ordering), decided).worst
        return {_numbers(world, values): effort for values, effort in worst.items()}

    def guarantees(self, world: World, rows: Rows) -> dict[State, Guarantee | None]:
        """`Guarantees.level`, by the certificate of the package, once `Guarantees.check_ranks` accepts it."""
        policy = policy_from_rows(world.spec, dict(rows))
        certificate = analysed(policy, world.spec, world.ordering, certify=True).certificate
        assert certificate is not None
        decisions = {_values(world, state): _names(world, chosen) for state, chosen in rows.items()}
        judge = checker.Judge(_own(world.text, world.ordering), decisions.get)
        claims = checker.Guarantees(judge, loads(guarantees.dumps(certificate)))
        try:
            claims.check_ranks()
        except checker.Refuted as refuted:
            raise AssertionError(refuted) from None
        return {state: Guarantee(*claims.level(_values(world, state))) for state in rows}

    def believes(self, world: World, certificate: Unrealizability) -> bool:
        """`judge_no`."""
        try:
            checker.judge_no(_own(world.text, world.ordering), loads(dumps(certificate)))
        except checker.Refuted:
            return False
        return True


@lru_cache(maxsize=REMEMBERED)
def _own(text: str, ordering: Ordering) -> Any:
    return checker.World(checker.read_specification(text.encode()), ordering)


def _values(world: World, state: State) -> tuple[str, ...]:
    return tuple(v.values[value] for v, value in zip(world.spec.variables, state, strict=True))


def _numbers(world: World, values: tuple[str, ...]) -> State:
    return tuple(v.values.index(value) for v, value in zip(world.spec.variables, values, strict=True))


def _names(world: World, chosen: ActionSet) -> frozenset[str]:
    return frozenset(world.spec.actions[number].name for number in chosen)
