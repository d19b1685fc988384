"""The paper's mobile robot: alone, with several load places, and several of its kind."""

from __future__ import annotations

from itertools import combinations
from pathlib import Path

from benchmarks.writing import Text, all_of

_EXAMPLES = Path(__file__).resolve().parents[1] / "examples"


def amr(_: int, realizable: bool) -> str:
    """The paper's example; the twin allows plans of 3 steps where 4 are needed."""
    text = (_EXAMPLES / "amr.tum").read_text(encoding="utf-8")
    return text if realizable else text.replace("max_plan_length: 5", "max_plan_length: 3")


def loads(count: int, realizable: bool) -> str:
    """The AMR with several load places, each with a conveyor: load all, then deliver, so that goals interact.

    Without the assumption that at most one conveyor runs where it must not, the twin has two faults to restore at once.
    """
    text = Text(longest_plan=5 * count)
    text.state("S_Location", "corridor", "charger", "workstation_1", "workstation_2")
    text.state("S_Battery", "low", "ok")
    text.resource("MOTORS")
    _drive(text)
    for i in range(count):
        text.state(f"S_Load_{i}", "loaded", "free")
        text.state(f"S_Conveyor_{i}", "on", "off")
        text.resource(f"CONVEYOR_{i}")
        _load_place(text, i)
        text.rule(f"IF S_Location is corridor OR S_Location is charger THEN S_Conveyor_{i} is off")
    if realizable:
        for i, j in combinations(range(count), 2):
            both = f"S_Conveyor_{i} is on AND S_Conveyor_{j} is on"
            text.assume(f"IF S_Location is corridor OR S_Location is charger THEN NOT ({both})")
    text.goal("S_Battery is ok", when="S_Battery is low")
    for i in range(count):
        text.goal(f"S_Load_{i} is free", when=f"S_Load_{i} is loaded")
    free, loaded = (all_of([f"S_Load_{i} is {value}" for i in range(count)]) for value in ("free", "loaded"))
    text.goal(loaded, when=free)
    return text.render()


def _drive(text: Text) -> None:
    """The actions of the AMR that need only its motors."""
    corridor, motors = "S_Location is corridor", ("MOTORS",)
    text.action("move_to_workstation_1", "S_Location is workstation_1", corridor, when=corridor, holds=motors, takes=10)
    text.action("move_to_workstation_2", "S_Location is workstation_2", when=corridor, holds=motors, takes=10)
    text.action("move_to_charger", "S_Location is charger", when=corridor, holds=motors, takes=10)
    text.action("move_to_corridor", corridor, when=f"NOT {corridor}", holds=motors, takes=2)
    text.action("charge", "S_Battery is ok", when="S_Location is charger", holds=motors, takes=50)


def _load_place(text: Text, i: int) -> None:
    """Receive, deliver and stop at one load place of the AMR."""
    both = ("MOTORS", f"CONVEYOR_{i}")
    on, off = f"S_Conveyor_{i} is on", f"S_Conveyor_{i} is off"
    loaded, free = f"S_Load_{i} is loaded", f"S_Load_{i} is free"
    text.action(
        f"receive_{i}",
        f"{on}, {loaded}",
        f"{on}, {free}",
        f"{off}, {free}",
        when=f"S_Location is workstation_1, {free}",
        holds=both,
        takes=3,
    )
    text.action(
        f"deliver_{i}",
        f"{on}, {free}",
        f"{on}, {loaded}",
        when=f"S_Location is workstation_2, {loaded}",
        holds=both,
        takes=3,
    )
    text.action(f"stop_{i}", off, when=on, holds=both[1:], takes=1)


def robots(count: int, realizable: bool) -> str:
    """Several AMRs that share a charger and a workstation.

    Assumptions exclude that two of them are where only one may be, or break their own rule at the same time. Without
    them the twin has two faults to restore at once (`examples/two_robots.tum`).
    """
    text = Text()
    for i in range(count):
        _robot(text, i)
    for i, j in combinations(range(count), 2):
        for place in ("charger", "ws1"):
            apart = f"NOT (S_Loc{i} is {place} AND S_Loc{j} is {place})"
            text.rule(apart)
            if realizable:
                text.assume(apart)
        if realizable:
            text.assume(f"NOT ({_running(i)} AND {_running(j)})")
    for i in range(count):
        text.goal(f"S_Bat{i} is ok", when=f"S_Bat{i} is low")
    for i in range(count):
        text.goal(f"S_Load{i} is free", when=f"S_Load{i} is loaded")
    text.goal("S_Load0 is loaded", when="S_Load0 is free")
    return text.render()


def _running(i: int) -> str:
    """That a robot's conveyor runs where it must not."""
    return f"(S_Loc{i} is corridor OR S_Loc{i} is charger) AND S_Conv{i} is on"


def _robot(text: Text, i: int) -> None:
    """The variables, the actions and the own rule of one robot."""
    at = {place: f"S_Loc{i} is {place}" for place in ("corridor", "charger", "ws1", "ws2")}
    on, off = f"S_Conv{i} is on", f"S_Conv{i} is off"
    loaded, free = f"S_Load{i} is loaded", f"S_Load{i} is free"
    text.state(f"S_Loc{i}", *at)
    text.state(f"S_Bat{i}", "low", "ok")
    text.state(f"S_Load{i}", "loaded", "free")
    text.state(f"S_Conv{i}", "on", "off")
    text.resource(f"M{i}", f"C{i}")
    motors, both = (f"M{i}",), (f"M{i}", f"C{i}")
    text.action(f"to_ws1_{i}", at["ws1"], at["corridor"], when=at["corridor"], holds=motors, takes=10)
    text.action(f"to_ws2_{i}", at["ws2"], when=at["corridor"], holds=motors, takes=10)
    text.action(f"to_ch_{i}", at["charger"], when=at["corridor"], holds=motors, takes=10)
    text.action(f"to_cor_{i}", at["corridor"], when=f"NOT {at['corridor']}", holds=motors, takes=2)
    receive = (f"{on}, {loaded}", f"{on}, {free}", f"{off}, {free}")
    text.action(f"recv_{i}", *receive, when=f"{at['ws1']}, {free}", holds=both, takes=3)
    text.action(f"delv_{i}", f"{on}, {free}", f"{on}, {loaded}", when=f"{at['ws2']}, {loaded}", holds=both, takes=3)
    text.action(f"stop_{i}", off, when=on, holds=both[1:], takes=1)
    text.action(f"chg_{i}", f"S_Bat{i} is ok", when=at["charger"], holds=motors, takes=50)
    text.rule(f"IF {at['corridor']} OR {at['charger']} THEN {off}")
