#!/usr/bin/env python3
"""Judge a policy against a specification by the explicit meaning. One file; nothing but Python (3.9 or newer).

    python3 checker.py policy.json spec.tum [--strict] [--guarantees guarantees.json]
        [--effect-ordering any|first] [--restoration one_step|bounded|fair]

It is written from docs/semantics.md, language.md, policy.md and certificate.md and shares no code with the package: a
second opinion that can be read in one sitting. It looks at every valid state (of at most 2,000,000 states) and judges
these properties of the policy, be it a table or a diagram:

    total      every valid state has a decision; with START, every start has one, and no state that is not valid
    safe       every decision is allowed: Ok(s, A), or Keep(s, A) where safety may take several steps to restore
    restoring  every unsafe state is restored; asked only where that may take several steps, or rules have severities
    goals      every nominal run reaches the active goals within the bound
    minimal    where safety is restored, no better allowed set would do as well

Exit codes: 0 all hold; 1 one fails; 2 unreadable input, or a specification with errors; 3 no verdict (too large to look
at every state, or a kind of claim that is not known); 70 this program is broken. A certificate (ranks, efforts) is
judged as well: one that is wrong, or stale (made for another specification), counts only with `--strict`; one that is
absent or incomplete never does. With `--guarantees`, the certificate of what the policy guarantees beyond nominal runs
has to be right as well.

Not judged: whether the specification says what was meant.
"""
# ruff: noqa: ANN401, D102, N818

from __future__ import annotations

import argparse
import hashlib
import itertools
import json
import math
import operator
import re
import sys
import traceback
from bisect import bisect_left
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import Any

State = tuple[str, ...]  # one value per variable, in the order of declaration
ActionSet = frozenset[str]  # the names of the actions that are executed at the same time
Formula = tuple[Any, ...]  # see section 2
Located = tuple[Formula, int]  # a formula and the line on which it begins
Counted = tuple[Formula, int]  # a formula and the number of its terms
Effect = dict[int, str]  # an assignment: the new value by the position of its variable
Residual = tuple[frozenset[Formula], ActionSet]  # goal bodies, and those of their actions that are executed first
Required = tuple[int, ...]  # the numbers of the state rules that a step has to keep
Effort = tuple[int, int]  # the duration and the number of steps of what it takes to restore safety

LARGEST = 2_000_000
"""So many states, sets or outcomes in one state, and assignments of one set of effects are looked at."""

# Limits of specifications (docs/language.md) and of the files beside them (docs/policy.md).
MOST_BYTES, MOST_FILE_BYTES, MOST_DIGITS, MOST_LEVELS = 2_000_000, 256 * 2**20, 18, 100
MOST_VARIABLES, MOST_VALUES, MOST_ACTIONS, LARGEST_NUMBER = 1_000, 10_000, 10_000, 1_000_000_000
MOST_TERMS, MOST_TERMS_IN_ALL, MOST_OUTCOMES = 100_000, 1_000_000, 10_000
MOST_VALUES_IN_ALL, MOST_COMBINATIONS, MOST_ENTRIES = 1_000_000, 1_000_000, 100_000

RESTORATIONS = ("one_step", "bounded", "fair")  # each is weaker than the one before it


class Unreadable(Exception):
    """Input that cannot be judged: exit code 2."""


class TooLarge(Exception):
    """Input that would take too long: exit code 3."""


class NotKnown(Exception):
    """A kind of claim that cannot be judged here: exit code 3."""


class Refuted(Exception):
    """A claim of a certificate that is not so."""


def need(condition: bool, message: str) -> None:
    """Refuse input unless the condition holds."""
    if not condition:
        raise Unreadable(message)


def counted(number: int, noun: str) -> str:
    """`1 state`, `2 states`."""
    return f"{number} {noun}{'' if number == 1 else 's'}"


def within_limit(count: int, what: str) -> None:
    """Give up where there are too many to look at."""
    if count > LARGEST:
        raise TooLarge(f"more than {LARGEST:,} {what} are too many to look at each of them")


# ----------------------------------------------------------------------------------------------------------------------
# 1. Tokens (docs/language.md). White space and line ends mean nothing; `//` and `/* */` are comments. A line ends with
#    a line feed, a carriage return, or both.

TOKEN = re.compile(
    r"[ \t\n]+|//[^\n]*|/\*.*?\*/|(?P<token>"
    r"(?:[A-Za-z0-9_]|\{[A-Za-z_][A-Za-z0-9_]*(?:[+-](?:0|[1-9][0-9]*))?\})+(?!\w)"
    r"|[+-][0-9]+(?![\w{])|[+-](?![0-9])|[(),:{}]|\.\.|[<>!]=|[<>=])",
    re.DOTALL,
)
MISLEADING = re.compile(r"[^\t\n -~\u00a0-\U0010ffff]|[\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069]")  # nowhere
NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
NUMBER = re.compile(r"0|-?[1-9][0-9]{0,17}")  # of a value; of durations and bounds: WHOLE_NUMBER
VALUE = re.compile(f"{NAME.pattern}|{NUMBER.pattern}")
WHOLE_NUMBER = re.compile(f"[0-9]{{1,{MOST_DIGITS}}}")
BRACES = re.compile(r"\{(\w+)((?:[+-][0-9]+)?)\}")  # in names: the value of a parameter
ONE_WORD = re.compile(r"\{\w+\}")
SHIFT = re.compile(r"[+-][1-9][0-9]{0,17}")  # of a parameter
KEYWORDS = {"BEGIN", "END", "AND", "OR", "NOT", "IF", "THEN", "IFONLYIF"}  # never a name
OWN_WORDS = {"true", "false", "none", "executing"}  # only ever the name of a value


def tokens_of(text: str) -> list[tuple[str, int]]:
    """The tokens of a specification with their lines; the last one is empty."""
    found, position, line = [], 0, 1
    while position < len(text):
        match = TOKEN.match(text, position)
        if match is None:
            raise Unreadable(f"line {line}: unexpected character {text[position]!r}")
        if misleading := MISLEADING.search(match[0]):
            raise Unreadable(f"line {line}: there is a comment with {misleading[0]!r}")
        if match["token"]:
            found.append((match["token"], line))
        line += match[0].count("\n")
        position = match.end()
    return [*found, ("", line)]


# ----------------------------------------------------------------------------------------------------------------------
# 2. Parsing (docs/language.md). A formula is a nested tuple:
#      ("true",)  ("false",)  ("not", f)  ("and", f, g, …)  ("or", f, g, …)  ("if", f, g)  ("iff", f, g)
#      ("is", variable, value)  ("executing", action)  ("alias", name)
#      ("in", variable, items)  ("compared", variable, operator, number or variable)
#      ("all", f, …)  ("some", f, …)  ("exactly one", f, …)  ("no instance", constant, f)
#    An effect may also be ("change", variable, variable, how much).
#    The parser leaves names as (text, line); section 3 replaces them: variables by their position, aliases by their
#    meaning, `IF p THEN q` by `NOT p OR q`, the last two lines by what they stand for. Copies are made here: what is
#    inside `for … end for` is read once for each, while `scope` has the values of its parameters.

Item = Sequence[Any]  # of a list of values: one value, or a range of numbers
Operand = tuple[str, str]  # in `where`: a word, a number or a parameter, and what is added to it
Test = tuple[Operand, str, Operand]
OPERATORS: dict[str, Callable[[Any, Any], bool]] = {
    "=": operator.eq,
    "!=": operator.ne,
    "<": operator.lt,
    "<=": operator.le,
    ">": operator.gt,
    ">=": operator.ge,
}
MIRRORED = {"<": ">", "<=": ">=", ">": "<", ">=": "<="}
SETTINGS = {
    "max_plan_length :": ("bound",),
    "effect_ordering :": ("ordering", "any", "first"),
    "restoration :": ("restoration", *RESTORATIONS),
    "preconditions :": ("preconditions", "at_start", "throughout"),
}
NO_PARAMETERS = {*KEYWORDS, "action", "define", "for", "in", "is", "not", "where"}
NO_VALUES = {*KEYWORDS, "when", "then", "action", "define", "for", "end"}  # after `S is not`: there, `not` is the value
ENTRIES = {"duration", "cost", "preconditions", "effects", "rule", "severity", "assume", "goal", "start"}
ENTRIES |= {"max_plan_length", "effect_ordering", "restoration"}  # followed by a colon
TITLES = {("controlled", "resources"), ("nominal", "effects"), ("alternative", "effects")}
NO_PREDICATES = (KEYWORDS - {"NOT", "IF"}) | {"is", "in", "not", "action", "for", "end", "when"}  # none begins one


@dataclass
class EffectSet:
    """A set of effects: what stands before all clauses, and the clauses `when CONDITION: EFFECT, …`."""

    line: int = 0
    effects: list[Located] = field(default_factory=list)
    clauses: list[tuple[Located, list[Located]]] = field(default_factory=list)


@dataclass
class Action:
    """An action as it is written; section 3 computes `effects`: the nominal assignment, then every alternative.

    Of an action with clauses, `effects` are known for the values that its conditions speak of, those of `places`.
    """

    name: str = ""
    line: int = 0
    fields: set[str] = field(default_factory=set)
    duration: int = 0
    resources: list[tuple[str, int]] = field(default_factory=list)
    preconditions: list[Located] = field(default_factory=list)
    nominal: EffectSet = field(default_factory=EffectSet)
    alternatives: list[EffectSet] = field(default_factory=list)
    holds_resources: frozenset[str] = frozenset()
    conditional: bool = False
    places: list[int] = field(default_factory=list)
    effects: dict[State, list[Effect]] = field(default_factory=dict)

    def effects_in(self, state: State) -> list[Effect]:
        """The effects that it takes when it starts in a state; none where effects disagree, which no such state is."""
        return self.effects.get(tuple(state[place] for place in self.places) if self.places else (), [])


@dataclass
class Goal:
    """A simple goal (`kind` is "goal"), or a list of goals (`kind` is "priority" or "constraint")."""

    kind: str = "constraint"
    condition: Formula | None = None  # after `when`
    body: Formula = ("true",)  # of a simple goal
    members: list[Goal] = field(default_factory=list)  # of a list


@dataclass
class Specification:
    """A specification: first as it is written, after `resolve` by what its names mean."""

    lines: list[str] = field(default_factory=list)
    variables: dict[str, tuple[str, ...]] = field(default_factory=dict)
    lists: dict[str, tuple[str, ...]] = field(default_factory=dict)  # that parameters may range over
    aliases: dict[str, Formula] = field(default_factory=dict)
    sizes: dict[str, tuple[int, int]] = field(default_factory=dict)  # of aliases that are resolved: terms and levels
    terms: int = 0  # of all predicates that are resolved
    values: int = 0  # of all variables
    written: int = 0  # terms of all predicates, aliases not expanded
    resources: dict[str, None] = field(default_factory=dict)
    actions: dict[str, Action] = field(default_factory=dict)
    reaction_rules: list[Located] = field(default_factory=list)
    state_rules: list[Located] = field(default_factory=list)
    severity: int = 1  # of the next state rule: 1 is the most severe
    severities: list[int] = field(default_factory=list)  # of the state rules
    assumptions: list[Located] = field(default_factory=list)
    starts: list[Located] = field(default_factory=list)  # none: every valid state is a start
    goals: Goal | None = None
    bound: int | None = None  # L; None: runs of any length
    ordering: str | None = None
    restoration: str | None = None  # None: one_step
    preconditions: str | None = None  # None: at_start

    @cached_property
    def atoms(self) -> dict[str, dict[str, Formula]]:
        """The atom of each value of each variable."""
        return {
            name: {value: ("is", place, value) for value in values}
            for place, (name, values) in enumerate(self.variables.items())
        }

    @cached_property
    def numbers(self) -> dict[str, list[tuple[int, int]]]:
        """The values of each variable that are numbers, the smallest first, with their places."""
        return {
            name: sorted((int(value), place) for place, value in enumerate(values) if NUMBER.fullmatch(value))
            for name, values in self.variables.items()
        }

    def tiers(self) -> list[list[Located]]:
        """The state rules by severity, the most severe first."""
        numbered = list(enumerate(self.state_rules))
        return [[rule for n, rule in numbered if self.severities[n] == each] for each in sorted(set(self.severities))]


class Parser:
    """Recursive descent: each method below the helpers reads one construct of the language."""

    def __init__(self, text: str) -> None:
        text = text.replace("\r\n", "\n").replace("\r", "\n")
        self.tokens = tokens_of(text)
        self.position = 0
        self.parentheses = 0  # that are open
        self.title = ""  # of the block
        self.scope: dict[str, tuple[str, dict[str, int]]] = {}  # parameters: the value, and the places in its list
        self.orders: dict[tuple[str, ...], dict[str, int]] = {}  # those places, by list
        self.dry = False  # whether nothing comes of what is read, as there is no copy of it
        self.made = self.combinations = self.copied = self.loops = 0
        self.spec = Specification(text.split("\n"))
        self.lists: dict[str, tuple[str, ...]] = {}  # of the whole text: they may be declared after their use
        for here, (word, _) in enumerate(self.tokens):
            self.position = here + 3
            if word == "define" and self.list_begins(-3):
                self.lists[self.tokens[here + 1][0]] = self.listed(self.items(True), MOST_COMBINATIONS)
        self.position = 0

    @property
    def next(self) -> str:
        return self.tokens[self.position][0]

    @property
    def line(self) -> int:
        return self.tokens[self.position][1]

    def need(self, condition: bool, message: str) -> None:
        need(condition, f"line {self.line}: {message}, but here is `{self.next or 'the end'}`")

    def ahead(self, start: int, count: int) -> list[str]:
        here = self.position + start
        return [text for text, _ in self.tokens[here : here + count]]

    def at(self, words: str, start: int = 0) -> bool:
        if start == 0 and not words.startswith(self.next):
            return False
        wanted = words.split()
        return self.ahead(start, len(wanted)) == wanted

    def accept(self, *choices: str) -> str:
        """Read whichever of these (of one word or more) comes next; "" where none does."""
        found = next((words for words in choices if self.at(words)), "")
        self.position += len(found.split())
        return found

    def expect(self, *choices: str) -> str:
        found = self.accept(*choices)
        self.need(found != "", f"expected {' or '.join(f'`{words}`' for words in choices)}")
        return found

    def filled(self) -> str:
        """What comes next, with the values of parameters in the place of braces."""

        def value(braces: re.Match[str]) -> str:
            self.need(braces[1] in self.scope, f"expected a parameter in `{braces[0]}`")
            return self.shifted(self.scope[braces[1]][0], braces[2])

        return BRACES.sub(value, self.next)

    def shifted(self, value: str, shift: str) -> str:
        """A number with another one added to it."""
        self.need(shift == "" or NUMBER.fullmatch(value) is not None, f"expected a number, not `{value}`, to add to")
        return str(int(value) + int(shift)) if shift else value

    def word(self, pattern: re.Pattern[str], what: str) -> str:
        word = self.filled()
        fits = pattern.fullmatch(word) is not None and word not in KEYWORDS
        self.need(fits or (self.dry and "{" in self.next), f"expected {what}")
        self.position += 1
        return word

    def name(self) -> str:
        return self.word(NAME, "a name")

    def new_name(self, *known: Iterable[str]) -> str:
        word = self.filled()
        self.need(word not in OWN_WORDS, "expected a name that is not a word of the language")
        self.need(self.dry or not any(word in each for each in known), "expected a name that is not declared yet")
        return self.name()

    def located_name(self) -> tuple[str, int]:
        line = self.line
        return self.name(), line

    def located_value(self) -> tuple[str, int]:
        line = self.line
        return self.word(VALUE, "a value"), line

    def number(self, least: int = 0) -> int:
        line, word = self.line, self.word(WHOLE_NUMBER, "a number")
        number = int(word) if word.isdigit() else least
        need(self.dry or least <= number <= LARGEST_NUMBER, f"line {line}: {word} is not {least} to {LARGEST_NUMBER}")
        return number

    def nested(self, levels: int) -> None:
        self.need(levels <= MOST_LEVELS, f"nested more than {MOST_LEVELS} levels deep")

    # Values: V, V, A..B, …, in braces or not. The braces of a list may touch the one word in it.

    def items(self, braced: bool) -> list[Item]:
        if braced and ONE_WORD.fullmatch(self.next):
            self.position += 1
            return [(self.tokens[self.position - 1][0][1:-1],)]
        if braced:
            self.expect("{")
        found = [self.item()]
        while self.at(",") and (braced or not self.parameter_begins(1)):
            self.expect(",")
            found.append(self.item())
        if braced:
            self.expect("}")
        return found

    def item(self) -> Item:
        first, line = self.located_value()
        if not self.accept(".."):
            return (first,)
        last, _ = self.located_value()
        if self.dry:
            return (first,)
        numbers = NUMBER.fullmatch(first) and NUMBER.fullmatch(last)
        need(bool(numbers) and int(first) <= int(last), f"line {line}: {first}..{last} is no range of numbers")
        return range(int(first), int(last) + 1)

    def listed(self, items: list[Item], most: int) -> tuple[str, ...]:
        need(sum(map(len, items)) <= most, f"line {self.line}: more than {most} values")
        values = tuple(str(value) for item in items for value in item)
        need(self.dry or len(set(values)) == len(values), f"line {self.line}: a value is listed twice before this")
        return values

    # Copies: NAME in r1, r2, r3, NAME in 1..5 where COND, COND. What follows is read once for each combination, or dry.

    def parameter_begins(self, ahead: int = 0) -> bool:
        words = self.ahead(ahead, 2)
        return words[1:] == ["in"] and NAME.fullmatch(words[0]) is not None and words[0] not in NO_PARAMETERS

    def header(self) -> tuple[dict[str, dict[str, int]], list[Test]]:
        outer, self.scope, dry, self.dry = self.scope, {}, self.dry, False  # no braces here, and no mistakes either
        found: dict[str, dict[str, int]] = {}
        while not found or self.accept(","):
            self.need(self.parameter_begins(), "expected `PARAMETER in`")
            name = self.name()
            self.need(name not in found and name not in outer, f"there is a parameter {name} already")
            self.expect("in")
            braced = self.next.startswith("{")
            values = self.listed(self.items(braced), MOST_COMBINATIONS)
            values = self.lists.get(values[0], values) if len(values) == 1 and not braced else values
            found[name] = self.orders.setdefault(values, {value: place for place, value in enumerate(values)})
        tests = [self.test()] if self.accept("where") else []
        while tests and self.accept(","):
            tests.append(self.test())
        self.scope, self.dry = outer, dry
        return found, tests

    def test(self) -> Test:
        return self.operand(), self.expect(*OPERATORS), self.operand()

    def operand(self) -> Operand:
        word, _ = self.located_value()
        shift = self.next if NAME.fullmatch(word) and SHIFT.fullmatch(self.next) else ""
        self.position += shift != ""
        return word, shift

    def passes(self, test: Test) -> bool:
        one, sign, other = test
        values: list[Any] = []
        orders: list[dict[str, int]] = []
        for (word, shift), (partner, _) in ((one, other), (other, one)):
            value, order = self.scope.get(word, (word, self.scope.get(partner, ("", {}))[1]))
            values.append(self.shifted(value, shift))
            orders.append(order)
        numbers = [NUMBER.fullmatch(value) is not None for value in values]
        if all(numbers):
            values = [int(value) for value in values]
        elif sign not in ("=", "!="):
            self.need(not any(numbers) and orders[0] is orders[1], f"`{sign}` asks for numbers, or words of one list")
            values = [orders[0][value] for value in values]
        return OPERATORS[sign](*values)

    def check(self, tests: list[Test], scope: dict[str, tuple[str, dict[str, int]]]) -> None:
        for one, _, other in tests:
            for (word, shift), (partner, _) in ((one, other), (other, one)):
                value = NUMBER.fullmatch(word) is not None or word in scope.get(partner, ("", {}))[1]
                known = word in scope or (value and not shift)
                self.need(known, f"`{word}` is no parameter, and no value that it is compared with")

    def copies(self, before: str = "") -> Iterator[None]:
        domains, tests = self.header()
        self.check(tests, {**self.scope, **{name: ("1", order) for name, order in domains.items()}})
        if before:
            self.expect(before)
        start, outer, dry, made = self.position, self.scope, self.dry, 0
        if not dry:
            self.combinations += math.prod(map(len, domains.values()))
            self.need(self.combinations <= MOST_COMBINATIONS, f"more than {MOST_COMBINATIONS} combinations before this")
        for values in itertools.product(*domains.values()) if not dry else ():
            self.scope = {**outer, **{name: (values[n], domains[name]) for n, name in enumerate(domains)}}
            if sum(map(self.passes, tests)) == len(tests):
                self.position = start
                yield
                made += 1
                self.copied += self.position - start
                within_limit(self.copied, "words in copies")
        if not made:
            self.position, self.dry = start, True
            self.scope = {**outer, **{name: ("1", order) for name, order in domains.items()}}
            yield
        self.scope, self.dry = outer, dry

    def entries(self, read: Callable[[Any], None], target: Any, end: str) -> None:
        while not self.accept(end):
            if self.at("for"):
                self.repeat(read, target)
            else:
                self.count()
                read(target)

    def repeat(self, read: Callable[[Any], None], target: Any) -> None:  # for … end for
        self.expect("for")
        self.loops += 1
        self.nested(self.loops)
        for _ in self.copies():
            self.entries(read, type(target)() if self.dry else target, "end for")
        self.loops -= 1

    def count(self) -> None:
        self.made += not self.dry
        self.need(self.made <= MOST_ENTRIES, f"more than {MOST_ENTRIES} entries before this")

    # Blocks stand in any order, each at most once.

    def specification(self) -> Specification:
        titles = ("STATE VECTOR", "ALIASES", "RESOURCES", "ACTIONS", "REACTION RULES", "STATE RULES", "ASSUMPTIONS")
        seen: set[str] = set()
        while self.next:
            self.expect("BEGIN")
            self.title = self.expect(*titles, "START", "GOALS", "CONFIG")
            self.need(self.title not in seen, f"there is a block {self.title} already")
            seen.add(self.title)
            if self.title == "GOALS":
                self.spec.goals = self.goal_list(None)
                self.nested(levels_of_goal(self.spec.goals))
            else:
                self.entries(self.entry, self.spec, "END")
                self.expect(self.title)
        return self.spec

    def entry(self, spec: Specification) -> None:
        if self.title == "STATE VECTOR":
            self.state(spec)
        elif self.title == "ALIASES":
            self.alias(spec)
        elif self.title == "RESOURCES":
            self.expect("resource")
            spec.resources[self.new_name(spec.resources)] = None
        elif self.title == "ACTIONS":
            self.action(spec)
        elif self.title == "CONFIG":
            self.setting(spec)
        elif self.title == "STATE RULES" and not self.scope and self.accept("severity :"):
            spec.severity = self.number(1)
        else:
            self.expect({"ASSUMPTIONS": "assume :", "START": "start :"}.get(self.title, "rule :"))
            rules = {"STATE RULES": spec.state_rules, "REACTION RULES": spec.reaction_rules, "START": spec.starts}
            rules.get(self.title, spec.assumptions).append(self.located_predicate())
            spec.severities += [spec.severity] if self.title == "STATE RULES" else []

    def state(self, spec: Specification) -> None:  # state NAME can be VALUE, A..B, …
        self.expect("state")
        variable = self.new_name(spec.variables)
        self.expect("can be")
        spec.variables[variable] = self.listed(self.items(False), MOST_VALUES)
        spec.values += len(spec.variables[variable])
        self.need(spec.values <= MOST_VALUES_IN_ALL, f"more than {MOST_VALUES_IN_ALL} values before this")

    def alias(self, spec: Specification) -> None:  # define NAME as PREDICATE, or {WORD, WORD, …}
        is_list = self.list_begins()
        self.need(not (is_list and self.scope), "expected a list outside `for`")
        self.expect("define")
        name = self.new_name(spec.aliases, spec.lists)
        self.expect("as")
        if is_list:
            self.items(True)
            spec.lists[name] = self.lists[name]
        else:
            spec.aliases[name], _ = self.located_predicate()

    def list_begins(self, ahead: int = 0) -> bool:  # define NAME as {
        define, _, between, braces = (*self.ahead(ahead, 4), *[""] * 4)[:4]
        return (define, between) == ("define", "as") and (braces == "{" or ONE_WORD.fullmatch(braces) is not None)

    def setting(self, spec: Specification) -> None:  # max_plan_length: N, effect_ordering: any, restoration: one_step
        setting = self.expect(*SETTINGS)
        name, *choices = SETTINGS[setting]
        self.need(self.dry or getattr(spec, name) is None, f"there is a `{setting}` already")
        setattr(spec, name, self.expect(*choices) if choices else self.number(1))

    # Actions: fields in any order, each at most once but for alternatives; `cost:` and `effects:` are older spellings.

    FIELDS = (
        *("duration :", "cost :", "preconditions :", "effects :"),
        *("controlled resources :", "nominal effects :", "alternative effects :"),
    )

    def action(self, spec: Specification) -> None:
        self.expect("action")
        line = self.line
        action = Action(self.new_name(spec.actions), line)
        spec.actions[action.name] = action
        self.fields(action)

    def fields(self, action: Action) -> None:
        while True:
            if any(map(self.at, self.FIELDS)):
                self.count()
                self.field(action)
            elif self.at("for") and not self.follows("action"):
                self.repeat(self.field, action)
            else:
                return

    def follows(self, word: str) -> bool:  # behind all headers that follow one another
        start = self.position
        while self.accept("for"):
            self.header()
        found = self.next == word
        self.position = start
        return found

    def field(self, action: Action) -> None:
        words = self.expect(*self.FIELDS)
        kind = {"cost :": "duration :", "effects :": "nominal effects :"}.get(words, words)
        again = kind in action.fields and kind != "alternative effects :" and not self.dry
        self.need(not again, f"there is a field `{kind}` already")
        action.fields.add(kind)
        if kind == "duration :":
            action.duration = self.number()
        elif kind == "controlled resources :":
            action.resources = self.list_of(self.located_name)
        elif kind == "preconditions :":
            action.preconditions = self.list_of(self.located_predicate)
        elif kind == "nominal effects :":
            action.nominal = self.effect_set()
        else:
            action.alternatives.append(self.effect_set())

    def effect_set(self) -> EffectSet:
        found = EffectSet(self.line, self.list_of(self.located_effect))
        while self.at("when") or (self.at("for") and self.follows("when")):
            if self.at("when"):
                self.clause(found.clauses)
            else:
                self.repeat(self.clause, found.clauses)
        return found

    def clause(self, clauses: list[tuple[Located, list[Located]]]) -> None:  # when PREDICATE: EFFECT, …
        self.count()
        self.expect("when")
        condition = self.located_predicate()
        self.expect(":")
        clauses.append((condition, self.list_of(self.located_effect)))

    def located_effect(self) -> Located:  # a predicate, or S is S + 1
        line, (variable, word, origin, sign) = self.line, (*self.ahead(0, 4), *[""] * 4)[:4]
        self.position += 2
        denied = origin == "not" and self.value_follows()
        self.position -= 2
        if word != "is" or sign[:1] not in ("+", "-") or denied or not is_name(variable) or not is_name(origin):
            return self.located_predicate()
        name = self.located_name()
        self.expect("is")
        other = self.located_name()
        step = self.next
        self.position += 1
        number = self.word(WHOLE_NUMBER, "a number") if step in ("+", "-") else step[1:]
        self.need(step in ("+", "-") or number[0] != "0", "expected a number without zeros before it")
        amount = int(number) * (-1 if step[0] == "-" else 1) if number.isdigit() else 1
        need(1 <= abs(amount) <= LARGEST_NUMBER, f"line {line}: {amount} is not 1 to {LARGEST_NUMBER}")
        return ("change", name, other, amount), line

    def list_of(self, read: Callable[[], tuple[Any, int]]) -> list[tuple[Any, int]]:  # …, … or none; may be empty
        ends = self.at("END") or any(map(self.at, self.FIELDS)) or self.action_begins()
        copies = (self.at("for") and self.parameter_begins(1)) or (self.scope != {} and self.at("end for"))
        if self.accept("none") or ends or copies or self.clause_begins():
            return []
        found = [read()]
        while self.accept(","):
            found.append(read())
        return found

    def clause_begins(self) -> bool:  # `when` may also be the name of a variable or an alias
        following, after = (*self.ahead(1, 2), "", "")[:2]
        word = re.match(r"[A-Za-z_]|\w*\{\w", following) is not None and following not in NO_PREDICATES
        return self.at("when") and (following == "(" or (word and not entry_begins(following, after)))

    def action_begins(self) -> bool:  # `action` may also be the name of a variable or an alias
        following, after = (*self.ahead(1, 2), "", "")[:2]
        named = re.match(r"[A-Za-z_]|\w*\{\w", following) is not None and following not in {*KEYWORDS, "is"}
        in_set = (following, after[:1]) == ("in", "{") or (following, after) == ("not", "in")
        return self.at("action") and named and not in_set

    # Goals.

    def goal_list(self, condition: Formula | None) -> Goal:  # what follows BEGIN GOALS
        if self.accept("END GOALS"):
            return Goal("constraint", condition)
        self.expect("goal type :")
        goals = Goal(self.expect("priority", "constraint"), condition)
        self.entries(self.goal, goals, "END")
        self.expect("GOALS")
        return goals

    def goal(self, goals: Goal) -> None:
        when = None
        if self.accept("when"):
            when = self.predicate()
            self.expect("then")
        nested = self.expect("goal :", "BEGIN GOALS") == "BEGIN GOALS"
        goals.members.append(self.goal_list(when) if nested else Goal("goal", when, self.predicate()))

    # Predicates, loosest first. IFONLYIF comes once, without a chain; a nested IF needs parentheses.

    def located_predicate(self) -> Located:
        line = self.line
        found = self.predicate()
        self.nested(levels_of(found))
        return found, line

    def predicate(self) -> Formula:
        left = self.implication()
        return ("iff", left, self.disjunction()) if self.accept("IFONLYIF") else left

    def implication(self) -> Formula:
        if not self.accept("IF"):
            return self.disjunction()
        condition = self.disjunction()
        self.expect("THEN")
        return ("if", condition, self.disjunction())

    def disjunction(self) -> Formula:
        parts = [self.conjunction()]
        while self.accept("OR"):
            parts.append(self.conjunction())
        return ("or", *parts) if len(parts) > 1 else parts[0]

    def conjunction(self) -> Formula:
        parts = [self.negation()]
        while self.accept("AND"):
            parts.append(self.negation())
        return ("and", *parts) if len(parts) > 1 else parts[0]

    def negation(self) -> Formula:
        return ("not", self.negation()) if self.accept("NOT") else self.basic()

    def basic(self) -> Formula:  # ( p ), true, false, executing ACTION, an alias, or what begins with a variable
        if self.accept("("):
            self.parentheses += 1
            self.nested(self.parentheses)
            inside = self.predicate()
            self.expect(")")
            self.parentheses -= 1
            return inside
        for quantifier in ("all", "some", "exactly one"):
            if self.at(quantifier) and self.parameter_begins(len(quantifier.split())):
                return self.quantified(quantifier)
        if word := self.accept("true", "false"):
            return (word,)
        if self.accept("executing"):
            return ("executing", self.located_name())
        name = self.located_name()
        if self.accept("is"):
            negated = self.at("not") and self.value_follows() and self.accept("not")
            found: Formula = ("is", name, self.located_value())
            return ("denied", found) if negated else found
        if words := self.accept("in", "not in"):
            found = ("in", name, self.items(True))
            return found if words == "in" else ("denied", found)
        if sign := self.accept(*OPERATORS):
            return ("compared", name, sign, self.located_value())
        return ("alias", name)

    def value_follows(self) -> bool:  # after `S is not`; otherwise `not` is the value
        word, following = (*self.ahead(1, 2), "")[:2]
        is_value = re.match(r"\w|[+-][0-9]|\{\w", word) is not None and word not in NO_VALUES
        return is_value and not entry_begins(word, following)

    def quantified(self, quantifier: str) -> Formula:  # all PARAMETER in r1, r2 where COND: PREDICATE
        self.accept(quantifier)
        bodies, empty = [], False
        for _ in self.copies(":"):
            bodies.append(self.predicate())
            empty = self.dry
        if empty:
            return ("no instance", ("true" if quantifier == "all" else "false",), bodies[0])
        return (quantifier, *bodies)


def is_name(word: str) -> bool:
    """Whether a word can name a variable."""
    return re.match(r"[A-Za-z_]|\{\w", word) is not None and word not in KEYWORDS


def entry_begins(word: str, after: str) -> bool:
    """Whether a word and the next begin a field, a rule, a goal or a setting."""
    return (word, after) in TITLES or (word in ENTRIES and after == ":")


ATOMS = {"true", "false", "is", "executing", "alias", "in", "compared", "denied"}  # as a formula is written


def levels_of(formula: Formula) -> int:
    """How many operators are nested in a formula as it is written."""
    return 0 if formula[0] in ATOMS else 1 + max(map(levels_of, formula[1:]))


def levels_of_goal(goal: Goal) -> int:
    """How many lists, conditions, goals and operators are nested in a goal."""
    inside = 1 + max([levels_of(goal.body), *map(levels_of_goal, goal.members)])
    return inside if goal.condition is None else 1 + max(levels_of(goal.condition), inside)


# ----------------------------------------------------------------------------------------------------------------------
# 3. Names, and the effects of actions (docs/semantics.md, section 2).


def read_specification(data: bytes) -> Specification:
    """The specification that a file holds."""
    need(len(data) <= MOST_BYTES, f"the specification is larger than {MOST_BYTES} bytes")
    return resolve(Parser(data.decode("utf-8-sig")).specification())


def resolve(spec: Specification) -> Specification:
    """Replace every name by what it means, and every list of effects by the assignments that it denotes."""
    need(bool(spec.variables), "there is no state variable")
    names = [*spec.variables, *spec.lists, *spec.aliases, *spec.resources, *spec.actions]
    need(len(set(names)) == len(names), "two things of different kinds have the same name")
    need(len(spec.variables) <= MOST_VARIABLES, f"there are more than {MOST_VARIABLES} state variables")
    need(len(spec.actions) <= MOST_ACTIONS, f"there are more than {MOST_ACTIONS} actions")
    spec.aliases = {name: spelled_out(spec, alias) for name, alias in spec.aliases.items()}
    for name in spec.aliases:
        resolve_alias(spec, name)
    for action in spec.actions.values():
        resolve_action(spec, action)
    spec.reaction_rules = [(resolved(spec, rule, True), line) for rule, line in spec.reaction_rules]
    spec.state_rules = [(resolved(spec, rule, False), line) for rule, line in spec.state_rules]
    spec.assumptions = [(resolved(spec, rule, False), line) for rule, line in spec.assumptions]
    spec.starts = [(resolved(spec, rule, False), line) for rule, line in spec.starts]
    for action in spec.actions.values():
        if action.conditional:
            check_clauses(spec, action)
    if spec.goals is not None:
        resolve_goal(spec, spec.goals)
    return spec


def spelled_out(spec: Specification, formula: Formula) -> Formula:
    """A formula as it is written, without what stands for several atoms."""
    found, terms = Speller(spec).spell(formula)
    spec.written += terms
    need(spec.written <= MOST_TERMS_IN_ALL, f"all predicates together have more than {MOST_TERMS_IN_ALL} terms")
    return found


class Speller:
    """What the sets, comparisons and quantifiers of a predicate stand for (docs/certificate.md, The digest).

    Every formula comes with the number of its terms, which is known before a large one is made.
    """

    def __init__(self, spec: Specification) -> None:
        self.spec = spec

    def spell(self, formula: Formula) -> Counted:
        kind, *parts = formula
        if kind in ("true", "false", "is", "executing", "alias"):
            return formula, 1
        if kind == "in":
            return self.one_of(parts[0], self.listed(*parts))
        if kind == "compared":
            return self.compared(*parts)
        if kind == "no instance":
            return parts[0], 1
        spelled = [self.spell(part) for part in parts]
        if kind == "exactly one" and len(spelled) > 1:
            others = [self.joined("not", [each]) for each in spelled]
            self.check(len(others) * sum(terms for _, terms in others))
            each = ([one, *others[:n], *others[n + 1 :]] for n, one in enumerate(spelled))
            return self.joined("or", [self.joined("and", parts) for parts in each])
        if kind in ("all", "some", "exactly one"):
            return self.joined("and" if kind == "all" else "or", spelled)
        return self.joined("not" if kind == "denied" else kind, spelled)

    def joined(self, kind: str, parts: list[Counted]) -> Counted:
        """An operator with its operands; one operand of `and` or `or` stands for itself."""
        if len(parts) == 1 and kind in ("and", "or"):
            return parts[0]
        terms = 1 + sum(terms for _, terms in parts)
        self.check(terms)
        return (kind, *(part for part, _ in parts)), terms

    def check(self, terms: int) -> None:
        need(terms <= MOST_TERMS, f"a predicate has {terms} terms when it is written out")

    def values(self, name: tuple[str, int]) -> tuple[str, ...]:
        need(name[0] in self.spec.variables, f"line {name[1]}: there is no variable `{name[0]}`")
        return self.spec.variables[name[0]]

    def numbers(self, name: tuple[str, int]) -> list[tuple[int, int]]:
        """The values of a variable, the smallest first, with their places."""
        found, values = self.spec.numbers.get(name[0], []), self.values(name)
        need(len(found) == len(values), f"line {name[1]}: `{name[0]}` has values that are no numbers")
        return found

    def one_of(self, name: tuple[str, int], values: Iterable[str]) -> Counted:
        return self.joined("or", [(("is", name, (value, name[1])), 1) for value in values])

    def listed(self, name: tuple[str, int], items: list[Item]) -> list[str]:
        """The values of a set, in the order of declaration."""
        values, numbers = self.values(name), self.spec.numbers.get(name[0], [])
        ranges = [item for item in items if isinstance(item, range)]
        chosen = {item[0] for item in items if not isinstance(item, range)}
        spans = [[bisect_left(numbers, (number,)) for number in (each.start, each.stop)] for each in ranges]
        known = chosen <= self.spec.atoms[name[0]].keys() and all(start < end for start, end in spans)
        need(known, f"line {name[1]}: the set has something that is no value of `{name[0]}`")
        done = 0
        for start, end in sorted(spans):
            chosen.update(str(number) for number, _ in numbers[max(start, done) : end])
            done = max(done, end)
        return [value for value in values if value in chosen]

    def compared(self, name: tuple[str, int], sign: str, other: tuple[str, int]) -> Counted:
        """`S < 3`; or `S < T`: for each value of S, that T has a larger one."""
        self.numbers(name)
        if NUMBER.fullmatch(other[0]):
            return self.than(name, sign, other[0], alone=True)
        self.numbers(other)
        found, count = [], 0
        for value in self.values(name):
            here: Counted = ("is", name, (value, name[1])), 1
            there = self.than(other, MIRRORED.get(sign, sign), value, alone=False)
            count += there[1]
            self.check(count)
            if there[0] != ("false",):
                found.append(here if there[0] == ("true",) else self.joined("and", [here, there]))
        return self.joined("or", found) if found else (("false",), 1)

    def than(self, name: tuple[str, int], sign: str, number: str, alone: bool) -> Counted:
        """A comparison with a number; constant where it is so of every value, or of none."""
        values, numbers = self.values(name), self.numbers(name)
        if sign in ("=", "!="):
            known = number in self.spec.atoms[name[0]]
            if not alone and (not known or len(values) == 1):
                return ("true" if known == (sign == "=") else "false",), 1
            return self.one_of(name, [number]) if sign == "=" else self.joined("not", [self.one_of(name, [number])])
        first, last = (bisect_left(numbers, (int(number) + more,)) for more in (0, 1))
        spans = {"<": (0, first), "<=": (0, last), ">": (last, len(values)), ">=": (first, len(values))}
        start, end = spans[sign]
        if end - start in (0, len(values)):
            return ("true" if start < end else "false",), 1
        return self.one_of(name, (values[place] for place in sorted(place for _, place in numbers[start:end])))


def resolve_action(spec: Specification, action: Action) -> None:
    """Names in an action, and its effects, unless they depend on the state in which it starts."""
    for name, line in action.resources:
        need(name in spec.resources, f"line {line}: there is no resource `{name}`")
    action.holds_resources = frozenset(name for name, _ in action.resources)
    action.preconditions = [(resolved(spec, part, False), line) for part, line in action.preconditions]
    sets = [action.nominal, *action.alternatives]
    for each in sets:
        each.effects = [(resolved_effect(spec, effect), line) for effect, line in each.effects]
        each.clauses = [
            ((resolved(spec, condition, False), line), [(resolved_effect(spec, effect), at) for effect, at in effects])
            for (condition, line), effects in each.clauses
        ]
    changes = {effect[1] for each in sets for effect, _ in each.effects if effect[0] == "change"}
    clauses = [clause for each in sets for clause in each.clauses]
    changes |= {effect[1] for _, effects in clauses for effect, _ in effects if effect[0] == "change"}
    action.places = sorted(changes | {atom[1] for (condition, _), _ in clauses for atom in atoms(condition)})
    action.conditional = clauses != [] or changes != set()
    if not action.conditional:
        action.effects[()], why = effects_from(spec, action, ())
        need(why == "", f"line {action.line}: {why}")


def resolved_effect(spec: Specification, effect: Formula) -> Formula:
    """A predicate with its names replaced; or what becomes of each value of a variable that changes relatively."""
    if effect[0] != "change":
        return resolved(spec, effect, False)
    (name, line), (origin, _), step = effect[1:]
    need(name in spec.variables and name == origin, f"line {line}: `{name}` is not changed relative to itself")
    values = spec.variables[name]
    need(all(map(NUMBER.fullmatch, values)), f"line {line}: `{name}` has values that are no numbers")
    least, most = min(map(int, values)), max(map(int, values))
    becomes = {value: str(min(max(int(value) + step, least), most)) for value in values}
    need(set(becomes.values()) <= set(values), f"line {line}: `{name}` changes to what is none of its values")
    place, atoms = list(spec.variables).index(name), spec.atoms[name]
    return ("change", place, {value: atoms[new] for value, new in becomes.items()})


def effects_from(spec: Specification, action: Action, state: State) -> tuple[list[Effect], str]:
    """The effects that an action takes when it starts in a state, and what is wrong with them: then there are none."""
    found = []
    for number, each in enumerate([action.nominal, *action.alternatives]):
        happening = [each.effects, *(effects for (condition, _), effects in each.clauses if holds(condition, state))]
        parts = [effect for effects in happening for effect, _ in effects]
        outcomes = assignments(spec, [part[2][state[part[1]]] if part[0] == "change" else part for part in parts])
        need(len(outcomes) <= MOST_OUTCOMES, f"line {action.line}: effects of `{action.name}` are too many")
        if number == 0 and len(outcomes) != 1:
            return [], f"the nominal effects of `{action.name}` leave {counted(len(outcomes), 'assignment')}, not one"
        if not outcomes:
            return [], f"alternative effects of `{action.name}` cannot happen"
        found += outcomes
    return found, ""


def check_clauses(spec: Specification, action: Action) -> None:
    """The effects of an action for all values that its conditions speak of.

    Where they disagree, no valid state satisfies its preconditions.
    """
    domains = list(spec.variables.values())
    within_limit(math.prod(len(domains[place]) for place in action.places), "values that conditions speak of")
    wrong: dict[State, str] = {}
    for values in itertools.product(*(domains[place] for place in action.places)):
        here = {place: values[number] for number, place in enumerate(action.places)}
        state = tuple(here.get(place, "") for place in range(len(domains)))
        action.effects[values], why = effects_from(spec, action, state)
        if why:
            wrong[values] = why
    if not wrong:
        return
    within_limit(math.prod(map(len, domains)), "states")
    for state in itertools.product(*domains):
        why = wrong.get(tuple(state[place] for place in action.places), "")
        rules = [*action.preconditions, *spec.assumptions] if why else []
        need(not why or not all(holds(rule, state) for rule, _ in rules), f"line {action.line}: in {state}, {why}")


def resolve_goal(spec: Specification, goal: Goal) -> None:
    """Names in a goal: conditions speak of the state only, bodies also of what is executed."""
    if goal.condition is not None:
        goal.condition = resolved(spec, goal.condition, False)
    if goal.kind == "goal":
        goal.body = resolved(spec, goal.body, True)
    for member in goal.members:
        resolve_goal(spec, member)


def resolve_alias(spec: Specification, name: str) -> None:
    """Replace the names in an alias, after those in the aliases that it uses."""
    path = {name: iter(aliases_in(spec.aliases[name]))} if name not in spec.sizes else {}
    while path:
        here = next(reversed(path))
        used, line = next(path[here], ("", 0))
        need(used not in path, f"line {line}: the alias `{used}` uses itself")
        if used and used not in spec.sizes:
            need(used in spec.aliases, f"line {line}: there is no alias `{used}`")
            path[used] = iter(aliases_in(spec.aliases[used]))
        elif not used:
            size = size_of(spec, spec.aliases[here])
            spec.aliases[here], spec.sizes[here] = meaning(spec, spec.aliases[here]), size
            del path[here]


def aliases_in(formula: Formula) -> list[tuple[str, int]]:
    """The aliases that a formula names as it is written, with their lines."""
    if formula[0] == "alias":
        return [formula[1]]
    parts = formula[1:] if formula[0] not in ("is", "executing") else ()
    return [name for part in parts for name in aliases_in(part)]


def size_of(spec: Specification, formula: Formula) -> tuple[int, int]:
    """Terms and levels of a formula as it is written, with its aliases expanded; `IF p THEN q` is `NOT p OR q`."""
    kind, *parts = formula
    if kind == "alias":
        name, line = parts[0]
        need(name in spec.sizes, f"line {line}: there is no alias `{name}`")
        return spec.sizes[name]
    if kind in ("true", "false", "is", "executing"):
        return 1, 1
    sizes = [size_of(spec, part) for part in parts]
    if kind == "if":
        sizes[0] = sizes[0][0] + 1, sizes[0][1] + 1
    terms, levels = 1 + sum(terms for terms, _ in sizes), 1 + max(levels for _, levels in sizes)
    fits = terms <= MOST_TERMS and levels <= MOST_LEVELS
    need(fits, f"with its aliases expanded, a predicate has {terms} terms and {levels} levels")
    return terms, levels


def resolved(spec: Specification, formula: Formula, may_execute: bool) -> Formula:
    """The formula with names replaced."""
    formula = spelled_out(spec, formula)
    spec.terms += size_of(spec, formula)[0]
    need(spec.terms <= MOST_TERMS_IN_ALL, f"all predicates together have more than {MOST_TERMS_IN_ALL} terms")
    found = meaning(spec, formula)
    executing = "" if may_execute else next((part[1] for part in atoms(found) if part[0] == "executing"), "")
    need(not executing, f"`executing {executing}` stands outside of reaction rules and goals")
    return found


def meaning(spec: Specification, formula: Formula) -> Formula:
    """The formula with names replaced; the aliases that it uses are resolved."""
    kind = formula[0]
    if kind == "if":
        return ("or", ("not", meaning(spec, formula[1])), meaning(spec, formula[2]))
    if kind not in ("is", "executing", "alias"):
        return (kind, *(meaning(spec, part) for part in formula[1:]))
    name, line = formula[1]
    if kind == "is":
        value = formula[2][0]
        need(name in spec.variables, f"line {line}: there is no variable `{name}`")
        need(value in spec.atoms[name], f"line {line}: `{name}` has no value `{value}`")
        return spec.atoms[name][value]
    if kind == "executing":
        need(name in spec.actions, f"line {line}: there is no action `{name}`")
        return ("executing", name)
    return spec.aliases[name]


def assignments(spec: Specification, effects: list[Formula]) -> list[Effect]:
    """The assignments to the mentioned variables that satisfy the whole list of effects."""
    parts = conjuncts(effects)
    domains = list(spec.variables.values())
    choices = {atom[1]: domains[atom[1]] for part in parts for atom in atoms(part)}
    for kind, *rest in parts:
        if kind == "is":  # a plain effect leaves one value: no need to try the others
            choices[rest[0]] = (rest[1],)
    if math.prod(map(len, choices.values())) > LARGEST:
        raise TooLarge("a set of effects has too many assignments to look at")
    found = []
    for values in itertools.product(*choices.values()):
        effect = {variable: values[place] for place, variable in enumerate(choices)}
        state = tuple(effect.get(variable, "") for variable in range(len(domains)))
        if all(holds(part, state) for part in parts):
            found.append(effect)
    return found


def conjuncts(formulas: Iterable[Formula]) -> list[Formula]:
    """The same conjunction, with `p AND q` taken apart."""
    return [part for f in formulas for part in (conjuncts(f[1:]) if f[0] == "and" else [f])]


def atoms(formula: Formula) -> Iterator[Formula]:
    """The `is` and `executing` parts of a formula."""
    if formula[0] in ("is", "executing"):
        yield formula
    else:
        for part in formula[1:]:
            yield from atoms(part)


def holds(formula: Formula, state: State, executed: ActionSet = frozenset()) -> bool:
    """Whether a formula is true in a state while `executed` is executed."""
    kind = formula[0]
    if kind == "is":
        return bool(state[formula[1]] == formula[2])
    if kind == "executing":
        return formula[1] in executed
    if kind == "not":
        return not holds(formula[1], state, executed)
    if kind == "and":
        return all(holds(part, state, executed) for part in formula[1:])
    if kind == "or":
        return any(holds(part, state, executed) for part in formula[1:])
    if kind == "iff":
        return holds(formula[1], state, executed) == holds(formula[2], state, executed)
    return bool(kind == "true")


def truth(formula: Formula, state: State, executed: ActionSet, open_actions: ActionSet) -> bool | None:
    """The truth of a formula whichever of the open actions are executed besides; None where that seems to matter."""
    kind = formula[0]
    if kind == "executing" and formula[1] in open_actions:
        return None
    if kind not in ("not", "and", "or", "iff"):
        return holds(formula, state, executed)
    found = [truth(part, state, executed, open_actions) for part in formula[1:]]
    if kind in ("and", "or"):
        settling = kind == "or"
        return settling if settling in found else None if None in found else not settling
    if None in found:
        return None
    return not found[0] if kind == "not" else found[0] == found[1]


# ----------------------------------------------------------------------------------------------------------------------
# 4. States (docs/semantics.md, section 1), and what may be executed together (sections 3, 9 and 10).


class World:
    """A specification under one effect ordering and one way to restore safety.

    With starts (section 12), only those valid states count that a policy decides, as if that were assumed: `part`.

    A *tier* is the state rules of one severity. Decisions are *stepwise* where restoring may take more than one step:
    several because it is said so, or one for each tier.
    """

    def __init__(self, spec: Specification, ordering: str, restoration: str | None = None) -> None:
        self.spec = spec
        self.ordering = ordering
        self.restoration = restoration or spec.restoration or RESTORATIONS[0]
        self.tiers = spec.tiers()
        self.stepwise = self.restoration != "one_step" or len(self.tiers) > 1
        self.all_rules: Required = tuple(range(len(spec.state_rules)))
        self.known: dict[Required, dict[State, bool]] = {}  # of `meets`
        self.levels: dict[State, int] = {}
        self.answers: dict[tuple[State, ActionSet, Required, State], bool] = {}  # of `stays_within`
        self.part: set[State] | None = None  # None: all valid states count

    @cached_property
    def valid(self) -> list[State]:
        """`V`."""
        count = math.prod(map(len, self.spec.variables.values()))
        if count > LARGEST:
            raise TooLarge(f"{count:,} states are too many to look at each of them, which is done up to {LARGEST:,}")
        valid = [state for state in self.every_state() if self.is_valid(state)]
        need(valid != [], "no state satisfies all assumptions")
        return valid

    def every_state(self) -> Iterator[State]:
        """All states, valid or not."""
        return itertools.product(*self.spec.variables.values())

    def is_start(self, state: State) -> bool:
        """Whether a valid state satisfies a start condition."""
        return any(holds(formula, state) for formula, _ in self.spec.starts)

    def within(self, decided: set[State]) -> World:
        """The same where, of the valid states, only decided ones count."""
        part = World(self.spec, self.ordering, self.restoration)
        part.part = decided.intersection(self.valid)
        part.valid = [state for state in self.valid if state in decided]
        return part

    @cached_property
    def safe(self) -> list[State]:
        """`S`."""
        return [state for state in self.valid if self.is_safe(state)]

    def is_valid(self, state: State) -> bool:
        """Whether a state satisfies all assumptions, and is one that counts."""
        if self.part is not None:
            return state in self.part
        return self.broken(self.spec.assumptions, state) is None

    def is_safe(self, state: State) -> bool:
        """Whether a state is valid and satisfies all state rules."""
        return self.meets(self.all_rules, state)

    def meets(self, required: Required, state: State) -> bool:
        """Whether a state is valid and satisfies the state rules of these numbers."""
        known = self.known.setdefault(required, {})
        if state not in known:
            rules = [self.spec.state_rules[number] for number in required]
            known[state] = self.is_valid(state) and self.broken(rules, state) is None
        return known[state]

    def level(self, state: State) -> int:
        """How many tiers, the most severe first, a state satisfies before the first that it does not."""
        if state not in self.levels:
            broken = (number for number, tier in enumerate(self.tiers) if self.broken(tier, state) is not None)
            self.levels[state] = next(broken, len(self.tiers))
        return self.levels[state]

    def required(self, state: State) -> Required:
        """The state rules that hold wherever a step from a valid state may lead.

        Those of the tiers that the state satisfies and of the first that it does not; in several steps, of these only
        such as hold in the state already. In a safe state that is all of them.
        """
        if not self.stepwise or self.is_safe(state):
            return self.all_rules
        mildest = sorted(set(self.spec.severities))[self.level(state)]
        rules = [number for number in self.all_rules if self.spec.severities[number] <= mildest]
        if self.restoration != "one_step":
            rules = [number for number in rules if holds(self.spec.state_rules[number][0], state)]
        return tuple(rules)

    def restored(self, state: State, after: State) -> bool:
        """Whether a state satisfies a tier more than an earlier one; with one tier, whether it is safe."""
        return self.is_valid(after) and self.level(after) > self.level(state)

    def broken(self, rules: list[Located], state: State, executed: ActionSet = frozenset()) -> int | None:
        """The line of the first rule that does not hold."""
        return next((line for formula, line in rules if not holds(formula, state, executed)), None)

    def apply(self, state: State, effect: Effect) -> State:
        """The state after an effect: variables that it does not mention keep their values."""
        values = list(state)
        for place, value in effect.items():
            values[place] = value
        return tuple(values)

    def effects(self, start: State, name: str) -> list[Effect]:
        """Every effect that an action may take that starts in a state, the nominal one first.

        None where no effect mentions a variable.
        """
        found = self.spec.actions[name].effects_in(start)
        return found if any(found) else []

    def nominal(self, start: State, name: str) -> Effect:
        """What an action writes nominally that starts in a state."""
        found = self.spec.actions[name].effects_in(start)
        return found[0] if found else {}

    def acts(self, start: State, chosen: Iterable[str]) -> bool:
        """Whether some action of a set takes effect."""
        return any(self.effects(start, name) for name in chosen)

    def agree(self, start: State, chosen: ActionSet) -> bool:
        """Whether the nominal effects of a set never give one variable two values."""
        given = {pair for name in chosen for pair in self.nominal(start, name).items()}
        return len(given) == len({variable for variable, _ in given})

    def successor(self, state: State, chosen: ActionSet) -> State:
        """`δ(s, A)`: all nominal effects at once. Where they agree, their order does not matter."""
        start = state
        for name in chosen:
            state = self.apply(state, self.nominal(start, name))
        return state

    def outcomes(self, state: State, chosen: ActionSet) -> Iterator[tuple[State, list[State]]]:
        """`Out(s, A)`, each outcome with the states on the way to it; some of them more than once.

        Under `any` the actions take effect one after the other, each at most once and with any one of its effects,
        and every state on the way counts. Under `first` only one action takes effect. Where no action of the set has
        effects, as in the empty one, the only outcome is the state itself.
        """
        if not self.acts(state, chosen):
            yield state, [state]
        yield from ((after, way) for after, _, way in self.in_turn(state, chosen))

    def in_turn(self, state: State, chosen: ActionSet) -> Iterator[tuple[State, ActionSet, list[State]]]:
        """What effects lead to, each time with the actions that have not taken effect, and the states on the way."""
        waiting, seen = [(state, chosen, [state])], set()
        while waiting:
            here, idle, way = waiting.pop()
            for name, effect in [(each, effect) for each in sorted(idle) for effect in self.effects(state, each)]:
                after, rest = self.apply(here, effect), idle - {name}
                if (after, rest) not in seen:
                    seen.add((after, rest))
                    within_limit(len(seen), "outcomes of one set of actions")
                    yield after, rest, [*way, after]
                    if self.ordering == "any":
                        waiting.append((after, rest, [*way, after]))

    def next_states(self, state: State, chosen: ActionSet) -> set[State]:
        """`Next(s, A)`: every state in which the next decision may be taken."""
        return {self.successor(state, chosen), *(after for after, _ in self.outcomes(state, chosen))}

    def stays_within(self, start: State, state: State, chosen: ActionSet, required: Required) -> bool:
        """Whether the rules are kept wherever effects of a set lead that are still to come; they began in `start`.

        Answers are kept: orders share states.
        """
        conditional = any(self.spec.actions[name].conditional for name in chosen)
        asked = state, chosen, required, start if conditional else ()
        if asked not in self.answers:
            within_limit(len(self.answers), "outcomes of sets of actions")
            effects = ((name, effect) for name in chosen for effect in self.effects(start, name))
            after = ((self.apply(state, effect), chosen - {name}) for name, effect in effects)
            self.answers[asked] = all(
                self.meets(required, there)
                and self.falsified(there, rest) is None
                and (self.ordering == "first" or self.stays_within(start, there, rest, required))
                for there, rest in after
            )
        return self.answers[asked]

    def falsified(self, state: State, pending: ActionSet) -> str | None:
        """A precondition that does not hold, of actions that have not taken effect; None if it does not have to."""
        for name in sorted(pending) if self.spec.preconditions == "throughout" else ():
            line = self.broken(self.spec.actions[name].preconditions, state)
            if line is not None:
                return f"the precondition of {name} at {self.quote(line)}"
        return None

    def objection(self, state: State, chosen: ActionSet) -> str | None:
        """Why `Ok(s, A)` (or `Keep(s, A)`) is false, or None where it is true: the conditions of section 3 in order."""
        if len(self.answers) > LARGEST // 2:
            self.answers.clear()
        actions = [self.spec.actions[name] for name in sorted(chosen)]
        for action in actions:
            line = self.broken(action.preconditions, state)
            if line is not None:
                return f"a precondition of {action.name} does not hold: {self.quote(line)}"
        for one, other in itertools.combinations(actions, 2):
            if one.holds_resources & other.holds_resources:
                return f"{one.name} and {other.name} share {min(one.holds_resources & other.holds_resources)}"
        if not self.agree(state, chosen):
            return "the nominal effects disagree"
        line = self.broken(self.spec.reaction_rules, state, chosen)
        if line is not None:
            return f"a reaction rule is broken: {self.quote(line)}"
        required = self.required(state)
        acts = self.acts(state, chosen)
        within = acts and self.stays_within(state, state, chosen, required)
        for after, way in self.outcomes(state, chosen) if not within else ():
            if not self.meets(required, after):
                there = "; the effects lead to " + ", then ".join(map(self.show, way[1:])) if acts else ""
                return f"an outcome {self.fault(required, after)}{there}"
        for after, pending, way in self.in_turn(state, chosen) if not within else ():
            line_of = self.falsified(after, pending)
            if line_of is not None:
                return f"effects that lead to {', then '.join(map(self.show, way[1:]))} falsify {line_of}"
        after = self.successor(state, chosen)
        if not self.meets(required, after):
            return f"the nominal successor {self.show(after)} {self.fault(required, after)}"
        return None

    def duration(self, chosen: ActionSet) -> int:
        """The duration of a set: the sum of its actions' durations (section 5)."""
        return sum(self.spec.actions[name].duration for name in chosen)

    def allowed_sets(self, state: State, below: float = math.inf) -> Iterator[ActionSet]:
        """The allowed sets of a smaller duration than `below`, grown action by action in the order of declaration.

        A larger set has all that a smaller one has: the duration, the disagreements about resources and nominal
        effects, and (but for sets without effects) every outcome. Where one of these is at fault, or where a reaction
        rule will be false whatever is added, a set is not grown.
        """
        names = [name for name, a in self.spec.actions.items() if self.broken(a.preconditions, state) is None]
        self.answers.clear()
        waiting, count = [(frozenset[str](), 0)] if below > 0 else [], 0
        while waiting:
            chosen, begin = waiting.pop()
            count += 1
            within_limit(count, "sets of actions in one state")
            if self.objection(state, chosen) is None:
                yield chosen
            larger = ((chosen | {names[place]}, place + 1) for place in range(begin, len(names)))
            waiting += [each for each in larger if self.may_grow(state, each[0], frozenset(names[each[1] :]), below)]

    def may_grow(self, state: State, chosen: ActionSet, others: ActionSet, below: float) -> bool:
        """Whether a set has no fault that it keeps, whichever of the others are added."""
        held = [resource for name in chosen for resource in self.spec.actions[name].holds_resources]
        return (
            self.duration(chosen) < below
            and len(held) == len(set(held))
            and self.agree(state, chosen)
            and all(truth(rule, state, chosen, others) is not False for rule, _ in self.spec.reaction_rules)
            and self.stays_within(state, state, chosen, self.required(state))
        )

    def steps(self, state: State) -> Iterator[tuple[ActionSet, State]]:
        """Every allowed set with the nominal successor to which it leads."""
        for chosen in self.allowed_sets(state):
            yield chosen, self.successor(state, chosen)

    # Words for reports.

    def steps_on(self, state: State) -> Iterator[tuple[ActionSet, State]]:
        """Those steps; under `bounded` none that may leave an unsafe state as it is, which never restores it."""
        for chosen, after in self.steps(state):
            if self.restoration != "bounded" or self.is_safe(state) or state not in self.next_states(state, chosen):
                yield chosen, after

    def show(self, state: State) -> str:
        return "(" + ", ".join(f"{name} {state[place]}" for place, name in enumerate(self.spec.variables)) + ")"

    def show_set(self, chosen: ActionSet) -> str:
        return f"{{{', '.join(sorted(chosen))}}} (duration {self.duration(chosen)})"

    def step(self, state: State, chosen: ActionSet) -> str:
        return f"in {self.show(state)}, {self.show_set(chosen)} leads to {self.show(self.successor(state, chosen))}"

    def quote(self, line: int) -> str:
        return f"line {line}: `{self.spec.lines[line - 1].strip()}`"

    def fault(self, required: Required, state: State) -> str:
        """What a state breaks that does not meet what is required."""
        line = self.broken(self.spec.assumptions, state)
        if line is not None:
            return f"breaks the assumption at {self.quote(line)}"
        rules = [self.spec.state_rules[number] for number in required]
        if self.broken(rules, state) is None:
            return f"is {self.show(state)}, which is not decided"
        return f"breaks the state rule at {self.quote(self.broken(rules, state) or 0)}"

    # Goals (docs/semantics.md, section 4).

    def active_goals(self, state: State) -> frozenset[Formula]:
        """`Γ(s)`."""
        found: list[Formula] = []
        if self.spec.goals is not None:
            self.walk(self.spec.goals, state, found)
        return frozenset(found)

    def walk(self, goal: Goal, state: State, found: list[Formula]) -> bool:
        """Collect what is active in a goal, and tell whether it was entered."""
        if goal.condition is not None and not holds(goal.condition, state):
            return False
        if goal.kind == "goal":
            found.append(goal.body)
        for member in goal.members:
            if self.walk(member, state, found) and goal.kind == "priority":
                break
        return True

    def residual_goal(self, state: State, chosen: ActionSet) -> Residual:
        """What `chosen`, executed first in `state`, leaves to be reached."""
        bodies = self.active_goals(state)
        return bodies, actions_in(bodies) & chosen

    def reached(self, goal: Residual, state: State) -> bool:
        """Whether every body of a residual goal holds; where decisions are stepwise, in a safe state."""
        bodies, executed = goal
        counts = not self.stepwise or self.is_safe(state)
        return counts and all(holds(body, state, executed) for body in bodies)


def actions_in(bodies: Iterable[Formula]) -> ActionSet:
    """The actions that goal bodies speak of."""
    return frozenset(atom[1] for body in bodies for atom in atoms(body) if atom[0] == "executing")


# ----------------------------------------------------------------------------------------------------------------------
# 5. Policy files (docs/policy.md). Anything doubtful is refused; sections that nobody knows are passed over.


@dataclass
class Policy:
    """What is decided in a state, if anything; `States` and `Certificate` are needed again for the ranks."""

    decide: Callable[[State], ActionSet | None]
    document: dict[str, Any]


def read_document(data: bytes) -> dict[str, Any]:
    """The JSON object that a file holds."""
    need(len(data) <= MOST_FILE_BYTES, f"the file is larger than {MOST_FILE_BYTES} bytes")
    decoder = json.JSONDecoder(
        object_pairs_hook=distinct_keys,
        parse_constant=lambda word: need(False, word),
        parse_int=lambda digits: int(digits) if len(digits) <= MOST_DIGITS else float(digits),
    )
    try:
        document = decoder.decode(data.decode("utf-8-sig"))
    except ValueError as problem:
        raise Unreadable(f"the file is not JSON: {problem}") from problem
    need(isinstance(document, dict), "the file is not a JSON object")
    level: list[Any] = [document]
    for _ in range(MOST_LEVELS):
        parts = (part.values() if isinstance(part, dict) else part for part in level if isinstance(part, (dict, list)))
        level = [part for each in parts for part in each if isinstance(part, (dict, list))]
    need(level == [], f"objects and lists are nested more than {MOST_LEVELS} levels deep")
    return dict(document)


def read_policy(document: dict[str, Any], spec: Specification) -> Policy:
    """The policy, for this specification: the same variables and values, in whatever order."""
    read_header(document, spec)
    if document.get("Type") == "policy-diagram":
        need("Policy" not in document, "a policy of type `policy-diagram` has no `Policy`")
        return Policy(read_diagram_policy(document, spec), document)
    need(document.get("Type") == "policy" and "Diagram" not in document, "the policy is not of type `policy`")
    return Policy(read_table(document, spec).get, document)


def read_header(document: dict[str, Any], spec: Specification) -> None:
    """What policies and certificates have in common: versions, the ordering, and the names that they speak of."""
    version = document.get("FormatVersion", 1)
    need(is_number(version) and version == 1, "`FormatVersion` is 1")
    for key in ("PolicyFrameworkVersion", "SpecificationDigest"):
        need(is_texts([document.get(key, "")]), f"`{key}` is a text")
    need(document.get("EffectOrdering", "any") in ("any", "first"), "`EffectOrdering` is `any` or `first`")
    need(document.setdefault("Restoration", "one_step") in RESTORATIONS, "`Restoration` is one_step, bounded or fair")
    actions: Any = document.get("Actions")
    need(is_names(actions), "`Actions` is a list of different names")
    need(set(actions) == set(spec.actions), "the actions of the file are not those of the specification")
    document["States"] = numbered_from_zero(document.get("States"), spec)


def read_table(document: dict[str, Any], spec: Specification) -> dict[State, ActionSet]:
    """The rows of a table."""
    need("Actions" not in spec.variables, "a table cannot hold a variable that is called `Actions`")
    actions: Any = document["Actions"]
    rows: Any = document.get("Policy")
    need(isinstance(rows, list), "`Policy` is a list of rows")
    table: dict[State, ActionSet] = {}
    for number, row in enumerate(rows, 1):
        need(isinstance(row, dict), f"row {number} is not an object")
        need(set(row) == {*spec.variables, "Actions"}, f"row {number} does not hold just the variables and `Actions`")
        for variable, values in spec.variables.items():
            row[variable] = as_written(row[variable])
            need(row[variable] in values, f"row {number}: `{variable}` has no value {row[variable]!r}")
        need(is_texts(row["Actions"]), f"row {number}: `Actions` is a list of names")
        need(set(row["Actions"]) <= set(actions), f"row {number} has an unknown action")
        state, chosen = tuple(row[variable] for variable in spec.variables), frozenset(row["Actions"])
        need(table.setdefault(state, chosen) == chosen, f"row {number} contradicts an earlier row")
    return table


def read_diagram_policy(document: dict[str, Any], spec: Specification) -> Callable[[State], ActionSet | None]:
    """What a diagram decides in a state: the actions whose roots lead to true, where `Defined` does."""
    section: Any = document.get("Diagram")
    diagram = Diagram(section, document["States"], spec)
    need(diagram.is_yes_or_no(), "`Diagram.Leaves` is not [false, true]")
    named = section.get("Roots")
    need(isinstance(named, dict), "`Roots` is an object")
    need(set(named) == set(document["Actions"]), "`Roots` has not just one entry for every action")
    roots = {action: diagram.reference(root) for action, root in named.items()}
    defined = diagram.reference(section.get("Defined"))

    def decide(state: State) -> ActionSet | None:
        if not diagram.value(defined, state):
            return None
        return frozenset(action for action, root in roots.items() if diagram.value(root, state))

    return decide


class Diagram:
    """Functions of the state that share nodes. A reference is the number of a leaf, or after those, of a node."""

    def __init__(self, section: Any, states: Numbered, spec: Specification) -> None:
        need(isinstance(section, dict), "a diagram is an object")
        need({"Order", "Leaves", "Nodes"} <= set(section), "a diagram has not all of `Order`, `Leaves` and `Nodes`")
        order, self.leaves, nodes = section["Order"], section["Leaves"], section["Nodes"]
        need(is_names(order) and set(order) <= set(states), "`Order` is wrong")
        need(isinstance(self.leaves, list) and self.leaves != [], "`Leaves` is wrong")
        need(isinstance(nodes, list), "`Nodes` is wrong")
        self.places = [list(spec.variables).index(name) for name in order]
        self.numbers = [states[name] for name in order]
        self.nodes: list[tuple[int, list[int]]] = []
        for node in nodes:
            self.add(node)

    def add(self, node: Any) -> None:
        """Read a node. Every edge leads to a leaf, or to an earlier node that tests a later variable."""
        number = len(self.leaves) + len(self.nodes)
        wrong = f"node {number} is wrong"
        need(isinstance(node, list) and len(node) == 2 and is_number(node[0]) and node[0] < len(self.places), wrong)
        level, below = node
        need(isinstance(below, list) and len(below) == len(self.numbers[level]), wrong)
        for child in below:
            need(is_number(child) and child < number, wrong)
            need(child < len(self.leaves) or self.nodes[child - len(self.leaves)][0] > level, wrong)
        self.nodes.append((level, below))

    def is_yes_or_no(self) -> bool:
        """Whether the leaves are false and true, in this order."""
        return self.leaves == [False, True] and all(isinstance(leaf, bool) for leaf in self.leaves)

    def is_of_numbers(self) -> bool:
        """Whether the leaves are different numbers, or null."""
        each_fits = all(leaf is None or is_number(leaf) for leaf in self.leaves)
        return each_fits and len(set(self.leaves)) == len(self.leaves)

    def reference(self, number: Any) -> int:
        """A reference into this diagram."""
        need(is_number(number) and number < len(self.leaves) + len(self.nodes), "a root is wrong")
        return int(number)

    def same(self) -> list[int]:
        """For every reference the first one that leads from each state to the same leaf. (All leaves differ.)"""
        found, known = list(range(len(self.leaves))), dict[tuple[int, ...], int]()
        for number, (level, below) in enumerate(self.nodes, len(self.leaves)):
            children = [found[child] for child in below]
            found.append(children[0] if len(set(children)) == 1 else known.setdefault((level, *children), number))
        return found

    def value(self, reference: int, state: State) -> Any:
        """The leaf to which a state leads."""
        while reference >= len(self.leaves):
            level, below = self.nodes[reference - len(self.leaves)]
            reference = below[self.numbers[level][state[self.places[level]]]]
        return self.leaves[reference]


Numbered = dict[str, dict[str, int]]  # the section `States`, the values of every variable numbered 0, 1, …


def numbered_from_zero(states: Any, spec: Specification) -> Numbered:
    """The section `States`. Values are numbered 0, 1, …; or, in the whole file, 1, 2, …"""
    need(isinstance(states, dict), "`States` is an object")
    need(set(states) == set(spec.variables), "the variables of the policy are not those of the specification")
    for name, values in states.items():
        fits = isinstance(values, dict) and all(map(is_number, values.values()))
        need(fits, f"the values of `{name}` have no numbers")
        need(set(values) == set(spec.variables[name]), f"the values of `{name}` are not those of the specification")
    first = 0 if any(0 in values.values() for values in states.values()) else 1
    for name, values in states.items():
        wanted = list(range(first, first + len(values)))
        need(sorted(values.values()) == wanted, f"the values of `{name}` are not numbered {first}, {first + 1}, …")
    return {name: {value: number - first for value, number in values.items()} for name, values in states.items()}


def distinct_keys(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """An object whose keys all differ."""
    need(len({key for key, _ in pairs}) == len(pairs), "a key comes twice in one object")
    return dict(pairs)


def as_written(value: Any) -> Any:
    """A value of a variable as the specification writes it; in JSON a number may be a number."""
    return str(value) if type(value) is int else value


def is_texts(value: Any) -> bool:
    """Whether a JSON value is a list of texts that can be written in UTF-8."""
    texts = isinstance(value, list) and all(isinstance(entry, str) for entry in value)
    return texts and not any(re.search("[\ud800-\udfff]", entry) for entry in value)


def is_names(value: Any) -> bool:
    """Whether a JSON value is a list of different texts."""
    return is_texts(value) and len(set(value)) == len(value)


def is_number(value: Any) -> bool:
    """Whether a JSON value is a whole number from 0 up."""
    return isinstance(value, int) and not isinstance(value, bool) and value >= 0


# ----------------------------------------------------------------------------------------------------------------------
# 6. The judgement (docs/semantics.md, sections 5, 9 and 10).


class Restoring:
    """How a policy restores the unsafe states that it decides. `worst` is `w`, without the states where it is infinite.

    `open` are the states after a decision that are not restored yet: where all of them have an effort, so has it.
    """

    def __init__(self, world: World, decided: dict[State, ActionSet]) -> None:
        self.world, self.decided = world, decided
        unsafe = [(state, chosen) for state, chosen in decided.items() if not world.is_safe(state)]
        self.open = {state: self.open_after(state, chosen) for state, chosen in unsafe if world.agree(state, chosen)}
        self.worst: dict[State, Effort] = {}
        left = {state: len(after) for state, after in self.open.items()}
        before: dict[State, list[State]] = {}
        for state, after in self.open.items():
            for each in after:
                before.setdefault(each, []).append(state)
        ready = [state for state, count in left.items() if not count]
        for state in ready:
            self.worst[state] = self.worst_of(decided[state], self.open[state])
            for earlier in before.get(state, ()):
                left[earlier] -= 1
                if not left[earlier]:
                    ready.append(earlier)

    def open_after(self, state: State, chosen: ActionSet) -> set[State]:
        """Those of `Next(s, A)` where the state is not restored yet."""
        return {after for after in self.world.next_states(state, chosen) if not self.world.restored(state, after)}

    def longer(self, chosen: ActionSet, effort: Effort) -> Effort:
        """One step more."""
        return effort[0] + self.world.duration(chosen), effort[1] + 1

    def worst_of(self, chosen: ActionSet, after: set[State]) -> Effort:
        """`w` of a set after which these states, which all have an effort, are not restored yet."""
        return self.longer(chosen, max((self.worst[each] for each in after), default=(0, 0)))

    def quality(self, state: State, chosen: ActionSet) -> tuple[int, Effort] | None:
        """How well a set restores, the smaller the better: in one step 0, whatever happens 1, nominally (fair) 2."""
        after = self.open_after(state, chosen)
        if after <= self.worst.keys():
            return (1 if after else 0), self.worst_of(chosen, after)
        nominal = self.nominal(state, chosen) if self.world.restoration == "fair" else None
        return None if nominal is None else (2, nominal)

    def nominal(self, state: State, chosen: ActionSet) -> Effort | None:
        """The effort of the nominal run until the state is restored, with this set in it; None: it never is."""
        effort, here, seen = (0, 0), state, set[State]()
        following: ActionSet | None = chosen
        while following is not None and self.world.agree(here, following) and here not in seen:
            seen.add(here)
            effort, here = self.longer(following, effort), self.world.successor(here, following)
            if self.world.restored(state, here):
                return effort
            following = self.decided.get(here)
        return None

    def endless(self, state: State) -> list[State]:
        """States one after another that are never restored: nominal ones where that is what has to end (fair)."""
        way = [state]
        while way[-1] in self.open and way[-1] not in way[:-1]:
            here = way[-1]
            after = self.open[here] - self.worst.keys()
            way.append(
                self.world.successor(here, self.decided[here]) if self.world.restoration == "fair" else min(after)
            )
        return way


class Judge:
    """A policy against a specification. What it says of states that are not valid plays no part, without starts."""

    def __init__(self, world: World, decide: Callable[[State], ActionSet | None]) -> None:
        self.not_begun: list[State] = []  # starts without a decision
        self.invalid: list[State] = []  # decided states that are not valid, where there are starts
        if world.spec.starts:
            starts = [state for state in world.valid if world.is_start(state)]
            need(starts != [], "no valid state is a start")
            decided = {state for state in world.every_state() if decide(state) is not None}
            self.not_begun = [state for state in starts if state not in decided]
            self.invalid = sorted(decided.difference(world.valid))
            world = world.within(decided)
        self.world = world
        found = ((state, decide(state)) for state in world.valid)
        self.decided = {state: chosen for state, chosen in found if chosen is not None}
        judged = ((state, world.objection(state, chosen)) for state, chosen in self.decided.items())
        self.objections = {state: why for state, why in judged if why is not None}
        self.allowed = [state for state in self.decided if state not in self.objections]
        agreeing = {state: chosen for state, chosen in self.decided.items() if world.agree(state, chosen)}
        self.after = {state: world.successor(state, chosen) for state, chosen in agreeing.items()}
        self.steps: dict[Residual, dict[State, int | None]] = {}
        self.rivals_of: dict[State, list[ActionSet]] = {}
        self.missing = [*self.not_begun, *(state for state in world.valid if state not in self.decided)]

    def departure(self) -> tuple[State, State] | None:
        """The first decided state with an outcome that is valid and undecided, and that outcome.

        Decisions with too many outcomes are passed over: this is a witness only.
        """
        missing = set(self.missing)
        for state, chosen in self.decided.items():
            with suppress(TooLarge):
                for after, _ in self.world.outcomes(state, chosen):
                    if after in missing:
                        return state, after
        return None

    def verdicts(self) -> dict[str, tuple[list[State], Callable[[State], str]]]:
        """For each property the states in which it fails, and the function that tells why in one of them."""
        found = {
            "total": ([*self.missing, *self.invalid], self.undecided),
            "safe": (list(self.objections), self.refused),
        }
        if self.world.stepwise:
            found["restoring"] = [state for state in self.restoring.open if self.quality(state) is None], self.endless
        return {
            **found,
            "goals": ([state for state in self.allowed if not self.serves(state, self.decided[state])], self.missed),
            "minimal": ([state for state in self.decided if self.cheaper(state) is not None], self.dearer),
        }

    @cached_property
    def restoring(self) -> Restoring:
        """How the policy restores."""
        return Restoring(self.world, self.decided)

    def quality(self, state: State) -> tuple[int, Effort] | None:
        """How well the policy restores an unsafe state that it decides."""
        return self.restoring.quality(state, self.decided[state]) if state in self.after else None

    def cheaper(self, state: State) -> ActionSet | None:
        """For an unsafe state a cheaper (stepwise: better) allowed set that serves as well, if there is one."""
        if self.world.is_safe(state):
            return None
        if self.world.stepwise:
            return next((chosen for chosen in self.rivals(state) if not self.losers(state, chosen)), None)
        sets = self.world.allowed_sets(state, self.world.duration(self.decided[state]))
        return next((chosen for chosen in sets if self.serves(state, chosen)), None)

    def serves(self, state: State, chosen: ActionSet) -> bool:
        """Whether the run that begins with an allowed set and goes on with the policy reaches its residual goal."""
        left = self.steps_left(self.world.residual_goal(state, chosen), self.world.successor(state, chosen))
        return left is not None and (self.world.spec.bound is None or 1 + left <= self.world.spec.bound)

    def steps_left(self, goal: Residual, state: State) -> int | None:
        """The least `k ≥ 0` after which the run of the policy from `state` satisfies `goal`; None: it never does."""
        known = self.steps.setdefault(goal, {})
        way: list[State] = []
        here: State | None = state
        while here is not None and here not in known:
            if self.world.reached(goal, here):
                known[here] = 0
            else:
                known[here] = None  # and it stays so where the run comes back here
                way.append(here)
                here = self.after.get(here)
        left = None if here is None else known[here]
        for earlier in reversed(way):
            left = None if left is None else left + 1
            known[earlier] = left
        return known[state]

    # Where decisions are stepwise, unsafe states serve each other: a better set may take another one's goal.

    def rivals(self, state: State) -> list[ActionSet]:
        """The allowed sets that restore an unsafe state better than its decision, and with which its run serves it."""
        if state not in self.rivals_of:
            now = self.quality(state)
            below = self.world.duration(self.decided[state]) if now is not None and now[0] == 0 else math.inf
            found = self.rivals_of[state] = []
            for chosen in self.world.allowed_sets(state, below):
                quality = self.restoring.quality(state, chosen)
                better = quality is not None and (now is None or quality < now)
                if better and self.run(state, chosen, {state: chosen}) is not None:
                    found.append(chosen)
        return self.rivals_of[state]

    def losers(self, state: State, chosen: ActionSet) -> list[State]:
        """The other states whose runs reach their goals by the policy, and not with this set in an unsafe state."""
        changed = {state: chosen}
        return [each for each in self.passing.get(state, ()) if self.run(each, self.decided[each], changed) is None]

    @cached_property
    def passing(self) -> dict[State, list[State]]:
        """For an unsafe state the others whose runs pass through it and then reach their goals."""
        found: dict[State, list[State]] = {}
        for start in self.after:
            for here in self.run(start, self.decided[start], {}) or ():
                if here != start and not self.world.is_safe(here):
                    found.setdefault(here, []).append(start)
        return found

    def run(self, start: State, first: ActionSet, changed: dict[State, ActionSet]) -> list[State] | None:
        """The states after `start` and before the goal, of the run that begins with a set; None: it fails.

        It goes on with the policy, but for what is changed.
        """
        goal, way, seen = self.world.residual_goal(start, first), list[State](), set[State]()
        here: State | None = self.world.successor(start, first)
        while here is not None and not self.world.reached(goal, here):
            way.append(here)
            if here in seen or len(way) == self.world.spec.bound:
                return None
            seen.add(here)
            here = self.world.successor(here, changed[here]) if here in changed else self.after.get(here)
        return None if here is None else way

    # Witnesses in words.

    def endless(self, state: State) -> str:
        way = ", then ".join(map(self.world.show, self.restoring.endless(state)[1:]))
        return f"{self.decision(state)}: it need never be restored; it may lead to {way}"

    def decision(self, state: State) -> str:
        return f"in {self.world.show(state)} the decision is {self.world.show_set(self.decided[state])}"

    def undecided(self, state: State) -> str:
        if state in self.not_begun:
            return f"no decision in {self.world.show(state)}, which is a start"
        if state in self.invalid:
            return f"there is a decision in {self.world.show(state)}, which is not valid"
        departure = self.departure()
        if departure is None:
            return f"no decision in {self.world.show(state)}"
        origin, after = departure
        return f"no decision in {self.world.show(after)}, which is an outcome of a decision: {self.decision(origin)}"

    def refused(self, state: State) -> str:
        return f"{self.decision(state)}: {self.objections[state]}"

    def dearer(self, state: State) -> str:
        better = self.cheaper(state) or frozenset()
        return f"{self.decision(state)}: {self.world.show_set(better)} would serve as well"

    def missed(self, state: State) -> str:
        goal = self.world.residual_goal(state, self.decided[state])
        way, here = [state], self.after.get(state)
        while here is not None and here not in way[1:] and not self.world.reached(goal, here):
            way.append(here)
            here = self.after.get(here)
        if here is None:
            end = "where nothing is decided that has one nominal successor"
        elif here in way[1:]:
            end = f"and round again from {self.world.show(here)}"
        else:
            end = f"and reaches it after {counted(len(way), 'step')}, more than {self.world.spec.bound}"
        words = " and ".join(sorted(text_of(body, self.world.spec) for body in goal[0]))
        return f"{self.decision(state)}: its goal is {words}; the run is {', '.join(map(self.world.show, way))} {end}"


def text_of(formula: Formula, spec: Specification) -> str:
    """A formula as certificates write it: every operand in parentheses."""
    kind, *parts = formula
    if kind == "is":
        return f"{list(spec.variables)[parts[0]]} is {parts[1]}"
    if kind in ("true", "false"):
        return str(kind)
    if kind == "executing":
        return f"executing {parts[0]}"
    words = {"not": "NOT ", "and": " AND ", "or": " OR ", "iff": " IFONLYIF "}[kind]
    operands = [f"({text_of(part, spec)})" for part in parts]
    return words + operands[0] if kind == "not" else words.join(operands)


# ----------------------------------------------------------------------------------------------------------------------
# 7. The certificate (docs/certificate.md, docs/policy.md): for every residual goal a diagram with the ranks of the safe
#    states. It is wrong when a rank is 0 where the goal does not hold, is otherwise not larger than that of the
#    successor, or is not below L in the first successor of a state with this goal; incomplete where ranks are missing.
#    With a section `Restoring`, the ranks are those of all valid states, and efforts must not be too small.


def judge_certificate(judge: Judge, document: dict[str, Any]) -> tuple[str, str]:
    """What the certificate is (`absent`, `stale`, `wrong`, `incomplete` or `right`), and why."""
    if "Certificate" not in document:
        return "absent", ""
    if document.get("SpecificationDigest") != digest(judge.world.spec):
        return "stale", "it was made for another specification, or says for none"
    try:
        restoring = read_restoring(judge.world, document)
        ranks = read_ranks(judge.world, document)
        for goal, rank in ranks.items():
            for state, own in rank.items():
                check_rank(judge, goal, rank, state, own)
        missing = [check_bound(judge, state, ranks) for state in judge.allowed]
        missing.append(check_restoring(judge, restoring) if judge.world.stepwise else "")
    except (Unreadable, Refuted) as problem:
        return "wrong", str(problem)
    first = next((why for why in missing if why), "")
    return ("incomplete", first) if first else ("right", "")


def read_ranks(world: World, document: dict[str, Any]) -> dict[Residual, dict[State, int | None]]:
    """The ranks of all safe states, by residual goal; of all valid ones where it is said how they are restored."""
    section = document["Certificate"]
    diagram = Diagram(section, document["States"], world.spec)
    need(diagram.is_of_numbers(), "`Leaves` are not different numbers")
    need(isinstance(section.get("Goals"), list), "`Goals` is a list")
    ranks: dict[Residual, dict[State, int | None]] = {}
    for entry in section["Goals"]:
        goal = read_goal(entry, world.spec)
        need(goal[1] == set(entry["Executed"]), "`Executed` has an action that the goal does not mention")
        need(goal not in ranks, f"it ranks {entry['Bodies']} twice")
        root = diagram.reference(entry.get("Root"))
        ranked = world.valid if world.stepwise and "Restoring" in section else world.safe
        ranks[goal] = {state: diagram.value(root, state) for state in ranked}
    return ranks


def read_goal(entry: Any, spec: Specification) -> Residual:
    """The residual goal of an entry of `Goals`: its bodies, and which of their actions are executed."""
    need(isinstance(entry, dict) and {"Bodies", "Executed"} <= set(entry), "an entry of `Goals` is no goal")
    for key in ("Bodies", "Executed"):
        need(is_names(entry[key]), f"`{key}` is no list of different names")
    bodies = {text_of(body, spec): body for body in bodies_of(spec.goals)}
    need(set(entry["Executed"]) <= set(spec.actions), f"there are no such actions: {entry['Executed']}")
    if not set(entry["Bodies"]) <= set(bodies):
        raise Refuted(f"there is no such goal: {entry['Bodies']}")
    goals = frozenset(bodies[text] for text in entry["Bodies"])
    return goals, actions_in(goals) & set(entry["Executed"])


def check_bound(judge: Judge, state: State, ranks: dict[Residual, dict[State, int | None]]) -> str:
    """Refuse a rank of the successor that exceeds the bound; tell where one that is needed is missing."""
    world, after = judge.world, judge.after[state]
    goal = world.residual_goal(state, judge.decided[state])
    own = ranks.get(goal, {}).get(after)
    if not goal[0] and (world.is_safe(state) or not world.stepwise):
        return ""  # no goal is pending, not even to come to safety
    if own is None:
        return f"{world.show(after)}, which follows {world.show(state)}, has no rank"
    below = world.spec.bound is None or own < world.spec.bound
    need(below, f"the rank {own} of {world.show(after)}, which follows {world.show(state)}, is not below the bound")
    return ""


def check_rank(judge: Judge, goal: Residual, rank: dict[State, Any], state: State, own: int | None) -> None:
    """One rank: 0 where the goal holds, otherwise larger than that of the successor; None claims nothing."""
    if own == 0:
        need(
            judge.world.reached(goal, state),
            f"the rank of {judge.world.show(state)} is 0, but the goal does not hold there",
        )
    elif own is not None:
        following = rank.get(judge.after.get(state, ()))  # an unsafe successor has no rank
        need(following is not None and following < own, f"the rank {own} of {judge.world.show(state)} does not fall")


@dataclass
class Claimed:
    """The section `Restoring`: efforts of unsafe valid states, and why some states are not restored better."""

    worst: dict[State, Effort]
    nominal: dict[State, Effort]  # under `fair`, where there is no worst one
    deviations: list[tuple[State, ActionSet, State]]  # a state, a better set, and whose run would miss its goal


def read_restoring(world: World, document: dict[str, Any]) -> Claimed | None:
    """The section `Restoring` where there is one; what is wrong in its form counts under every restoration."""
    need(isinstance(document["Certificate"], dict), "`Certificate` is an object")
    if "Restoring" not in document["Certificate"]:
        return None
    section: Any = document["Certificate"]["Restoring"]
    diagram = Diagram(section, document["States"], world.spec)
    pairs = [leaf for leaf in diagram.leaves if leaf is not None]
    fits = all(isinstance(leaf, list) and len(leaf) == 2 and all(map(is_number, leaf)) for leaf in pairs)
    need(fits and len(set(map(str, diagram.leaves))) == len(diagram.leaves), "`Leaves` are not different efforts")
    diagram.leaves = [None if leaf is None else tuple(leaf) for leaf in diagram.leaves]
    tables: list[dict[State, Effort]] = []
    for root in ("Worst", "Nominal"):
        reference = diagram.reference(section.get(root))
        found = {state: diagram.value(reference, state) for state in world.valid if not world.is_safe(state)}
        tables.append({state: effort for state, effort in found.items() if effort is not None})
    worst, nominal = tables
    claimed = Claimed(worst, {}, [])
    if world.restoration == "fair":
        claimed.nominal = {state: effort for state, effort in nominal.items() if state not in worst}
    for entry in read_objects(section, "Deviations"):
        state, missed = read_state(entry, "State", world.spec), read_state(entry, "Missed", world.spec)
        claimed.deviations.append((state, read_actions(entry, "Better", world.spec), missed))
    return claimed


def check_restoring(judge: Judge, claimed: Claimed | None) -> str:
    """Refuse efforts that are too small, and deviations that are none; tell what is missing or larger than it is."""
    world, true = judge.world, judge.restoring
    if claimed is None:
        return "it does not say how safety is restored" if true.open else ""
    for state in (*claimed.worst, *claimed.nominal):
        need(is_enough(judge, claimed, state), f"the effort of {world.show(state)} is not enough")
    for state, better, missed in claimed.deviations:
        shown = f"with {world.show_set(better)} in {world.show(state)}"
        need(state in judge.decided and not world.is_safe(state), f"{world.show(state)} is not unsafe and decided")
        need(world.agree(state, better), f"{shown}, nominal effects disagree")
        spoiled = judge.run(state, better, {state: better}) is None
        misses = spoiled if missed == state else missed in judge.losers(state, better)
        need(misses, f"{shown}, {world.show(missed)} does not miss its goal for that")
    for state in true.open:
        worst, nominal = true.worst.get(state), true.nominal(state, judge.decided[state])
        efforts = worst, nominal if worst is None and world.restoration == "fair" else None
        given = claimed.worst.get(state), claimed.nominal.get(state)
        if given != efforts or given == (None, None):
            return f"the efforts of {world.show(state)} are {efforts}, not {given}"
    listed = {(state, better) for state, better, _ in claimed.deviations}
    rivals = ((state, better) for state in true.open for better in judge.rivals(state))
    for state, better in rivals:
        if (state, better) not in listed and judge.losers(state, better):
            return f"{world.show_set(better)} in {world.show(state)} is better, and it is not said why it is not taken"
    return ""


def is_enough(judge: Judge, claimed: Claimed, state: State) -> bool:
    """Whether a claimed effort is at least that of each state that it is about, and of the step there."""
    true, after = judge.restoring, judge.after.get(state)
    if after is None:
        return False
    if state in claimed.worst:
        efforts = [claimed.worst.get(each) for each in true.open[state]]
    else:
        restored = judge.world.restored(state, after) or after in claimed.worst
        efforts = [] if restored else [claimed.nominal.get(after)]
    most = max((effort for effort in efforts if effort is not None), default=(0, 0))
    own = claimed.worst.get(state) or claimed.nominal[state]
    return None not in efforts and own >= true.longer(judge.decided[state], most)


def bodies_of(goal: Goal | None) -> set[Formula]:
    """The bodies of all simple goals."""
    if goal is None:
        return set()
    return ({goal.body} if goal.kind == "goal" else set()).union(*map(bodies_of, goal.members))


def digest(spec: Specification) -> str:
    """What identifies the meaning of a specification (docs/certificate.md, The digest)."""
    meaning = {
        "version": 1,
        "variables": {name: sorted(values) for name, values in spec.variables.items()},
        "actions": {name: meaning_of_action(spec, action) for name, action in spec.actions.items()},
        "reaction_rules": texts_of(spec, spec.reaction_rules),
        "state_rules": texts_of(spec, spec.state_rules),
        "assumptions": texts_of(spec, spec.assumptions),
        "goals": meaning_of_goal(spec, spec.goals) if spec.goals is not None and spec.goals.members else None,
        "max_plan_length": spec.bound,
    }
    if len(spec.tiers()) > 1:
        meaning["severities"] = [texts_of(spec, tier) for tier in spec.tiers()]
    if spec.starts:
        meaning["starts"] = texts_of(spec, spec.starts)
    if spec.preconditions == "throughout":
        meaning["preconditions"] = spec.preconditions
    text = json.dumps(meaning, sort_keys=True, separators=(",", ":"))
    return "sha256:" + hashlib.sha256(text.encode()).hexdigest()


def texts_of(spec: Specification, rules: list[Located]) -> list[str]:
    """Rules without their places and their order."""
    return sorted({text_of(rule, spec) for rule, _ in rules})


def meaning_of_action(spec: Specification, action: Action) -> dict[str, Any]:
    """An action by names; what it does nominally is no alternative, and an alternative counts once."""
    found = {
        "duration": action.duration,
        "resources": sorted(action.holds_resources),
        "preconditions": texts_of(spec, action.preconditions),
    }
    if action.conditional:
        nominal, *others = [meaning_of_effects(spec, each) for each in (action.nominal, *action.alternatives)]
        return {**found, "nominal": nominal, "alternatives": each_once(others)}
    names = list(spec.variables)
    nominal, *others = [{names[place]: value for place, value in effect.items()} for effect in action.effects[()]]
    alternatives = sorted({tuple(sorted(effect.items())) for effect in others if effect != nominal})
    return {
        **found,
        "nominal": nominal,
        "alternatives": [dict(effect) for effect in alternatives],
    }


def meaning_of_effects(spec: Specification, effects: EffectSet) -> dict[str, Any]:
    """A set of effects with clauses by names; a relative effect is a clause for each value."""
    clauses = []
    for condition, then in [(None, effects.effects), *((condition, then) for (condition, _), then in effects.clauses)]:
        fixed = [effect for effect, _ in then if effect[0] != "change"]
        changes = [effect for effect, _ in then if effect[0] == "change"]
        if condition is not None and (fixed or not changes):
            clauses.append([text_of(condition, spec), sorted({text_of(effect, spec) for effect in fixed})])
        for _, place, becomes in changes:
            for value, new in becomes.items():
                here = ("is", place, value)
                when = here if condition in (None, ("true",)) else ("and", condition, here)
                clauses.append([text_of(when, spec), [text_of(new, spec)]])
    always = sorted({text_of(effect, spec) for effect, _ in effects.effects if effect[0] != "change"})
    return {"effects": always, "clauses": each_once(clauses)}


def each_once(values: list[Any]) -> list[Any]:
    """Values of JSON, sorted."""
    return [json.loads(text) for text in sorted({json.dumps(each, sort_keys=True) for each in values})]


def meaning_of_goal(spec: Specification, goal: Goal) -> list[Any]:
    """The order of goals matters in a priority list only."""
    if goal.condition is not None:
        return ["when", text_of(goal.condition, spec), meaning_of_goal(spec, replace(goal, condition=None))]
    if goal.kind == "goal":
        return ["goal", text_of(goal.body, spec)]
    members = [meaning_of_goal(spec, member) for member in goal.members]
    return [goal.kind, *(sorted(members, key=json.dumps) if goal.kind == "constraint" else members)]


# ----------------------------------------------------------------------------------------------------------------------
# 8. What the policy guarantees beyond nominal runs (docs/certificate.md). A rank claims, of a state where its goal is
#    pending, how many steps are left: nominal ones in W_k, of `Surviving`, the worst in G, of `Forced`. The ranks have
#    to be the fixpoints exactly, so that both what they hold and what they leave out is shown, and each level follows.


LEVELS = ("guaranteed", "fair", "survives", "nominal")
Ranks = dict[State, Any]  # a number, or None outside


class Guarantees:
    """The claims of a file, by residual goal: the ranks of W_0, W_1, …, W_ω, and those of G, of every valid state."""

    def __init__(self, judge: Judge, document: dict[str, Any]) -> None:
        world = judge.world
        self.world, self.judge = world, judge
        self.next = {state: world.next_states(state, chosen) for state, chosen in judge.decided.items()}
        section: Any = document.get("Ranks")
        diagram = Diagram(section, document["States"], world.spec)
        need(diagram.is_of_numbers(), "`Leaves` are not different numbers")
        self.surviving: dict[Residual, list[Ranks]] = {}
        self.forced: dict[Residual, Ranks] = {}
        for entry in read_objects(section, "Goals"):
            goal = read_goal(entry, world.spec)
            need(goal[1] == set(entry["Executed"]), "`Executed` has an action that the goal does not mention")
            need(goal not in self.forced, f"it ranks {entry['Bodies']} twice")
            need(read_list(entry, "Surviving") != [], "`Surviving` is empty")
            roots = [diagram.reference(root) for root in (*entry["Surviving"], entry.get("Forced"))]
            *ranks, self.forced[goal] = ({state: diagram.value(root, state) for state in world.valid} for root in roots)
            self.surviving[goal] = ranks

    def check_ranks(self) -> None:
        """Every rank is right, and every state without one is outside the fixpoint."""
        for goal, surviving in self.surviving.items():
            for state in self.world.valid:
                if self.world.reached(goal, state):
                    right = all(ranks[state] == 0 for ranks in (*surviving, self.forced[goal]))
                else:
                    right = self.is_right(goal, state)
                if not right:
                    where = f"the ranks of {self.world.show(state)} for {goal_text(self.world, goal)}"
                    raise Refuted(f"{where} are not those of its steps")

    def is_right(self, goal: Residual, state: State) -> bool:
        """Whether the ranks of a state where the goal does not hold are what those of the next states say."""
        surviving, forced = self.surviving[goal], self.forced[goal]
        nominal, after = self.judge.after[state], self.next[state]
        worst = [forced[each] for each in after]
        if forced[state] != (None if None in worst else 1 + max(worst)):
            return False
        for number, ranks in enumerate(surviving):
            before = surviving[number - 1] if number else None
            stays = before is None or all(before[each] is not None for each in after if each != nominal)
            left = ranks[nominal] if stays else None
            if ranks[state] != (None if left is None else 1 + left):
                return False
        last = surviving[-1]  # closed under all outcomes, and so a part of every W_k
        return last[state] is None or all(last[each] is not None for each in after)

    def level(self, state: State) -> tuple[str, int | None, int | None]:
        """The level of a state, with the worst number of steps and the number of deviations."""
        goal = self.world.residual_goal(state, self.judge.decided[state])
        if goal not in self.forced:
            raise Refuted(
                f"it has no ranks for {goal_text(self.world, goal)}, which is pending in {self.world.show(state)}"
            )
        surviving, forced = self.surviving[goal], self.forced[goal]
        nominal, after = self.judge.after[state], self.next[state]
        worst = [forced[each] for each in after]
        if None not in worst:
            return "guaranteed", 1 + max(worst), None
        if all(surviving[-1][each] is not None for each in after):
            return "fair", None, None
        for number in reversed(range(1, len(surviving))):
            others = all(surviving[number - 1][each] is not None for each in after if each != nominal)
            if surviving[number][nominal] is not None and others:
                return "survives", None, number
        return "nominal", None, None

    def levels(self) -> dict[tuple[str, int | None], list[tuple[State, int | None]]]:
        """The states of every level, each with its worst number of steps."""
        found: dict[tuple[str, int | None], list[tuple[State, int | None]]] = {}
        for state in self.world.valid:
            name, steps, deviations = self.level(state)
            found.setdefault((name, deviations), []).append((state, steps))
        return found


def check_guarantees(judge: Judge, document: dict[str, Any]) -> str:
    """The levels in words; `judge` has found the policy total and safe, and its goals met."""
    world = judge.world
    claims = Guarantees(judge, document)
    claims.check_ranks()
    found, told = claims.levels(), list[str]()
    for entry in read_objects(document, "Levels"):
        name, steps, deviations = str(entry.get("Level")), entry.get("Steps"), entry.get("Deviations")
        need(name in LEVELS, f"`Level` is one of {', '.join(LEVELS)}")
        need(all(number is None or is_number(number) for number in (steps, deviations)), "a number is wrong")
        states = found.pop((name, deviations), [])
        worst = max((each for _, each in states if each is not None), default=None)
        title = name + ("" if deviations is None else f" {counted(deviations, 'deviation')}")
        need(is_number(entry.get("States")), "`States` is a number")
        if entry["States"] != len(states) or not states:
            raise Refuted(f"{title}: there are {counted(len(states), 'such state')}, or it is told twice")
        if steps != worst:
            raise Refuted(f"{title}: the worst number of steps is {worst}")
        check_cubes(world, entry.get("Cubes"), {state for state, _ in states}, title)
        told.append(f"{len(states)} {title}" + ("" if worst is None else f" (at most {counted(worst, 'step')})"))
    if found:
        raise Refuted(f"it tells of no state that is {next(iter(found))[0]}")
    return ", ".join(told)


def check_cubes(world: World, cubes: Any, states: set[State], title: str) -> None:
    """Cubes, if there are any, hold these valid states and no others."""
    if cubes is None:
        return
    need(isinstance(cubes, list) and all(isinstance(cube, dict) for cube in cubes), "`Cubes` is a list of objects")
    for cube in cubes:
        cube.update((name, [*map(as_written, values)]) for name, values in cube.items() if isinstance(values, list))
        known = set(cube) <= set(world.spec.variables) and all(map(is_names, cube.values()))
        known = known and all(set(values) <= set(world.spec.variables[name]) for name, values in cube.items())
        need(known, "a cube has an unknown variable or value")
    places = {name: place for place, name in enumerate(world.spec.variables)}
    for state in world.valid:
        inside = any(all(state[places[name]] in values for name, values in cube.items()) for cube in cubes)
        if inside != (state in states):
            raise Refuted(f"{title}: the cubes are wrong about {world.show(state)}")


# ----------------------------------------------------------------------------------------------------------------------
# 9. Unrealizability (docs/certificate.md): a certificate that there is no policy. What it claims is looked at state by
#    state, set by set; the first claim that is not so ends in `Refuted`.


def judge_no(world: World, document: dict[str, Any]) -> str:
    """What proves that there is no policy, in words."""
    reason: Any = document.get("Reason")
    need(isinstance(reason, dict), "`Reason` is an object")
    kind = reason.get("Kind")
    if kind == "no-allowed-set":
        return check_no_allowed_set(world, reason)
    if kind == "no-plan":
        return check_no_plan(world, reason, document["States"])
    if kind == "no-restoration":
        return check_no_restoration(world, reason, document["States"])
    if kind == "no-part":
        count = check_no_part(world, reason, document["States"])
        return f"no part that has all starts has a policy, by removing {counted(count, 'state')}"
    need(kind == "conflict", "`Kind` is `no-allowed-set`, `no-restoration`, `no-plan`, `conflict` or `no-part`")
    return check_conflict(world, reason, document["States"])


def met_from(world: World, starts: list[State]) -> list[State]:
    """The states in which runs from some states may be: from safe ones, and wherever one step restores, safe ones."""
    return world.safe if not world.stepwise or all(map(world.is_safe, starts)) else world.valid


@contextmanager
def runs_from(world: World, start: State) -> Iterator[list[State]]:
    """The states in which runs from a state may be.

    Where unsafe ones count, all sets with `Keep` are looked at there, be it that they do not restore. That proves more
    than has to be proved; so what is refuted then is not known.
    """
    met = met_from(world, [start])
    try:
        yield met
    except Refuted as problem:
        if met is world.safe:
            raise
        raise NotKnown(f"of runs through unsafe states it is not known how these are restored: {problem}") from None


def check_decides(world: World, state: State) -> None:
    """A policy decides valid states, with starts these at least, and need not do anything elsewhere."""
    if not world.is_valid(state):
        raise Refuted(f"the state {world.show(state)} is not valid")
    if world.spec.starts and not world.is_start(state):
        raise Refuted(f"the state {world.show(state)} is no start")


# What the certificate consists of.


def read_list(section: dict[str, Any], key: str) -> list[Any]:
    """A list in an object."""
    value = section.get(key)
    need(isinstance(value, list), f"`{key}` is a list")
    return list(value or [])


def read_objects(section: dict[str, Any], key: str) -> list[dict[str, Any]]:
    """A list of objects."""
    entries = read_list(section, key)
    need(all(isinstance(entry, dict) for entry in entries), f"`{key}` is a list of objects")
    return entries


def read_numbers(section: dict[str, Any], key: str, end: int) -> list[int]:
    """A list of numbers below `end`."""
    numbers = read_list(section, key)
    need(all(is_number(number) and number < end for number in numbers), f"`{key}` is a list of numbers below {end}")
    return numbers


def read_effect(section: dict[str, Any], key: str, spec: Specification) -> Effect:
    """An object from variables to values."""
    value: Any = section.get(key)
    need(
        isinstance(value, dict) and set(value) <= set(spec.variables), f"`{key}` is an object from variables to values"
    )
    texts = {name: as_written(each) for name, each in value.items()}
    for name, text in texts.items():
        need(isinstance(text, str) and text in spec.variables[name], f"`{key}`: `{name}` has no value {text!r}")
    return {list(spec.variables).index(name): text for name, text in texts.items()}


def read_state(section: dict[str, Any], key: str, spec: Specification) -> State:
    """A value for every variable."""
    values = read_effect(section, key, spec)
    need(len(values) == len(spec.variables), f"`{key}` has not a value for every variable")
    return tuple(values[place] for place in range(len(values)))


def read_actions(section: dict[str, Any], key: str, spec: Specification) -> ActionSet:
    """A list of different actions."""
    names = section.get(key)
    need(is_names(names), f"`{key}` is a list of different names")
    found = frozenset(names or ())
    need(found <= set(spec.actions), f"`{key}` has an unknown action")
    return found


# No allowed set: a cube is all sets of actions that contain `executed` and nothing of `idle`. The cubes hold every set
# once, and none of a cube's sets is allowed, because of its `Violation`.


@dataclass
class Cube:
    """A cube, and what its violation speaks of."""

    executed: ActionSet
    idle: ActionSet
    kind: str
    actions: ActionSet = frozenset()
    rule: str = ""
    outcome: list[tuple[str, Effect]] = field(default_factory=list)


def check_no_allowed_set(world: World, reason: dict[str, Any]) -> str:
    """No set of actions is allowed in `State`."""
    state = read_state(reason, "State", world.spec)
    cubes = None
    need("Cubes" in reason, "there is no `Cubes`")
    if reason["Cubes"] is not None:
        cubes = [read_cube(entry, world.spec) for entry in read_objects(reason, "Cubes")]
    check_decides(world, state)
    if cubes is None:
        chosen = next(world.allowed_sets(state), None)
        if chosen is not None:
            raise Refuted(f"in {world.show(state)}, {world.show_set(chosen)} is allowed")
        return f"no set of actions is allowed in {world.show(state)}, by looking at them"
    check_cover(cubes, list(world.spec.actions))
    for number, cube in enumerate(cubes):
        why = unviolated(world, state, cube)
        if why:
            raise Refuted(f"the sets of cube {number} are not ruled out by `{cube.kind}`: {why}")
    return f"no set of actions is allowed in {world.show(state)}, by {counted(len(cubes), 'cube')}"


VIOLATIONS = (
    *("precondition", "resource", "nominal-conflict", "reaction-rule"),
    *("unsafe", "falsified", "idle", "nominal-unsafe"),
)


def read_cube(entry: dict[str, Any], spec: Specification) -> Cube:
    """An entry of `Cubes`."""
    violation: Any = entry.get("Violation")
    need(isinstance(violation, dict), "`Violation` is an object")
    kind: Any = violation.get("Kind")
    cube = Cube(read_actions(entry, "Executed", spec), read_actions(entry, "Idle", spec), kind)
    if kind in ("precondition", "resource", "nominal-conflict", "falsified"):
        cube.actions = read_actions(violation, "Actions", spec)
        count = 1 if kind in ("precondition", "falsified") else 2
        need(len(cube.actions) == count, f"a violation `{kind}` names {counted(count, 'action')}")
    elif kind == "reaction-rule":
        cube.rule = violation.get("Rule", "")
        need(isinstance(cube.rule, str), "`Rule` is a text")
    if kind in ("unsafe", "falsified"):
        for step in read_objects(violation, "Outcome"):
            need(isinstance(step.get("Action"), str) and step["Action"] in spec.actions, "`Action` is an action")
            cube.outcome.append((step["Action"], read_effect(step, "Effect", spec)))
    need(kind in VIOLATIONS, f"there is no violation {kind!r}")
    return cube


def check_cover(cubes: list[Cube], names: list[str]) -> None:
    """No set is in two cubes, and together they hold as many sets as there are."""
    bit = {name: 1 << place for place, name in enumerate(names)}
    earlier: list[tuple[int, int]] = []
    held = 0
    for number, cube in enumerate(cubes):
        executed, idle = sum(bit[name] for name in cube.executed), sum(bit[name] for name in cube.idle)
        if executed & idle:
            raise Refuted(f"cube {number} executes what it leaves idle")
        for other, (also_executed, also_idle) in enumerate(earlier):
            if not executed & also_idle and not idle & also_executed:
                raise Refuted(f"cubes {other} and {number} have a set in common")
        earlier.append((executed, idle))
        held += 1 << (len(names) - len(cube.executed) - len(cube.idle))
    if held != 1 << len(names):
        raise Refuted("the cubes do not hold all sets of actions")


def unviolated(world: World, state: State, cube: Cube) -> str:
    """Why a violation does not rule out every set of its cube; "" where it does."""
    settled = len(cube.executed) + len(cube.idle) == len(world.spec.actions)
    named = [world.spec.actions[name] for name in sorted(cube.actions)]
    if not cube.actions <= cube.executed:
        return "it names an action that not all sets execute"
    if cube.kind == "precondition":
        return "" if world.broken(named[0].preconditions, state) is not None else "the preconditions hold"
    if cube.kind == "resource":
        return "" if named[0].holds_resources & named[1].holds_resources else "the two share no resource"
    if cube.kind == "nominal-conflict":
        return "" if not world.agree(state, cube.actions) else "the nominal effects of the two agree"
    if cube.kind == "reaction-rule":
        return kept_rule(world, state, cube)
    if cube.kind in ("unsafe", "falsified"):
        return safe_outcome(world, state, cube)
    if cube.kind == "idle":
        changes = world.acts(state, set(world.spec.actions) - cube.idle)
        kept = changes or world.meets(world.required(state), state)
        return "doing nothing may be allowed" if kept else ""
    if not settled or not world.agree(state, cube.executed):
        return "there is not one nominal successor"
    kept = world.meets(world.required(state), world.successor(state, cube.executed))
    return "the nominal successor is safe" if kept else ""


def kept_rule(world: World, state: State, cube: Cube) -> str:
    """Why a reaction rule does not fail in all sets of a cube: cases on its open actions, until its truth is known."""
    rules = [rule for rule, _ in world.spec.reaction_rules if text_of(rule, world.spec) == cube.rule]
    if not rules:
        return "there is no such rule"
    waiting, count = [(cube.executed, actions_in(rules[:1]) - cube.executed - cube.idle)], 0
    while waiting:
        executed, others = waiting.pop()
        count += 1
        within_limit(count, "sets of actions in a rule")
        found = truth(rules[0], state, executed, others)
        if found:
            return f"{world.show_set(executed)} keeps the rule"
        if found is None:
            left = others - {min(others)}
            waiting += [(executed, left), (executed | {min(others)}, left)]
    return ""


def safe_outcome(world: World, state: State, cube: Cube) -> str:
    """Why the effects of an `Outcome` break no rule that has to be kept, or cannot happen in all sets."""
    names, required, start = [name for name, _ in cube.outcome], world.required(state), state
    if not names or len(set(names)) < len(names) or not cube.executed.issuperset(names):
        return "its effects are not those of different actions that all sets execute"
    if world.ordering == "first" and len(names) > 1:
        return "only the first effect counts"
    for name, effect in cube.outcome:
        if effect not in world.effects(start, name):
            return f"`{name}` does not have the effect"
        state = world.apply(state, effect)
    if cube.kind == "falsified":
        late = cube.actions <= cube.executed.difference(names)
        return "" if late and world.falsified(state, cube.actions) else "no precondition is falsified"
    return f"{world.show(state)} is safe" if world.meets(required, state) else ""


# No restoration: a trap is the states of a set that have the level of `State`, which is not safe. Whatever is executed
# in one of them, some outcome (under `fair` the nominal one) is in the trap again.


def check_no_restoration(world: World, reason: dict[str, Any], states: Numbered) -> str:
    """From `State` nothing surely leads to a state of a higher level."""
    start = read_state(reason, "State", world.spec)
    diagram = Diagram(reason, states, world.spec)
    need(diagram.is_yes_or_no(), "`Leaves` is not [false, true]")
    root = diagram.reference(reason.get("Root"))
    check_decides(world, start)
    if world.restoration == "one_step":
        raise Refuted("safety is to be restored in one step, and a trap speaks of several")
    level = [state for state in world.valid if world.level(state) == world.level(start)]
    trap = {state for state in level if diagram.value(root, state)}
    if world.is_safe(start) or start not in trap:
        raise Refuted(f"{world.show(start)} is safe, or not in the trap")
    for state in level:
        if state in trap:
            check_trapped(world, state, trap)
    return f"safety is never surely restored from {world.show(start)}, by a trap of {counted(len(trap), 'state')}"


def check_trapped(world: World, state: State, trap: set[State]) -> None:
    """Whatever is executed in a state of a trap, some outcome is in it again."""
    for chosen, after in world.steps(state):
        ends = {after} if world.restoration == "fair" else world.next_states(state, chosen)
        if ends.isdisjoint(trap):
            raise Refuted(f"{world.step(state, chosen)}, and surely out of the trap")


# No plan: whatever residual goal `State` can have, the layers R_1, …, R_n hold all runs of allowed steps that have it
# (after k steps a run is in one of R_1, …, R_k), and none of their states meets it.

Layers = tuple[Residual, list[int]]  # a residual goal, and a root for every layer


def check_no_plan(world: World, reason: dict[str, Any], states: Numbered) -> str:
    """No run from `State` meets its residual goal in `1` to `L` steps."""
    start = read_state(reason, "State", world.spec)
    diagram = Diagram(reason, states, world.spec)
    need(diagram.is_yes_or_no(), "`Leaves` is not [false, true]")
    goals: list[Layers] = []
    for entry in read_objects(reason, "Goals"):
        layers = [diagram.reference(root) for root in read_list(entry, "Layers")]
        need(layers != [], "there is a goal without layers")
        goals.append((read_goal(entry, world.spec), layers))
    check_decides(world, start)
    with runs_from(world, start) as met:
        check_first_steps(world, start, diagram, goals)
        for state in met:
            check_layers(world, state, diagram, goals)
    return f"no run from {world.show(start)} meets its residual goal, by layers for {counted(len(goals), 'goal')}"


def check_first_steps(world: World, start: State, diagram: Diagram, goals: list[Layers]) -> None:
    """Every residual goal of the start is listed, and each first successor is in the first layer of its goal."""
    for chosen, after in world.steps(start):
        pending = world.residual_goal(start, chosen)
        firsts = [layers[0] for goal, layers in goals if goal == pending]
        if not firsts:
            raise Refuted(
                f"{world.step(start, chosen)} and leaves {goal_text(world, pending)} pending, which is not listed"
            )
        if not all(diagram.value(first, after) for first in firsts):
            raise Refuted(f"{world.step(start, chosen)}, which is not in layer 1 for {goal_text(world, pending)}")


def check_layers(world: World, state: State, diagram: Diagram, goals: list[Layers]) -> None:
    """A state of a layer does not meet the goal; its steps lead into this layer, an earlier one, or the next.

    It is enough to look at the first layer that holds the state. Steps from the last layer stay in the layers, unless
    there are as many layers as steps are allowed.
    """
    held: list[tuple[Residual, int, list[int]]] = []
    for goal, layers in goals:
        number = next((place for place, root in enumerate(layers, 1) if diagram.value(root, state)), 0)
        if number and world.reached(goal, state):
            raise Refuted(f"the state {world.show(state)} of layer {number} meets {goal_text(world, goal)}")
        bound = world.spec.bound
        if number and (number < len(layers) or bound is None or number < bound):
            held.append((goal, number, layers[: number + 1]))
    for chosen, after in world.steps(state) if held else ():
        for goal, number, layers in held:
            if not any(diagram.value(root, after) for root in layers):
                where = f"layers 1 to {len(layers)} for {goal_text(world, goal)}"
                raise Refuted(f"from layer {number}, {world.step(state, chosen)}, which is not in {where}")


# Conflict: for some valid states all *options* are listed, where a set leads and its residual goal. A *cut* is a run
# that fails unless one of certain options is taken, or outcomes that restore nothing unless some option prevents them.
# No choice of one option for every state takes one for every cut.

Option = tuple[State, int, list[State]]  # the successor, the goal by its class, and where it may lead as well
Cut = tuple[int | None, list[int], State | None, int]  # goal and run; the end of a path; where outcomes lead back to
Pick = tuple[int, int]  # a listed state and one of its options, by number


class Distances:
    """Goals, and how far they are at least. Goals with one root, or equal diagrams below it, are one class: a root."""

    def __init__(self, section: dict[str, Any], states: Numbered, spec: Specification) -> None:
        self.bound = spec.bound
        self.diagram = Diagram(section, states, spec)
        need(self.diagram.is_of_numbers(), "`Leaves` are not different numbers")
        same = self.diagram.same()
        entries = read_objects(section, "Goals")
        self.goals = [same[self.diagram.reference(entry.get("Root"))] for entry in entries]
        self.members: dict[int, set[Residual]] = {number: set() for number in self.goals}
        for place, entry in enumerate(entries):
            self.members[self.goals[place]].add(read_goal(entry, spec))

    def distance(self, goal: int, state: State) -> float:
        """`D`: at least so many allowed steps are left to a goal of the class. From the bound on, all is too far."""
        found = self.diagram.value(goal, state)
        distance = math.inf if found is None else found
        return distance if self.bound is None else min(distance, self.bound)

    def near(self, goal: int, state: State, steps: int) -> bool:
        """Whether a run that is here after so many steps may still reach the goal."""
        distance = self.distance(goal, state)
        return distance < math.inf if self.bound is None else steps + distance <= self.bound


class Conflict(Distances):
    """The parts of a conflict."""

    def __init__(self, world: World, reason: dict[str, Any], states: Numbered) -> None:
        spec = world.spec
        super().__init__(reason, states, spec)
        self.choices: list[tuple[State, list[Option]]] = []
        for entry in read_objects(reason, "Choices"):
            found = [(read_state(o, "Successor", spec), self.goal(o)) for o in read_objects(entry, "Options")]
            listed = read_list(entry, "Outcomes") if "Outcomes" in entry else [[]] * len(found)
            need(len(listed) == len(found), "`Outcomes` has an entry for every option")
            need(all(isinstance(each, list) for each in listed), "`Outcomes` is a list of lists")
            outcomes = [[read_state({"State": state}, "State", spec) for state in each] for each in listed]
            options = [(*option, led) for option, led in zip(found, outcomes, strict=True)]
            self.choices.append((read_state(entry, "State", spec), options))
        self.starts = read_numbers(reason, "Starts", len(self.choices))
        self.cuts = [self.cut(entry, spec) for entry in read_objects(reason, "Cuts")]

    def goal(self, section: dict[str, Any]) -> int:
        """The class of the goal that an option or a cut names."""
        number: Any = section.get("Goal")
        need(is_number(number) and number < len(self.goals), "`Goal` is the number of a goal")
        return self.goals[int(number)]

    def cut(self, entry: dict[str, Any], spec: Specification) -> Cut:
        """The class of the goal, the listed states on the run, and the end of a path; a loop has none.

        Outcomes have no goal, but the place to which they lead back.
        """
        kind = entry.get("Kind")
        need(kind in ("path", "loop", "outcomes"), "a cut is a `path`, a `loop`, or `outcomes`")
        need(("End" in entry) == (kind == "path"), "a path has an `End`, and no other cut has one")
        run = read_numbers(entry, "States", len(self.choices))
        need(run != [], "there is a cut without states")
        if kind == "outcomes":
            back: Any = entry.get("Back")
            need("Goal" not in entry and is_number(back), "outcomes have no `Goal`, and `Back` is a number")
            return None, run, None, int(back)
        return self.goal(entry), run, read_state(entry, "End", spec) if "End" in entry else None, 0


def check_conflict(world: World, reason: dict[str, Any], states: Numbered, decided: Iterable[State] = ()) -> str:
    """No policy serves all `Starts`, if it decides these states beside the starts."""
    conflict = Conflict(world, reason, states)
    for state, _ in conflict.choices:
        if not world.is_valid(state):
            raise Refuted(f"the state {world.show(state)} is not valid")
    begun = {conflict.choices[start][0] for start in conflict.starts}
    for state in begun.difference(decided):
        check_decides(world, state)
    met = met_from(world, [state for state, _ in conflict.choices])
    for state, options in conflict.choices:
        read = options if met is world.valid else [(after, goal, []) for after, goal, _ in options]
        check_options(world, conflict, state, read)
    clauses = [clause_of(world, conflict, number) for number in range(len(conflict.cuts))]
    undecided = int(bool(world.spec.starts))  # one more option, where there is none: not to decide
    counts = [len(options) or (0 if state in begun else undecided) for state, options in conflict.choices]
    if Choosing(counts, clauses).succeeds():
        raise Refuted("there is a choice of options that respects all cuts")
    for state in met:
        check_distances(world, conflict, state)
    parts = f"{counted(len(conflict.choices), 'state')} and {counted(len(clauses), 'cut')}"
    return f"no policy serves {counted(len(set(conflict.starts)), 'state')} together, by the options of {parts}"


def check_options(world: World, conflict: Conflict, state: State, options: list[Option]) -> None:
    """Every allowed set leads and may lead where one of the options says, and has a residual goal of its class.

    Sets that a policy never executes in an unsafe state are not looked at.
    """
    for chosen, after in world.steps_on(state):
        pending = world.residual_goal(state, chosen)
        named = [led for there, goal, led in options if after == there and pending in conflict.members[goal]]
        led_to = world.next_states(state, chosen) if any(named) else set()
        if not any(led_to.issuperset(led) for led in named):
            raise Refuted(
                f"{world.step(state, chosen)} and leaves {goal_text(world, pending)} pending, which is no option there"
            )


def check_distances(world: World, distances: Distances, state: State) -> None:
    """The distance is 0 where a goal is met, and no step makes it smaller by more than one."""
    for goal, members in distances.members.items():
        met = next((each for each in members if world.reached(each, state)), None)
        if met is not None and distances.distance(goal, state) != 0:
            raise Refuted(f"{world.show(state)} meets {goal_text(world, met)}, and its distance is not 0")
    for chosen, after in world.steps_on(state):
        for goal, members in distances.members.items():
            if distances.distance(goal, state) > distances.distance(goal, after) + 1:
                nearer = f"from where {min(goal_text(world, each) for each in members)} is nearer by more than one step"
                raise Refuted(f"{world.step(state, chosen)}, {nearer}")


def clause_of(world: World, conflict: Conflict, number: int) -> list[Pick]:
    """Options of which every policy that serves the first state of a cut takes one."""
    goal, run, end, back = conflict.cuts[number]
    if run[0] not in conflict.starts:
        raise Refuted(f"cut {number} begins in a state that is not among the starts")
    if goal is None:
        return avoiding(world, conflict, number, back)
    picks = [(run[0], place) for place, option in enumerate(conflict.choices[run[0]][1]) if option[1] != goal]
    way = [conflict.choices[each][0] for each in run]
    if end is None:  # those that meet the goal, or leave the loop for where it is near enough
        for each in sorted(set(run)):
            for place, (after, _, _) in enumerate(conflict.choices[each][1]):
                leaves = after not in way and conflict.near(goal, after, 1)
                if leaves or conflict.distance(goal, after) == 0:
                    picks.append((each, place))
        return picks
    met = next((state for state in way[1:] if conflict.distance(goal, state) == 0), None)
    if met is not None:
        raise Refuted(f"cut {number} passes {world.show(met)}, where its goal may be met")
    if conflict.near(goal, end, len(way)):
        raise Refuted(f"cut {number} ends in {world.show(end)}, from where its goal may be reached")
    for steps, following in enumerate([*way[1:], end], 1):  # those that turn off to where it is near enough
        each = run[steps - 1]
        for place, (after, _, _) in enumerate(conflict.choices[each][1]):
            if after != following and conflict.near(goal, after, steps):
                picks.append((each, place))
    return picks


def avoiding(world: World, conflict: Conflict, number: int, back: int) -> list[Pick]:
    """Options that cannot lead to the next state; those that come again and again are unsafe, and of one level."""
    run = conflict.cuts[number][1]
    way = [conflict.choices[each][0] for each in run]
    if world.restoration != "bounded" or back >= len(way):
        raise Refuted(f"cut {number} is of outcomes that lead back to none of its states, or need not restore safety")
    if any(world.is_safe(state) or world.level(state) != world.level(way[back]) for state in way[back:]):
        raise Refuted(f"the outcomes of cut {number} restore something")
    return [
        (each, place)
        for each, following in zip(run, [*way[1:], way[back]], strict=True)
        for place, (after, _, led) in enumerate(conflict.choices[each][1])
        if following != after and following not in led
    ]


# No part: states are removed that no policy decides which stays in what is left. Then a start is among them, or goals
# conflict in what is left, and each case is looked at in which one of those states is left out that is no start.


def check_no_part(world: World, reason: dict[str, Any], states: Numbered) -> int:
    """No part of the valid states that has all starts has a policy; how many were removed.

    Of the arguments in `Parts`, the first is about all valid states, every other one about a case of an earlier one.
    """
    parts, count = read_objects(reason, "Parts"), 0
    left = {0: world}
    for number, part in enumerate(parts):
        need(part.get("Kind") in ("start", "conflict"), "a part is of kind `start` or `conflict`")
        if number not in left:
            raise Refuted(f"part {number} is no case of an earlier one")
        here = left[number]
        for place, entry in enumerate(read_objects(part, "Removals")):
            gone = removed(here, entry, f"removal {place} of part {number}", states)
            here, count = here.within(set(here.valid) - gone), count + len(gone)
        if part["Kind"] == "start":
            start = read_state(part, "State", world.spec)
            check_decides(world, start)
            if here.is_valid(start):
                raise Refuted(f"the state {world.show(start)} is not removed")
            continue
        need(isinstance(part.get("Conflict"), dict), "`Conflict` is an object")
        cases = read_objects(part, "Cases")
        others = [read_state(case, "Without", world.spec) for case in cases]
        check_conflict(here, part["Conflict"], states, others)
        for place, case in enumerate(cases):
            following: Any = case.get("Part")
            need(is_number(following), "`Part` is a number")
            if following <= number or following in left:
                raise Refuted(f"a case of part {number} is not a part of its own")
            left[following] = here.within(set(here.valid) - {others[place]})
    if set(left) != set(range(len(parts))):
        raise Refuted("there are cases without a part")
    return count


def removed(world: World, entry: dict[str, Any], name: str, states: Numbered) -> set[State]:
    """The states that a removal removes: traps, or from where every step leads too far away from its goal."""
    need(entry.get("Kind") in ("no-restoration", "no-plan"), "a removal is `no-restoration` or `no-plan`")
    distances = Distances(entry, states, world.spec)
    root = distances.diagram.reference(entry.get("Root"))
    gone = [state for state in world.valid if distances.diagram.value(root, state) is not None]
    if entry["Kind"] == "no-restoration":
        if world.restoration == "one_step" or any(map(world.is_safe, gone)):
            raise Refuted(f"{name} is of traps, but safe states and one step have none")
        for level in range(len(world.tiers)):
            trap = {state for state in gone if world.level(state) == level}
            for state in sorted(trap):
                check_trapped(world, state, trap)
        return set(gone)
    for state in world.valid if world.stepwise else world.safe:
        check_distances(world, distances, state)
    for state in gone:
        for chosen, after in world.steps_on(state):
            pending = world.residual_goal(state, chosen)
            classes = [goal for goal, members in distances.members.items() if pending in members]
            if all(distances.near(goal, after, 1) for goal in classes):
                told = f"from where {goal_text(world, pending)} may be reached"
                raise Refuted(f"{name}: {world.step(state, chosen)}, {told}")
    return set(gone)


class Choosing:
    """The search for one option of every state so that every clause has one that is chosen.

    A *group* is a clause, or all options of a state: it needs an option that is chosen. Where all but one of a group
    are excluded, that one is chosen, and the other options of its state are excluded.
    """

    def __init__(self, counts: list[int], clauses: list[list[Pick]]) -> None:
        self.states = [[(state, place) for place in range(count)] for state, count in enumerate(counts)]
        self.groups = self.states + [sorted(set(clause)) for clause in clauses]
        self.left = [len(group) for group in self.groups]  # how many of a group are not excluded
        self.groups_of: dict[Pick, list[int]] = {pick: [] for group in self.states for pick in group}
        for number, group in enumerate(self.groups):
            for pick in group:
                self.groups_of[pick].append(number)
        self.excluded: dict[Pick, None] = {}  # in order
        self.touched = list(range(len(self.groups)))

    def succeeds(self) -> bool:
        """Whether there is such a choice: guess an option; exclude it where that leaves nothing of some group."""
        guesses: list[tuple[Pick, int]] = []  # and how many were excluded before
        count = 0
        while True:
            if not self.follow():
                if not guesses:
                    return False
                guess, before = guesses.pop()
                self.take_back(before)
                self.exclude([guess])
                continue
            undecided = [state for state in range(len(self.states)) if self.left[state] > 1]
            if not undecided:
                return True
            count += 1
            within_limit(count, "choices of options")
            guesses.append((self.first_left(min(undecided, key=self.left.__getitem__)), len(self.excluded)))
            self.choose(guesses[-1][0])

    def follow(self) -> bool:
        """Choose what is the last one left of its group; False where nothing is left of one."""
        while self.touched:
            number = self.touched.pop()
            if self.left[number] == 0:
                self.touched.clear()
                return False
            if self.left[number] == 1:
                self.choose(self.first_left(number))
        return True

    def first_left(self, number: int) -> Pick:
        """The first option of a group that is not excluded."""
        return next(pick for pick in self.groups[number] if pick not in self.excluded)

    def choose(self, pick: Pick) -> None:
        """Exclude all other options of the state."""
        self.exclude([other for other in self.states[pick[0]] if other != pick])

    def exclude(self, picks: list[Pick]) -> None:
        """Exclude options."""
        for pick in picks:
            if pick not in self.excluded:
                self.excluded[pick] = None
                for number in self.groups_of[pick]:
                    self.left[number] -= 1
                    self.touched.append(number)

    def take_back(self, count: int) -> None:
        """Leave the first `count` excluded."""
        while len(self.excluded) > count:
            for number in self.groups_of[self.excluded.popitem()[0]]:
                self.left[number] += 1


def goal_text(world: World, goal: Residual) -> str:
    """A residual goal in words."""
    bodies = " AND ".join(sorted(f"({text_of(body, world.spec)})" for body in goal[0])) or "no goal"
    return bodies + (f" while executing {', '.join(sorted(goal[1]))}" if goal[1] else "")


# ----------------------------------------------------------------------------------------------------------------------
# 10. The command line.


def main(argv: list[str] | None = None) -> int:
    """Judge the files that are named; the exit code."""
    parser = argparse.ArgumentParser(description="Judge a policy against a specification, state by state.")
    parser.add_argument("policy")
    parser.add_argument("spec")
    parser.add_argument("--effect-ordering", choices=("any", "first"))
    parser.add_argument("--restoration", choices=RESTORATIONS)
    parser.add_argument("--strict", action="store_true", help="a wrong or stale certificate makes the verdict no")
    parser.add_argument("--guarantees", metavar="FILE", help="a certificate of what the policy guarantees")
    options = parser.parse_args(argv)
    recursion_limit = sys.getrecursionlimit()
    sys.setrecursionlimit(max(10_000, recursion_limit))
    try:
        return judge_files(options)
    except (Unreadable, OSError, UnicodeDecodeError, RecursionError) as problem:
        print(f"cannot be judged: {problem}", file=sys.stderr)
        return 2
    except (TooLarge, NotKnown) as problem:
        print(f"no verdict: {problem}", file=sys.stderr)
        return 3
    finally:
        sys.setrecursionlimit(recursion_limit)


def judge_files(options: argparse.Namespace) -> int:
    """Read, judge, report."""
    spec = read_specification(Path(options.spec).read_bytes())
    document = read_document(Path(options.policy).read_bytes())
    if document.get("Type") == "unrealizable":
        return judge_certificate_of_no(spec, document, options)
    return judge_policy(spec, read_policy(document, spec), options)


def judge_policy(spec: Specification, policy: Policy, options: argparse.Namespace) -> int:
    """Ordering and restoration are the command line's, else the specification's, else `any` and `one_step`."""
    ordering = options.effect_ordering or spec.ordering or "any"
    world = World(spec, ordering, options.restoration)
    valid = counted(len(world.valid), "valid state")
    judge = Judge(world, policy.decide)
    world = judge.world
    unsafe = len(world.valid) - len(world.safe)
    valid += f", {len(world.valid)} decided" if spec.starts else ""
    print(f"{valid}: {len(world.safe)} safe, {unsafe} unsafe; {shown_settings(world)}")
    right = True
    if options.effect_ordering is None and policy.document.get("EffectOrdering") == "first" and ordering == "any":
        print("ordering FAILS: the policy was made for `first`, but the specification means `any`")
        right = False
    made_for, meant = policy.document["Restoration"], world.restoration
    if options.restoration is None and RESTORATIONS.index(made_for) > RESTORATIONS.index(meant):
        print(f"restoration FAILS: the policy was made for `{made_for}`, but the specification means `{meant}`")
        right = False
    for name, (states, reason) in judge.verdicts().items():
        print(
            f"{name:{9 if world.stepwise else 8}} "
            + (f"FAILS in {counted(len(states), 'state')}: {reason(states[0])}" if states else "holds")
        )
        right = right and not states
    status, why = judge_certificate(judge, policy.document)
    if status in ("stale", "wrong"):
        status, right = status.upper(), right and not options.strict
    print(f"certificate: {status}" + (f": {why}" if why else ""))
    if options.guarantees is not None:
        right = judge_guarantees(judge, read_document(Path(options.guarantees).read_bytes())) and right
    return 0 if right else 1


def judge_guarantees(judge: Judge, document: dict[str, Any]) -> bool:
    """Whether the certificate of what the policy guarantees is right, for this specification and these settings."""
    world, verdicts = judge.world, judge.verdicts()
    read_header(document, world.spec)
    need(document.get("Type") == "guarantees", "it is no certificate of guarantees")
    made_for = document.get("SpecificationDigest"), document.get("EffectOrdering"), document["Restoration"]
    why = shown = ""
    if any(verdicts[name][0] for name in ("total", "safe", "goals")):
        why = "the policy is not total and safe with its goals met, on which they build"
    elif made_for != (digest(world.spec), world.ordering, world.restoration):
        why = "they are for another specification, ordering or restoration"
    else:
        try:
            shown = check_guarantees(judge, document)
        except Refuted as problem:
            why = str(problem)
    print(f"guarantees FAIL: {why}" if why else f"guarantees hold: {shown}")
    return not why


def shown_settings(world: World) -> str:
    """The ordering, and the restoration where it is not `one_step`."""
    restoration = "" if world.restoration == "one_step" else f"; restoration {world.restoration}"
    return f"effect ordering {world.ordering}{restoration}"


def judge_certificate_of_no(spec: Specification, document: dict[str, Any], options: argparse.Namespace) -> int:
    """The ordering is the command line's, else the certificate's; `any` proves nothing where `first` is written.

    Safety is to be restored as the command line or the specification says, whatever the certificate was made for.
    """
    read_header(document, spec)
    need({"SpecificationDigest", "EffectOrdering"} <= set(document), "the digest or the ordering is missing")
    ordering = options.effect_ordering or document["EffectOrdering"]
    world = World(spec, ordering, options.restoration)
    print(shown_settings(world))
    shown = why = ""
    if options.effect_ordering is None and (ordering, spec.ordering) == ("any", "first"):
        why = "it speaks of `any`, but the specification writes `first`, under which more sets are allowed"
    else:
        try:
            shown = judge_no(world, document)
        except Refuted as problem:
            why = str(problem)
    print(f"unrealizable FAILS: {why}" if why else f"unrealizable holds: {shown}")
    stale = document["SpecificationDigest"] != digest(spec)
    print(f"specification: {'STALE: the certificate was made for another one' if stale else 'the same'}")
    return 0 if not why and not (stale and options.strict) else 1


if __name__ == "__main__":
    sys.stdout.reconfigure(errors="backslashreplace")  # type: ignore[union-attr]
    try:
        sys.exit(main())
    except Exception:  # noqa: BLE001 - a bug must not exit with 1
        traceback.print_exc()
        sys.exit(70)
