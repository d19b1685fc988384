"""Specifications in which goals interact so that decisions have to be repaired."""

from __future__ import annotations

from random import Random


def crossroads(seed: int) -> str:
    """Places with few ways between them, flags that can be set, and goals whose runs pass each other's regions."""
    random = Random(f"crossroads {seed}")
    places = [f"p{number}" for number in range(1, random.randint(4, 7))]
    flags = [f"S_f{number}" for number in range(random.randint(1, 2))]
    round_trip = random.sample(places, len(places))
    ways = [*zip(round_trip, [*round_trip[1:], round_trip[0]], strict=True)]
    ways += [(here, random.choice(places)) for here in places if random.random() < 0.6]
    lines = ["BEGIN STATE VECTOR", f"state S_pos can be {', '.join(places)}"]
    lines += [f"state {flag} can be no, yes" for flag in flags]
    lines += ["END STATE VECTOR", "BEGIN RESOURCES resource WHEELS END RESOURCES", "BEGIN ACTIONS"]
    names = []
    held = random.choice(("controlled resources: WHEELS", ""))
    for number, (here, there) in enumerate(dict.fromkeys(ways)):
        names.append(f"go{number}")
        when = "none" if random.random() < 0.1 else f"S_pos is {here}"
        lines.append(f"action go{number} {held} preconditions: {when} nominal effects: S_pos is {there}")
    for flag in flags:
        names.append(f"set_{flag}")
        when = random.choice(("none", f"S_pos is {random.choice(places)}"))
        lines.append(f"action set_{flag} preconditions: {when} nominal effects: {flag} is yes")
        if random.random() < 0.5:
            names.append(f"clear_{flag}")
            lines.append(
                f"action clear_{flag} preconditions: S_pos is {random.choice(places)} nominal effects: {flag} is no"
            )
    lines += ["END ACTIONS", "BEGIN GOALS goal type: priority"]
    for _ in range(random.randint(1, 3)):
        lines.append(f"when {_either(random, places, flags)} then goal: {_body(random, places, flags, names)}")
    lines += [f"goal: {_body(random, places, flags, names)}", "END GOALS"]
    if random.random() < 0.3:
        lines.append(f"BEGIN CONFIG max_plan_length: {random.randint(5, 10)} END CONFIG")
    return "\n".join([*lines, ""])


def _atom(random: Random, places: list[str], flags: list[str]) -> str:
    if random.random() < 0.3:
        return f"{random.choice(flags)} is {random.choice(('yes', 'yes', 'no'))}"
    return f"S_pos is {random.choice(places)}"


def _either(random: Random, places: list[str], flags: list[str]) -> str:
    return " OR ".join(_atom(random, places, flags) for _ in range(random.randint(1, 3)))


def _body(random: Random, places: list[str], flags: list[str], names: list[str]) -> str:
    atoms = [_atom(random, places, flags)]
    if random.random() < 0.4:
        atoms.append(f"executing {random.choice(names)}")
    return random.choice((" OR ", " OR ", " AND ")).join(atoms)
