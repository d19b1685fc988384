"""`tumato-sym rules`: a policy as a short list of rules."""

from __future__ import annotations

from tumato_symbolic.cli.console import write
from tumato_symbolic.cli.exits import YES
from tumato_symbolic.cli.parser import Options
from tumato_symbolic.policy import Policy, count_defined
from tumato_symbolic.policy.rules import minimal_rules
from tumato_symbolic.report.layout import dump
from tumato_symbolic.report.rules import as_json, as_text


def run(options: Options) -> int:
    """Print the rules of a policy, which are known to say what it says."""
    policy = Policy.load(options.policy)
    rules, states = minimal_rules(policy), count_defined(policy)
    if options.output_format == "json":
        write(dump(as_json(options.policy, rules, states)))
    else:
        write(as_text(options.policy, policy.vocabulary, rules, states))
    return YES
