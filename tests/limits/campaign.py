"""Commands on large inputs with a time limit: they end in time, with a right exit code, and leave nothing half done."""

from __future__ import annotations

import json
import os
import subprocess
import time
from collections.abc import Iterator
from pathlib import Path

from msgspec import Struct

from tests.limits.large import specification
from tests.shell import PROGRAM
from tumato_symbolic import parse
from tumato_symbolic.diagnostics import UserError
from tumato_symbolic.diagrams import DiagramBuilder
from tumato_symbolic.policy import DecisionDiagram, Policy, Vocabulary, dumps
from tumato_symbolic.spec import digest

LATE = 2.0
"""Seconds after its limit in which a command has to end."""

_SPEC_ALONE = ("synth", "explain", "check")
COMMANDS = (*_SPEC_ALONE, "verify", "show", "diff", "why", "run", "export", "report")
WITHOUT_JSON = ("export", "report")

_CODES = {
    "ok": 0,
    "same": 0,
    "different": 1,
    "realizable": 0,
    "proved": 0,
    "refuted": 1,
    "unrealizable": 1,
    "met": 0,
    "missed": 1,
    "error": 2,
    "undecided": 3,
}


class Ran(Struct, frozen=True):
    """One command: what was run, within which limit, how long it took, its exit code, and what is wrong with all that.

    `problems` does not depend on how fast the machine is, as long as the command ended by itself.
    """

    command: str
    limit: float
    seconds: float
    code: int
    problems: tuple[str, ...]

    @property
    def is_late(self) -> bool:
        """Whether it took longer than its limit and what is granted beyond."""
        return self.seconds > self.limit + LATE


def campaign(count: int, seed: int, limits: tuple[float, ...], folder: Path) -> Iterator[Ran]:
    """Every command in turn on a generated specification, in an empty folder each."""
    for number in range(seed, seed + count):
        yield on_generated(COMMANDS[number // 6 % len(COMMANDS)], number, limits[number % len(limits)], folder)


def on_generated(command: str, number: int, limit: float, folder: Path) -> Ran:
    """A command on the generated specification of a number."""
    place = folder / str(number)
    place.mkdir()
    spec = place / "large.tum"
    spec.write_text(specification(number))
    return run(command, spec, limit)


def on_files(specs: Iterator[Path], limits: tuple[float, ...], folder: Path) -> Iterator[Ran]:
    """Every command on every file, with every limit."""
    for spec in specs:
        for command in COMMANDS:
            for limit in limits:
                place = folder / f"{spec.stem}-{command}-{limit:g}"
                place.mkdir()
                (place / spec.name).write_bytes(spec.read_bytes())
                yield run(command, place / spec.name, limit)


def run(command: str, spec: Path, limit: float) -> Ran:
    """Run a command in the folder of its specification, which it has to itself."""
    folder = spec.parent
    arguments = _arguments(command, spec)
    before = set(folder.iterdir())
    started = time.monotonic()
    process = subprocess.Popen(
        [*PROGRAM, command, *arguments, "--timeout", f"{limit:g}"],
        cwd=folder,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        start_new_session=True,
    )
    try:
        out, err = process.communicate(timeout=limit + 30)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, 9)
        out, err = process.communicate()
    took = time.monotonic() - started
    problems = [*_judge(command, process.returncode, out, err), *_leftovers(folder, before)]
    if _session_lives(process.pid):
        problems.append("a process is left")
    return Ran(
        f"{command} {' '.join(arguments)} --timeout {limit:g}  ({folder.name})",
        limit,
        took,
        process.returncode,
        tuple(problems),
    )


def _arguments(command: str, spec: Path) -> list[str]:
    """What is typed after a command. A policy is made where it takes one: it does nothing, everywhere."""
    if command in _SPEC_ALONE:
        return [spec.name, "--output-format", "json"]
    policy = spec.parent / "idle.policy.json"
    try:
        made = _idle(spec.read_text())
    except UserError:
        made = None
    policy.write_text("{}" if made is None else dumps(made))
    match command:
        case "diff":
            return [policy.name, policy.name, "--output-format", "json"]
        case "show":
            return [policy.name, "--output-format", "json"]
        case "why":
            state = [] if made is None else [f"{name}={values[0]}" for name, values in made.vocabulary.variables]
            return [policy.name, spec.name, *(state or ["X=on"]), "--output-format", "json"]
        case "run":
            return [policy.name, spec.name, "--faults", "random", "--runs", "50", "--output-format", "json"]
        case "export":
            return ["coq", policy.name, spec.name, "-o", "proof.v"]
        case "report":
            return [policy.name, spec.name]
        case _:
            return [policy.name, spec.name, "--output-format", "json"]


def _idle(text: str) -> Policy:
    spec = parse(text)
    builder: DiagramBuilder[bool] = DiagramBuilder(tuple(range(len(spec.variables))), (False, True))
    never, always = builder.leaf(False), builder.leaf(True)
    roots = (never,) * len(spec.actions)
    return Policy(Vocabulary.of(spec), DecisionDiagram(builder.finish(), roots, always), "any", digest(spec))


def _judge(command: str, code: int, out: bytes, err: bytes) -> Iterator[str]:
    """What is wrong with an exit code and with what was printed."""
    if code not in (0, 1, 2, 3) or b"Traceback" in err:
        yield f"it exits with {code}: {err[-300:].decode(errors='replace')}"
        return
    if command in WITHOUT_JSON:
        if code == 3 and b"undecided" not in out + err:
            yield "it does not say that it is undecided"
        return
    try:
        verdict = json.loads(out).get("verdict")  # `why` gives none where it answers
    except ValueError:
        yield f"it prints no object: {out[:100]!r} {err[-300:]!r}"
        return
    if code != _CODES.get(verdict, code):
        yield f"the verdict is {verdict}, and it exits with {code}"


def _leftovers(folder: Path, before: set[Path]) -> Iterator[str]:
    """New files that are no whole ones."""
    for path in set(folder.iterdir()) - before:
        if path.suffix == ".tmp":
            yield f"{path.name} is left"
        elif path.suffix == ".json":
            try:
                json.loads(path.read_text())
            except ValueError:
                yield f"{path.name} is no whole file"


def _session_lives(session: int) -> bool:
    """Whether a process of a session still works."""
    for entry in Path("/proc").iterdir():
        if entry.name.isdecimal():
            try:
                fields = (entry / "stat").read_text().rpartition(")")[2].split()
            except OSError:
                continue
            if int(fields[3]) == session and fields[0] not in "ZX":
                return True
    return False
