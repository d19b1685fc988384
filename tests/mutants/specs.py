"""Mutations of the text of a specification, as `tests.printing` writes it: one construct a line."""

from __future__ import annotations

import re
from collections.abc import Callable
from random import Random

Mutation = Callable[[list[str], Random], None]
"""Changes the lines in place; where it finds nothing to change, it leaves them as they are."""


def _places(lines: list[str], pattern: str) -> list[int]:
    return [place for place, line in enumerate(lines) if re.match(rf"\s*(?:{pattern})", line)]


def _dropped(pattern: str) -> Mutation:
    def drop(lines: list[str], random: Random) -> None:
        if places := _places(lines, pattern):
            del lines[random.choice(places)]

    return drop


def _dropped_goal(lines: list[str], random: Random) -> None:
    if places := _places(lines, "goal:"):
        place = random.choice(places)
        begin = place - 1 if re.match(r"\s*when ", lines[place - 1]) else place
        del lines[begin : place + 1]


def _changed_number(pattern: str) -> Mutation:
    def change(lines: list[str], random: Random) -> None:
        if places := _places(lines, pattern):
            place = random.choice(places)
            lines[place] = re.sub(r"\d+$", str(random.randint(1, 6)), lines[place])

    return change


def _flipped(pattern: str) -> Mutation:
    """One value becomes another one of the same variable."""

    def flip(lines: list[str], random: Random) -> None:
        domains = {}
        for line in lines:
            if found := re.match(r"\s*state (\w+) can be (.*)", line):
                domains[found[1]] = re.findall(r"\w+", found[2])
        atoms = [
            (place, atom)
            for place in _places(lines, pattern)
            for atom in re.finditer(r"(S_\w+) is (\w+)", lines[place])
        ]
        if atoms:
            place, atom = random.choice(atoms)
            line, (start, end) = lines[place], atom.span(2)
            lines[place] = line[:start] + random.choice(domains[atom[1]]) + line[end:]

    return flip


def _reordered(pattern: str) -> Mutation:
    """Lines of one kind that follow each other change places."""

    def reorder(lines: list[str], random: Random) -> None:
        places = _places(lines, pattern)
        for begin in [place for place in places if place - 1 not in places]:
            end = begin
            while end in places:
                end += 1
            block = lines[begin:end]
            random.shuffle(block)
            lines[begin:end] = block

    return reorder


def _reordered_values(lines: list[str], random: Random) -> None:
    for place in _places(lines, r"state \w+ can be"):
        head, _, values = lines[place].partition(" can be ")
        lines[place] = f"{head} can be {', '.join(random.sample(values.split(', '), len(values.split(', '))))}"


def _reordered_actions(lines: list[str], random: Random) -> None:
    begin, end = lines.index("BEGIN ACTIONS") + 1, lines.index("END ACTIONS")
    starts = [place for place in _places(lines, r"action \w+$") if begin <= place < end]
    actions = [lines[start:stop] for start, stop in zip(starts, [*starts[1:], end], strict=True)]
    random.shuffle(actions)
    lines[begin:end] = [line for action in actions for line in action]


def _comments(lines: list[str], random: Random) -> None:
    for place in range(len(lines)):
        if random.random() < 0.3:
            lines[place] += random.choice(("  // rule: false", " /* END\nBEGIN */", "\n\n", "\t"))


def _restoration(lines: list[str], random: Random) -> None:
    """Safety is restored in another way."""
    for place in _places(lines, "restoration:"):
        lines[place] = f"  restoration: {random.choice(('one_step', 'bounded', 'fair'))}"


def _severity(lines: list[str], random: Random) -> None:
    """The state rules from one of them on are more severe, or milder."""
    begin, end = lines.index("BEGIN STATE RULES") + 1, lines.index("END STATE RULES")
    if begin < end:
        lines.insert(random.randint(begin, end), f"  severity: {random.randint(1, 3)}")


MEANT: dict[str, Mutation] = {
    "a rule dropped": _dropped("rule:|assume:"),
    "a state rule or assumption flipped": _flipped("rule:|assume:"),
    "a goal dropped": _dropped_goal,
    "a goal flipped": _flipped("goal:|when "),
    "a nominal effect flipped": _flipped("nominal effects:"),
    "an alternative dropped": _dropped("alternative effects:"),
    "an alternative flipped": _flipped("alternative effects:"),
    "preconditions dropped": _dropped("preconditions:"),
    "resources dropped": _dropped("controlled resources:"),
    "a duration changed": _changed_number("duration:"),
    "the bound changed": _changed_number("max_plan_length:"),
    "no bound": _dropped("max_plan_length:"),
    "no ordering": _dropped("effect_ordering:"),
}
"""What may change the meaning."""

RESTORING: dict[str, Mutation] = {
    "another restoration": _restoration,
    "a severity added": _severity,
    "a severity dropped": _dropped("severity:"),
    "a severity changed": _changed_number("severity:"),
    "a state rule dropped": _dropped("rule:"),
    "a duration changed": _changed_number("duration:"),
    "an alternative flipped": _flipped("alternative effects:"),
}
"""What changes how safety is restored."""

LAYOUT: dict[str, Mutation] = {
    "variables reordered": _reordered(r"state \w+ can be"),
    "values reordered": _reordered_values,
    "actions reordered": _reordered_actions,
    "rules reordered": _reordered("rule:|assume:"),
    "alternatives reordered": _reordered("alternative effects:"),
    "comments added": _comments,
}
"""What leaves the meaning alone: the policy must still pass, and the digest be equal."""
