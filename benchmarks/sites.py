"""Two robots of industrial size: one that serves a press in a factory, and an inspection UAV."""

from __future__ import annotations

from benchmarks.writing import Text


def factory(_: int, realizable: bool) -> str:
    """A robot that takes blanks to a press, has the parts inspected, and ships them: 2,688 states, 18 actions.

    The two state rules cannot both be broken at once; in the twin, where the press must be guarded wherever the robot
    is, they can.
    """
    text = Text()
    places = ("corridor", "store", "press", "inspection", "shipping", "charger", "parking")
    text.state("S_Location", *places)
    text.state("S_Battery", "low", "medium", "high")
    text.state("S_Gripper", "empty", "holding")
    text.state("S_Pressed", "no", "yes")
    text.state("S_Checked", "no", "yes")
    text.state("S_Belt", "on", "off")
    text.state("S_Guard", "open", "closed")
    text.state("S_Press", "idle", "running")
    text.state("S_Beacon", "off", "on")
    text.resource("MOTORS", "GRIPPER", "BELT", "GUARD", "PRESS")
    _factory_moves(text, places)
    _factory_work(text)
    text.react("IF S_Location is press AND guarded AND S_Press is running AND S_Beacon is off THEN executing signal")
    text.alias("guarded", "S_Guard is closed")
    text.rule("IF S_Location is corridor OR S_Location is charger THEN S_Belt is off")
    where = "S_Location is press AND " if realizable else ""
    text.rule(f"IF {where}S_Press is running THEN guarded")
    text.goal("S_Battery is high", when="S_Battery is low")
    text.goal("S_Gripper is holding", when="S_Gripper is empty")
    text.goal("S_Pressed is yes", when="S_Pressed is no")
    text.goal("S_Checked is yes", when="S_Checked is no")
    text.goal("S_Gripper is empty")
    return text.render()


def _factory_moves(text: Text, places: tuple[str, ...]) -> None:
    for place in places[1:]:
        missed = ("S_Location is corridor",) if place in ("press", "inspection") else ()
        when = "S_Location is corridor"
        text.action(f"move_to_{place}", f"S_Location is {place}", *missed, when=when, holds=("MOTORS",), takes=10)
    text.action(
        "move_to_corridor", "S_Location is corridor", when="NOT S_Location is corridor", holds=("MOTORS",), takes=4
    )


def _factory_work(text: Text) -> None:
    fresh = "S_Pressed is no, S_Checked is no"
    text.action(
        "receive_blank",
        f"S_Belt is on, S_Gripper is holding, {fresh}",
        f"S_Belt is on, S_Gripper is empty, {fresh}",
        when="S_Location is store, S_Gripper is empty",
        holds=("MOTORS", "GRIPPER", "BELT"),
        takes=5,
    )
    text.action("stop_belt", "S_Belt is off", when="S_Belt is on", holds=("BELT",))
    text.action("open_guard", "S_Guard is open", when="S_Guard is closed", holds=("GUARD",), takes=2)
    text.action("close_guard", "S_Guard is closed", when="S_Guard is open", holds=("GUARD",), takes=2)
    ready = "S_Location is press, S_Gripper is holding, S_Guard is closed, S_Press is idle"
    text.action("start_press", "S_Press is running", "none", when=ready, holds=("MOTORS", "PRESS"), takes=3)
    text.action(
        "press_part",
        "S_Pressed is yes, S_Press is idle, S_Beacon is off",
        "S_Press is idle, S_Beacon is off",
        when="S_Location is press, S_Gripper is holding, S_Press is running, S_Guard is closed",
        holds=("MOTORS", "PRESS"),
        takes=20,
    )
    text.action("stop_press", "S_Press is idle, S_Beacon is off", when="S_Press is running", holds=("PRESS",), takes=8)
    text.action(
        "inspect",
        "S_Checked is yes",
        "S_Pressed is no",
        when="S_Location is inspection, S_Gripper is holding, S_Pressed is yes",
        holds=("MOTORS", "GRIPPER"),
        takes=6,
    )
    text.action(
        "ship",
        f"S_Belt is on, S_Gripper is empty, {fresh}",
        "S_Belt is on",
        when="S_Location is shipping, S_Gripper is holding, S_Checked is yes",
        holds=("MOTORS", "GRIPPER", "BELT"),
        takes=5,
    )
    text.action(
        "charge", "S_Battery is high", "S_Battery is medium", when="S_Location is charger", holds=("MOTORS",), takes=60
    )
    text.action("signal", "S_Beacon is on", when="S_Press is running")


def uav(_: int, realizable: bool) -> str:
    """A UAV that photographs a site and reports: 16 variables, 17 actions, 221,184 states, 64,512 of them valid.

    Five notifications are forced by reaction rules, so that seven actions may be executed together. While safety is
    restored, nothing is forced; in the twin it is, and then no step restores.
    """
    text = Text()
    _uav_states(text)
    _uav_assumptions(text)
    _uav_flight(text)
    _uav_work(text)
    text.alias("sheltered", "NOT (S_Weather is storm AND S_Position is site)")
    text.alias("covered", "NOT (S_Flight is landed AND S_Camera is on)")
    text.alias("visible", "NOT (S_Position is base AND S_Flight is flying AND S_Lights is off)")
    for rule in ("sheltered", "covered", "visible"):
        text.rule(rule)
    quiet = "sheltered AND covered AND visible AND " if realizable else ""
    for name, condition in _UAV_NEWS.items():
        text.react(f"IF {quiet}{condition} AND S_Told{name} is no THEN executing tell_{name.lower()}")
    text.goal("S_Battery is high", when="S_Battery is low")
    landed = "S_Position is base AND S_Flight is landed"
    text.goal(landed, when="S_Weather is storm")
    text.goal("S_Images is stored", when="S_Images is none AND S_Report is open")
    text.goal("S_Report is sent", when="S_Report is open")
    text.goal(landed)
    return text.render()


_UAV_NEWS = {
    "Battery": "S_Battery is low",
    "Link": "S_Link is down",
    "Weather": "NOT S_Weather is calm",
    "Site": "S_Position is site",
    "Report": "S_Report is sent",
}
"""What the operator is told, and when."""


def _uav_states(text: Text) -> None:
    text.state("S_Position", "base", "transit", "site")
    text.state("S_Flight", "landed", "flying")
    text.state("S_Lights", "off", "on")
    text.state("S_Camera", "off", "on")
    text.state("S_Gimbal", "locked", "free")
    text.state("S_Weather", "calm", "windy", "storm")
    text.state("S_ToldWeather", "no", "yes")
    text.state("S_Battery", "low", "medium", "high")
    text.state("S_ToldBattery", "no", "yes")
    text.state("S_Link", "up", "down")
    text.state("S_ToldLink", "no", "yes")
    text.state("S_Permit", "none", "granted")
    text.state("S_ToldSite", "no", "yes")
    text.state("S_Images", "none", "stored")
    text.state("S_Report", "open", "sent")
    text.state("S_ToldReport", "no", "yes")
    text.resource("ROTORS", "CAMERA", "RADIO")


def _uav_assumptions(text: Text) -> None:
    text.assume("IF NOT S_Position is base THEN S_Flight is flying")
    text.assume("IF S_ToldBattery is yes THEN S_Battery is low")
    text.assume("IF S_ToldLink is yes THEN S_Link is down")
    text.assume("IF S_Report is sent THEN S_Images is stored OR S_ToldReport is yes")


def _uav_flight(text: Text) -> None:
    rotors = ("ROTORS",)
    text.action(
        "take_off",
        "S_Flight is flying, S_Lights is on",
        when="S_Position is base",
        holds=rotors,
        takes=5,
    )
    text.action(
        "land",
        "S_Flight is landed, S_Lights is off",
        when="S_Position is base, S_Flight is flying, S_Camera is off",
        holds=rotors,
        takes=5,
    )
    text.action(
        "fly_out",
        "S_Position is transit, S_ToldSite is no",
        "S_Position is transit, S_ToldSite is no, S_Weather is windy",
        when="S_Position is base, S_Flight is flying, NOT S_Weather is storm",
        holds=rotors,
        takes=60,
    )
    text.action(
        "approach",
        "S_Position is site",
        "S_Position is transit",
        when="S_Position is transit",
        holds=rotors,
        takes=20,
    )
    text.action("retreat", "S_Position is transit", when="S_Position is site", holds=rotors, takes=20)
    text.action(
        "fly_home",
        "S_Position is base, S_Lights is on",
        "S_Position is transit, S_Lights is on",
        when="S_Position is transit",
        holds=rotors,
        takes=60,
    )
    text.action(
        "charge",
        "S_Battery is high, S_ToldBattery is no",
        "S_Battery is medium, S_ToldBattery is no",
        when="S_Flight is landed",
        holds=rotors,
        takes=900,
    )


def _uav_work(text: Text) -> None:
    text.action("camera_on", "S_Camera is on, S_Gimbal is free", when="S_Camera is off", holds=("CAMERA",), takes=2)
    text.action("camera_off", "S_Camera is off, S_Gimbal is locked", when="S_Camera is on", holds=("CAMERA",), takes=2)
    text.action(
        "take_images",
        "S_Images is stored",
        "none",
        when="S_Position is site, S_Camera is on, S_Gimbal is free, S_Permit is granted",
        holds=("ROTORS", "CAMERA"),
        takes=30,
    )
    text.action(
        "send_report",
        "S_Report is sent",
        "S_Link is down",
        when="S_Images is stored, S_Link is up",
        holds=("RADIO",),
        takes=10,
    )
    text.action(
        "restore_link", "S_Link is up, S_ToldLink is no", "none", when="S_Link is down", holds=("RADIO",), takes=3
    )
    for name, condition in _UAV_NEWS.items():
        granted = ", S_Permit is granted" if name == "Site" else ""
        text.action(f"tell_{name.lower()}", f"S_Told{name} is yes{granted}", "none", when=condition)
