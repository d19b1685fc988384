"""`tumato-sym rules`: a policy as a short list of rules."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from tumato_symbolic.cli import arguments
from tumato_symbolic.cli.exits import UNDECIDED, YES
from tumato_symbolic.cli.options import CommandOptions, OutputFormat
from tumato_symbolic.cli.output import show_as
from tumato_symbolic.limits import Context

ABOUT = """\
Show a policy as a short ordered list of rules: the first that matches decides.

The list agrees with the policy in every state that the policy decides; this is checked before it is printed. Only the
policy is needed, and states are not listed: a policy over 10^12 states takes seconds.
"""

EXAMPLES = """\
examples:
  tumato-sym rules policy.json
  tumato-sym rules policy.json --output-format json
"""


@dataclass(frozen=True, slots=True)
class Options(CommandOptions):
    """What may be typed after `rules`."""

    policy: str = arguments.policy()
    timeout: float | None = arguments.timeout("60")
    memory: int | None = arguments.memory()
    output_format: OutputFormat = arguments.output_format("json")

    own_seconds: ClassVar[float | None] = 58.0


def run(options: Options, context: Context) -> int:
    """Print rules that are known to say what the policy says; exit with 3 where they leave out states."""
    from tumato_symbolic.policy import Policy, count_defined, find_rules
    from tumato_symbolic.report import rules

    context.tell(f"reading {options.policy}")
    policy = Policy.load(options.policy)
    context.tell("counting the states")
    states = count_defined(policy)
    found = find_rules(policy, context)
    show_as(
        options,
        text=lambda _: rules.as_text(options.policy, policy.vocabulary, found, states),
        json=lambda: rules.as_json(options.policy, found, states),
    )
    return UNDECIDED if found.left else YES
