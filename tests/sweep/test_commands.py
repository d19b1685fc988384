"""`tumato-sym sweep` as it is typed."""

import json
import re
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import jsonschema
import pytest

from tests.cli.conftest import Cli
from tests.repo.documents import ROOT
from tests.shell import ENTRY, HEEDING, PROGRAM
from tests.sweep.here import AMR, shuffling
from tumato_symbolic.limits.processes import descendants
from tumato_symbolic.sweep import cluster

SCHEMA = json.loads((ROOT / "tumato_symbolic" / "report" / "sweep.schema.json").read_text())


def lines(text: str) -> list[dict[str, Any]]:
    """Lines of results, each as the schema has it."""
    found = [json.loads(line) for line in text.splitlines()]
    for each in found:
        jsonschema.Draft202012Validator(SCHEMA).validate(each)
    return found


def test_the_schema_is_a_schema() -> None:
    """2020-12."""
    jsonschema.Draft202012Validator.check_schema(SCHEMA)


def test_values(cli: Cli, tmp_path: Path) -> None:
    """The lines on the output are those in the file; the exit code is that of the worst variant."""
    words = ("sweep", "amr.tum", "-D", "max_plan_length=3,4", "-o", "r.jsonl")
    ran = cli(*words, "--output-format", "json", "--jobs", "1")
    header, base, three, four = lines(ran.out)
    assert (tmp_path / "r.jsonl").read_text() == ran.out
    assert (header["sweep"], header["variants"]) == ("define", 3)
    assert header["options"]["define"] == {"max_plan_length": ["3", "4"]}
    assert [each["verdict"] for each in (base, three, four)] == ["realizable", "unrealizable", "realizable"]
    assert [each["differs"] for each in (base, three, four)] == [None, True, False]
    assert [each["proof"] for each in (base, three, four)] == ["proved"] * 3
    again = cli(*words)
    assert (ran.code, again.code) == (1, 1)
    assert again.out == (
        "amr.tum: realizable, 32 states decided, 24 of all 32 safe, runs of up to 4 steps.\n\n"
        "     max_plan_length  verdict       valid  safe  longest run  compared with the specification\n"
        "  1  3                unrealizable     32    24               8 states: no plan\n"
        "  2  4                realizable       32    24            4  the same decisions\n\n"
        "2 variants: 1 unrealizable and 1 realizable.\n"
    )


def test_elements_and_mistakes(cli: Cli) -> None:
    """What makes no difference is listed with its line, for a person and for GitHub; exit 1."""
    ran = cli("sweep", "amr.tum", "--drop", "each", "--no-verify", "-o", "r.jsonl")
    idle = [line for line in ran.out.splitlines() if line.endswith("the same decisions")]
    assert ran.code == (1 if idle else 0)
    assert f"{len(idle)} of " in ran.out
    github = cli("sweep", "amr.tum", "--drop", "each", "--no-verify", "-o", "r.jsonl", "--output-format", "github")
    assert github.out.count("::warning file=amr.tum,line=") == len(idle)
    ran = cli("sweep", "amr.tum", "--mutate", "5", "--seed", "1", "--jobs", "1", "--no-verify")
    assert " of 5 changes are noticed by its rules and goals.\n  drawn from 99 possible ones by --seed 1\n" in ran.out


def test_one_variant_is_shown(cli: Cli) -> None:
    """As a text, for `synth` and `explain`; the others are numbered."""
    assert cli("sweep", "amr.tum", "--drop", "each", "--show", "0").out == AMR.text
    shown = cli("sweep", "amr.tum", "-D", "max_plan_length=3,4", "--show", "2").out
    assert shown == AMR.text.replace("max_plan_length: 5", "max_plan_length: 4")
    ran = cli("sweep", "amr.tum", "--drop", "each", "--show", "16")
    assert (ran.code, "from 0, the specification itself, to 15" in ran.err) == (2, True)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ((), "give one of"),
        (("--drop", "each", "--mutate", "3"), "give one of"),
        (("--drop", "each", "--seed", "3"), "--seed is for --mutate"),
        (("--drop", "each", "--scheduler", "a:1", "--jobs", "2"), "give either --scheduler"),
        (("--drop", "each", "-o", "-"), "-o needs a file"),
        (("--drop", "each", "-o", "amr.tum"), "TUM118"),
        (("--drop", "each", "-o", "no/such.jsonl"), "TUM510"),
        (("--drop", "each", "-o", "amr.json"), "TUM120"),
        (("-D", "max_plan_lenght=3"), "did you mean `max_plan_length`"),
        (("--mutate", "0"), "0 is not a whole number, at least 1"),
    ],
)
def test_what_cannot_be_swept(words: tuple[str, ...], said: str, cli: Cli) -> None:
    """Is said before any work, with a way out; exit 2."""
    ran = cli("sweep", "amr.tum", *words)
    assert (ran.code, ran.out, said in ran.err) == (2, "", True), ran.err


def test_the_specification_has_to_be_one(cli: Cli) -> None:
    """Its mistakes are told as `synth` tells them; a folder and a missing file are named."""
    assert "TUM101" in cli("sweep", ".", "--drop", "each").err
    assert "TUM101" in cli("sweep", "none.tum", "--drop", "each").err
    assert json.loads(cli("sweep", "none.tum", "--drop", "each", "--output-format", "json").out)["verdict"] == "error"


def test_a_cluster_needs_a_package(cli: Cli, monkeypatch: pytest.MonkeyPatch) -> None:
    """Which is named with the way to get it; exit 3, as where any other package is missing."""
    monkeypatch.setitem(sys.modules, "distributed", None)
    ran = cli("sweep", "amr.tum", "--drop", "each", "--scheduler", "127.0.0.1:9")
    assert (ran.code, "pip install 'tumato-symbolic[cluster]'" in ran.out) == (3, True)


@pytest.mark.parametrize("words", [(), ("-o", "r.jsonl")])
def test_a_cluster_that_is_lost(
    words: tuple[str, ...], cli: Cli, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Exit 2, after what was found by then; with a file, the same command goes on."""
    pytest.importorskip("distributed", reason="distributed is not installed (make tools)")
    monkeypatch.setattr(cluster, "cluster", lambda _: shuffling(0, {}, most=8)())
    command = ("sweep", "amr.tum", "--mutate", "12", "--no-verify", *words)
    ran = cli(*command, "--scheduler", "127.0.0.1:9")
    assert ran.code == 2
    assert re.search(r"\n\d+ of 12 variants were not solved: the connection was lost\.\n", ran.out)
    assert "error[TUM119]: the connection was lost" in ran.err
    if words:
        assert 2 <= len(lines((tmp_path / "r.jsonl").read_text())) <= 9
        assert cli(*command).code == 1
        assert len(lines((tmp_path / "r.jsonl").read_text())) == 14


def test_a_kill_loses_nothing(cli: Cli, tmp_path: Path) -> None:
    """The same command goes on, and ends with the bytes of one that was never killed."""
    words = ["sweep", "amr.tum", "--mutate", "30", "--no-verify", "--jobs", "1", "-o"]
    results = tmp_path / "killed.jsonl"
    with subprocess.Popen([*PROGRAM, *words, results.name], cwd=tmp_path) as running:
        while not results.exists() or results.read_text().count("\n") < 4:
            assert running.poll() is None
            time.sleep(0.01)
        running.kill()
    found = lines(results.read_text())
    assert 4 <= len(found) < 32
    cli(*words, results.name)
    cli(*words, "whole.jsonl")
    assert results.read_bytes() == (tmp_path / "whole.jsonl").read_bytes()


def test_ctrl_c(tmp_path: Path) -> None:
    """Ends all processes; what was found is told and kept, and the same command goes on."""
    if sys.platform != "linux":
        pytest.skip("processes are looked for in /proc")
    (tmp_path / "amr.tum").write_text(AMR.text)
    words = [
        sys.executable,
        "-c",
        HEEDING + ENTRY,
        "sweep",
        "amr.tum",
        "--mutate",
        "all",
        "--jobs",
        "2",
        "-o",
        "r.jsonl",
    ]
    streams = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
    with subprocess.Popen(words, cwd=tmp_path, text=True, **streams) as running:  # type: ignore[call-overload]
        results = tmp_path / "r.jsonl"
        while not results.exists() or results.read_text().count("\n") < 4:
            assert running.poll() is None
            time.sleep(0.01)
        family = descendants(running.pid)
        running.send_signal(signal.SIGINT)
        out, err = running.communicate(timeout=10)
    assert running.returncode == 130, err
    assert re.search(r"\b(9\d|10\d) variants were not solved: it was interrupted\.", out)  # told once a second
    assert "the same command goes on" in err
    assert len(family) > 2
    until = time.monotonic() + 5
    while any(map(_lives, family)) and time.monotonic() < until:
        time.sleep(0.05)
    assert not [each for each in family if _lives(each)]
    assert len(lines(results.read_text())) >= 4


def _lives(process: int) -> bool:
    """Whether it is there, and more than an entry that nobody has looked at."""
    try:
        return Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False
