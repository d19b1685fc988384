"""Every command on small inputs, in the folder where it is run."""

from __future__ import annotations

from pathlib import Path

from tests.cli.inputs import write_inputs
from tests.without_z3.blocking import outputs

STATE = ("S_Location=corridor", "S_Battery=low", "S_Load=free", "S_Conveyor=on")

COMMANDS: dict[str, tuple[str, ...]] = {
    "check": ("check", "amr.tum"),
    "synth": ("synth", "amr.tum", "-o", "made.json"),
    "synth by the walk": ("synth", "amr.tum", "-o", "walked.json", "--prover", "walk"),
    "synth by Z3": ("synth", "amr.tum", "-o", "never.json", "--prover", "z3"),
    "no policy": ("synth", "two_robots.tum", "-o", "robots.json"),
    "conflict": ("synth", "conflict.tum", "-o", "conflict.json"),
    "auto": ("verify", "made.json", "amr.tum"),
    "walk": ("verify", "made.json", "amr.tum", "--prover", "walk"),
    "explicit": ("verify", "made.json", "amr.tum", "--prover", "explicit"),
    "z3": ("verify", "made.json", "amr.tum", "--prover", "z3"),
    "both": ("verify", "made.json", "amr.tum", "--prover", "both", "--output-format", "json"),
    "guarantees": ("verify", "made.json", "amr.tum", "--guarantees"),
    "certificate": ("verify", "robots.unrealizable.json", "two_robots.tum"),
    "folder": ("verify", "proofs", "--specs", "."),
    "explain": ("explain", "two_robots.tum"),
    "explain more": ("explain", "no_plan.tum"),
    "why": ("why", "made.json", "amr.tum", *STATE),
    "decide": ("decide", "made.json", *STATE),
    "run": ("run", "made.json", "amr.tum", "--faults", "random", "--runs", "20"),
    "worst": ("run", "made.json", "amr.tum", *STATE, "--faults", "worst"),
    "show": ("show", "made.json", "--format", "rules"),
    "export": ("export", "python", "made.json", "amr.tum"),
}


def main() -> dict[str, tuple[int, str, str]]:
    """By name, what each came to; the policy is there also where it cannot be computed."""
    write_inputs(Path())
    Path("made.json").write_bytes(Path("amr.json").read_bytes())
    Path("proofs").mkdir()
    found = {}
    for name, command in COMMANDS.items():
        (found[name],) = outputs([command])
        made = Path("made.json")
        if name == "synth" and made.exists():
            (Path("proofs") / "amr.policy.json").write_text(made.read_text())
    return found
