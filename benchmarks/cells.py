"""Families of cells: a walled grid, one with obstacles, and a counter."""

from __future__ import annotations

from random import Random

from benchmarks.writing import Text

WALL_EVERY = 16
"""Columns from one wall of the grid to the next; the first wall is half of that away from the border."""


def grid(size: int, realizable: bool) -> str:
    """A square of cells with walls whose doors are at alternate ends; a move may go one cell too far.

    In the twin the last wall has no door.
    """
    text = Text()
    last = size - 1
    cells = tuple(f"c{number}" for number in range(size))
    text.state("S_X", *cells)
    text.state("S_Y", *cells)
    text.resource("WHEELS")
    for axis, forth, back in (("S_X", "right", "left"), ("S_Y", "up", "down")):
        for here in range(size):
            for name, step in ((forth, 1), (back, -1)):
                if 0 <= here + step <= last:
                    too_far = [f"{axis} is c{here + 2 * step}"] if 0 <= here + 2 * step <= last else []
                    at, after = f"{axis} is c{here}", f"{axis} is c{here + step}"
                    text.action(f"{name}_from_{here}", after, *too_far, when=at, holds=("WHEELS",))
    walls = list(range(WALL_EVERY // 2, size, WALL_EVERY))
    for number, column in enumerate(walls):
        door = f"S_Y is c{last if number % 2 == 0 else 0}"
        text.assume(
            f"IF S_X is c{column} THEN {door}" if realizable or column != walls[-1] else f"NOT S_X is c{column}"
        )
    for column in range(3, size, WALL_EVERY):
        text.rule(f"NOT (S_X is c{column} AND S_Y is c{size // 2})")
    text.goal(f"S_X is c{last} AND S_Y is c{last if len(walls) % 2 == 0 else 0}")
    return text.render()


SHARE_OF_OBSTACLES = 0.08
"""How many of the cells with two odd numbers are taken: about 2 % of all."""


def obstacles(size: int, realizable: bool) -> str:
    """A square of cells, some of which are taken, from one corner to the other: a plan of 2 (n - 1) steps.

    Obstacles never touch. In the twin the column before the last cannot be entered.
    """
    text, random = Text(longest_plan=4 * size), Random(size)
    cells = tuple(f"c{number}" for number in range(size))
    text.state("S_X", *cells)
    text.state("S_Y", *cells)
    text.resource("WHEELS")
    for axis, forth, back in (("S_X", "right", "left"), ("S_Y", "up", "down")):
        for here in range(size - 1):
            low, high = f"{axis} is c{here}", f"{axis} is c{here + 1}"
            text.action(f"{forth}_{here}", high, when=low, holds=("WHEELS",))
            text.action(f"{back}_{here + 1}", low, when=high, holds=("WHEELS",))
    for x in range(1, size - 1, 2):
        for y in range(1, size - 1, 2):
            if random.random() < SHARE_OF_OBSTACLES:
                text.rule(f"NOT (S_X is c{x} AND S_Y is c{y})")
    if not realizable:
        text.assume(f"NOT S_X is c{size - 2}")
    text.goal(f"S_X is c{size - 1} AND S_Y is c{size - 1}")
    return text.render()


def counter(size: int, realizable: bool) -> str:
    """One variable with n values, counted up to the last, a step for each. In the twin the last step is missing."""
    text = Text()
    values = tuple(f"n{number}" for number in range(size))
    text.state("S_Count", *values)
    text.resource("COUNTER")
    for here in range(size - 1):
        low, high = f"S_Count is n{here}", f"S_Count is n{here + 1}"
        if realizable or here < size - 2:
            text.action(f"up_{here}", high, "none", when=low, holds=("COUNTER",))
        text.action(f"down_{here + 1}", low, when=high, holds=("COUNTER",))
    text.goal(f"S_Count is n{size - 1}")
    return text.render()
