"""A policy as the output of a cell: its rules."""

from __future__ import annotations

from tumato_symbolic.diagnostics import UserError
from tumato_symbolic.diagnostics.cubes import actions_text, named_cube_text
from tumato_symbolic.diagnostics.wording import count
from tumato_symbolic.limits import Context, LimitReachedError, Limits
from tumato_symbolic.notebook.markup import panel, table
from tumato_symbolic.policy import Policy, count_defined, find_rules

_MOST_RULES = 40
"""So many rules are shown."""

_SECONDS = 2.0
"""How long rules are looked for while someone waits for the output of a cell."""


def policy_html(policy: Policy) -> str:
    """How many states a policy decides, and by which rules."""
    return panel("plain", f"Policy: {count(count_defined(policy), 'state')} decided", body=rules_html(policy))


def rules_html(policy: Policy) -> str:
    """The rules of a policy, as many as are read at a glance, and what was left out, and why."""
    try:
        found = find_rules(policy, Context(Limits(seconds=_SECONDS)))
    except UserError as error:
        return panel("plain", "No rules", (each.message for each in error.diagnostics))
    except LimitReachedError as reached:
        return panel("doubt", "No rules", (f"{reached}.",))
    known, shown = dict(policy.vocabulary.variables), found.rules[:_MOST_RULES]
    rows = (
        (str(number), named_cube_text(known, rule.condition, " AND ") or "otherwise", actions_text(rule.actions))
        for number, rule in enumerate(shown, 1)
    )
    rules = table(("", "the first that matches decides", "actions"), rows) if shown else ""
    left = []
    if len(found.rules) > len(shown):
        left.append(
            f"{count(len(found.rules) - len(shown), 'more rule')}: tumato_symbolic.policy.minimal_rules(policy)"
        )
    if found.left:
        left.append(f"{count(found.left, 'state is', 'states are')} left out: {found.limit}.")
    return rules + (panel("doubt", "Not all is shown", left) if left else "")
