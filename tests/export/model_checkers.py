"""NuSMV, SPIN, Storm and a checker of TLA+, where they are installed."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator, Sequence
from functools import cache
from math import prod
from pathlib import Path
from typing import Any, TypeAlias

import pytest

try:
    import stormpy
except ImportError:
    stormpy = None

_BY_PYTHON = """
import sys
from pynusmv.init import init_nusmv
from pynusmv_lower_interface.nusmv.cmd.cmd import Cmd_SecureCommandExecute as execute
with init_nusmv():
    for line in open(sys.argv[2]):
        if line.strip() != "quit":
            execute(line)
"""
"""Commands of NuSMV through the Python package `pynusmv`, of which there are wheels for Python 3.6."""


PYNUSMV = Path(sys.prefix) / "pynusmv"
"""Where `tests.export.install` puts that package and what it needs; `TUMATO_PYNUSMV` names another folder."""


@cache
def nusmv() -> tuple[str, ...] | None:
    """How NuSMV is called with a file of commands."""
    for name in ("NuSMV", "nusmv"):
        if shutil.which(name):
            return name, "-source"
    for python in pythons_for_nusmv():
        asked = subprocess.run([python, "-c", "import pynusmv"], capture_output=True, check=False, env=_plain())
        if asked.returncode == 0:
            return python, "-c", _BY_PYTHON, "-source"
    return None


def pythons_for_nusmv() -> Iterator[str]:
    """Every Python 3.6 that is found here and runs."""
    versions = Path(os.environ.get("PYENV_ROOT", Path.home() / ".pyenv")) / "versions"
    for python in (shutil.which("python3.6"), *map(str, versions.glob("3.6.*/bin/python"))):
        if python and subprocess.run([python, "-c", "pass"], capture_output=True, check=False).returncode == 0:
            yield python


def _plain() -> dict[str, str]:
    """The environment for another Python, which has its own packages."""
    kept = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    return {**kept, "PYTHONPATH": os.environ.get("TUMATO_PYNUSMV", str(PYNUSMV))}


needs_nusmv = pytest.mark.skipif(
    nusmv() is None,
    reason="there is no NuSMV, and no Python 3.6 with pynusmv (`make tools`; TUMATO_PYNUSMV names its folder)",
)


Verdicts: TypeAlias = Callable[[Sequence[tuple[str, ...]], Path], list[dict[str, bool]]]
"""Which of its claims hold of each model, by name. A model is what a target writes."""


def nusmv_verdicts(models: Sequence[tuple[str, ...]], folder: Path) -> list[dict[str, bool]]:
    """What NuSMV says of models."""
    commands = []
    for number, (text,) in enumerate(models):
        (folder / f"{number}.smv").write_text(text, encoding="utf-8")
        commands += [f"read_model -i {number}.smv", "go", "check_property", f"show_property -o {number}.txt", "reset"]
    (folder / "commands").write_text("".join(f"{command}\n" for command in [*commands, "quit"]))
    command = nusmv()
    assert command is not None
    ran = subprocess.run(
        [*command, "commands"], cwd=folder, env=_plain(), capture_output=True, text=True, errors="replace", check=False
    )
    found = []
    for number in range(len(models)):
        path = folder / f"{number}.txt"
        assert path.exists(), ran.stderr + ran.stdout
        listed = re.findall(r"\[CTL +(True|False|Unchecked) +\S+ +(\w+)\]", path.read_text(encoding="utf-8"))
        assert listed
        assert all(verdict != "Unchecked" for verdict, _ in listed)
        found.append({name: verdict == "True" for verdict, name in listed})
    return found


def spin_accepts(text: str, folder: Path) -> bool:
    """Whether SPIN goes through the whole model without a violated assertion."""
    (folder / "model.pml").write_text(text, encoding="utf-8")
    for command in (
        ["spin", "-a", "model.pml"],
        ["cc", "-O0", "-w", "-DSAFETY", "-o", "pan", "pan.c"],
        ["./pan", "-m1000000", "-w16"],
    ):
        ran = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
        assert ran.returncode == 0, (command, ran.stdout, ran.stderr)
    assert "Error" not in ran.stdout
    assert "max search depth too small" not in ran.stdout
    return re.findall(r"errors: (\d+)", ran.stdout) == ["0"]


SPIN = shutil.which("spin")

needs_spin = pytest.mark.skipif(
    SPIN is None or shutil.which("cc") is None, reason="spin or cc is not installed: no model is checked by SPIN"
)

needs_storm = pytest.mark.skipif(stormpy is None, reason="stormpy is not installed: no model is checked by Storm")


MOST_STATES_LISTED = 500
"""Above, Storm takes diagrams: it finds states in which runs begin by solving, a second for some hundred of them."""


def storm_verdicts(models: Sequence[tuple[str, ...]], folder: Path) -> list[dict[str, bool]]:
    """What Storm says of models, of all initial states."""
    found = []
    for text, properties in models:
        states = prod(int(most) + 1 for most in re.findall(r": \[0\.\.(\d+)\];", text))
        found.append(by_storm(text, properties, folder, diagrams=states > MOST_STATES_LISTED))
    return found


def by_storm(text: str, properties: str, folder: Path, *, diagrams: bool) -> dict[str, bool]:
    """The verdicts on one model, of which the states are listed, or are diagrams (`--engine dd`)."""
    (folder / "model.prism").write_text(text, encoding="utf-8")
    program = stormpy.parse_prism_program(str(folder / "model.prism"))
    claims = stormpy.parse_properties(properties, program)
    if diagrams:
        model = stormpy.build_symbolic_model(program.substitute_constants().substitute_formulas(), claims)
    else:
        model = stormpy.build_model(program, claims)
    first = stormpy.create_filter_initial_states(model)
    verdicts = {}
    for claim in claims:
        result = stormpy.model_checking(model, claim)
        result.filter(first)
        verdicts[claim.get_name()] = result.forall_true()
    return verdicts


TLA = shutil.which("tla")

needs_tla = pytest.mark.skipif(
    TLA is None, reason="tla is not installed (cargo install tla-checker): no module of TLA+ is checked"
)


def tla_verdicts(models: Sequence[tuple[str, ...]], folder: Path) -> list[dict[str, bool]]:
    """What the checker of the crate `tla-checker` says of modules: of all invariants at once, and of each property."""
    return [_tla_verdicts(module, configuration, folder) for module, configuration in models]


def _tla_verdicts(module: str, configuration: str, folder: Path) -> dict[str, bool]:
    properties = re.findall(r"^PROPERTY (\w+)$", configuration, re.MULTILINE)
    others = re.sub(r"^PROPERTY .*\n", "", configuration, flags=re.MULTILINE)
    broken = {each["name"] for each in _tla(module, others, folder)["stats"].get("violations_by_invariant", [])}
    without = re.sub(r"^INVARIANT .*\n", "", others, flags=re.MULTILINE)
    for name in properties:
        answer = _tla(_of_one_mode(module, name), f"{without}PROPERTY {name}\n", folder)
        broken |= set() if answer["status"] == "ok" else {name}
    claims = [*re.findall(r"^INVARIANT (\w+)$", configuration, re.MULTILINE), *properties]
    return {re.sub(r"\B(?=[A-Z])", "_", name).lower(): name not in broken for name in claims}


def _of_one_mode(module: str, name: str) -> str:
    """The module without the runs that a property says nothing of; most states are met in these."""
    about = re.search(rf'^{name} == \(mode = ("\w+")\) =>', module, re.MULTILINE)
    both = 'mode \\in {"effects", "nominal"}'
    assert about is not None
    assert module.count(both) == 1
    return module.replace(both, f"mode = {about[1]}")


def _tla(module: str, configuration: str, folder: Path) -> dict[str, Any]:
    """The answer to one configuration; that something is wrong with the module itself is no answer."""
    (folder / "policy.tla").write_text(module, encoding="utf-8")
    (folder / "policy.cfg").write_text(configuration, encoding="utf-8")
    command = [str(TLA), "policy.tla", "--config", "policy.cfg", "--check-liveness", "--continue", "--json"]
    ran = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    answers = [json.loads(line) for line in ran.stdout.splitlines() if line.startswith("{")]
    assert len(answers) == 1, (ran.stdout, ran.stderr)
    answer: dict[str, Any] = answers[0]
    assert answer["status"] in {"ok", "invariant_violation", "liveness_violation"}, answer
    return answer
