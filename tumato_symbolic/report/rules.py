"""A list of rules, for a person and for a program."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

from tumato_symbolic.diagnostics.cubes import actions_text, named_cube_text
from tumato_symbolic.report.cubes import named_json
from tumato_symbolic.report.layout import count
from tumato_symbolic.views import OTHER

if TYPE_CHECKING:
    from tumato_symbolic.policy import Rule, RuleList

OTHERWISE = "otherwise"

SOMETHING_ELSE = "–"
"""Stands for the decisions that are not looked at."""


def rule_lines(values: Mapping[str, Sequence[str]], found: RuleList, states: int) -> Iterator[str]:
    """The rules that decide so many states, with conditions in the syntax of specifications, each with its actions
    below; `values` are all values of each variable.
    """
    rules = found.rules
    same = f"{count(len(rules), 'rule decides', 'rules decide')} the same"
    if found.left:
        same += f" in {states - found.left:,} of them"
    yield f"{same}. The first that matches decides."
    yield ""
    width = len(str(len(rules)))
    for number, rule in enumerate(rules, 1):
        yield f"{number:>{width}}  {condition(values, rule)}"
        yield f"{'':>{width}}    {SOMETHING_ELSE if OTHER in rule.actions else actions_text(rule.actions)}"
    yield from _left_out(found)


def _left_out(found: RuleList) -> list[str]:
    """What was not looked for, and why."""
    if found.limit is None:
        return []
    what = f"{count(found.left, 'state is', 'states are')} left out" if found.left else "no shorter list was looked for"
    return ["", f"{what[0].upper()}{what[1:]}: {found.limit}. --timeout SECONDS allows more."]


def condition(values: Mapping[str, Sequence[str]], rule: Rule) -> str:
    """A rule's condition as a specification would say it; `values` are all values of each variable."""
    return named_cube_text(values, rule.condition, " AND ") or OTHERWISE


def rules_json(found: RuleList) -> dict[str, object]:
    """The rules for a program, and what was left out; `actions` are null where something else is done."""
    listed = [
        {
            "condition": named_json(rule.condition),
            "actions": None if OTHER in rule.actions else list(rule.actions),
        }
        for rule in found.rules
    ]
    more = {} if found.limit is None else {"left": found.left, "limit": found.limit}
    return {"rules": listed, **more}
