"""`tumato-sym decide`: ask a policy what to do."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import TYPE_CHECKING, ClassVar

from tumato_symbolic.cli import arguments
from tumato_symbolic.cli.console import need_output, note, write
from tumato_symbolic.cli.exits import NO, YES
from tumato_symbolic.cli.options import CommandOptions, argument
from tumato_symbolic.diagnostics import Code, Diagnostic, UserError
from tumato_symbolic.limits import Context

if TYPE_CHECKING:
    from tumato_symbolic.policy import Policy

ABOUT = """\
Ask a policy what to do in a state: one action a line, nothing where nothing is to be done.

With --stdin, read one JSON object per line and answer each with one JSON list on a line of its own: null where the
policy says nothing about the state, {"error": "..."} where the line is no state. Every line is answered; the exit code
is 1 where one of them was not answered with a list.
"""

EXAMPLES = """\
examples:
  tumato-sym decide policy.json S_Location=corridor S_Battery=low S_Load=free S_Conveyor=off
  echo '{"S_Location": "corridor", "S_Battery": "low", "S_Load": "free", "S_Conveyor": "off"}' \\
    | tumato-sym decide policy.json --stdin
"""


_LONGEST_LINE = 1_000_000
"""Bytes of one line on the standard input; a state needs a few hundred."""


class Options(CommandOptions, frozen=True):
    """What may be typed after `decide`."""

    policy: str = arguments.policy()
    assignments: tuple[str, ...] = arguments.state("*")
    stdin: bool = argument(
        "--stdin", action="store_true", help="read states from the standard input, one JSON object a line"
    )

    may_take_long: ClassVar[bool] = False

    def inputs(self) -> list[str]:
        """The policy, and the states where they are read as well."""
        return [self.policy, *(["-"] if self.stdin else [])]

    def mistake(self) -> str | None:
        """States come from one place."""
        if self.stdin != bool(self.assignments):
            return None
        what = "not both" if self.stdin else "or --stdin"
        return f"give the state as VAR=VALUE …, {what} (see tumato-sym decide --help)"


def run(options: Options, _: Context) -> int:
    """Answer for one state, or for every line of the standard input."""
    from tumato_symbolic.policy import Policy

    need_output()
    policy = Policy.load(options.policy)
    return _answer_lines(policy) if options.stdin else _answer(policy, options.assignments)


def _answer(policy: Policy, words: tuple[str, ...]) -> int:
    from tumato_symbolic.policy import UndecidedState, parse_assignments

    try:
        actions = policy.decide(parse_assignments(policy.vocabulary, words))
    except UndecidedState as undecided:
        note(f"tumato-sym: {undecided}")
        return NO
    if actions:
        write("\n".join(actions))
    else:
        note("tumato-sym: do nothing in this state")
    return YES


def _answer_lines(policy: Policy) -> int:
    """Answer line by line, to the end: one that is no state is answered with what is wrong with it."""
    unanswered = 0
    for number, (text, problem) in enumerate(_replies(policy), 1):
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
    from tumato_symbolic.syntax.reading import standard_input

    try:
        stream = standard_input()
        while line := stream.readline(_LONGEST_LINE + 1):
            yield line
            while len(line) > _LONGEST_LINE and not line.endswith(b"\n"):
                line = stream.readline(_LONGEST_LINE + 1)
    except OSError as error:
        message = f"the standard input cannot be read: {error.strerror or error}"
        raise UserError((Diagnostic(Code.TUM101, message),)) from error


def _replies(policy: Policy) -> Iterator[tuple[str, str | None]]:
    """For every line the one that answers it, and why it names no actions."""
    from tumato_symbolic.policy import UndecidedState, parse_state

    def reply(line: bytes) -> tuple[str, str | None]:
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

    return map(reply, _lines())


def _error(problem: str) -> tuple[str, str]:
    return json.dumps({"error": problem}), problem
