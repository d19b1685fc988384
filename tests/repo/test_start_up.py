"""What is loaded when: start-up is a feature."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

from tests.repo.documents import ROOT
from tumato_symbolic.cli.commands import COMMANDS

_PROBE = """
import io, json, sys
from contextlib import redirect_stdout, redirect_stderr
with redirect_stdout(io.StringIO()), redirect_stderr(io.StringIO()):
    from tumato_symbolic.cli.main import main
    code = main(sys.argv[1:])
print(json.dumps([code, list(sys.modules)]))
"""
"""Runs a command; shows its exit code, and what it loaded."""

_ASKED = {
    "lark", "z3", "dd", "multiprocessing", "tumato_symbolic.policy.unrealizability", "tumato_symbolic.syntax.mistakes",
    "tumato_symbolic.policy.guarantees", "tumato_symbolic.views.two_policies",
}  # fmt: skip
"""The heavy packages, and what other answers need."""


def _modules(*arguments: str) -> tuple[int, set[str]]:
    done = subprocess.run([sys.executable, "-c", _PROBE, *arguments], capture_output=True, text=True, check=True)
    code, names = json.loads(done.stdout)
    return code, set(names)


def _loaded(*arguments: str) -> tuple[int, set[str]]:
    code, names = _modules(*arguments)
    return code, names & _ASKED


_OF_HELP = {"cli", "diagnostics", "limits"}
"""The rooms that help needs."""


@pytest.mark.parametrize("arguments", ["--help", "--version", *(f"{name} --help" for name in COMMANDS)])
def test_help_loads_no_room_that_works(arguments: str) -> None:
    """Help loads the command that it is about, and of the rooms only what a command line needs: a table of targets."""
    code, names = _modules(*arguments.split())
    assert (code, names & _ASKED) == (0, set())
    rooms = {name.split(".")[1] for name in names if name.startswith("tumato_symbolic.")}
    assert rooms == _OF_HELP | ({"export"} if arguments == "export --help" else set())
    commands = [name.rsplit(".", 1)[1] for name in names if name.startswith("tumato_symbolic.cli.commands.")]
    assert commands == [word.replace("-", "_") for word in arguments.split() if word in COMMANDS]


def test_check_loads_neither_solver_nor_lark() -> None:
    """`check` imports none of z3, dd and lark: the parse table of the grammar is in a file."""
    assert _loaded("check", str(ROOT / "examples" / "amr.tum")) == (0, set())


def test_format_loads_neither_solver_nor_lark() -> None:
    """`format` imports none of z3, dd and lark."""
    assert _loaded("format", "--check", str(ROOT / "examples" / "amr.tum"))[1] == set()


def test_synth_loads_solvers_only(tmp_path: Path) -> None:
    """`synth` imports dd and z3, no lark, and, where there is a policy, nothing that only unrealizability needs."""
    output = str(tmp_path / "policy.json")
    assert _loaded("synth", str(ROOT / "examples" / "amr.tum"), "-o", output) == (0, {"dd", "z3"})


def test_decide_loads_neither_solver_nor_parser() -> None:
    """`decide` imports none of lark, z3 and dd."""
    policy = ROOT / "proofs" / "amr.policy.json"
    state = ("S_Location=corridor", "S_Battery=ok", "S_Load=free", "S_Conveyor=off")
    assert _loaded("decide", str(policy), *state) == (0, set())


_FOR_OTHERS = {
    "cli.many", "synthesis.conflict", "synthesis.diagnosis", "report.guaranteed", "policy.lookup",
    "policy.decisions.rules", "semantics.traces", "semantics.shortcomings", "verify.guarantees.result",
    "verify.by_diagrams.prover", "verify.by_states.prover", "verify.by_z3.best_property", "verify.by_z3.effort_source",
}  # fmt: skip
"""What serves several files, other provers, and answers that are not the plain one."""


@pytest.mark.parametrize("command", ["synth", "verify"])
def test_the_plain_answer_loads_nothing_for_others(command: str, tmp_path: Path) -> None:
    """A policy that Z3 proves needs no other prover, no diagnosis and no execution."""
    spec, policy = str(ROOT / "examples" / "amr.tum"), str(tmp_path / "policy.json")
    words = {
        "synth": ("synth", spec, "-o", policy),
        "verify": ("verify", str(ROOT / "proofs" / "amr.policy.json"), spec),
    }
    code, names = _modules(*words[command])
    assert (code, {name for name in names if name.removeprefix("tumato_symbolic.") in _FOR_OTHERS}) == (0, set())


def test_verify_does_not_load_the_engine() -> None:
    """`verify` imports no dd, for it shares nothing with the engine, and no lark, and nothing for unrealizability."""
    files = (str(ROOT / "proofs" / "amr.policy.json"), str(ROOT / "examples" / "amr.tum"))
    assert _loaded("verify", *files) == (0, {"z3"})


def test_the_walk_does_without_z3() -> None:
    """`verify --prover walk` imports none of dd, z3 and lark."""
    files = (str(ROOT / "proofs" / "amr.policy.json"), str(ROOT / "examples" / "amr.tum"))
    assert _loaded("verify", *files, "--prover", "walk") == (0, set())


def test_a_small_proof_loads_nothing_for_processes() -> None:
    """`verify` imports what makes processes only where it makes some, whatever `--jobs` says."""
    files = (str(ROOT / "proofs" / "amr.policy.json"), str(ROOT / "examples" / "amr.tum"))
    assert _loaded("verify", *files, "--prover", "walk", "--jobs", "4") == (0, set())
    assert _loaded("verify", *files, "--jobs", "4") == (0, {"z3"})


def test_importing_the_package_loads_nothing_heavy(tmp_path: Path) -> None:
    """`import tumato_symbolic` loads no room at all."""
    probe = "import sys, tumato_symbolic; print(sorted(n for n in sys.modules if n.startswith('tumato_symbolic')))"
    done = subprocess.run([sys.executable, "-c", probe], capture_output=True, text=True, check=True, cwd=tmp_path)
    assert done.stdout.strip() == "['tumato_symbolic']"


def test_why_loads_no_solver() -> None:
    """`why` reads the specification, and imports none of z3, dd and lark."""
    policy, spec = ROOT / "proofs" / "amr.policy.json", ROOT / "examples" / "amr.tum"
    state = ("S_Location=corridor", "S_Battery=ok", "S_Load=free", "S_Conveyor=off")
    assert _loaded("why", str(policy), str(spec), *state) == (0, set())
