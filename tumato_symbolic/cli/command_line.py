"""Reading the command line: help, version, unknown words and what may be meant by them."""

from __future__ import annotations

import argparse
from collections.abc import Iterable, Sequence
from itertools import takewhile
from typing import TYPE_CHECKING, Any, NamedTuple

from tumato_symbolic.cli.commands import COMMANDS, Command, load
from tumato_symbolic.cli.console import write
from tumato_symbolic.cli.options import CommandOptions, add_arguments

if TYPE_CHECKING:
    from _typeshed import SupportsWrite

_EXITS = """\
exit codes:
  0 yes   1 no   2 the input or the command line cannot be used   3 no verdict within the limits
  70 a bug of this program (please report it)   130 interrupted
"""

_ABOUT = """\
From a declarative specification to a robot policy that is proved safe.

A specification says what the robot can be in (state variables), what it can do (actions with nominal and
alternative effects), what must never happen (rules) and what it should reach (goals). `synth` computes what to do in
every valid state, or says why there is no such policy; `verify` proves a policy for all states.
"""

_EXAMPLES = """\
example:
  tumato-sym check amr.tum                   # look for mistakes
  tumato-sym synth amr.tum                   # writes policy.json, proved
  tumato-sym explain robots.tum              # if there is none: why, and possible changes
  tumato-sym verify policy.json amr.tum      # proves it again, independently
  tumato-sym decide policy.json S_Location=corridor S_Battery=low S_Load=free S_Conveyor=off

"""


class CommandLine(NamedTuple):
    """A command line that makes sense: its command, the options, and its words as they were typed."""

    command: Command
    options: CommandOptions
    words: tuple[str, ...]


def parse(words: Sequence[str]) -> CommandLine:
    """Read a command line. Help, version and usage errors end in `SystemExit`, as argparse does.

    Raises `UserError` where help cannot be shown.
    """
    parser = _parser(next((word for word in words if word in COMMANDS), None))
    found: dict[str, Any] = vars(parser.parse_args(words))
    name = found.pop("command")
    command = load(name)
    options = command.Options(**{key: tuple(each) if isinstance(each, list) else each for key, each in found.items()})
    mistake = _mistake(options)
    if mistake is not None:
        parser.error(f"{name}: {mistake}")
    return CommandLine(command, options, tuple(words))


def _mistake(options: CommandOptions) -> str | None:
    """What is wrong with options that can be used one by one."""
    for name, target in options.outputs().items():
        if getattr(options, name) == "":
            return f"{target.option} needs a file name (or - for the standard output)"
    if (mistake := options.mistake()) is not None:
        return mistake
    if options.inputs().count("-") > 1:
        return "only one input can be the standard input"
    return None


class _Parser(argparse.ArgumentParser):
    """A parser that reports help that cannot be written, and says what may be meant by a word that it does not know."""

    def _check_value(self, action: argparse.Action, value: object) -> None:
        """Refuse what is none of the choices of an argument."""
        try:
            super()._check_value(action, value)
        except argparse.ArgumentError as error:
            error.message += _meant(str(value), map(str, action.choices or ()))
            raise

    def print_help(self, file: SupportsWrite[str] | None = None) -> None:
        """Put the help on the standard output. Raises `UserError` where it cannot be."""
        if file is None:
            write(self.format_help())
        else:
            super().print_help(file)


class _CommandParser(_Parser):
    """The parser of one command: its own usage is shown where a word is unknown, not the program's."""

    def parse_known_args(  # type: ignore[override]  # a subset of what argparse overloads, all that subparsers need
        self, args: Sequence[str] | None = None, namespace: argparse.Namespace | None = None
    ) -> tuple[argparse.Namespace, list[str]]:
        """Refuse what is unknown here, before the parser of the program does.

        Where any number of words may stand, argparse takes none after an option; they are taken here.
        """
        found, left = super().parse_known_args(args, namespace)
        several = next((each for each in self._get_positional_actions() if each.nargs == "*"), None)
        if several is not None:
            taken = list(takewhile(lambda word: not word.startswith("-"), left))
            setattr(found, several.dest, [*getattr(found, several.dest), *taken])
            left = left[len(taken) :]
        if left:
            near = _meant(left[0].partition("=")[0], self._option_string_actions)
            self.error(f"unrecognized arguments: {' '.join(left)}{near}")
        return found, []


def _meant(typed: str, known: Iterable[str]) -> str:
    """What may be meant by a word, to be added to a message."""
    from tumato_symbolic.diagnostics.wording import nearest

    near = nearest(typed, known)
    return "" if near is None else f"; did you mean {near}?"


class _Version(argparse.Action):
    """Print the version, which is looked up only now."""

    def __call__(self, parser: argparse.ArgumentParser, *_: object) -> None:
        from tumato_symbolic import __version__

        write(f"tumato-sym {__version__}")
        parser.exit()


class _Help(argparse.RawDescriptionHelpFormatter):
    """Help as Python 3.13 formats it: earlier ones forget that commands are indented, and break their column."""

    def add_argument(self, action: argparse.Action) -> None:
        """Count the indented commands in the width of the first column."""
        super().add_argument(action)
        for command in self._iter_indented_subactions(action):
            width = len(self._format_action_invocation(command)) + self._current_indent
            self._action_max_length = max(self._action_max_length, width)


def _parser(typed: str | None) -> argparse.ArgumentParser:
    """What may be typed. Of the commands, only the one that was typed is loaded, and knows its arguments."""
    parser = _Parser(
        prog="tumato-sym",
        description=_ABOUT,
        epilog=_EXAMPLES + _EXITS,
        formatter_class=_Help,
        allow_abbrev=False,
    )
    parser.add_argument(
        "--version", action=_Version, nargs=0, default=argparse.SUPPRESS, help="show the version and exit"
    )
    commands = parser.add_subparsers(dest="command", metavar="COMMAND", required=True, parser_class=_CommandParser)
    for name, purpose in COMMANDS.items():
        if name != typed:
            commands.add_parser(name, help=purpose)
            continue
        command = load(name)
        known = commands.add_parser(
            name,
            help=purpose,
            description=command.ABOUT,
            epilog=f"{command.EXAMPLES}\n{_EXITS}",
            formatter_class=_Help,
            allow_abbrev=False,
        )
        add_arguments(known, command.Options)
    return parser
