"""Pages for a browser, of a policy or of a specification without one: what `report` and `synth --html` write."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tumato_symbolic.cli.console import write_to
from tumato_symbolic.diagnostics import Code, Source, UserError
from tumato_symbolic.limits import Context, LimitReachedError
from tumato_symbolic.policy import RuleList, find_rules
from tumato_symbolic.report.explained import Explained
from tumato_symbolic.report.html.contents import NoPolicyPage, PolicyPage
from tumato_symbolic.report.html.page import page

if TYPE_CHECKING:
    from tumato_symbolic.policy import Policy
    from tumato_symbolic.spec import Ordering, Spec

RULES_SECONDS = 20.0
"""Seconds in which a short list of rules is looked for, for a page."""

EXPLAIN_SECONDS = 30.0
"""Seconds in which it is looked for why there is no policy, for a page."""


def rules_of(policy: Policy, context: Context) -> RuleList | str:
    """The policy as rules; why there are none, where there are none in time, or none that is short enough to read."""
    try:
        return find_rules(policy, context.within(RULES_SECONDS))
    except LimitReachedError as limit:
        context.check()
        return str(limit)
    except UserError as error:
        if error.diagnostics[0].code is not Code.TUM508:
            raise
        return error.diagnostics[0].message


def why_none(source: Source, spec: Spec, ordering: Ordering, context: Context) -> Explained:
    """Why there is no policy, as far as that is found out in time."""
    from tumato_symbolic.explain.explain import explain

    found = explain(spec, ordering, context=context.within(EXPLAIN_SECONDS))
    return Explained(source, spec, found, (), None, every_cube=False)


def write_page(of: PolicyPage | NoPolicyPage, output: str, context: Context) -> None:
    """Write a page to a file; `-` is the standard output."""
    context.tell("putting the page together")
    text = page(of)
    context.check()
    write_to(output, text, "page")
