"""The options of a command: a record whose fields say how they are typed, and which files it writes."""

from __future__ import annotations

import argparse
import os
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any, ClassVar, Literal, NamedTuple

from msgspec import Struct

OutputFormat = Literal["text", "json", "github", "sarif"]

STANDARD_OUTPUT = "-"


class Target(NamedTuple):
    """A file that a command may write: what is written there, the option that names it, and its name."""

    what: str
    option: str = "-o"
    example: str = "policy.json"
    path: str = ""


class Argument(Struct, frozen=True, eq=False):
    """How a field is typed: what `argparse` is told of it. Without flags, it is typed by its place.

    `writes` says what is written to the file that the field names.
    """

    flags: tuple[str, ...]
    settings: dict[str, Any]
    writes: Target | None


MINUTE = 58.0
"""Seconds that a command may take which promises an answer in a minute, with what comes before and after."""

_LARGE = 200_000
"""Bytes of specifications that take a second or so to read."""


def are_large(paths: Iterable[str]) -> bool:
    """Whether there is much to read in files."""
    return sum(Path(path).stat().st_size for path in paths if Path(path).is_file()) > _LARGE


class CommandOptions(Struct, frozen=True):
    """What was typed after a command. A command's own record extends this one, and says so where it differs.

    Its fields are made by `argument`, in the order in which the help shows them; one of a name that is known here
    takes the place of the default here.
    """

    reports_interruption: ClassVar[bool] = False
    """Whether what is known is reported after Ctrl-C as well."""

    @property
    def own_seconds(self) -> float | None:
        """How long the command takes at most where no limit is asked for."""
        return None

    @property
    def may_take_long(self) -> bool:
        """Whether there may be much to do: a child does it, which Ctrl-C ends, and a terminal shows the progress."""
        return True

    @property
    def policy(self) -> str:
        """The file with the policy, empty where the command reads none."""
        return ""

    @property
    def specs(self) -> tuple[str, ...]:
        """The files with specifications."""
        return ()

    @property
    def is_many(self) -> bool:
        """Whether there are several files to do one thing with, or folders of them, where a command does that."""
        return len(self.specs) > 1 or any(map(is_folder, self.specs))

    @property
    def timeout(self) -> float | None:
        """The time limit in seconds."""
        return None

    @property
    def memory(self) -> int | None:
        """The memory limit in megabytes."""
        return None

    @property
    def output_format(self) -> OutputFormat:
        """For whom the report is."""
        return "text"

    def inputs(self) -> list[str]:
        """The names of what is read, `-` for the standard input."""
        return [name for name in (self.policy, *self.specs) if name]

    @classmethod
    def outputs(cls) -> dict[str, Target]:
        """The fields that name a file to write, with what is written there."""
        return {name: each.writes for name, each in cls.arguments().items() if each.writes is not None}

    @classmethod
    def arguments(cls) -> dict[str, Argument]:
        """How every field is typed."""
        return dict(zip(cls.__struct_fields__, cls.__struct_defaults__, strict=True))

    def targets(self) -> Iterator[Target]:
        """The files that may be written."""
        for name, target in self.outputs().items():
            path = getattr(self, name)
            if path is not None:
                yield target._replace(path=path)

    def mistake(self) -> str | None:
        """What is wrong with options that do not go together."""
        return None

    @property
    def report_apart(self) -> bool:
        """Whether the standard output is for what the command makes, and not for its report."""
        return any(getattr(self, name) == STANDARD_OUTPUT for name in self.outputs())


def is_folder(name: str) -> bool:
    """Whether a name is that of a folder."""
    return os.path.isdir(name)  # noqa: PTH112 - Path.is_dir() fails for names that are too long


def argument(*flags: str, writes: Target | None = None, **settings: Any) -> Any:  # noqa: ANN401 - a field of any type
    """A field of a record of options: an `Argument`, in the place of a default."""
    return Argument(flags, settings, writes)


def add_arguments(parser: argparse.ArgumentParser, options: type[CommandOptions]) -> None:
    """Let a parser know the fields of a record."""
    for name, each in options.arguments().items():
        settings = each.settings
        if each.flags:
            parser.add_argument(*each.flags, dest=name, **settings)
        else:
            if settings.get("nargs") == "*":
                settings = {"default": (), **settings}  # without a default, usage says that some is required
            parser.add_argument(name, **settings)
