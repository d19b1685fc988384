"""Broken texts out of good ones, the same for the same seed."""

import json
import random
from copy import deepcopy
from typing import Any

VALUES: list[Any] = [
    None, True, False, -1, 0, 1, 2, 7, 1.5, 1e308, 10**30, "", "any", "hall", "go", "Actions", "\ud800",
    [], {}, [[]], {"": ""}, [0, [0, 1]], {"hall": 0}, ["go", "go"],
]  # fmt: skip
PIECES = [
    b'"', b"{", b"}", b"[", b"]", b",", b":", b"-", b"NaN", b"Infinity", b"-Infinity", b"1e999", b"9" * 5000,
    b"\\ud800", b"\x00", b"\xff", b"\xef\xbb\xbf", b"true", b"null", b"[" * 20000, b'{"a":' * 20000, b"\\", b"\r\n",
    b"/* */", b"0x1",
]  # fmt: skip


def mutations(text: str, seed: int) -> bytes:
    """One mutant of a JSON text, as bytes: of its structure (twice out of three times) or of its bytes."""
    dice = random.Random(seed)
    if dice.random() < 2 / 3:
        document = json.loads(text)
        for _ in range(dice.choice([1, 1, 1, 2, 5])):
            document = mutate(document, dice)
        return json.dumps(document, allow_nan=True).encode()
    data = bytearray(text.encode())
    for _ in range(dice.choice([1, 1, 2, 4])):
        at = dice.randrange(len(data) + 1)
        match dice.randrange(5):
            case 0:
                del data[at:]
            case 1:
                del data[at : at + dice.randrange(1, 40)]
            case 2:
                data[at:at] = dice.choice(PIECES)
            case 3:
                start = dice.randrange(len(data) + 1)
                data[at:at] = data[start : start + dice.randrange(1, 200)]
            case _:
                data[at : at + 1] = bytes([dice.randrange(256)])
    return bytes(data)


def _places(value: Any, found: list[tuple[Any, Any]]) -> list[tuple[Any, Any]]:
    """Every (container, key) below a value."""
    keys = value.keys() if isinstance(value, dict) else range(len(value)) if isinstance(value, list) else ()
    for key in keys:
        found.append((value, key))
        _places(value[key], found)
    return found


def mutate(document: Any, dice: random.Random) -> Any:
    """Change one place: drop it, double it, swap it, replace it by a strange value or by another place's value."""
    places = _places(document, [])
    if not places:
        return deepcopy(dice.choice(VALUES))
    container, key = dice.choice(places)
    other, other_key = dice.choice(places)
    copy = deepcopy(other[other_key])
    match dice.randrange(6):
        case 0:
            del container[key]
        case 1 if isinstance(container, list):
            container.insert(dice.randrange(len(container) + 1), copy)
        case 1:
            container[dice.choice(["x", "Actions", "S_Place", "go"])] = copy
        case 2:
            container[key] = copy
        case 3 if type(container[key]) is int:
            container[key] += dice.choice([-1, 1, 1000])
        case 4 if isinstance(container[key], str):
            container[key] += dice.choice(["x", "_", ""])
        case _:
            container[key] = deepcopy(dice.choice(VALUES))
    return document
