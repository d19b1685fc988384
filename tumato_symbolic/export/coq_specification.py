"""A specification as a record of the theory in `proofs/coq`, in the order of `proofs/coq/Semantics.v`."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from textwrap import indent

from tumato_symbolic.spec import (
    Action,
    Assignment,
    ConditionalGoal,
    Connectives,
    Executing,
    Formula,
    Goal,
    GoalList,
    Is,
    Restoration,
    Rule,
    SimpleGoal,
    Spec,
    fold,
    fold_goal,
)


def specification(spec: Spec) -> Iterator[str]:
    """The record of a specification, in the order of `Semantics.v`."""
    yield "(* Numbers count from 0, as declared. Resources: " + _numbered(spec.resources) + ". Variables:"
    yield from (f"     {number} {v.name}: {_numbered(v.values)}" for number, v in enumerate(spec.variables))
    yield "*)"
    yield "Definition spec : specification := {|"
    yield f"  sizes := {in_brackets(str(len(variable.values)) for variable in spec.variables)};"
    yield from _field("declared", [(f"{number} {a.name}", _action(a)) for number, a in enumerate(spec.actions)])
    yield from _field("reaction_rules", _rules(spec.reaction_rules))
    yield from _tiers(spec)
    yield from _field("assumptions", _rules(spec.assumptions))
    if spec.goals is None:
        yield "  goals := None;"
    else:
        yield "  goals := Some"
        yield f"{indent(_goal(spec, spec.goals), '    ')};"
    bound = spec.max_plan_length
    yield "  max_plan_length := " + ("None" if bound is None else f"Some {bound}%N") + ";"
    yield f"  restored_in := {_RESTORATIONS[spec.restoration]};"
    yield f"  throughout := {'true' if spec.preconditions == 'throughout' else 'false'};"
    yield from _field("starts", _rules(spec.starts))
    yield "  part := fun _ => true"
    yield "|}.\n"


_RESTORATIONS: dict[Restoration, str] = {"one_step": "OneStep", "bounded": "Bounded", "fair": "Fair"}


def _numbered(names: Sequence[str]) -> str:
    return ", ".join(f"{number} {name}" for number, name in enumerate(names)) or "none"


def in_brackets(entries: Iterable[str]) -> str:
    """A list of terms."""
    return f"[{'; '.join(entries)}]"


def _comment(text: str) -> str:
    """A comment of one line; what would end it, or begin another or a string, is broken up."""
    words = text.replace("*", " * ").replace('"', "'").split()
    return f"(* {' '.join(words)} *)"


def _field(name: str, entries: Sequence[tuple[str, str]]) -> Iterator[str]:
    """A field that is a list, every entry under its comment."""
    if not entries:
        yield f"  {name} := [];"
        return
    yield f"  {name} := ["
    yield from _entries(entries)
    yield "  ];"


def _entries(entries: Sequence[tuple[str, str]]) -> Iterator[str]:
    for number, (text, entry) in enumerate(entries, 1):
        yield f"    {_comment(text)}"
        yield f"    {entry}{';' if number < len(entries) else ''}"


def _tiers(spec: Spec) -> Iterator[str]:
    """The state rules, a list for every severity."""
    if not spec.state_rules:
        yield "  state_rules := [];"
        return
    yield "  state_rules := ["
    for number, tier in enumerate(spec.tiers, 1):
        yield f"    (* severity {tier[0].severity} *) ["
        yield from _entries(_rules(tier))
        yield f"    ]{';' if number < len(spec.tiers) else ''}"
    yield "  ];"


def _rules(rules: Iterable[Rule]) -> list[tuple[str, str]]:
    return [(rule.text, _formula(rule.formula)) for rule in rules]


def _formula(formula: Formula) -> str:
    return fold(formula, _atom, _COQ)


def _atom(atom: Is | Executing) -> str:
    return f"Is {atom.variable} {atom.value}" if isinstance(atom, Is) else f"Executing {atom.action}"


_COQ: Connectives[str] = Connectives(
    constant=lambda value: f"Constant {'true' if value else 'false'}",
    negation=lambda text: f"Not ({text})",
    conjunction=lambda texts: f"And {in_brackets(texts)}",
    disjunction=lambda texts: f"Or {in_brackets(texts)}",
    equivalence=lambda left, right: f"Iff ({left}) ({right})",
)


def _action(action: Action) -> str:
    alternatives = (_assignment(outcome) for entry in action.alternatives for outcome in entry.outcomes)
    return (
        f"{{| duration := {action.duration}%N; resources := {in_brackets(map(str, sorted(action.resources)))};\n"
        f"       preconditions := {in_brackets(_formula(rule.formula) for rule in action.preconditions)};\n"
        f"       guard := {in_brackets([] if action.guard is None else [_formula(action.guard.formula)])};\n"
        f"       nominal := {_assignment(action.nominal)};\n"
        f"       alternatives := {in_brackets(alternatives)} |}}"
    )


def _assignment(assignment: Assignment) -> str:
    return in_brackets(f"({variable}, {value})" for variable, value in assignment)


def _goal(spec: Spec, goal: Goal) -> str:
    def simple(goal: SimpleGoal) -> str:
        body = spec.as_written(goal)
        return f"{_comment('goal: ' + body.text)}\n(Simple ({_formula(body.formula)}))"

    def conditional(goal: ConditionalGoal, inner: str) -> str:
        condition = goal.condition
        return f"{_comment('when ' + condition.text)}\n(When ({_formula(condition.formula)})\n{indent(inner, '  ')})"

    def several(goal: GoalList, members: list[str]) -> str:
        inside = indent(";\n".join(members), "  ")
        return f"(Goals {goal.kind.capitalize()} [\n{inside}])"

    return fold_goal(goal, simple, conditional, several)
