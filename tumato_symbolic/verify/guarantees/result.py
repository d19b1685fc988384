"""What is known of the guarantees of a policy."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, TypeAlias

from msgspec import Struct

from tumato_symbolic.semantics import Guarantee, Shortcoming

if TYPE_CHECKING:
    from tumato_symbolic.policy.guarantees import GuaranteesCertificate

StateCube: TypeAlias = tuple[tuple[int, ...], ...]
"""For every variable the values that it may have, ascending; all of them where it does not matter."""


class Level(Struct, frozen=True):
    """The valid states with one guarantee; where they are guaranteed, `guarantee.steps` is the worst of them.

    `cubes` hold these states and no other valid one; None where that takes too many. `shortcoming` shows of one of the
    states why it is guaranteed no more.
    """

    guarantee: Guarantee
    states: int
    cubes: tuple[StateCube, ...] | None
    shortcoming: Shortcoming | None


class Guarantees(Struct, frozen=True):
    """The levels of all valid states, the strongest first.

    `unproved`: the policy's own properties are not proved, so that nothing was looked at. `undecided`: a limit was met,
    as `reason` says. `certificate`: where one was asked for.
    """

    status: Literal["known", "undecided", "unproved"]
    levels: tuple[Level, ...] = ()
    reason: str | None = None
    certificate: GuaranteesCertificate | None = None
