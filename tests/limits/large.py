"""Specifications that are too large for a short limit, in whichever stage: random, and the same for the same seed."""

from __future__ import annotations

from collections.abc import Callable
from itertools import combinations
from random import Random


def specification(seed: int) -> str:
    """A large specification; families take turns."""
    random = Random(f"large {seed}")
    return _FAMILIES[seed % len(_FAMILIES)](random)


def _text(states: list[str], actions: list[str], rules: list[str], goals: list[str], kind: str = "priority") -> str:
    blocks = [("STATE VECTOR", states), ("ACTIONS", actions), ("STATE RULES", rules), ("GOALS", goals)]
    head = {"GOALS": f"goal type: {kind}\n"}
    return "\n".join(
        f"BEGIN {name}\n{head.get(name, '')}" + "\n".join(lines) + f"\nEND {name}" for name, lines in blocks if lines
    )


def _switches(count: int) -> list[str]:
    return [f"state X{number} can be off, on" for number in range(count)]


def _permutation(random: Random) -> str:
    """All values differ: the diagram of the safe states is large in every order."""
    size = random.randint(9, 14)
    values = ", ".join(f"v{value}" for value in range(size))
    states = [f"state P{number} can be {values}" for number in range(size)]
    rules = [
        f"rule: NOT (P{first} is v{value} AND P{second} is v{value})"
        for first, second in combinations(range(size), 2)
        for value in range(size)
    ]
    actions = [f"action a{number} nominal effects: P{number} is v0" for number in range(random.randint(0, size))]
    return _text(states, actions, rules, ["goal: P0 is v0"])


def _counter(random: Random) -> str:
    """A binary counter, whose plans take exponentially many steps."""
    size = random.randint(10, 18)
    actions = [
        f"action up{bit} preconditions: X{bit} is off"
        + "".join(f" AND X{low} is on" for low in range(bit))
        + f" nominal effects: X{bit} is on"
        + "".join(f" AND X{low} is off" for low in range(bit))
        for bit in range(size)
    ]
    goal = " AND ".join(f"X{bit} is on" for bit in range(size))
    return _text(_switches(size), actions, [], [f"goal: {goal}"], "constraint")


def _independent(random: Random) -> str:
    """Many targets that do not interact, and goals that do: regions are many."""
    size = random.randint(10, 20)
    actions = [
        f"action set{number} nominal effects: X{number} is on"
        + (f" alternative effects: X{random.randrange(size)} is off" if random.random() < 0.5 else "")
        for number in range(size)
    ]
    goals = [f"when X{number} is off then goal: X{number} is on" for number in range(size)]
    return _text(_switches(size), actions, [], goals)


def _alternatives(random: Random) -> str:
    """Actions with very many effects, together without end."""
    size, choice = random.randint(3, 5), random.randint(6, 10)
    values = [f"v{value}" for value in range(choice)]
    states = [f"state P{number} can be {', '.join(values)}" for number in range(size)]
    anything = ", ".join("(" + " OR ".join(f"P{n} is {value}" for value in values) + ")" for n in range(size))
    actions = [
        f"action a{number} nominal effects: none alternative effects: {anything}"
        for number in range(random.randint(2, 4))
    ]
    return _text(states, actions, ["rule: NOT (P0 is v1 AND P1 is v2 AND P2 is v3)"], ["goal: true"])


def _long(random: Random) -> str:
    """A long text: reading it takes a while."""
    size = random.randint(3_000, 12_000)
    rules = [
        "rule: NOT (" + " AND ".join(f"X{random.randrange(20)} is {value}" for value in ("on", "on", "off")) + ")"
        for _ in range(size)
    ]
    actions = [f"action a{number} nominal effects: X{number} is on" for number in range(20)]
    return _text(_switches(20), actions, rules, ["goal: X0 is on"])


def _scrambled(random: Random) -> str:
    """Random rules of three literals over many variables, and actions that write several of them."""
    size = random.randint(20, 45)

    def literal() -> str:
        return f"X{random.randrange(size)} is {random.choice(('on', 'off'))}"

    rules = [f"rule: NOT ({literal()} AND {literal()} AND {literal()})" for _ in range(random.randint(size, 3 * size))]
    actions = [
        f"action a{number} preconditions: {literal()} nominal effects: X{number} is {random.choice(('on', 'off'))}"
        for number in range(min(size, 24))
    ]
    return _text(_switches(size), actions, rules, [f"goal: {literal()} AND {literal()}"], "constraint")


_FAMILIES: tuple[Callable[[Random], str], ...] = (
    _permutation,
    _counter,
    _independent,
    _alternatives,
    _long,
    _scrambled,
)
