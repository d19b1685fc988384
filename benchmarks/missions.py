"""Families that grow: sample targets, a plant of many stations."""

from __future__ import annotations

from random import Random

from benchmarks.writing import Text, all_of


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


def sampler(count: int, realizable: bool) -> str:
    """Sample targets from the air in any order, with a sampler that works beside the motors, then land at home.

    A flight may end at the next target, and a sample may fail. In the twin the last target cannot be sampled.
    """
    text = Text(longest_plan=2 * count + 6)
    places = [f"w{i}" for i in range(count)]
    text.state("S_Place", "home", *places)
    text.state("S_Flight", "ground", "air")
    text.state("S_Battery", "empty", "low", "full")
    text.resource("MOTORS", "SAMPLER")
    motors, flying = ("MOTORS",), "S_Flight is air"
    text.action("take_off", flying, when="S_Flight is ground, NOT S_Battery is empty", holds=motors)
    text.action("land", "S_Flight is ground", when=flying, holds=motors)
    for i, place in enumerate(places):
        done = f"S_Target{i} is done"
        text.state(f"S_Target{i}", "todo", "done")
        missed = f"S_Place is {places[(i + 1) % count]}"
        text.action(f"go_{i}", f"S_Place is {place}", missed, when=flying, holds=motors, takes=5)
        if realizable or i < count - 1:
            failed, there = f"S_Target{i} is todo", f"{flying}, S_Place is {place}"
            text.action(f"sample_{i}", done, failed, when=there, holds=("SAMPLER",))
    text.action("go_home", "S_Place is home", when=flying, holds=motors, takes=5)
    text.action("charge", "S_Battery is full", when="S_Flight is ground, S_Place is home", holds=motors, takes=50)
    text.assume(f"IF S_Battery is empty THEN {flying} OR S_Place is home")
    text.rule(f"IF S_Battery is empty THEN {flying} OR S_Place is home")
    text.rule("IF S_Flight is ground THEN S_Place is home OR S_Target0 is done")
    text.goal("S_Flight is ground AND S_Place is home AND S_Battery is full", when="S_Battery is empty")
    every = all_of([f"S_Target{i} is done" for i in range(count)])
    text.goal(every, when=f"NOT ({every})")
    text.goal("S_Flight is ground AND S_Place is home")
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
