"""Generated specifications with clauses and relative effects, and the same without any."""

from __future__ import annotations

import re
from itertools import product
from random import Random

from msgspec import Struct
from msgspec.structs import replace

from tests.generate import denoted, random_spec
from tests.printing import formula_text, print_spec
from tests.profiles import ALL_PROFILES
from tumato_symbolic.semantics import all_states, holds, is_valid
from tumato_symbolic.spec import Action, And, Formula, Is, Not, Or, Restoration, Spec, variables_of

RESTORATIONS: tuple[Restoration, ...] = ("one_step", "bounded", "fair")
_VALUE = re.compile(r"\bv(\d+)\b")


class Change(Struct, frozen=True):
    """A relative effect."""

    variable: int
    step: int


class Clause(Struct, frozen=True):
    """Effects under a condition; None: before all clauses."""

    condition: Formula | None
    effects: tuple[Formula | Change, ...]


ClauseSet = tuple[Clause, ...]


class Pair(Struct, frozen=True):
    """A text with clauses, the same without (None where effects disagree in some state), and the names of actions.

    `action_of` has the name of the action for each action of the text that is written out.
    """

    text: str
    written_out: str | None
    action_of: dict[str, str]


def random_pair(seed: int) -> Pair:
    """The pair of a seed."""
    random = Random(f"clauses {seed}")
    profile = random.choice([name for name in ALL_PROFILES if name not in ("large", "wide")])
    spec = random_spec(random.randrange(10**6), ALL_PROFILES[profile])
    spec = replace(spec, restoration=random.choice(RESTORATIONS), preconditions="at_start")
    if random.random() < 0.2:
        rules = (replace(rule, severity=random.choice((1, 2))) for rule in spec.state_rules)
        spec = replace(spec, state_rules=tuple(rules))
    chosen = [number for number in range(len(spec.actions)) if random.random() < 0.6] or [0]
    sets = {number: _sets(spec, number, random) for number in chosen}
    text, (written_out, action_of) = _text(spec, sets, random), _written_out(spec, sets)
    starts = _starts(spec, random) if random.random() < 0.3 else ""
    return Pair(text + starts, written_out and written_out + starts, action_of)


def _starts(spec: Spec, random: Random) -> str:
    """A block of starts, of which one valid state at least is one."""
    state = random.choice([state for state in all_states(spec) if is_valid(spec, state)])
    places = random.sample(range(len(state)), random.randint(1, len(state)))
    names = [(variable.name, variable.values) for variable in spec.variables]
    text = formula_text(And(tuple(Is(place, state[place]) for place in places)), names)
    return _VALUE.sub(r"\1", f"\nBEGIN START\n  start: {text}\nEND START\n")


def _sets(spec: Spec, number: int, random: Random) -> list[ClauseSet]:
    """The sets of effects of an action: the nominal one, and alternatives."""
    maker = _Maker(spec, random)
    sets = [maker.clauses([Is(variable, value) for variable, value in spec.actions[number].nominal])]
    return sets + [maker.clauses([]) for _ in range(random.choice((0, 0, 0, 1, 1, 2)))]


class _Maker:
    """Draws clauses."""

    def __init__(self, spec: Spec, random: Random) -> None:
        self.spec, self.random = spec, random

    def _atom(self, variables: list[int]) -> Is:
        variable = self.random.choice(variables)
        return Is(variable, self.random.randrange(len(self.spec.variables[variable].values)))

    def _condition(self) -> Formula:
        everything = list(range(len(self.spec.variables)))
        atom, other = self._atom(everything), self._atom(everything)
        return self.random.choice((atom, atom, Not(atom), And((atom, other)), Or((atom, Not(other)))))

    def _effect(self, variables: list[int]) -> Formula | Change:
        variable = self.random.choice(variables)
        if self.random.random() < 0.4:
            return Change(variable, self.random.choice((-2, -1, -1, 1, 1, 2)))
        return self._atom([variable])

    def clauses(self, base: list[Is]) -> ClauseSet:
        """A set; its clauses mostly write other variables than what stands before them."""
        random = self.random
        mentioned = {each.variable for each in base}
        free = [n for n in range(len(self.spec.variables)) if n not in mentioned] or [0]
        first: list[Formula | Change] = list(base)
        if random.random() < 0.35:
            changed = random.choice(free)
            first.append(Change(changed, random.choice((-1, 1))))
            free = [n for n in free if n != changed] or free
        found = [Clause(None, tuple(first))]
        split = self._condition()
        for number in range(random.choice((0, 1, 1, 2, 2, 3))):
            condition = (split, Not(split), And((self._condition(), Not(split))))[number]
            effects = tuple(self._effect(free) for _ in range(random.choice((0, 1, 1, 1, 2))))
            found.append(Clause(condition, tuple({getattr(e, "variable", e): e for e in effects}.values())))
        return tuple(found)


def _text(spec: Spec, sets: dict[int, list[ClauseSet]], random: Random) -> str:
    names = [(variable.name, variable.values) for variable in spec.variables]

    def effect(each: Formula | Change) -> str:
        if isinstance(each, Change):
            name, sign = spec.variables[each.variable].name, "+" if each.step > 0 else "-"
            return f"{name} is {name} {sign} {abs(each.step)}"
        return formula_text(each, names)

    def lines(title: str, clauses: ClauseSet) -> list[str]:
        found = []
        for clause in clauses:
            effects = ", ".join(map(effect, clause.effects)) or "none"
            condition = "" if clause.condition is None else formula_text(clause.condition, names)
            found.append(f"{title} {effects}" if clause.condition is None else f"  when {condition}: {effects}")
        return found

    written: list[str] = []
    action = -1
    for line in print_spec(spec, random).split("\n"):
        action += line.startswith("  action ")
        if action in sets and line.startswith("    nominal effects:"):
            nominal, *others = sets[action]
            written += lines("    nominal effects:", nominal)
            for each in others:
                written += lines("    alternative effects:", each)
        elif not (action in sets and line.startswith("    alternative effects:")):
            written.append(line)
    return _VALUE.sub(r"\1", "\n".join(written))


def _written_out(spec: Spec, sets: dict[int, list[ClauseSet]]) -> tuple[str | None, dict[str, str]]:
    """One action for each combination of values on which the effects of an action depend."""
    names = [(variable.name, variable.values) for variable in spec.variables]
    sizes = [len(variable.values) for variable in spec.variables]
    actions: list[tuple[str, list[str]]] = []
    several: dict[int, list[str]] = {}
    valid = [state for state in all_states(spec) if is_valid(spec, state)]
    for number, action in enumerate(spec.actions):
        if number not in sets:
            actions.append((action.name, []))
            several[number] = [action.name]
            continue
        places = sorted(_places(sets[number]))
        several[number] = []
        for values in product(*(range(sizes[place]) for place in places)):
            here = [Is(place, value) for place, value in zip(places, values, strict=True)]
            found = [_outcomes(clauses, dict(zip(places, values, strict=True)), sizes) for clauses in sets[number]]
            if len(found[0]) != 1 or not all(found):
                rules = [*(rule.formula for rule in action.preconditions), *here]
                if any(all(holds(rule, state) for rule in rules) for state in valid):
                    return None, {}
                continue
            name = f"{action.name}__{'_'.join(map(str, values))}"
            several[number].append(name)
            lines = [f"    preconditions: {', '.join(formula_text(each, names) for each in _guarded(action, here))}"]
            lines += [f"    nominal effects: {_assigned(found[0][0], names)}"]
            for outcomes in found[1:]:
                lines += [f"    alternative effects: {_assigned(outcome, names)}" for outcome in outcomes]
            actions.append((name, lines))
        if not several[number]:  # its preconditions hold nowhere
            several[number] = [f"{action.name}__"]
            conditions = ", ".join(formula_text(rule.formula, names) for rule in action.preconditions)
            actions.append((several[number][0], [f"    preconditions: {conditions}", "    nominal effects: none"]))
    text = _with_actions(print_spec(spec, Random(0)), spec, actions, several)
    return _VALUE.sub(r"\1", text), {name: f"act{number}" for number, found in several.items() for name in found}


def _guarded(action: Action, here: list[Is]) -> list[Formula]:
    return [*(rule.formula for rule in action.preconditions), *here] or [Or((Is(0, 0), Not(Is(0, 0))))]


def _places(sets: list[ClauseSet]) -> set[int]:
    clauses = [clause for each in sets for clause in each]
    changed = {e.variable for clause in clauses for e in clause.effects if isinstance(e, Change)}
    conditions = (clause.condition for clause in clauses if clause.condition is not None)
    return changed.union(*map(variables_of, conditions))


def _outcomes(clauses: ClauseSet, here: dict[int, int], sizes: list[int]) -> list[tuple[tuple[int, int], ...]]:
    state = tuple(here.get(place, 0) for place in range(len(sizes)))
    parts: list[Formula] = []
    for clause in clauses:
        for effect in clause.effects if clause.condition is None or holds(clause.condition, state) else ():
            if isinstance(effect, Change):
                value = min(max(state[effect.variable] + effect.step, 0), sizes[effect.variable] - 1)
                parts.append(Is(effect.variable, value))
            else:
                parts.append(effect)
    return list(denoted(parts, sizes))


def _assigned(outcome: tuple[tuple[int, int], ...], names: list[tuple[str, tuple[str, ...]]]) -> str:
    return ", ".join(formula_text(Is(variable, value), names) for variable, value in outcome) or "none"


def _with_actions(text: str, spec: Spec, actions: list[tuple[str, list[str]]], several: dict[int, list[str]]) -> str:
    head, rest = text.split("BEGIN ACTIONS\n")
    body, tail = rest.split("END ACTIONS\n")
    blocks = [f"  action {block}" for block in body.split("  action ")[1:]]
    by_name = {f"act{number}": block for number, block in enumerate(blocks)}
    written = []
    for name, lines in actions:
        block = by_name[name.split("__")[0]].split("\n")
        kept = [line for line in block if not lines or re.match(r"    (duration|controlled)", line)]
        written += [f"  action {name}", *(kept if lines else kept[1:]), *lines]

    def executing(found: re.Match[str]) -> str:
        return "(" + " OR ".join(f"executing {each}" for each in several[int(found[1])]) + ")"

    rules = re.sub(r"executing act(\d+)", executing, tail)
    return f"{head}BEGIN ACTIONS\n" + "\n".join(line for line in written if line) + f"\nEND ACTIONS\n{rules}"
