"""Many machines that may each help many: which of them does, with whom, is a choice among very many sets of actions."""

from __future__ import annotations

from itertools import product

from benchmarks.writing import Text


def responders(count: int, realizable: bool) -> str:
    """First responders in a town of as many places, with as many fire engines and people hurt, one ambulance less.

    Fires are put out from any place, perhaps not at once; nobody drives into one. The roads go from place to place, and
    from each to the second, where there is water and a hospital; only there a person in a bad state gets well. In the
    twin there is no hospital.
    """
    text = Text(goal_type="constraint")
    places = [f"place{place}" for place in range(count)]
    engines, ambulances = (
        [f"{kind}{n}" for n in range(many)] for kind, many in (("Engine", count), ("Ambulance", count - 1))
    )
    people, burning = [f"Person{n}" for n in range(count)], [place for place in places if place != places[1]]
    for place in burning:
        text.state(f"S_Fire_{place}", "yes", "no")
    for person in people:
        text.state(f"S_Place_{person}", *places, *(f"in_{each}" for each in ambulances))
        text.state(f"S_State_{person}", "well", "hurt", *(["bad"] if person == people[-1] else []))
    for machine in (*engines, *ambulances):
        text.state(f"S_Place_{machine}", *places)
    for engine in engines:
        text.state(f"S_Water_{engine}", "yes", "no")
    text.resource(*(f"R_{each}" for each in (*engines, *ambulances, *people)))
    for machine, (number, start), (other, end) in product(
        (*engines, *ambulances), enumerate(places), enumerate(places)
    ):
        if start != end and (1 in (number, other) or abs(number - other) == 1):
            clear = f", S_Fire_{end} is no" if end in burning else ""
            text.action(
                f"{machine}_from_{start}_to_{end}",
                f"S_Place_{machine} is {end}",
                when=f"S_Place_{machine} is {start}{clear}",
                holds=(f"R_{machine}",),
            )
    for engine in engines:
        _fights(text, engine, places, burning)
        for person, place in product(people, places):
            text.action(
                f"{engine}_treats_{person}_at_{place}",
                f"S_State_{person} is well",
                f"S_State_{person} is hurt",
                when=f"S_Place_{engine} is {place}, S_Place_{person} is {place}, S_State_{person} is hurt",
                holds=(f"R_{engine}", f"R_{person}"),
            )
    for ambulance, person, place in product(ambulances, people, places):
        here, held = f"S_Place_{ambulance} is {place}", (f"R_{ambulance}", f"R_{person}")
        outside, inside = f"S_Place_{person} is {place}", f"S_Place_{person} is in_{ambulance}"
        text.action(f"{ambulance}_takes_{person}_at_{place}", inside, when=f"{here}, {outside}", holds=held)
        text.action(f"{ambulance}_leaves_{person}_at_{place}", outside, when=f"{here}, {inside}", holds=held)
    for person in people if realizable else ():
        there = f"S_Place_{person} is {places[1]}"
        text.action(f"hospital_for_{person}", f"S_State_{person} is well", when=there, holds=(f"R_{person}",))
    for place in burning:
        text.goal(f"S_Fire_{place} is no")
    for person in people:
        text.goal(f"S_State_{person} is well")
    return text.render()


def _fights(text: Text, engine: str, places: list[str], burning: list[str]) -> None:
    """The actions of an engine against fires: it fills up at the second place, and the fire may outlast the water."""
    holds = (f"R_{engine}",)
    at, wet = f"S_Place_{engine} is", f"S_Water_{engine} is"
    text.action(f"{engine}_fills_up", f"{wet} yes", when=f"{at} {places[1]}", holds=holds)
    for fire in burning:
        for place in places:
            text.action(
                f"{engine}_at_{place}_puts_out_{fire}",
                f"S_Fire_{fire} is no, {wet} no",
                f"{wet} no",
                when=f"{at} {place}, {wet} yes, S_Fire_{fire} is yes",
                holds=holds,
            )
