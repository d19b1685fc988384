"""Specifications with runs of a wanted length, and unsafe states with a cheap and a dear way back."""

from __future__ import annotations

from random import Random

from msgspec import Struct

from tumato_symbolic import parse
from tumato_symbolic.semantics import ActionSet, State, all_states, is_valid
from tumato_symbolic.spec import Spec

LENGTHS = (0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 13, 14, 15, 16, 17)
"""Around powers of two, where a number may be taken for *none*."""


class Line(Struct, frozen=True):
    """A line of places `t0`, `t1`, …, unsafe places beside it, and a trap; perhaps a lamp.

    `t0` is the goal. From an unsafe place `dear` leads near to it, and `cheap` to anywhere, perhaps too far away, or
    into the trap. So whether the dear way is minimal depends on the bound and on how long the runs are. Z3 needs ranks
    only where it has met a cheap way that does not serve: some unsafe places have one, and some have one that does.
    """

    text: str
    spec: Spec


def line(random: Random, length: int) -> Line:
    """A line of this length."""
    places = [f"t{place}" for place in range(length + 1)]
    unsafe = [f"u{number}" for number in range(random.randint(2, 4))]
    lamp, trap = random.random() < 0.2, random.random() < 0.5
    bound = random.randint(max(1, length // 2), length + 2) if random.random() < 0.75 else None
    every = [*places, *unsafe, *(("trap",) if trap else ())]
    random.shuffle(every)
    actions = [_action(f"down{place}", 0, f"t{place}", f"t{place - 1}") for place in range(1, length + 1)]
    actions += [_action(f"up{place}", 0, f"t{place}", f"t{place + 1}") for place in range(length)]
    for name in unsafe:
        far = "trap" if trap and random.random() < 0.3 else f"t{random.randint(0, length)}"
        actions.append(_action(f"cheap_{name}", random.randint(1, 2), name, far))
        actions.append(_action(f"dear_{name}", random.randint(3, 5), name, f"t{random.randint(0, length // 2)}"))
    if lamp:
        actions.append("  action lit  duration: 1  nominal effects: S_Lamp is on")
    random.shuffle(actions)
    text = "\n".join(
        [
            "BEGIN STATE VECTOR",
            f"  state S_P can be {', '.join(every)}",
            *(("  state S_Lamp can be off, on",) if lamp else ()),
            "END STATE VECTOR",
            "BEGIN RESOURCES resource WHEELS END RESOURCES",
            "BEGIN ACTIONS",
            *actions,
            "END ACTIONS",
            "BEGIN STATE RULES",
            f"  rule: NOT ({' OR '.join(f'S_P is {name}' for name in unsafe)})",
            "END STATE RULES",
            *_goals(random, places[: bound if random.random() < 0.9 else None], places, trap, lamp),
            *([] if bound is None else [f"BEGIN CONFIG max_plan_length: {bound} END CONFIG"]),
            "",
        ]
    )
    return Line(text, parse(text))


def _action(name: str, duration: int, start: str, end: str) -> str:
    return (
        f"  action {name}  duration: {duration}  controlled resources: WHEELS  "
        f"preconditions: S_P is {start}  nominal effects: S_P is {end}"
    )


def _goals(random: Random, near: list[str], places: list[str], trap: bool, lamp: bool) -> list[str]:
    """The goal of the unsafe places, and of some near ones."""
    idle = places[random.randint(1, len(near)) :] + (["trap"] if trap else [])
    condition = f"when NOT ({' OR '.join(f'S_P is {name}' for name in idle)}) then " if idle else ""
    goals = [f"  {condition}goal: S_P is t0"]
    if lamp:
        body = random.choice(("S_Lamp is on", "S_P is t0 AND S_Lamp is on", "S_P is t0 OR executing lit"))
        goals.insert(0, f"  when S_Lamp is on then goal: {body}")
    return ["BEGIN GOALS", "  goal type: priority", *goals, "END GOALS"]


def rows_of(random: Random, spec: Spec) -> dict[State, ActionSet]:
    """A policy: mostly down the line, the dear or the cheap way out of unsafe places, now and then anything else."""
    numbers = {action.name: number for number, action in enumerate(spec.actions)}
    values = spec.variables[0].values
    mostly, rows = random.choice((0.97, 1.0)), {}
    for state in all_states(spec):
        if not is_valid(spec, state):
            continue
        place = values[state[0]]
        options = [name for name in numbers if name.endswith(f"_{place}") or name == f"up{place[1:]}"]
        if place[0] == "u":
            wanted = random.choice(("dear", "dear", "dear", "cheap")) + f"_{place}"
        else:
            wanted = f"down{place[1:]}" if random.random() < mostly else random.choice([*options, ""])
        chosen = [numbers[wanted]] if wanted in numbers else []
        if "lit" in numbers and place[0] != "u" and random.random() < 0.3:
            chosen.append(numbers["lit"])
        rows[state] = frozenset(chosen)
    return rows
