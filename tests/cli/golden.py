"""Golden outputs: what commands print, kept as text in tests/golden and read by people at review."""

from __future__ import annotations

import re
import tempfile
from pathlib import Path

from msgspec import Struct

from tests import shell
from tests.cli.inputs import write_inputs
from tests.explain.variants import VARIANTS
from tests.repo.documents import ROOT


class Case(Struct, frozen=True):
    """A command and the name of its golden file."""

    name: str
    command: str


_UNSAFE = "S_Location=corridor S_Battery=low S_Load=free S_Conveyor=on"
_SAFE = "S_Location=workstation_1 S_Battery=ok S_Load=free S_Conveyor=off"

CASES = (
    Case("synth-json", "tumato-sym synth amr.tum --output-format json"),
    Case("synth-github", "tumato-sym synth warned.tum --output-format github"),
    Case("synth-unproved", "tumato-sym synth warned.tum --no-verify -o unproved.json"),
    Case("synth-no-allowed-set", "tumato-sym synth two_robots.tum"),
    Case("synth-no-plan", "tumato-sym synth no_plan.tum"),
    Case("synth-no-plan-json", "tumato-sym synth no_plan.tum --output-format json"),
    Case("synth-conflict", "tumato-sym synth conflict.tum"),
    Case("synth-conflict-json", "tumato-sym synth conflict.tum --output-format json"),
    Case("synth-conflict-github", "tumato-sym synth conflict.tum --output-format github"),
    Case("synth-errors-json", "tumato-sym synth typo.tum --output-format json"),
    Case("verify-json", "tumato-sym verify amr.json amr.tum --output-format json"),
    Case("verify-slower", "tumato-sym verify slower.json amr.tum"),
    Case("verify-slower-json", "tumato-sym verify slower.json amr.tum --output-format json"),
    Case("verify-unsafe", "tumato-sym verify unsafe.json amr.tum"),
    Case("verify-unsafe-github", "tumato-sym verify unsafe.json amr.tum --output-format github"),
    Case("verify-guarantees", "tumato-sym verify amr.json amr.tum --guarantees"),
    Case("verify-guarantees-json", "tumato-sym verify amr.json amr.tum --guarantees --output-format json"),
    Case("verify-guarantees-github", "tumato-sym verify amr.json amr.tum --guarantees --output-format github"),
    Case("verify-guarantees-unproved", "tumato-sym verify slower.json amr.tum --guarantees"),
    Case("verify-lazy", "tumato-sym verify lazy.json amr.tum --properties total,safe,goals"),
    Case(
        "verify-unrealizable",
        "tumato-sym synth conflict.tum -o c.json > report.txt || tumato-sym verify c.unrealizable.json conflict.tum",
    ),
    Case("verify-holed", "tumato-sym verify holed.unrealizable.json two_robots.tum"),
    Case("verify-holed-json", "tumato-sym verify holed.unrealizable.json two_robots.tum --output-format json"),
    Case("verify-holed-github", "tumato-sym verify holed.unrealizable.json two_robots.tum --output-format github"),
    Case("check", "tumato-sym check amr.tum typo.tum warned.tum"),
    Case("check-json", "tumato-sym check amr.tum typo.tum --output-format json"),
    Case("check-github", "tumato-sym check typo.tum warned.tum --output-format github"),
    Case("help", "tumato-sym --help"),
    *(Case(f"explain-{variant.name}", f"tumato-sym explain {variant.name}.tum") for variant in VARIANTS),
    Case("explain-two-robots", "tumato-sym explain two_robots.tum"),
    Case("explain-grid5", "tumato-sym explain grid5.tum --write assumed.tum --timeout 1000"),
    Case("explain-conflict", "tumato-sym explain conflict.tum"),
    Case("explain-conflict-json", "tumato-sym explain conflict.tum --output-format json"),
    Case("explain-json", "tumato-sym explain alternative_too_many.tum --output-format json --cores 2"),
    Case("explain-github", "tumato-sym explain rule_too_many.tum --output-format github"),
    Case("explain-sarif", "tumato-sym explain rule_too_many.tum --output-format sarif"),
    Case("explain-realizable", "tumato-sym explain amr.tum"),
    Case("why", f"tumato-sym why amr.json amr.tum {_UNSAFE}"),
    Case("why-not", f"tumato-sym why amr.json amr.tum {_UNSAFE} --not move_to_charger"),
    Case("why-json", f"tumato-sym why amr.json amr.tum {_SAFE} --output-format json"),
)

_SECONDS = re.compile(r'("(?:seconds|synthesis|proof)": )[\d.]+')
_TIME = re.compile(r"\b\d+(?:\.\d+)? s\b")


def golden_path(case: Case) -> Path:
    """Where the golden output of a case is."""
    return ROOT / "tests" / "golden" / f"{case.name}.txt"


def produce(case: Case) -> str:
    """What the command prints now, stream by stream, without times, and its exit code."""
    with tempfile.TemporaryDirectory() as folder:
        write_inputs(Path(folder))
        done = shell.run(case.command, Path(folder), environment={"COLUMNS": "100"})
    text = f"$ {case.command}\n{done.stdout}"
    if done.stderr:
        text += f"--- standard error\n{done.stderr}"
    text += f"--- exit code {done.returncode}\n"
    return _TIME.sub("0 s", _SECONDS.sub(r"\g<1>0", text))
