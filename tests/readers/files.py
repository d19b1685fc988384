"""Damaged policy files and certificates of unrealizability, as bytes: values, keys, nesting, numbers, texts, encodings.

A document is kept as JSON spells it: an object is a list of pairs, so that a key may come twice, and a `Raw` is written
as it is.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from functools import cache
from random import Random
from typing import Any

from msgspec import Struct, field

from tests.generate import random_spec, random_text
from tests.profiles import PROFILES
from tumato_symbolic import Realizable, synthesize
from tumato_symbolic.policy import dumps
from tumato_symbolic.policy.unrealizability import dumps as certificate_text
from tumato_symbolic.semantics import count_states
from tumato_symbolic.synthesis import Unrealizable


class Object(Struct):
    """A JSON object: its keys may repeat."""

    pairs: list[list[Any]] = field(default_factory=list)


class Raw(Struct, frozen=True):
    """A piece of JSON, or of what is none."""

    text: str


Document = Any
Damage = Callable[[Document, Random], Document]

NUMBERS = (
    *("0", "1", "2", "-0", "-1", "1.0", "1e0", "0.0", "1E400", "-1e999", "01", "+1", ".5", "1.", "0x1", "1_0", "NaN"),
    *("Infinity", "-Infinity", "9" * 18, "9" * 19, "-" + "9" * 18, "1" + "0" * 5000, "١", "true", "false", "null"),
)
TEXTS = (
    *('"\\ud800"', '"\\udc00\\ud800"', '"\\ud83d\\ude00"', '"\\u0000"', '"a\tb"', '"a\nb"', '"\\x41"', '"\\u41"', '""'),
    *('"Actions"', '"policy"', '"any"', '"first"', '"S_A"', '"v0"', '"act0"', "'any'", '"é"', '"\\/"', '"', "\\"),
)
SHAPES = ("[]", "{}", "[[]]", '{"": ""}', '{"a": 1, "a": 2}', "[0, [0, 1]]", "[1, 2", "{]", '{"a"}', "[,]", "[1,]")


def spelled(document: Document, random: Random) -> str:
    """The text of a document, now and then with escapes and other white space, which mean nothing."""
    match document:
        case Raw(text):
            return text
        case Object(pairs):
            space = random.choice(("", "", "", " ", "\n", "\t\r\n"))
            each = (f"{spelled(key, random)}{space}:{space}{spelled(value, random)}" for key, value in pairs)
            return "{" + space + f",{space}".join(each) + space + "}"
        case list():
            return "[" + ",".join([spelled(part, random) for part in document]) + "]"
        case str() if document and random.random() < 0.01:
            at = random.randrange(len(document))
            escaped = "".join(f"\\u{ord(each):04x}" for each in document[at])
            return json.dumps(document[:at])[:-1] + escaped + json.dumps(document[at + 1 :])[1:]
        case _:
            return json.dumps(document)


def _tree(text: str) -> Document:
    return json.loads(text, object_pairs_hook=lambda pairs: Object([[key, value] for key, value in pairs]))


class Base(Struct, frozen=True):
    """A right file, and the specification that it is for."""

    text: str
    spec: str


@cache
def bases() -> tuple[tuple[Base, ...], ...]:
    """Tables, diagrams, and certificates of unrealizability."""
    tables: list[Base] = []
    diagrams: list[Base] = []
    unrealizable: list[Base] = []
    for name, profile in PROFILES.items():
        for seed in range(20):
            spec, text = random_spec(seed, profile), random_text(seed, profile)
            if count_states(spec) > 40 or len(tables) > 60:
                continue
            outcome = synthesize(spec)
            if isinstance(outcome, Realizable):
                tables.append(Base(dumps(outcome.policy), text))
                other = synthesize(spec, policy_format="diagram")
                assert isinstance(other, Realizable), (name, seed)
                diagrams.append(Base(dumps(other.policy), text))
            elif isinstance(outcome, Unrealizable) and outcome.certificate is not None:
                unrealizable.append(Base(certificate_text(outcome.certificate), text))
    return tuple(tables), tuple(diagrams), tuple(unrealizable)


def damaged(seed: int) -> tuple[bytes, str]:
    """The file of a seed, and the specification beside it."""
    random = Random(f"file {seed}")
    base = random.choice(random.choice(bases()))
    document = _tree(base.text)
    for _ in range(random.choice((0, 1, 1, 1, 1, 2, 3))):
        document = random.choice(DAMAGES)(document, random)
    return _encoded(spelled(document, random), random), base.spec


def _places(document: Document) -> list[tuple[list[Any], int]]:
    """Every value that is in something: the list that holds it, and where in that."""
    found: list[tuple[list[Any], int]] = []
    waiting = [document]
    while waiting:
        here = waiting.pop()
        slots = [(pair, 1) for pair in here.pairs] if isinstance(here, Object) else []
        slots += [(here, place) for place in range(len(here))] if isinstance(here, list) else []
        found += slots
        waiting += [holder[place] for holder, place in slots]
    return found


def _objects(document: Document) -> list[Object]:
    return [
        value
        for value in (document, *(holder[place] for holder, place in _places(document)))
        if isinstance(value, Object)
    ]


def _any_place(document: Document, random: Random) -> tuple[list[Any], int]:
    """A value, those near the top as likely as those in the many rows and nodes."""
    places = _places(document)
    return random.choice(places[:30] if random.random() < 0.5 else places) if places else ([document], 0)


def _value(document: Document, random: Random) -> Document:
    """Another value in place of one."""
    holder, place = _any_place(document, random)
    old = holder[place]
    same = {int: NUMBERS, str: TEXTS}.get(type(old), SHAPES)
    holder[place] = Raw(random.choice(same if random.random() < 0.6 else (*NUMBERS, *TEXTS, *SHAPES)))
    return document


def _number(document: Document, random: Random) -> Document:
    """A whole number spelled in another way, or a bit larger or smaller."""
    numbers = [(holder, place) for holder, place in _places(document) if type(holder[place]) is int]
    if not numbers:
        return document
    holder, place = random.choice(numbers)
    old = holder[place]
    spellings = (f"{old}.0", f"{old}e0", f"-{old}", f"0{old}", f"{old + 1}", f"{old - 1}", "0" * 18 + f"{old}", "true")
    holder[place] = Raw(random.choice((*spellings, *NUMBERS)))
    return document


def _numbering(document: Document, random: Random) -> Document:
    """Values numbered from one, or from where it is wrong, in some variables or in all."""
    states = next((value for key, value in document.pairs if key == "States"), None)
    if not isinstance(states, Object):
        return document
    step = random.choice((1, 1, 1, 2, -1))
    chosen = (
        states.pairs if random.random() < 0.6 else random.sample(states.pairs, random.randint(0, len(states.pairs)))
    )
    for _, values in chosen:
        for pair in values.pairs if isinstance(values, Object) else ():
            pair[1] = pair[1] + step if isinstance(pair[1], int) else pair[1]
    if random.random() < 0.2:
        random.shuffle(states.pairs)
    return document


def _key(document: Document, random: Random) -> Document:
    """A key that is lost, added, renamed, or comes twice, with its value or another one."""
    objects = _objects(document)
    section = random.choice(objects if random.random() < 0.6 else objects[:1])
    if not section.pairs:
        return document
    at = random.randrange(len(section.pairs))
    key, value = section.pairs[at]
    match random.randrange(6):
        case 0:
            del section.pairs[at]
        case 1:
            name = random.choice(
                ("x", "Remarks", "Policy", "Diagram", "Certificate", "Actions", "act0", "S_A", "", "\ud800")
            )
            section.pairs.insert(at, [name, Raw(random.choice((*NUMBERS, *TEXTS, *SHAPES)))])
        case 2:
            section.pairs.append([key, value])
        case 3:
            section.pairs.insert(0, [key, random.choice(section.pairs)[1]])
        case 4:
            section.pairs[at][0] = random.choice((key.lower(), f"{key} ", "x", random.choice(section.pairs)[0]))
        case _:
            random.shuffle(section.pairs)
    return document


def _entries(document: Document, random: Random) -> Document:
    """Entries of a list that are lost, doubled, exchanged or moved."""
    lists = [holder[place] for holder, place in _places(document) if isinstance(holder[place], list) and holder[place]]
    if not lists:
        return document
    chosen = random.choice(lists if random.random() < 0.5 else sorted(lists, key=len)[-3:])
    at, other = random.randrange(len(chosen)), random.randrange(len(chosen))
    match random.randrange(5):
        case 0:
            del chosen[at]
        case 1:
            chosen.insert(other, chosen[at])
        case 2:
            chosen[at], chosen[other] = chosen[other], chosen[at]
        case 3:
            random.shuffle(chosen)
        case _:
            chosen[at] = chosen[other]
    return document


def _nesting(document: Document, random: Random) -> Document:
    """A value one level too deep or too high, or something very deep in a section that nobody knows."""
    holder, place = _any_place(document, random)
    old = holder[place]
    match random.randrange(4):
        case 0:
            holder[place] = [old]
        case 1:
            holder[place] = Object([[random.choice(("x", "Actions")), old]])
        case 2 if isinstance(old, list) and old:
            holder[place] = old[0]
        case _:
            depth = random.choice((1, 33, 49, 50, 97, 98, 99, 100, 101, 102, 300, 900, 1000, 5000, 20_000))
            start, end = random.choice((("[", "]"), ('{"a":', "}"), ('[{"b": 1, "a":', "}]")))
            inside = Raw(start * depth + random.choice(("1", "[]", "{}", '"x"')) + end * depth)
            section = random.choice(_objects(document)[:4] if isinstance(document, Object) else [Object()])
            section.pairs.append(["Remarks", inside])
    return document


def _header(document: Document, random: Random) -> Document:
    """Another version, type, ordering or digest, or none."""
    given = {
        "FormatVersion": NUMBERS,
        "Type": ('"policy"', '"policy-diagram"', '"unrealizable"', '"Policy"', *TEXTS),
        "EffectOrdering": ('"any"', '"first"', '"last"', '["any"]', "null", *TEXTS),
        "SpecificationDigest": ('"sha256:0"', '""', "null", "0", *TEXTS),
        "PolicyFrameworkVersion": ('"0.0.0"', '"1"', "0", "null", *TEXTS),
    }
    key, values = random.choice([*given.items()])
    if random.random() < 0.3:
        document.pairs = [pair for pair in document.pairs if pair[0] != key]
    else:
        pair = next((pair for pair in document.pairs if pair[0] == key), None)
        if pair is None:
            pair = [key, None]
            document.pairs.insert(0, pair)
        pair[1] = Raw(random.choice(values))
    return document


def _other_name(document: Document, random: Random) -> Document:
    """A text in place of another of the same document."""
    texts = [(holder, place) for holder, place in _places(document) if isinstance(holder[place], str)]
    (holder, place), (other, there) = random.choice(texts), random.choice(texts)
    old = holder[place]
    holder[place] = random.choice((other[there], f"{old} ", old.upper(), old + "\u200b", f"({old})"))
    return document


DAMAGES: tuple[Damage, ...] = (
    _value,
    _number,
    _numbering,
    _key,
    _key,
    _entries,
    _entries,
    _nesting,
    _header,
    _other_name,
)


def _encoded(text: str, random: Random) -> bytes:
    """As bytes: mostly plain UTF-8, sometimes marked, cut, with something behind, or in another encoding."""
    whole = text.encode("utf-8", "surrogatepass")
    if random.random() < 0.85:
        return whole
    at = random.randrange(len(whole) + 1)
    forms = (
        b"\xef\xbb\xbf" + whole, b"\xef\xbb\xbf" * 2 + whole, whole + b"\xef\xbb\xbf", whole + b"\n\r\t ",
        whole + b"{}", whole + b"\0", whole + b"// x", whole + b"\xc2\xa0", b"\x0c" + whole, b"\xe2\x80\xa8" + whole,
        whole[:at], b"", b" ", text.encode("utf-16", "surrogatepass"), text.encode("utf-32", "surrogatepass"),
        text.encode("utf-7", "replace"),
        whole[:at] + bytes([random.randrange(256)]) + whole[at + 1 :], whole[:at] + b"\xff" + whole[at:], whole + whole,
        whole.replace(b",", b", \r", 3), whole.replace(b'"', b"'"), whole[:-1] + b",}", b"[" + whole + b"]",
    )  # fmt: skip
    return random.choice(forms)
