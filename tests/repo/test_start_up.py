"""What is loaded when: start-up is a feature."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

from tests.repo.documents import ROOT

_PROBE = """
import io, json, sys
from contextlib import redirect_stdout, redirect_stderr
with redirect_stdout(io.StringIO()), redirect_stderr(io.StringIO()):
    from tumato_symbolic.cli.main import main
    code = main(sys.argv[1:])
print(json.dumps([code, [name for name in ("lark", "z3", "dd", "multiprocessing") if name in sys.modules]]))
"""


def _loaded(*arguments: str) -> tuple[int, set[str]]:
    done = subprocess.run([sys.executable, "-c", _PROBE, *arguments], capture_output=True, text=True, check=True)
    code, names = json.loads(done.stdout)
    return code, set(names)


@pytest.mark.parametrize("arguments", [["--help"], ["--version"], ["synth", "--help"], ["verify", "--help"]])
def test_help_loads_no_solver_and_no_parser(arguments: list[str]) -> None:
    """`--help` imports neither lark nor z3 nor dd."""
    assert _loaded(*arguments) == (0, set())


def test_check_loads_no_solver() -> None:
    """`check` imports neither z3 nor dd."""
    assert _loaded("check", str(ROOT / "examples" / "amr.tum")) == (0, {"lark"})


def test_decide_loads_neither_solver_nor_parser() -> None:
    """`decide` imports none of lark, z3 and dd."""
    policy = ROOT / "proofs" / "amr.policy.json"
    state = ("S_Location=corridor", "S_Battery=ok", "S_Load=free", "S_Conveyor=off")
    assert _loaded("decide", str(policy), *state) == (0, set())


def test_verify_does_not_load_the_engine() -> None:
    """`verify` imports no dd: it shares nothing with the engine."""
    code, names = _loaded("verify", str(ROOT / "proofs" / "amr.policy.json"), str(ROOT / "examples" / "amr.tum"))
    assert code == 0
    assert "dd" not in names


def test_the_walk_does_without_z3() -> None:
    """`verify --prover walk` imports neither dd nor z3."""
    files = (str(ROOT / "proofs" / "amr.policy.json"), str(ROOT / "examples" / "amr.tum"))
    assert _loaded("verify", *files, "--prover", "walk") == (0, {"lark"})


def test_a_small_proof_loads_nothing_for_processes() -> None:
    """`verify` imports what makes processes only where it makes some, whatever `--jobs` says."""
    files = (str(ROOT / "proofs" / "amr.policy.json"), str(ROOT / "examples" / "amr.tum"))
    assert _loaded("verify", *files, "--prover", "walk", "--jobs", "4") == (0, {"lark"})
    assert _loaded("verify", *files, "--jobs", "4") == (0, {"lark", "z3"})


def test_importing_the_package_loads_nothing_heavy(tmp_path: Path) -> None:
    """`import tumato_symbolic` loads no room at all."""
    probe = "import sys, tumato_symbolic; print(sorted(n for n in sys.modules if n.startswith('tumato_symbolic')))"
    done = subprocess.run([sys.executable, "-c", probe], capture_output=True, text=True, check=True, cwd=tmp_path)
    assert done.stdout.strip() == "['tumato_symbolic']"


def test_why_loads_no_solver() -> None:
    """`why` reads the specification, and imports neither z3 nor dd."""
    policy, spec = ROOT / "proofs" / "amr.policy.json", ROOT / "examples" / "amr.tum"
    state = ("S_Location=corridor", "S_Battery=ok", "S_Load=free", "S_Conveyor=off")
    assert _loaded("why", str(policy), str(spec), *state) == (0, {"lark"})
