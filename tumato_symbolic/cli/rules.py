"""`tumato-sym rules`: a policy as a short list of rules."""

from __future__ import annotations

from tumato_symbolic.cli.console import write
from tumato_symbolic.cli.exits import UNDECIDED, YES
from tumato_symbolic.cli.parser import Options
from tumato_symbolic.limits import Context
from tumato_symbolic.policy import Policy, count_defined
from tumato_symbolic.policy.rules import find_rules
from tumato_symbolic.report.layout import dump
from tumato_symbolic.report.rules import as_json, as_text


def run(options: Options, context: Context) -> int:
    """Print rules that are known to say what the policy says; exit with 3 where they leave out states."""
    context.tell(f"reading {options.policy}")
    policy = Policy.load(options.policy)
    context.tell("counting the states")
    states = count_defined(policy)
    found = find_rules(policy, context)
    if options.output_format == "json":
        write(dump(as_json(options.policy, found, states)))
    else:
        write(as_text(options.policy, policy.vocabulary, found, states))
    return UNDECIDED if found.left else YES
