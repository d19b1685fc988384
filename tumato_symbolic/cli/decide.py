"""`tumato-sym decide`: ask a policy what to do."""

from __future__ import annotations

import json
import sys

from tumato_symbolic.cli.console import note, write
from tumato_symbolic.cli.exits import NO, USAGE, YES
from tumato_symbolic.cli.parser import Options
from tumato_symbolic.diagnostics import Code, Diagnostic, UserError, render
from tumato_symbolic.policy import Policy, UndecidedState, parse_assignments, parse_state

_LONGEST_LINE = 1_000_000
"""Bytes of one line on the standard input; a state needs a few hundred."""


def run(options: Options) -> int:
    """Answer for one state, or for every line of the standard input."""
    if options.stdin and options.policy == "-":
        raise UserError((Diagnostic(Code.TUM501, "the policy and the states cannot both come from standard input"),))
    policy = Policy.load(options.policy)
    return _answer_lines(policy) if options.stdin else _answer(policy, options.assignments)


def _answer(policy: Policy, words: tuple[str, ...]) -> int:
    try:
        actions = policy.decide(parse_assignments(policy, words))
    except UndecidedState as undecided:
        note(f"tumato-sym: {undecided}")
        return NO
    if actions:
        write("\n".join(actions))
    else:
        note("tumato-sym: nothing is to be done in this state")
    return YES


def _answer_lines(policy: Policy) -> int:
    code = YES
    for number, line in enumerate(iter(lambda: sys.stdin.buffer.readline(_LONGEST_LINE), b""), 1):
        try:
            write(json.dumps(policy.decide(parse_state(policy, line.decode()))))
        except UndecidedState as undecided:
            note(f"tumato-sym: line {number}: {undecided}")
            write("null")
            code = NO
        except (UserError, UnicodeDecodeError) as error:
            problem = render(error.diagnostics, None) if isinstance(error, UserError) else "the line is not UTF-8 text"
            note(f"tumato-sym: line {number} of the standard input:\n{problem}")
            return USAGE
    return code
