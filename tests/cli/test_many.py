"""`synth`, `explain` and `run` for many files: each line is what the command says of one."""

import json
import os
import re
import shutil
import signal
from pathlib import Path
from typing import Any

import pytest

from tests.cli.conftest import Cli
from tests.repo.documents import ROOT
from tumato_symbolic.cli.commands import synth

SPECS = ("amr", "coin", "lid", "no_plan")


@pytest.fixture
def folder(tmp_path: Path, cli: Cli) -> Path:
    """Specifications with and without a policy, one with a mistake, and a folder for policies."""
    there = tmp_path / "robots"
    there.mkdir()
    (tmp_path / "proofs").mkdir()
    shutil.copy(tmp_path / "no_plan.tum", there)
    for name in SPECS[:3]:
        shutil.copy(ROOT / "examples" / f"{name}.tum", there)
    (there / "wrong.tum").write_text((there / "coin.tum").read_text().replace("S_Coin is heads", "S_Coin is headz"))
    return there


def lines(text: str) -> dict[str, dict[str, Any]]:
    """The report of each file, by its name, without times."""
    plain = re.sub(r'("seconds|"synthesis|"proof)": [\d.]+', r'\1": 0', text)
    return {each["file"]: each for each in map(json.loads, plain.splitlines())}


def test_synth(folder: Path, cli: Cli, tmp_path: Path) -> None:
    """A policy or a certificate for each, as one by one; the exit code is that of the worst."""
    ran = cli("synth", "robots", "-o", "proofs", "--jobs", "1")
    table = ran.out.splitlines()
    assert ran.code == 2
    assert table[0] == "robots/amr.tum      realizable    32 valid states, proofs/amr.policy.json"
    assert table[3].endswith("failing states: 1 no-plan; proofs/no_plan.unrealizable.json")
    assert table[4] == "robots/wrong.tum    error         TUM202 in line 20: `S_Coin` has no value `headz`"
    assert table[5].startswith("5 files: 3 realizable, 1 unrealizable, 1 error. In ")
    cli("synth", "robots/amr.tum", "-o", "alone.json")
    assert (tmp_path / "alone.json").read_bytes() == (tmp_path / "proofs" / "amr.policy.json").read_bytes()
    (folder / "wrong.tum").unlink()
    assert cli("verify", "proofs", "--specs", "robots", "--strict", "--require-all").code == 0


def test_lines_for_programs_do_not_depend_on_the_jobs(folder: Path, cli: Cli) -> None:
    """In the order of the files; each has what the command says of that file alone."""
    one, two = (cli("synth", "robots", "-o", "proofs", "--output-format", "json", "--jobs", n) for n in ("1", "2"))
    assert lines(one.out) == lines(two.out)
    assert list(lines(one.out)) == [f"robots/{name}.tum" for name in (*SPECS, "wrong")]
    assert [each["exit_code"] for each in lines(one.out).values()] == [0, 0, 0, 1, 2]
    alone = cli("synth", "robots/coin.tum", "-o", "proofs/coin.policy.json", "--output-format", "json").out
    said = lines(one.out)["robots/coin.tum"]
    head = {"file": "robots/coin.tum", "exit_code": 0}
    assert said == lines(json.dumps({**head, **json.loads(alone)}))["robots/coin.tum"]


def test_explain(folder: Path, cli: Cli) -> None:
    """Files and folders together, each once; what has a policy is nothing to explain."""
    ran = cli("explain", "robots/no_plan.tum", "robots/coin.tum", "robots/no_plan.tum", "--repairs", "0")
    assert ran.code == 1
    assert ran.out.splitlines()[0].startswith(
        "robots/no_plan.tum  unrealizable  1 failing state, reasons: 1, repairs: 0"
    )
    assert ran.out.splitlines()[1] == "robots/coin.tum     realizable    nothing to explain"


def test_run(folder: Path, cli: Cli) -> None:
    """Every policy of a folder against its specification, or all against one."""
    cli("synth", "robots/coin.tum", "robots/amr.tum", "-o", "proofs")
    ran = cli("run", "proofs", "robots", "--runs", "5")
    assert (ran.code, ran.out.splitlines()[:2]) == (
        0,
        [
            "proofs/amr.policy.json   met  robots/amr.tum: of 5 runs 5 met the goal",
            "proofs/coin.policy.json  met  robots/coin.tum: of 5 runs 5 met the goal",
        ],
    )
    ran = cli("run", "proofs", "robots", "--faults", "worst", "S_Coin=heads", "--output-format", "json")
    assert [each["exit_code"] for each in lines(ran.out).values()] == [2, 0]
    assert lines(ran.out)["proofs/coin.policy.json"]["steps"] == 1
    assert cli("run", "proofs", "robots/coin.tum", "--runs", "5").code == 2


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("synth", "proofs"), "there is no specification in the folder proofs"),
        (("synth", "robots", "-o", "-"), "-o names the folder"),
        (("synth", "robots", "-o", "none"), "-o names the folder"),
        (("synth", "robots", "--html", "x.html"), "--html writes one page"),
        (("synth", "robots", "-"), "the standard input is one specification"),
        (("synth", "robots", "copy", "-o", "proofs"), "are both called amr"),
        (("synth", "robots", "--output-format", "sarif"), "is for one specification"),
        (("explain", "robots", "--write", "x.tum"), "--write writes one"),
        (("run", "proofs", "robots"), "is executed by itself"),
        (("run", "robots", "robots", "--runs", "3"), "there is no policy in the folder robots"),
    ],
)
def test_what_cannot_be_done_for_many(words: tuple[str, ...], said: str, folder: Path, cli: Cli) -> None:
    """Is said before any work; nothing is written."""
    shutil.copytree(folder, "copy")
    ran = cli(*words)
    assert (ran.code, ran.out, said in ran.err) == (2, "", True), ran.err
    assert not list(Path("proofs").iterdir())


def test_one_that_is_killed_is_undecided_alone(folder: Path, cli: Cli, monkeypatch: pytest.MonkeyPatch) -> None:
    """The others are what they would be."""
    run = synth.run

    def killed(options: synth.Options, context: Any) -> int:
        if options.specs == ("robots/coin.tum",):
            os.kill(os.getpid(), signal.SIGKILL)
        return run(options, context)

    (folder / "wrong.tum").unlink()
    monkeypatch.setattr(synth, "run", killed)
    ran = cli("synth", "robots", "-o", "proofs", "--jobs", "2")
    assert ran.code == 1
    assert "robots/coin.tum     undecided     a worker process was ended by signal 9\n" in ran.out
    assert "4 files: 2 realizable, 1 undecided, 1 unrealizable." in ran.out


def test_a_limit_ends_all_and_what_is_known_is_told(folder: Path, cli: Cli, monkeypatch: pytest.MonkeyPatch) -> None:
    """How many were not looked at; exit 3 where none of the others is worse."""
    ran = cli("synth", "robots", "-o", "proofs", "--timeout", "0.000001")
    assert (ran.code, "the time limit of 1e-06 s was met" in ran.out) == (3, True)
