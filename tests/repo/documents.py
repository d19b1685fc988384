"""Documents that run.

In a Markdown file, a fenced block marked `console` is a session: lines that start with `$ ` are commands for the shell,
and what follows is their output, both streams together. A block marked `… file=NAME` is the file NAME. All blocks of a
document run in order in one empty folder, in which `examples` is the repository's. A session marked
`console needs=TOOL` is left out where there is no such program, and no package of Python.

In expected output, `...` stands for any text on a line, a line that is only `...` for any lines, and a time such as
`0.12 s` for any time. Every command has to exit with 0; one that is meant to fail says so:
`$ command || echo "exit code $?"`.
"""

from __future__ import annotations

import re
import shutil
from collections.abc import Iterator
from importlib.util import find_spec
from pathlib import Path

from msgspec import Struct

from tests import shell

ROOT = Path(__file__).resolve().parents[2]

_FENCE = re.compile(r"^```([^\n]*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
_TIME = re.compile(r"\b(?:\d+ min )?\d+(?:\.\d+)? s\b")


class Step(Struct, frozen=True):
    """A command with its expected output, and where in the document that output stands."""

    command: str
    expected: str
    start: int
    end: int


class Given(Struct, frozen=True):
    """A file that the document gives."""

    name: str
    text: str


def steps(text: str) -> Iterator[Step | Given]:
    """What a document asks to be done, in order."""
    for block in _FENCE.finditer(text):
        language, _, settings = block[1].strip().partition(" ")
        if settings.startswith("file="):
            yield Given(settings.removeprefix("file="), block[2])
        elif language == "console" and _is_there(settings.removeprefix("needs=")):
            yield from _session(block[2], block.start(2))


def _is_there(tool: str) -> bool:
    """Whether a session that needs a tool can be run; without one, it always can."""
    return not tool or shutil.which(tool) is not None or find_spec(tool) is not None


def _session(body: str, offset: int) -> Iterator[Step]:
    commands = list(re.finditer(r"^\$ ((?:.*\\\n)*.*)\n", body, re.MULTILINE))
    for number, command in enumerate(commands):
        end = commands[number + 1].start() if number + 1 < len(commands) else len(body)
        yield Step(command[1], body[command.end() : end], offset + command.end(), offset + end)


def prepare(folder: Path) -> None:
    """Make the folder what a reader has: the examples, and nothing else."""
    (folder / "examples").symlink_to(ROOT / "examples")


def perform(step: Step | Given, folder: Path) -> str:
    """Carry out one step and return what it printed. Raises AssertionError when a command fails."""
    if isinstance(step, Given):
        (folder / step.name).write_text(step.text)
        return ""
    done = shell.run(step.command, folder, together=True)
    assert done.returncode == 0, f"`{step.command}` exits with {done.returncode}:\n{done.stdout}"
    return done.stdout


def matches(expected: str, printed: str) -> bool:
    """Whether output is what a document says, up to `...` and times."""
    lines = _TIME.sub("0 s", expected.strip()).split("\n")
    pattern = "\n".join("(?s:.*?)" if line == "..." else re.escape(line).replace(r"\.\.\.", ".*?") for line in lines)
    return re.fullmatch(pattern, _TIME.sub("0 s", printed.strip())) is not None


def renewed(text: str, folder: Path) -> str:
    """The document with the output that its commands print now, where it says something else."""
    prepare(folder)
    parts, done = [], 0
    for step in steps(text):
        printed = perform(step, folder)
        if isinstance(step, Step) and not matches(step.expected, printed):
            gap = "\n" if step.expected.endswith("\n\n") else ""
            parts += [text[done : step.start], printed.rstrip("\n") + "\n" + gap if printed.strip() else gap]
            done = step.end
    return "".join([*parts, text[done:]])
