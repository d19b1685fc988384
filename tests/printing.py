"""The text of a `Spec` record, in the user's syntax: the other direction of `tumato_symbolic.spec.load`."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from random import Random

from tumato_symbolic.spec import (
    Action,
    And,
    ConditionalGoal,
    Constant,
    Executing,
    Formula,
    Goal,
    GoalList,
    Iff,
    Is,
    Not,
    Or,
    SimpleGoal,
    Spec,
)

Names = Sequence[tuple[str, tuple[str, ...]]]
_LEVELS: dict[type, int] = {Iff: 0, Or: 2, And: 3, Not: 4}


def formula_text(formula: Formula, names: Names, level: int = 0, aliases: Aliases | None = None) -> str:
    """The text of a formula, in parentheses where its operator is looser than `level`.

    The levels are 0 IFONLYIF, 1 IF, 2 OR, 3 AND, 4 NOT, 5 what needs no parentheses ever. Actions are called `act0`,
    `act1`, …; `aliases` may replace any compound part by a name.
    """
    if aliases is not None and (name := aliases.replacement(formula)) is not None:
        return name

    def part(operand: Formula, least: int) -> str:
        return formula_text(operand, names, least, aliases)

    own = _LEVELS.get(type(formula), 5)
    match formula:
        case Constant(value):
            text = "true" if value else "false"
        case Is(variable, value):
            text = f"{names[variable][0]} is {names[variable][1][value]}"
        case Executing(action):
            text = f"executing act{action}"
        case Not(operand):
            text = f"NOT {part(operand, 5)}"
        case And(operands):
            text = " AND ".join(part(operand, 4) for operand in operands)
        case Or((Not(condition), consequence)):
            own, text = 1, f"IF {part(condition, 3)} THEN {part(consequence, 3)}"
        case Or(operands):
            text = " OR ".join(part(operand, 3) for operand in operands)
        case Iff(left, right):
            text = f"{part(left, 2)} IFONLYIF {part(right, 2)}"
    return f"({text})" if own < level else text


class Aliases:
    """Names for some of the compound formulas of a specification, invented while it is printed."""

    def __init__(self, names: Names, random: Random, probability: float) -> None:
        self._names = names
        self._random = random
        self._probability = probability
        self._known: dict[Formula, str] = {}

    def replacement(self, formula: Formula) -> str | None:
        """A name that stands for `formula`, or None where it is to be written out."""
        if formula in self._known:
            return self._known[formula]
        if isinstance(formula, Constant | Is | Executing) or self._random.random() >= self._probability:
            return None
        return self._known.setdefault(formula, f"K_{len(self._known)}")

    def block(self) -> list[str]:
        """The block that defines the names."""
        defined = [f"  define {name} as {formula_text(known, self._names)}" for known, name in self._known.items()]
        return _block("ALIASES", defined) if defined else []


def print_spec(spec: Spec, random: Random, alias_probability: float = 0.0) -> str:
    """A text that means `spec`; its action names must be `act0`, `act1`, …"""
    names = [(variable.name, variable.values) for variable in spec.variables]
    aliases = Aliases(names, random, alias_probability)

    def text(formula: Formula) -> str:
        return formula_text(formula, names, 0, aliases)

    blocks = [
        _block("STATE VECTOR", [f"  state {name} can be {', '.join(values)}" for name, values in names]),
        _block("RESOURCES", [f"  resource {name}" for name in spec.resources]) if spec.resources else [],
        _block("ACTIONS", [line for action in spec.actions for line in _action(spec, action, text, names)]),
        _block("REACTION RULES", [f"  rule: {text(rule.formula)}" for rule in spec.reaction_rules]),
        _block("STATE RULES", list(_state_rules(spec, text))),
        _block("ASSUMPTIONS", [f"  assume: {text(rule.formula)}" for rule in spec.assumptions]),
        _block("START", [f"  start: {text(rule.formula)}" for rule in spec.starts]) if spec.starts else [],
        _goal_list(spec, spec.goals, text, "") if spec.goals is not None else [],
        _config(spec),
    ]
    return "\n".join(line for block in (*blocks[:1], aliases.block(), *blocks[1:]) for line in block) + "\n"


def _block(title: str, lines: list[str]) -> list[str]:
    return [f"BEGIN {title}", *lines, f"END {title}"]


def _state_rules(spec: Spec, text: Callable[[Formula], str]) -> Iterator[str]:
    severity = 1
    for rule in spec.state_rules:
        if rule.severity != severity:
            severity = rule.severity
            yield f"  severity: {severity}"
        yield f"  rule: {text(rule.formula)}"


def _action(spec: Spec, action: Action, text: Callable[[Formula], str], names: Names) -> list[str]:
    lines = [f"  action {action.name}", f"    duration: {action.duration}"]
    if action.resources:
        held = ", ".join(spec.resources[number] for number in sorted(action.resources))
        lines.append(f"    controlled resources: {held}")
    nominal = [formula_text(Is(variable, value), names) for variable, value in action.nominal]
    conditions = [text(rule.formula) for rule in action.preconditions]
    lines.append(f"    preconditions: {', '.join(conditions) or 'none'}")
    lines.append(f"    nominal effects: {', '.join(nominal) or 'none'}")
    lines.extend(f"    alternative effects: {entry.text}" for entry in action.alternatives)
    return lines


def _goal_list(spec: Spec, goals: GoalList, text: Callable[[Formula], str], indent: str) -> list[str]:
    members = [line for member in goals.members for line in _goal(spec, member, text, indent + "  ")]
    return [f"{indent}BEGIN GOALS", f"{indent}  goal type: {goals.kind}", *members, f"{indent}END GOALS"]


def _goal(spec: Spec, goal: Goal, text: Callable[[Formula], str], indent: str) -> list[str]:
    match goal:
        case SimpleGoal(body):
            return [f"{indent}goal: {text(spec.bodies[body].formula)}"]
        case GoalList():
            return _goal_list(spec, goal, text, indent)
        case ConditionalGoal(condition, inner):
            return [f"{indent}when {text(condition.formula)} then", *_goal(spec, inner, text, indent + "  ")]


def _config(spec: Spec) -> list[str]:
    lines = []
    if spec.max_plan_length is not None:
        lines.append(f"  max_plan_length: {spec.max_plan_length}")
    if spec.effect_ordering is not None:
        lines.append(f"  effect_ordering: {spec.effect_ordering}")
    if spec.preconditions != "at_start":
        lines.append(f"  preconditions: {spec.preconditions}")
    if spec.restoration != "one_step":
        lines.append(f"  restoration: {spec.restoration}")
    return _block("CONFIG", lines) if lines else []
