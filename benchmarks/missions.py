"""Families that grow: sample targets, a walled grid, a plant of many stations."""

from __future__ import annotations

from random import Random

from benchmarks.writing import Text, all_of

WALL_EVERY = 16
"""Columns from one wall of the grid to the next; the first wall is half of that away from the border."""


def samples(count: int, realizable: bool) -> str:
    """Go to every target in any order, sample it and come home: the ranks count what is left to do.

    In the twin the last target cannot be sampled.
    """
    text = Text()
    text.state("S_Location", "home", *(f"w{i}" for i in range(count)))
    text.state("S_Battery", "low", "medium", "full")
    text.state("S_Arm", "stowed", "out")
    text.resource("BODY")
    body = ("BODY",)
    text.action("go_home", "S_Location is home", when="S_Arm is stowed", holds=body, takes=5)
    text.action("stow", "S_Arm is stowed", when="S_Arm is out", holds=body, takes=1)
    text.action("charge", "S_Battery is full", "S_Battery is medium", when="S_Location is home", holds=body, takes=60)
    for i in range(count):
        text.state(f"S_Target{i}", "todo", "done")
        text.action(f"go_{i}", f"S_Location is w{i}", when="S_Arm is stowed", holds=body, takes=5)
        if realizable or i < count - 1:
            done, at = f"S_Target{i} is done", f"S_Location is w{i}"
            text.action(f"sample_{i}", done, "S_Arm is out", when=at, holds=body, takes=2)
    text.rule("IF S_Location is home THEN S_Arm is stowed")
    text.goal("S_Battery is full", when="S_Battery is low")
    text.goal(all_of(["S_Location is home", *(f"S_Target{i} is done" for i in range(count))]))
    return text.render()


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


LOADS = 5


def plant(stations: int, realizable: bool, shuffle: Random | None = None) -> str:
    """A robot with five load places in a plant of many stations (6 · 2^10 · 8^n states; n = 10 is 6.6 · 10^12).

    Three goals interact: who is to load everything must pass states in which everything is to be delivered. About 1 %
    of the states are unsafe. The twin has a second rule, which may be broken at the same time.
    """
    text = Text()
    _plant_robot(text)
    for j in range(stations):
        _station(text, j)
    text.rule("NOT (S_Location is charger AND S_Hatch is open AND S_Spray is on AND S_Fan is off AND S_Conveyor is on)")
    if not realizable:
        text.rule("NOT (S_Valve0 is open AND S_Tank0 is full)")
    free, loaded = (all_of([f"S_Load{i} is {value}" for i in range(LOADS)]) for value in ("free", "loaded"))
    closed = all_of([f"S_Valve{j} is closed" for j in range(stations)])
    text.goal("S_Battery is ok", when="S_Battery is low")
    text.goal(f"{loaded} AND {closed}", when=free)
    text.goal(free)
    if shuffle is not None:
        shuffle.shuffle(text.states)
    return text.render()


def strewn(stations: int, realizable: bool) -> str:
    """`plant`, its variables declared in a random order: what is related stands far apart."""
    return plant(stations, realizable, Random(stations))


def _plant_robot(text: Text) -> None:
    corridor, motors = "S_Location is corridor", ("MOTORS",)
    places = ("charger", "intake", "outlet", "oven", "dock")
    text.state("S_Location", "corridor", *places)
    text.state("S_Battery", "low", "ok")
    text.state("S_Hatch", "open", "closed")
    text.state("S_Spray", "on", "off")
    text.state("S_Fan", "on", "off")
    text.state("S_Conveyor", "on", "off")
    text.resource("MOTORS", "HATCH", "SPRAY", "FAN", "CONVEYOR")
    for place in places:
        missed = (corridor,) if place in ("intake", "outlet") else ()
        text.action(f"move_to_{place}", f"S_Location is {place}", *missed, when=corridor, holds=motors, takes=10)
    text.action("move_to_corridor", corridor, when=f"NOT {corridor}", holds=motors, takes=2)
    text.action(
        "charge", "S_Battery is ok", "none", when="S_Location is charger, S_Hatch is open", holds=motors, takes=50
    )
    for name, values in {"Hatch": ("open", "closed"), "Spray": ("on", "off"), "Fan": ("on", "off")}.items():
        for value, other in (values, values[::-1]):
            effect, before = f"S_{name} is {value}", f"S_{name} is {other}"
            text.action(f"{name.lower()}_{value}", effect, "none", when=before, holds=(name.upper(),), takes=1)
    text.action("stop_conveyor", "S_Conveyor is off", when="S_Conveyor is on", holds=("CONVEYOR",))
    for i in range(LOADS):
        text.state(f"S_Load{i}", "loaded", "free")
        for name, place, effect, before in (
            ("receive", "intake", f"S_Load{i} is loaded", f"S_Load{i} is free"),
            ("deliver", "outlet", f"S_Load{i} is free", f"S_Load{i} is loaded"),
        ):
            text.action(
                f"{name}_{i}",
                f"S_Conveyor is on, {effect}",
                f"S_Conveyor is on, {before}",
                when=f"S_Location is {place}, {before}",
                holds=("MOTORS", "CONVEYOR"),
                takes=3,
            )


def _station(text: Text, j: int) -> None:
    """A tank and its valve."""
    pump = (f"PUMP{j}",)
    opened, closed = f"S_Valve{j} is open", f"S_Valve{j} is closed"
    text.state(f"S_Tank{j}", "empty", "low", "high", "full")
    text.state(f"S_Valve{j}", "open", "closed")
    text.resource(*pump)
    text.action(f"open_{j}", opened, "none", when=closed, holds=pump)
    text.action(f"close_{j}", closed, when=f"{opened}, NOT S_Tank{j} is full", holds=pump)
    text.action(f"drain_{j}", f"S_Tank{j} is empty", f"S_Tank{j} is low", when=opened, holds=pump, takes=5)
