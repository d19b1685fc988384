"""A list of rules, for a person and for a program."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from tumato_symbolic.diagnostics.wording import quoted
from tumato_symbolic.policy import Rule, RuleList, Vocabulary
from tumato_symbolic.report.layout import count

OTHERWISE = "otherwise"


def as_text(path: str, vocabulary: Vocabulary, found: RuleList, states: int) -> str:
    """The rules with conditions in the syntax of specifications, each with its actions below."""
    rules = found.rules
    decided = f"{path} decides {count(states, 'state')}"
    if not rules and not found.left:
        return f"{decided}: there are no rules."
    values = dict(vocabulary.variables)
    same = f"{count(len(rules), 'rule decides', 'rules decide')} the same"
    if found.left:
        same += f" in {states - found.left:,} of them"
    lines = [f"{decided}; {same}. The first that matches decides.", ""]
    width = len(str(len(rules)))
    for number, rule in enumerate(rules, 1):
        actions = ", ".join(map(_shown, rule.actions)) or "(nothing)"
        lines += [f"{number:>{width}}  {condition(values, rule)}", f"{'':>{width}}    {actions}"]
    return "\n".join((*lines, *_left_out(found)))


def _left_out(found: RuleList) -> list[str]:
    """What was not looked for, and why."""
    if found.limit is None:
        return []
    what = f"{count(found.left, 'state is', 'states are')} left out" if found.left else "no shorter list was looked for"
    return ["", f"{what[0].upper()}{what[1:]}: {found.limit}. --timeout SECONDS allows more."]


def condition(values: Mapping[str, Sequence[str]], rule: Rule) -> str:
    """A rule's condition as a specification would say it; `values` are all values of each variable."""
    parts = [_literal(name, allowed, values[name]) for name, allowed in rule.condition]
    if len(parts) == 1:
        return parts[0].removeprefix("(").removesuffix(")") if parts[0].startswith("(") else parts[0]
    return " AND ".join(parts) or OTHERWISE


def _literal(name: str, allowed: Sequence[str], known: Sequence[str]) -> str:
    excluded = [value for value in known if value not in allowed]
    named = excluded if len(excluded) < len(allowed) else allowed
    text = " OR ".join(f"{_shown(name)} is {_shown(value)}" for value in named)
    text = f"({text})" if len(named) > 1 else text
    return f"NOT {text}" if named is excluded else text


def _shown(name: str) -> str:
    return quoted(name)[1:-1]


def as_json(path: str, found: RuleList, states: int) -> dict[str, object]:
    """The object that `rules --output-format json` prints."""
    listed = [
        {"condition": {name: list(values) for name, values in rule.condition}, "actions": list(rule.actions)}
        for rule in found.rules
    ]
    verdict = "undecided" if found.left else "ok"
    more = {} if found.limit is None else {"left": found.left, "limit": found.limit}
    return {"verdict": verdict, "policy": path, "states": states, "rules": listed, **more}
