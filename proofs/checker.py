#!/usr/bin/env python3
"""Judge a policy table against a specification by the explicit meaning. One file; nothing but Python (3.9 or newer).

    python3 checker.py policy.json spec.tum [--effect-ordering any|first] [--strict]

It is written from docs/semantics.md and docs/policy.md and shares no code with the package: a second opinion that can be
read in one sitting, from the top down. It looks at every valid state, one by one, and judges four properties:

    total    every valid state has a decision
    safe     every decision is allowed: Ok(s, A)
    goals    every nominal run reaches the active goals within the bound
    minimal  where safety is restored, no cheaper allowed set would do as well

Exit codes: 0 all hold; 1 one fails; 2 unreadable input, or a specification with errors; 3 too large to look at every
state; 70 this program is broken. A certificate (ranks) is judged as well, but counts only with `--strict`.

Not judged: policies of type `policy-diagram`, and whether the digest in the policy belongs to this specification. Nor
does anybody here know whether the specification says what was meant.
"""

from __future__ import annotations

import argparse
import itertools
import json
import math
import re
import sys
import traceback
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

State = tuple[str, ...]  # one value per variable, in the order of declaration
ActionSet = frozenset[str]  # the names of the actions that are executed at the same time
Formula = tuple[Any, ...]  # see section 2
Effect = dict[int, str]  # the new value by the position of its variable
Located = tuple[Formula, int]  # a formula and the line on which it begins

LARGEST = 10_000_000  # this many states, or assignments of one set of effects, are enumerated at most


class Unreadable(Exception):
    """Input that cannot be judged: exit code 2."""


class TooLarge(Exception):
    """Input that would take too long: exit code 3."""


# ----------------------------------------------------------------------------------------------------------------------
# 1. Tokens. White space and line ends mean nothing; `//` and `/* */` are comments.

TOKEN = re.compile(r"\s+|//[^\n]*|/\*.*?\*/|(?P<token>[A-Za-z_][A-Za-z0-9_]*|[0-9]+|[(),:])", re.DOTALL | re.ASCII)
NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
RESERVED = {"BEGIN", "END", "AND", "OR", "NOT", "IF", "THEN", "IFONLYIF"}


def tokens_of(text: str) -> list[tuple[str, int]]:
    """The tokens of a specification with their lines; the last one is empty."""
    text = text.replace("\r\n", "\n").replace("\r", "\n")
    found, position, line = [], 0, 1
    while position < len(text):
        match = TOKEN.match(text, position)
        if match is None:
            raise Unreadable(f"line {line}: unexpected character {text[position]!r}")
        if match["token"]:
            found.append((match["token"], line))
        line += match[0].count("\n")
        position = match.end()
    return [*found, ("", line)]


# ----------------------------------------------------------------------------------------------------------------------
# 2. Parsing. A formula is a nested tuple:
#      ("true",)  ("false",)  ("not", f)  ("and", f, g, …)  ("or", f, g, …)  ("iff", f, g)
#      ("is", variable, value)  ("executing", action)  ("alias", name)
#    The parser leaves names as (text, line); section 3 replaces them: variables by their position, aliases by their
#    meaning. `IF p THEN q` is read as `NOT p OR q`.


@dataclass
class Action:
    """An action; `effects` holds the nominal assignment first, then every alternative one."""

    name: str
    line: int
    duration: int = 0
    resources: frozenset[str] = frozenset()
    preconditions: list[Located] = field(default_factory=list)
    nominal: Effect = field(default_factory=dict)
    effects: list[Effect] = field(default_factory=list)


@dataclass
class Goal:
    """A simple goal (`kind` is "goal"), or a list of goals (`kind` is "priority" or "constraint")."""

    kind: str
    condition: Formula | None  # after `when`
    body: Formula  # of a simple goal
    members: list[Goal]


@dataclass
class Specification:
    """A specification: first as it was written, after `resolve` by what its names mean."""

    variables: dict[str, tuple[str, ...]] = field(default_factory=dict)
    aliases: dict[str, Formula] = field(default_factory=dict)
    resources: list[str] = field(default_factory=list)
    actions: dict[str, Action] = field(default_factory=dict)
    reaction_rules: list[Located] = field(default_factory=list)
    state_rules: list[Located] = field(default_factory=list)
    assumptions: list[Located] = field(default_factory=list)
    goals: Goal | None = None
    bound: int | None = None  # L, or None: runs of any length
    ordering: str | None = None
    lines: list[str] = field(default_factory=list)
    fields: dict[str, dict[str, Any]] = field(default_factory=dict)  # of the actions, as written


class Parser:
    """Recursive descent; each method reads one construct of the language."""

    def __init__(self, text: str) -> None:
        self.tokens = tokens_of(text)
        self.position = 0
        self.spec = Specification(lines=text.replace("\r\n", "\n").replace("\r", "\n").split("\n"))

    @property
    def line(self) -> int:
        """The line of the next token."""
        return self.tokens[self.position][1]

    def at(self, words: str) -> bool:
        """Whether the next tokens are these words."""
        wanted = words.split()
        return [text for text, _ in self.tokens[self.position : self.position + len(wanted)]] == wanted

    def accept(self, words: str) -> bool:
        """Read these words if they come next."""
        if not self.at(words):
            return False
        self.position += len(words.split())
        return True

    def expect(self, words: str) -> None:
        """Read these words, which have to come next."""
        if not self.accept(words):
            raise Unreadable(f"line {self.line}: `{words}` expected, not `{self.tokens[self.position][0]}`")

    def name(self) -> str:
        """Any word that is not reserved."""
        text, line = self.tokens[self.position]
        if not NAME.fullmatch(text) or text in RESERVED:
            raise Unreadable(f"line {line}: a name expected, not `{text}`")
        self.position += 1
        return text

    def number(self) -> int:
        """A number from 0 up."""
        text, line = self.tokens[self.position]
        if not text.isdigit():
            raise Unreadable(f"line {line}: a number expected, not `{text}`")
        self.position += 1
        return int(text)

    def once(self, keys: Iterable[str], key: str, line: int) -> None:
        """Refuse what stands there for the second time."""
        if key in keys:
            raise Unreadable(f"line {line}: `{key}` comes twice")

    # Blocks, in any order, each at most once.

    def specification(self) -> Specification:
        """The whole file."""
        blocks = {
            "STATE VECTOR": self.state,
            "ALIASES": self.alias,
            "RESOURCES": self.resource,
            "ACTIONS": self.action,
            "REACTION RULES": lambda: self.rule("rule", self.spec.reaction_rules),
            "STATE RULES": lambda: self.rule("rule", self.spec.state_rules),
            "ASSUMPTIONS": lambda: self.rule("assume", self.spec.assumptions),
            "GOALS": None,
            "CONFIG": self.setting,
        }
        seen: set[str] = set()
        while self.tokens[self.position][0]:
            line = self.line
            self.expect("BEGIN")
            title = next((title for title in blocks if self.accept(title)), None)
            if title is None:
                raise Unreadable(f"line {line}: unknown block")
            self.once(seen, title, line)
            seen.add(title)
            read = blocks[title]
            if read is None:
                self.spec.goals = self.goal_list(None)
                continue
            while not self.accept("END"):
                read()
            self.expect(title)
        return self.spec

    def state(self) -> None:
        """`state NAME can be VALUE, VALUE, …`."""
        self.expect("state")
        line, name = self.line, self.name()
        self.expect("can be")
        values = [self.name()]
        while self.accept(","):
            self.once(values, self.tokens[self.position][0], self.line)
            values.append(self.name())
        self.once(self.spec.variables, name, line)
        self.spec.variables[name] = tuple(values)

    def alias(self) -> None:
        """`define NAME as PREDICATE`."""
        self.expect("define")
        line, name = self.line, self.name()
        self.expect("as")
        self.once(self.spec.aliases, name, line)
        self.spec.aliases[name] = self.predicate()

    def resource(self) -> None:
        """`resource NAME`."""
        self.expect("resource")
        line, name = self.line, self.name()
        self.once(self.spec.resources, name, line)
        self.spec.resources.append(name)

    def rule(self, word: str, rules: list[Located]) -> None:
        """`rule: PREDICATE` or `assume: PREDICATE`."""
        self.expect(f"{word} :")
        line = self.line
        rules.append((self.predicate(), line))

    def setting(self) -> None:
        """`max_plan_length: N` or `effect_ordering: any`."""
        line = self.line
        if self.accept("max_plan_length :"):
            if self.spec.bound is not None:
                raise Unreadable(f"line {line}: `max_plan_length` comes twice")
            self.spec.bound = self.number()
            if self.spec.bound == 0:
                raise Unreadable(f"line {line}: `max_plan_length` is at least 1")
        else:
            self.expect("effect_ordering :")
            if self.spec.ordering is not None:
                raise Unreadable(f"line {line}: `effect_ordering` comes twice")
            self.spec.ordering = "first" if self.accept("first") else "any"
            if self.spec.ordering == "any":
                self.expect("any")

    # Actions: fields in any order, `cost:` and `effects:` in older files.

    def action(self) -> None:
        """`action NAME` and its fields."""
        self.expect("action")
        line, name = self.line, self.name()
        self.once(self.spec.actions, name, line)
        self.spec.actions[name] = Action(name, line)
        written: dict[str, Any] = {"alternative": []}
        while (key := self.field_name()) is not None:
            line = self.line
            if key == "alternative":
                written[key].append((self.predicates(), line))
                continue
            self.once(written, key, line)
            if key == "duration":
                written[key] = self.number()
            elif key == "resources":
                written[key] = self.resource_list()
            else:
                written[key] = self.predicates()
        self.spec.fields[name] = written

    def field_name(self, read: bool = True) -> str | None:
        """The field that begins here, if one does."""
        names = {
            "duration :": "duration",
            "cost :": "duration",
            "controlled resources :": "resources",
            "preconditions :": "preconditions",
            "nominal effects :": "nominal",
            "effects :": "nominal",
            "alternative effects :": "alternative",
        }
        return next((key for words, key in names.items() if (self.accept(words) if read else self.at(words))), None)

    def list_is_empty(self) -> bool:
        """Whether a field has nothing, or `none`, behind its colon."""
        following = self.tokens[self.position + 1][0] if self.tokens[self.position][0] else ""
        if self.at("none") and following != "is":
            self.position += 1
            return True
        return self.at("END") or (self.at("action") and following != "is") or self.field_name(read=False) is not None

    def resource_list(self) -> list[tuple[str, int]]:
        """`R, R`."""
        found: list[tuple[str, int]] = []
        if not self.list_is_empty():
            found.append((self.name(), self.line))
            while self.accept(","):
                found.append((self.name(), self.line))
        return found

    def predicates(self) -> list[Located]:
        """`PREDICATE, PREDICATE, …`; a comma means AND."""
        found: list[Located] = []
        if not self.list_is_empty():
            line = self.line
            found.append((self.predicate(), line))
            while self.accept(","):
                line = self.line
                found.append((self.predicate(), line))
        return found

    # Goals.

    def goal_list(self, condition: Formula | None) -> Goal:
        """What follows `BEGIN GOALS`."""
        self.expect("goal type :")
        kind = "priority" if self.accept("priority") else "constraint"
        if kind == "constraint":
            self.expect("constraint")
        goal = Goal(kind, condition, ("true",), [])
        while not self.accept("END"):
            when = None
            if self.accept("when"):
                when = self.predicate()
                self.expect("then")
            if self.accept("BEGIN GOALS"):
                goal.members.append(self.goal_list(when))
            else:
                self.expect("goal :")
                goal.members.append(Goal("goal", when, self.predicate(), []))
        self.expect("GOALS")
        return goal

    # Predicates, loosest first: IFONLYIF (once), IF … THEN …, OR, AND, NOT.

    def predicate(self) -> Formula:
        """`p IFONLYIF q`, or what binds tighter."""
        left = self.implication()
        return ("iff", left, self.disjunction()) if self.accept("IFONLYIF") else left

    def implication(self) -> Formula:
        """`IF p THEN q`, or what binds tighter."""
        if not self.accept("IF"):
            return self.disjunction()
        condition = self.disjunction()
        self.expect("THEN")
        return ("or", ("not", condition), self.disjunction())

    def disjunction(self) -> Formula:
        """`p OR q OR …`, or what binds tighter."""
        parts = [self.conjunction()]
        while self.accept("OR"):
            parts.append(self.conjunction())
        return ("or", *parts) if len(parts) > 1 else parts[0]

    def conjunction(self) -> Formula:
        """`p AND q AND …`, or what binds tighter."""
        parts = [self.negation()]
        while self.accept("AND"):
            parts.append(self.negation())
        return ("and", *parts) if len(parts) > 1 else parts[0]

    def negation(self) -> Formula:
        """`NOT p`, or a basic predicate."""
        return ("not", self.negation()) if self.accept("NOT") else self.basic()

    def basic(self) -> Formula:
        """`( p )`, `VARIABLE is VALUE`, `executing ACTION`, `true`, `false`, or an alias."""
        if self.accept("("):
            inside = self.predicate()
            self.expect(")")
            return inside
        line, word = self.line, self.name()
        if self.accept("is"):
            return ("is", (word, line), (self.name(), self.line))
        if word in ("true", "false"):
            return (word,)
        if word == "executing":
            return ("executing", (self.name(), line))
        return ("alias", (word, line))


# ----------------------------------------------------------------------------------------------------------------------
# 3. Names, and the effects of actions (docs/semantics.md, section 2).


def resolve(spec: Specification) -> Specification:
    """Replace every name by what it means, and every list of effects by the assignments that it denotes."""
    if not spec.variables:
        raise Unreadable("there is no state variable")
    check_names(spec)
    for name in list(spec.aliases):
        meaning(spec, ("alias", (name, 0)), True)
    for action in spec.actions.values():
        written = spec.fields[action.name]
        action.duration = written.get("duration", 0)
        action.resources = frozenset(name for name, _ in written.get("resources", []))
        for name, line in written.get("resources", []):
            if name not in spec.resources:
                raise Unreadable(f"line {line}: unknown resource `{name}`")
        action.preconditions = [(meaning(spec, f, False), line) for f, line in written.get("preconditions", [])]
        nominal = assignments(spec, written.get("nominal", []))
        if len(nominal) != 1:
            raise Unreadable(f"line {action.line}: `{action.name}` has {len(nominal)} nominal outcomes, not one")
        action.nominal = nominal[0]
        action.effects = list(nominal)
        for parts, line in written["alternative"]:
            found = assignments(spec, parts)
            if not found:
                raise Unreadable(f"line {line}: these alternative effects are impossible")
            action.effects += [effect for effect in found if effect not in action.effects]
    spec.reaction_rules = [(meaning(spec, f, True), line) for f, line in spec.reaction_rules]
    spec.state_rules = [(meaning(spec, f, False), line) for f, line in spec.state_rules]
    spec.assumptions = [(meaning(spec, f, False), line) for f, line in spec.assumptions]
    if spec.goals is not None:
        resolve_goal(spec, spec.goals)
    return spec


def check_names(spec: Specification) -> None:
    """One name, one kind of thing."""
    kinds = {"variable": spec.variables, "alias": spec.aliases, "resource": spec.resources, "action": spec.actions}
    known: dict[str, str] = {}
    for kind, names in kinds.items():
        for name in names:
            if name in known:
                raise Unreadable(f"`{name}` is the name of a {known[name]} and of a {kind}")
            known[name] = kind


def meaning(spec: Specification, formula: Formula, may_execute: bool, inside: tuple[str, ...] = ()) -> Formula:
    """The formula with names replaced; `inside` are the aliases that are being expanded."""
    kind = formula[0]
    if kind == "is":
        (variable, line), (value, _) = formula[1], formula[2]
        if variable not in spec.variables:
            raise Unreadable(f"line {line}: unknown variable `{variable}`")
        if value not in spec.variables[variable]:
            raise Unreadable(f"line {line}: `{variable}` has no value `{value}`")
        return ("is", list(spec.variables).index(variable), value)
    if kind == "executing":
        name, line = formula[1]
        if name not in spec.actions:
            raise Unreadable(f"line {line}: unknown action `{name}`")
        if not may_execute:
            raise Unreadable(f"line {line}: `executing` belongs in reaction rules and goals")
        return ("executing", name)
    if kind == "alias":
        name, line = formula[1]
        if name not in spec.aliases:
            raise Unreadable(f"line {line}: unknown alias `{name}`")
        if name in inside:
            raise Unreadable(f"line {line}: the alias `{name}` uses itself")
        return meaning(spec, spec.aliases[name], may_execute, (*inside, name))
    return (kind, *(meaning(spec, part, may_execute, inside) for part in formula[1:]))


def resolve_goal(spec: Specification, goal: Goal) -> None:
    """Names in a goal: conditions speak of the state only, bodies also of what is executed."""
    if goal.condition is not None:
        goal.condition = meaning(spec, goal.condition, False)
    goal.body = meaning(spec, goal.body, True)
    for member in goal.members:
        resolve_goal(spec, member)


def assignments(spec: Specification, written: list[Located]) -> list[Effect]:
    """The assignments to the mentioned variables that satisfy the whole list of effects."""
    parts = [meaning(spec, formula, False) for formula, _ in written]
    domains = list(spec.variables.values())
    mentioned = sorted({atom[1] for part in parts for atom in atoms(part)})
    choices: dict[int, tuple[str, ...]] = {variable: domains[variable] for variable in mentioned}
    for kind, *names in parts:
        if kind == "is":  # a plain effect leaves one value: no need to try the others
            choices[names[0]] = (names[1],)
    if math.prod(len(values) for values in choices.values()) > LARGEST:
        raise TooLarge("a set of effects has too many assignments to look at")
    found = []
    for values in itertools.product(*choices.values()):
        effect = dict(enumerate(values))
        effect = {variable: values[place] for place, variable in enumerate(choices)}
        state = tuple(effect.get(variable, "") for variable in range(len(domains)))
        if all(holds(part, state) for part in parts):
            found.append(effect)
    return found


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
        return state[formula[1]] == formula[2]
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
    return kind == "true"
