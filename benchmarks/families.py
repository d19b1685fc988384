"""The families that are measured: generators of specifications, deterministic, each with an unrealizable twin."""

from __future__ import annotations

from collections.abc import Callable

from msgspec import Struct

from benchmarks.arbitrary import arbitrary
from benchmarks.cells import counter, grid, obstacles
from benchmarks.cleaning import errands, rooms
from benchmarks.limits import paired, pairs, puzzle, shelf_counts, shelves
from benchmarks.missions import plant, sampler, samples, strewn
from benchmarks.rescue import responders
from benchmarks.robots import amr, loads, robots
from benchmarks.sites import factory, uav


class Family(Struct, frozen=True):
    """`text(size, realizable)` is a specification, or its twin. `sizes` are measured, `quick` in a short run."""

    name: str
    title: str
    text: Callable[[int, bool], str]
    sizes: tuple[int, ...]
    quick: tuple[int, ...]
    limit: bool = False
    """Whether the family shows where the method breaks; a size may then end without an answer."""

    def case(self, size: int) -> str:
        """The name of one size of the family."""
        return self.name if self.sizes == (1,) else f"{self.name} {size}"


FAMILIES = {
    family.name: family
    for family in (
        Family("amr", "the paper's AMR", amr, (1,), (1,)),
        Family("loads", "AMR with n load places, which goals share", loads, (2, 4, 6, 8, 15, 20, 25, 30), (4,)),
        Family("factory", "a robot that serves a press", factory, (1,), (1,)),
        Family("uav", "an inspection UAV", uav, (1,), (1,)),
        Family("robots", "n AMRs that share a charger and a workstation", robots, (2, 3, 4), (2,)),
        Family("samples", "n sample targets", samples, (4, 8, 15, 30), (8,)),
        Family("sampler", "n targets, with a sampler that works beside the motors", sampler, (6, 30), (6,)),
        Family("grid", "n x n cells with walls", grid, (16, 32, 64), (16,)),
        Family("obstacles", "n x n cells, some of them taken", obstacles, (16, 126), (16,)),
        Family("counter", "a variable with n values", counter, (50, 1000), (50,)),
        Family("random", "generated from seed n", arbitrary, (1,), (1,)),
        Family("plant", "a robot among n stations", plant, (1, 4, 7, 10), (1,)),
        Family("strewn", "the plant, declared in a random order", strewn, (4, 10), ()),
        Family("rooms", "n rooms that clean themselves, a goal each", rooms, (12, 20), (12,)),
        Family("errands", "n rooms that one robot cleans, a goal each", errands, (12, 20), (12,)),
        Family("responders", "n engines and n - 1 ambulances", responders, (2, 4), (2,)),
        Family("shelves", "n boxes with names on n shelves", shelves, (4, 6, 8, 10), (4,), limit=True),
        Family("shelf_counts", "n boxes, all alike, on n shelves", shelf_counts, (4, 6, 8, 10), (), limit=True),
        Family("puzzle", "a sliding puzzle of n rows of three", puzzle, (2, 3), (2,), limit=True),
        Family("pairs", "n drives, then their n brakes", pairs, (4, 6, 8, 10), (4,), limit=True),
        Family("paired", "n drives, each with its brake", paired, (4, 6, 8, 10), (), limit=True),
    )
}
