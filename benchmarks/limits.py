"""Where decision diagrams blow up, and the same job said differently."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations

from benchmarks.writing import Text, all_of


def shelves(count: int, realizable: bool) -> str:
    """Boxes with names on as many shelves and a table, never two on one shelf: hard in every order of variables.

    A diagram has to remember which shelves are taken, which are 2^n sets. The twin asks for two boxes on one shelf.
    """
    text = Text()
    places = [f"shelf{place}" for place in range(count)]
    text.resource("ARM")
    for box in range(count):
        text.state(f"S_Box{box}", "table", *places)
        text.action(f"take_{box}", f"S_Box{box} is table", when=f"NOT S_Box{box} is table", holds=("ARM",))
        text.action(f"put_{box}", f"S_Box{box} is {places[box]}", when=f"S_Box{box} is table", holds=("ARM",))
    for place in places:
        for first, second in combinations(range(count), 2):
            text.assume(f"NOT (S_Box{first} is {place} AND S_Box{second} is {place})")
    wanted = [f"S_Box{box} is {places[box]}" for box in range(count)]
    text.goal(all_of(wanted if realizable else [*wanted[:-1], f"S_Box{count - 1} is {places[0]}"]))
    return text.render()


def shelf_counts(count: int, realizable: bool) -> str:
    """The same store for boxes that are all alike: a shelf is free or taken, and nothing blows up."""
    text = Text()
    text.resource("ARM")
    for place in range(count):
        text.state(f"S_Shelf{place}", "free", "taken")
        text.action(f"put_{place}", f"S_Shelf{place} is taken", when=f"S_Shelf{place} is free", holds=("ARM",))
    filled = range(count if realizable else count - 1)
    wanted = [f"S_Shelf{place} is taken" for place in filled]
    text.goal(all_of(wanted if realizable else [*wanted, f"S_Shelf{count - 1} is free"]))
    return text.render()


def pairs(count: int, realizable: bool, together: bool = False) -> str:
    """Drives and their brakes, which belong together; declared apart (all drives first), or pair by pair.

    A brake is closed exactly when its drive is off. The twin wants one drive on with its brake closed.
    """
    text = Text()
    drives = [(f"S_Drive{i}", ("off", "on")) for i in range(count)]
    brakes = [(f"S_Brake{i}", ("closed", "open")) for i in range(count)]
    declared = [each for pair in zip(drives, brakes, strict=True) for each in pair] if together else drives + brakes
    for name, values in declared:
        text.state(name, *values)
    for i in range(count):
        text.resource(f"AXIS{i}")
        text.assume(f"S_Drive{i} is off IFONLYIF S_Brake{i} is closed")
        text.action(f"start_{i}", f"S_Drive{i} is on, S_Brake{i} is open", holds=(f"AXIS{i}",))
        text.action(f"stop_{i}", f"S_Drive{i} is off, S_Brake{i} is closed", holds=(f"AXIS{i}",))
    text.goal(all_of([f"S_Drive{i} is on" for i in range(count)] + ([] if realizable else ["S_Brake0 is closed"])))
    return text.render()


def paired(count: int, realizable: bool) -> str:
    """`pairs`, declared pair by pair."""
    return pairs(count, realizable, together=True)


COLUMNS = 3


def puzzle(rows: int, realizable: bool) -> str:
    """The sliding puzzle with rows of three, a variable for every place; three rows are 181,440 arrangements.

    Half of the arrangements are never met, and which ones depends on all places. The twin wants one of these.
    """
    text, places = Text(), range(rows * COLUMNS)
    tiles = [f"tile{number}" for number in places if number]
    text.resource("HAND")
    for place in places:
        text.state(f"S_Place{place}", "blank", *tiles)
    for source, target in _beside(rows):
        for tile in tiles:
            moved = f"S_Place{source} is blank, S_Place{target} is {tile}"
            there = f"S_Place{source} is {tile}, S_Place{target} is blank"
            text.action(f"slide_{tile}_{source}_{target}", moved, when=there, holds=("HAND",))
    for value in ("blank", *tiles):
        for first, second in combinations(places, 2):
            text.assume(f"NOT (S_Place{first} is {value} AND S_Place{second} is {value})")
    text.start(_arranged(["blank", *tiles]))
    text.goal(_arranged(["blank", *tiles] if realizable else ["blank", *tiles[:-2], tiles[-1], tiles[-2]]))
    return text.render()


def _arranged(values: list[str]) -> str:
    return all_of([f"S_Place{place} is {value}" for place, value in enumerate(values)])


def _beside(rows: int) -> Iterator[tuple[int, int]]:
    """Places that touch each other, both ways."""
    for place in range(rows * COLUMNS):
        if place % COLUMNS + 1 < COLUMNS:
            yield from ((place, place + 1), (place + 1, place))
        if place + COLUMNS < rows * COLUMNS:
            yield from ((place, place + COLUMNS), (place + COLUMNS, place))
