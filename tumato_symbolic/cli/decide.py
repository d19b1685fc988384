"""`tumato-sym decide`: ask a policy what to do."""

from __future__ import annotations

import json
from collections.abc import Iterator

from tumato_symbolic.cli.console import need_output, note, write
from tumato_symbolic.cli.exits import NO, YES
from tumato_symbolic.cli.parser import Options
from tumato_symbolic.diagnostics import Code, Diagnostic, UserError
from tumato_symbolic.limits import Context
from tumato_symbolic.policy import Policy, UndecidedState, parse_assignments, parse_state
from tumato_symbolic.syntax.reading import standard_input

_LONGEST_LINE = 1_000_000
"""Bytes of one line on the standard input; a state needs a few hundred."""


def run(options: Options, _: Context) -> int:
    """Answer for one state, or for every line of the standard input."""
    need_output()
    policy = Policy.load(options.policy)
    return _answer_lines(policy) if options.stdin else _answer(policy, options.assignments)


def _answer(policy: Policy, words: tuple[str, ...]) -> int:
    try:
        actions = policy.decide(parse_assignments(policy.vocabulary, words))
    except UndecidedState as undecided:
        note(f"tumato-sym: {undecided}")
        return NO
    if actions:
        write("\n".join(actions))
    else:
        note("tumato-sym: nothing is to be done in this state")
    return YES


def _answer_lines(policy: Policy) -> int:
    """Answer line by line, to the end: one that is no state is answered with what is wrong with it."""
    unanswered = 0
    for number, line in enumerate(_lines(), 1):
        text, problem = _reply(policy, line)
        write(text)
        if problem is not None:
            unanswered += 1
            if unanswered == 1:
                note(f"tumato-sym: line {number}: {problem}")
    if unanswered > 1:
        note(f"tumato-sym: {unanswered:,} lines were not answered with actions; the first of them is named above")
    return NO if unanswered else YES


def _lines() -> Iterator[bytes]:
    """The lines of the standard input; one that is too long is cut. Raises `UserError` where it cannot be read."""
    try:
        stream = standard_input()
        while line := stream.readline(_LONGEST_LINE + 1):
            yield line
            while len(line) > _LONGEST_LINE and not line.endswith(b"\n"):
                line = stream.readline(_LONGEST_LINE + 1)
    except OSError as error:
        message = f"the standard input cannot be read: {error.strerror or error}"
        raise UserError((Diagnostic(Code.TUM101, message),)) from error


def _reply(policy: Policy, line: bytes) -> tuple[str, str | None]:
    """The line that answers a line, and why it names no actions."""
    try:
        if len(line) > _LONGEST_LINE:
            return _error(f"the line is longer than {_LONGEST_LINE:,} bytes")
        return json.dumps(policy.decide(parse_state(policy.vocabulary, line.decode()))), None
    except UndecidedState as undecided:
        return "null", str(undecided)
    except UnicodeDecodeError:
        return _error("the line is not UTF-8 text")
    except UserError as error:
        return _error("; ".join(diagnostic.message for diagnostic in error.diagnostics))


def _error(problem: str) -> tuple[str, str]:
    return json.dumps({"error": problem}), problem
