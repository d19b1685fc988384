"""Tree to `Spec`: every name resolved, every alias expanded, every effect normalised."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Final

from msgspec import Struct
from msgspec.structs import replace

from tumato_symbolic.diagnostics import Code, Diagnostic, Note, Source, Span
from tumato_symbolic.diagnostics.wording import quoted
from tumato_symbolic.spec.actions import Actions
from tumato_symbolic.spec.by_action import executing_cases
from tumato_symbolic.spec.collector import Findings
from tumato_symbolic.spec.formula import Formula
from tumato_symbolic.spec.names import Names, collect
from tumato_symbolic.spec.predicates import Predicates
from tumato_symbolic.spec.specification import ConditionalGoal, Goal, GoalList, Rule, SimpleGoal, Spec
from tumato_symbolic.syntax import Parsed, ast
from tumato_symbolic.syntax.excerpts import Excerpts

MAX_PLAN_LENGTH = 1_000_000_000
"""The largest plan bound, and the largest severity."""

_TITLES = {
    ast.StateVector: "STATE VECTOR",
    ast.Aliases: "ALIASES",
    ast.Resources: "RESOURCES",
    ast.Actions: "ACTIONS",
    ast.ReactionRules: "REACTION RULES",
    ast.StateRules: "STATE RULES",
    ast.Assumptions: "ASSUMPTIONS",
    ast.Start: "START",
    ast.Goals: "GOALS",
    ast.Config: "CONFIG",
}


class Resolution(Struct, frozen=True):
    """A specification, None where there is a mistake, what was found, and what lint needs to know beside it."""

    spec: Spec | None
    diagnostics: tuple[Diagnostic, ...]
    names: Names
    used_aliases: frozenset[int]
    used_variables: frozenset[int]


def resolve(parsed: Parsed, tree: ast.Specification, source: Source, findings: Findings) -> Resolution:
    """Resolve what was parsed, copies written out.

    After a mistake in the syntax, what the lost text may have declared is not missed.
    """
    _once_each(tree, findings)
    names = collect(tree, findings)
    if not names.variables and not parsed.lost:
        _no_state_vector(tree, findings)
    predicates = Predicates(names, Excerpts(source), findings, parsed.lost)
    resolver = Actions(names, predicates, Excerpts(source), findings)
    unfinished = resolver.resolve()
    reaction_rules = _rules(predicates, _of(tree, ast.ReactionRules), None)
    state_rules = _state_rules(predicates, _of(tree, ast.StateRules), findings)
    assumptions = _rules(predicates, _of(tree, ast.Assumptions), "an assumption")
    starts = _rules(predicates, _of(tree, ast.Start), "a start condition")
    goals = _Goals(predicates)
    goal_list = goals.outermost(_of(tree, ast.Goals))
    settings = _settings(tree, findings)
    actions = resolver.cases(unfinished, assumptions)
    errors = bool(parsed.diagnostics) or any(each.severity == "error" for each in findings.diagnostics)
    spec = None
    if not errors:
        spec = Spec(
            names.variables,
            tuple(each.name.text for each in names.resources),
            actions,
            reaction_rules,
            state_rules,
            assumptions,
            goal_list,
            tuple(goals.bodies.values()),
            None,
            None,
            starts=starts,
        )
        if spec.has_cases:
            spec = executing_cases(spec)
        for setting in settings:
            spec = _with_setting(spec, setting)
    used_aliases, used_variables = frozenset(predicates.used_aliases), frozenset(predicates.used_variables)
    return Resolution(spec, tuple(findings.diagnostics), names, used_aliases, used_variables)


def _of(tree: ast.Specification, kind: type[ast.Block]) -> list[ast.Block]:
    return [block for block in tree.blocks if isinstance(block, kind)]


def _once_each(tree: ast.Specification, findings: Findings) -> None:
    first: dict[str, Span] = {}
    for block in tree.blocks:
        title = _TITLES[type(block)]
        if title in first:
            findings.add(
                Code.TUM302,
                f"the block {quoted(title)} is repeated",
                heading(block.span, title),
                "join the two blocks into one",
                (Note("the first one begins here", heading(first[title], title)),),
            )
        first.setdefault(title, block.span)


def heading(block: Span, title: str) -> Span:
    """The span of `BEGIN TITLE`, as it is usually written."""
    return Span(block.line, block.column, block.line, block.column + len(f"BEGIN {title}"))


def _no_state_vector(tree: ast.Specification, findings: Findings) -> None:
    if not tree.blocks:
        findings.add(Code.TUM301, "the specification is empty", Span(1, 1, 1, 1), _STATE_VECTOR)
        return
    block = next(iter(_of(tree, ast.StateVector)), None)
    findings.add(
        Code.TUM301,
        "the STATE VECTOR declares no state variable" if block else "there is no STATE VECTOR block",
        heading(block.span, "STATE VECTOR") if block else Span(1, 1, 1, 1),
        _STATE_VECTOR,
    )


_STATE_VECTOR = "a specification needs `BEGIN STATE VECTOR`, `state NAME can be VALUE, VALUE`, `END STATE VECTOR`"


def _rules(predicates: Predicates, blocks: Iterable[ast.Block], no_executing_in: str | None) -> tuple[Rule, ...]:
    found: list[Rule | None] = []
    for block in blocks:
        match block:
            case ast.ReactionRules(rules) | ast.Assumptions(rules) | ast.Start(rules):
                written: Iterator[ast.Predicate] = ast.one_by_one(rules)
                found.extend(predicates.rule(each, no_executing_in) for each in written)
            case _:
                pass
    return tuple(rule for rule in found if rule is not None)


def _state_rules(predicates: Predicates, blocks: Iterable[ast.Block], findings: Findings) -> tuple[Rule, ...]:
    found: list[Rule] = []
    for block in (each for each in blocks if isinstance(each, ast.StateRules)):
        severity = 1
        entries: Iterator[ast.Predicate | ast.Severity] = ast.one_by_one(block.rules)
        for each in entries:
            if isinstance(each, ast.Severity):
                severity = ast.number(each.value)
                _check_number("severity", each, "1 is the most severe; only the order of the numbers counts", findings)
                continue
            rule = predicates.rule(each, "a state rule")
            if rule is not None:
                found.append(replace(rule, severity=severity))
    return tuple(found)


class _Goals:
    """The tree of goals, its bodies numbered, each structure once."""

    def __init__(self, predicates: Predicates) -> None:
        self._predicates = predicates
        self._numbers: dict[Formula, int] = {}
        self.bodies: dict[int, Rule] = {}

    def outermost(self, blocks: Iterable[ast.Block]) -> GoalList | None:
        """The goal block; None where there is no goal in it."""
        lists = [self._goal(block.goals) for block in blocks if isinstance(block, ast.Goals)]
        first = next(iter(lists), None)
        return first if isinstance(first, GoalList) and first.members else None

    def _goal(self, goal: ast.Goal) -> Goal | None:
        match goal:
            case ast.SimpleGoal(predicate, span=span):
                body = self._predicates.rule(predicate, None)
                if body is None:
                    return None
                number = self._numbers.setdefault(body.formula, len(self._numbers))
                self.bodies.setdefault(number, body)
                return SimpleGoal(number, body.text, span)
            case ast.ConditionalGoal(predicate, inner, span=span):
                condition = self._predicates.rule(predicate, "the condition of a goal")
                found = self._goal(inner)
                if condition is None or found is None or isinstance(found, ConditionalGoal):
                    return None
                return ConditionalGoal(condition, found, span)
            case ast.GoalList(kind, members, span=span):
                goals: Iterator[ast.Goal] = ast.one_by_one(members)
                parts = [self._goal(each) for each in goals]
                return GoalList(kind or "constraint", tuple(each for each in parts if each is not None), span)


SETTINGS: Final[dict[type[ast.Setting], str]] = {
    ast.MaxPlanLength: "max_plan_length",
    ast.EffectOrdering: "effect_ordering",
    ast.Restoration: "restoration",
    ast.PreconditionsHold: "preconditions",
}
"""What the lines of CONFIG are called."""


def _with_setting(spec: Spec, setting: ast.Setting) -> Spec:
    match setting:
        case ast.MaxPlanLength(value, span=span):
            return replace(spec, max_plan_length=ast.number(value), bound_span=span)
        case ast.EffectOrdering(value):
            return replace(spec, effect_ordering=value)
        case ast.Restoration(value):
            return replace(spec, restoration=value)
        case ast.PreconditionsHold(value):
            return replace(spec, preconditions=value)


def _settings(tree: ast.Specification, findings: Findings) -> list[ast.Setting]:
    """What CONFIG says, each setting once."""
    found: dict[type[ast.Setting], ast.Setting] = {}
    for block in (each for each in tree.blocks if isinstance(each, ast.Config)):
        settings: Iterator[ast.Setting] = ast.one_by_one(block.settings)
        for setting in settings:
            name, first = SETTINGS[type(setting)], found.setdefault(type(setting), setting)
            if first is not setting:
                notes = (Note("it is set first here", first.span),)
                findings.add(Code.TUM303, f"`{name}` is set twice", setting.span, "remove one", notes)
            elif isinstance(setting, ast.MaxPlanLength):
                help_ = "a plan has one step or more; leave the setting out for plans of any length"
                _check_number(name, setting, help_, findings)
    return list(found.values())


def _check_number(name: str, setting: ast.MaxPlanLength | ast.Severity, help_: str, findings: Findings) -> None:
    if not 1 <= ast.number(setting.value) <= MAX_PLAN_LENGTH:
        message = f"`{name}` is {setting.value}; it has to be from 1 to {MAX_PLAN_LENGTH:,}"
        findings.add(Code.TUM310, message, setting.span, help_)
