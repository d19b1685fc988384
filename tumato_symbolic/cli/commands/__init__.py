"""The commands of `tumato-sym`: one module each, and the table that names them.

A module is imported when its command is typed, for its help as well. It imports the rooms that do its work inside its
functions, so that help, and what is wrong with a command line, are there at once.
"""

from __future__ import annotations

from importlib import import_module
from typing import Any, Final, Protocol, cast

from tumato_symbolic.cli.options import CommandOptions
from tumato_symbolic.limits import Context

COMMANDS: Final = {
    "synth": "compute, prove and write a policy",
    "explain": "why there is no policy, and possible changes",
    "verify": "prove a policy, whatever its origin",
    "export": "write a policy for another tool or language",
    "show": "a policy, or a part of it, as a tree, rules, a table or a graph",
    "diff": "how two policies, or two specifications, differ",
    "decide": "what to do in a state",
    "run": "execute a policy, step by step or many times",
    "report": "a policy as a page for a browser",
    "why": "why a policy decides as it does in a state",
    "sweep": "solve many variants of one specification",
    "check": "look for mistakes in specifications",
    "format": "lay out specifications, and keep their comments",
    "lsp": "serve an editor",
}
"""Every command in the order of the help, with its purpose."""


class Command(Protocol):
    """What the module of a command holds."""

    ABOUT: str
    """What the command does, at the beginning of its help."""

    EXAMPLES: str
    """Command lines to copy, at the end of its help."""

    Options: type[CommandOptions]
    """What may be typed after the command."""

    def run(self, options: Any, context: Context) -> int:  # noqa: ANN401 - `Options` of the module
        """Do the work, print the report, and return the exit code."""

    def stopped(self, known: Any, why: str, options: Any) -> int:  # noqa: ANN401 - what `run` has told its context
        """Report what `run` had learned when it had to end, and return the exit code.

        A command whose `context` learns nothing does without this.
        """


def load(name: str) -> Command:
    """The module of a command."""
    return cast("Command", import_module(f"{__name__}.{name.replace('-', '_')}"))
