"""Random specifications with numbers, sets, comparisons, quantifiers and copies, and the same texts written out."""

from __future__ import annotations

import operator
from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import product
from random import Random

from msgspec import Struct

Value = str | int
Scope = Mapping[str, Value]
Domains = Mapping[str, Sequence[Value]]

COMPARISONS: dict[str, Callable[[object, object], bool]] = {
    "=": operator.eq,
    "!=": operator.ne,
    "<": operator.lt,  # type: ignore[dict-item]
    "<=": operator.le,  # type: ignore[dict-item]
    ">": operator.gt,  # type: ignore[dict-item]
    ">=": operator.ge,  # type: ignore[dict-item]
}
ROBOTS = ("r1", "r2", "r3")


class Piece(Struct, frozen=True):
    """A piece of a specification: as it is written in short, and in full for given values of parameters."""

    short: str
    long: Callable[[Scope], str]


def joined(word: str, texts: Sequence[str], none: str = "") -> str:
    """Predicates with an operator between them; one stands for itself."""
    if not texts:
        return none
    return texts[0] if len(texts) == 1 else "(" + f" {word} ".join(texts) + ")"


def shorthand(seed: int) -> tuple[str, str]:
    """The specification of a seed, in short and in full."""
    return Writer(Random(f"shorthand {seed}")).specification()


class Writer:
    """One specification."""

    def __init__(self, random: Random) -> None:
        self.random = random
        self.robots = ROBOTS[: random.randint(1, 3)]
        low, high = random.choice(((0, 3), (-2, 1), (1, 2), (0, 0), (9, 11)))
        self.numeric: dict[str, list[int]] = {"N": list(range(low, high + 1))}
        self.numeric["M"] = random.sample(range(-1, 5), random.randint(1, 4))
        self.words = {"P": ["dock", "hall", "yard", "in", "not"][: random.randint(2, 5)]}
        self.mixed = {"X": ["off", "0", "1", "2"]}
        self.names = iter(f"Q{number}" for number in range(1000))

    # Parameters.

    def parameters(self, outer: Domains) -> tuple[str, Domains, Callable[[Scope], Iterator[Scope]]]:
        """What stands between `for` and its body; the parameters; and the values that they take, given outer ones."""
        found: dict[str, Sequence[Value]] = {}
        shown = []
        for _ in range(self.random.choice((1, 1, 1, 2))):
            name = next(self.names)
            text, values = self.random.choice((self.of_robots, self.of_robots, self.of_numbers, self.of_places))()
            found[name] = values
            shown.append(f"{name} in {text}")
        tests = [self.test({**outer, **found}) for _ in range(self.random.choice((0, 0, 1, 2)))]
        where = " where " + ", ".join(test.short for test in tests) if tests else ""

        def values_of(scope: Scope) -> Iterator[Scope]:
            for chosen in product(*found.values()):
                inner = {**scope, **dict(zip(found, chosen, strict=True))}
                if all(test.long(inner) for test in tests):
                    yield inner

        return ", ".join(shown) + where, found, values_of

    def of_robots(self) -> tuple[str, Sequence[Value]]:
        """Words, also by the name of their list."""
        listed = ", ".join(self.robots)
        return self.random.choice(("ROBOTS", listed, "{" + listed + "}")), self.robots

    def of_numbers(self) -> tuple[str, Sequence[Value]]:
        """Numbers, also as a range."""
        low = self.random.choice((-1, 0, 1, 2))
        values = range(low, low + self.random.randint(1, 3))
        listed = ", ".join(map(str, values))
        return self.random.choice((f"{values[0]}..{values[-1]}", listed, "{" + listed + "}")), values

    def of_places(self) -> tuple[str, Sequence[Value]]:
        """Values of a variable."""
        values = self.random.sample(self.words["P"], self.random.randint(1, 2))
        return ", ".join(values), values

    def test(self, domains: Domains) -> Piece:
        """A condition after `where`; in full it is some text, or none where it does not hold."""
        name = self.random.choice(list(domains))
        domain = domains[name]
        partners: list[Value] = [each for each in domains if list(domains[each]) == list(domain)]
        numbers = isinstance(domain[0], int)
        shift = self.random.choice((0, 0, 1, -1)) if numbers else 0
        other = self.random.choice([*partners, self.random.choice(domain)])
        sign = self.random.choice(list(COMPARISONS))

        def holds(scope: Scope) -> str:
            one, two = scope[name], scope.get(str(other), other)
            if isinstance(one, int):
                return "yes" * COMPARISONS[sign](one + shift, two)
            places = list(domain)
            return "yes" * COMPARISONS[sign](places.index(one), places.index(two))

        return Piece(f"{name}{shift:+d} {sign} {other}" if shift else f"{name}{sign}{other}", holds)

    def number(self, values: Sequence[int], domains: Domains) -> Piece:
        """A number among some, or made of a parameter that never leaves them."""
        fitting = [
            (name, shift)
            for name, domain in domains.items()
            for shift in (-1, 0, 1)
            if all(isinstance(value, int) and value + shift in values for value in domain)
        ]
        if not fitting or self.random.random() < 0.3:
            number = self.random.choice(values)
            return Piece(str(number), lambda _: str(number))
        name, shift = self.random.choice(fitting)
        return Piece(f"{{{name}{shift:+d}}}" if shift else f"{{{name}}}", lambda scope: str(int(scope[name]) + shift))

    # Predicates.

    def predicate(self, depth: int, domains: Domains) -> Piece:
        """A predicate; what may be misread stands in parentheses."""
        random = self.random
        if depth == 0 or random.random() < 0.3:
            return random.choice((self.comparison, self.comparison, self.word, self.member, self.of_robot))(domains)
        kind = random.choice(("NOT", "AND", "OR", "IF", "IFONLYIF", "all", "some", "exactly one", "all"))
        if kind in ("all", "some", "exactly one"):
            return self.quantified(kind, depth, domains)
        one, two = self.predicate(depth - 1, domains), self.predicate(depth - 1, domains)
        if kind == "NOT":
            return Piece(f"NOT {one.short}", lambda scope: f"NOT {one.long(scope)}")
        form = "(IF {} THEN {})" if kind == "IF" else f"({{}} {kind} {{}})"
        return Piece(form.format(one.short, two.short), lambda scope: form.format(one.long(scope), two.long(scope)))

    def quantified(self, kind: str, depth: int, domains: Domains) -> Piece:
        """Copies of a predicate."""
        header, found, values_of = self.parameters(domains)
        body = self.predicate(depth - 1, {**domains, **found})

        def long(scope: Scope) -> str:
            copies = [body.long(inner) for inner in values_of(scope)]
            if kind != "exactly one":
                return joined("AND", copies, "true") if kind == "all" else joined("OR", copies, "false")
            others = [[f"NOT {text}" for m, text in enumerate(copies) if m != n] for n in range(len(copies))]
            return joined("OR", [joined("AND", [copies[n], *others[n]]) for n in range(len(copies))], "false")

        return Piece(f"({kind} {header}: {body.short})", long)

    def comparison(self, domains: Domains) -> Piece:
        """Of a variable with a number, or with another."""
        name, other = self.random.choice("NM"), self.random.choice("NM")
        values, sign = self.numeric[name], self.random.choice(list(COMPARISONS))
        holds = COMPARISONS[sign]
        if self.random.random() < 0.6:
            known = sign in ("=", "!=")
            number = self.number(values if known else range(-3, 14), domains)

            def long(scope: Scope) -> str:
                limit = int(number.long(scope))
                if known:
                    return f"{'NOT ' if sign == '!=' else ''}{name} is {limit}"
                return self.chosen(name, [value for value in values if holds(value, limit)], values)

            return Piece(f"{name} {sign} {number.short}", long)
        parts = []
        for value in values:
            there = [each for each in self.numeric[other] if holds(value, each)]
            text = self.chosen(other, there, self.numeric[other])
            if sign == "!=" and text not in ("true", "false"):
                text = f"NOT {other} is {value}"
            if text != "false":
                parts.append(f"{name} is {value}" if text == "true" else f"({name} is {value} AND {text})")
        whole = joined("OR", parts, "false")
        return Piece(f"{name}{sign}{other}", lambda _: whole)

    def chosen(self, name: str, some: Sequence[Value], values: Sequence[Value]) -> str:
        """That a variable has one of some values: all of them, or none, is a constant."""
        if len(some) == len(values):
            return "true"
        return joined("OR", [f"{name} is {value}" for value in some], "false")

    def word(self, domains: Domains) -> Piece:
        """A variable with words, and one."""
        values, denied = self.words["P"], self.random.choice(("", "", "not "))
        names = [name for name, domain in domains.items() if set(domain) <= set(values)]
        value = self.random.choice([value for value in values if value != "not"])
        long = f"{'NOT ' if denied else ''}P is "
        if names and self.random.random() < 0.7:
            name = self.random.choice(names)
            return Piece(f"P is {denied}{{{name}}}", lambda scope: f"{long}{scope[name]}")
        return Piece(f"P is {denied}{value}", lambda _: long + value)

    def member(self, domains: Domains) -> Piece:
        """A set of values."""
        random = self.random
        name = random.choice("NMPX")
        values = [*map(str, self.numeric.get(name, ())), *self.words.get(name, ()), *self.mixed.get(name, ())]
        some = random.choices(values, k=random.randint(1, 4))
        items = [Piece(text, lambda _, text=text: text) for text in some]  # type: ignore[misc]
        if name == "N":
            items += [self.number(self.numeric["N"], domains)]
        if name in "NX":
            low, high = sorted((int(random.choice(self.numeric["N"])), 0)) if name == "N" else (1, 2)
            items.append(Piece(f"{low - 1}..{high}", lambda _: " ".join(map(str, range(low - 1, high + 1)))))
        denied = random.choice(("", "not "))

        def long(scope: Scope) -> str:
            listed = {each for item in items for each in item.long(scope).split()}
            text = joined("OR", [f"{name} is {value}" for value in values if value in listed])
            return f"NOT {text}" if denied else text

        opening = random.choice(("{", "{ "))
        return Piece(f"{name} {denied}in {opening}{', '.join(item.short for item in items)}}}", long)

    def of_robot(self, domains: Domains) -> Piece:
        """A variable that each robot has."""
        value = self.random.choice(("yes", "no"))
        names = [name for name, domain in domains.items() if set(domain) <= set(self.robots)]
        if names:
            name = self.random.choice(names)
            return Piece(f"D_{{{name}}} is {value}", lambda scope: f"D_{scope[name]} is {value}")
        robot = self.random.choice(self.robots)
        return Piece(f"D_{robot} is {value}", lambda _: f"D_{robot} is {value}")

    # Entries.

    def repeated(self, make: Callable[[Domains], Piece], domains: Domains) -> Piece:
        """An entry, or copies of one or two."""
        if self.random.random() < 0.4 or len(domains) > 3:
            return make(domains)
        header, found, values_of = self.parameters(domains)
        inside = [self.repeated(make, {**domains, **found}) for _ in range(self.random.choice((0, 1, 1, 1, 2)))]
        return Piece(
            f"for {header}\n{' '.join(each.short for each in inside)}\nend for",
            lambda scope: " ".join(each.long(inner) for inner in values_of(scope) for each in inside),
        )

    def rule(self, word: str) -> Callable[[Domains], Piece]:
        """A maker of rules."""

        def make(domains: Domains) -> Piece:
            body = self.predicate(2, domains)
            return Piece(f"{word}: {body.short}", lambda scope: f"{word}: {body.long(scope)}")

        return make

    def goal(self, domains: Domains) -> Piece:
        """A goal, with or without a condition."""
        body, when = self.predicate(1, domains), self.predicate(1, domains)
        form = self.random.choice(
            (
                "goal: {}",
                "when {1} then goal: {0}",
                "when {1} then BEGIN GOALS goal type: constraint goal: {0} END GOALS",
            )
        )
        return Piece(form.format(body.short, when.short), lambda scope: form.format(body.long(scope), when.long(scope)))

    def action(self) -> Piece:
        """An action of each robot, with alternatives of its own."""
        condition = self.predicate(1, {"R": self.robots})
        alternative = self.repeated(lambda domains: self.alternative(), {"R": self.robots})
        head = (
            "action go_{0} controlled resources: MOTOR_{0} preconditions: {1} effects: D_{0} is yes {2} duration: 2\n"
        )
        return Piece(
            f"for R in ROBOTS {head.format('{R}', condition.short, alternative.short)} end for",
            lambda _: "".join(
                head.format(robot, condition.long({"R": robot}), alternative.long({"R": robot}))
                for robot in self.robots
            ),
        )

    def alternative(self) -> Piece:
        """One more outcome."""
        value = self.random.choice(self.numeric["N"])
        text = f"alternative effects: N is {value}, D_{{}} is no"
        return Piece(text.format("{R}"), lambda scope: text.format(scope["R"]))

    def specification(self) -> tuple[str, str]:
        """All blocks."""
        random, robots = self.random, ", ".join(self.robots)
        numbers = self.numeric["N"]
        listed = f"{numbers[0]}..{numbers[-1]}", ", ".join(map(str, numbers))
        common = f"state M can be {', '.join(map(str, self.numeric['M']))} state P can be {', '.join(self.words['P'])}"
        short = f"{common} state N can be {listed[0]} state X can be off, 0..2"
        short += " for R in ROBOTS state D_{R} can be yes, no end for"
        long = f"{common} state N can be {listed[1]} state X can be off, 0, 1, 2 "
        long += " ".join(f"state D_{robot} can be yes, no" for robot in self.robots)
        found = [
            Piece(
                f"BEGIN STATE VECTOR\n{short}\nEND STATE VECTOR\n",
                lambda _: f"BEGIN STATE VECTOR {long} END STATE VECTOR\n",
            )
        ]
        found.append(Piece(f"BEGIN ALIASES define ROBOTS as {{{robots}}} END ALIASES\n", lambda _: ""))
        motors = " ".join(f"resource MOTOR_{robot}" for robot in self.robots)
        copied = f"for R in {robots} resource MOTOR_{{R}} end for"
        blocks = [
            ("RESOURCES", Piece(copied, lambda _: motors)),
            ("ACTIONS", self.action()),
            *((f"{kind} RULES", self.several(self.rule("rule"))) for kind in ("STATE", "REACTION")),
            ("ASSUMPTIONS", self.several(self.rule("assume"))),
            ("START", self.several(self.rule("start"))),
        ]
        for title, piece in random.sample(blocks, len(blocks)):
            form = f"BEGIN {title}\n{{}}\nEND {title}\n"
            found.append(Piece(form.format(piece.short), lambda _, f=form, p=piece: f.format(p.long({}))))  # type: ignore[misc]
        goals = self.several(self.goal)
        form = f"BEGIN GOALS goal type: {random.choice(('priority', 'constraint'))}\n{{}}\nEND GOALS\n"
        found.append(Piece(form.format(goals.short), lambda _: form.format(goals.long({}))))
        return "".join(each.short for each in found), "".join(each.long({}) for each in found)

    def several(self, make: Callable[[Domains], Piece]) -> Piece:
        """Some entries of a block."""
        entries = [self.repeated(make, {}) for _ in range(self.random.randint(0, 3))]
        return Piece(
            "\n".join(each.short for each in entries), lambda scope: "\n".join(each.long(scope) for each in entries)
        )
