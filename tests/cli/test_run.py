"""`run` from the outside: step by step through a pipe, many runs, the worst case, traces as files."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from msgspec.structs import replace

from tests.cli.conftest import Cli
from tests.cli.inputs import write_inputs
from tests.shell import ENTRY, HEEDING, PROGRAM
from tumato_symbolic.policy import as_diagram, load, save

UNSAFE = ("S_Location=corridor", "S_Battery=low", "S_Load=free", "S_Conveyor=on")
LOADED = ("S_Location=workstation_2", "S_Battery=ok", "S_Load=loaded", "S_Conveyor=off")


def _piped(folder: Path, lines: str, *arguments: str) -> subprocess.CompletedProcess[str]:
    write_inputs(folder)
    command = [*PROGRAM, "run", "amr.json", "amr.tum", *arguments]
    return subprocess.run(command, cwd=folder, input=lines, capture_output=True, text=True, check=False)


def test_steps_are_taken_by_commands(tmp_path: Path) -> None:
    """Enter is the nominal outcome; the end of the input ends it, and the goal is told when it is met."""
    ran = _piped(tmp_path, "\n\n\n", *UNSAFE)
    assert (ran.returncode, ran.stderr) == (0, "")
    told = [line for line in ran.stdout.splitlines() if line[:1].isdigit() or line.startswith("The goal")]
    assert told == [
        "1. {stop_conveyor}: as intended (S_Conveyor=off)",
        "2. {move_to_charger}: as intended (S_Location=charger)",
        "3. {charge}: as intended (S_Battery=ok)",
        "The goal is met.",
    ]


def test_outcomes_disturbances_and_the_way_back(tmp_path: Path) -> None:
    """A number is another outcome, `s` disturbs, `b` takes the last event back, `w` is what `why` says."""
    trace = tmp_path / "trace.json"
    lines = "1\ns S_Battery=low\nb\nw\n?\nfly\n9\ns S_Battery=full\ns S_Battery=ok\nq\n\n"
    ran = _piped(tmp_path, lines, *LOADED, "--itf", "trace.json")
    assert (ran.returncode, ran.stderr) == (0, "")
    assert "1. {deliver_workpiece}: deliver_workpiece takes an alternative effect" in ran.stdout
    assert "2. disturbance: S_Battery=low" in ran.stdout
    assert "amr.json decides: {deliver_workpiece}" in ran.stdout
    assert ran.stdout.count("why the policy decides so") == 2
    assert "There is no command 'fly'" in ran.stdout
    assert "There is no outcome 9." in ran.stdout
    assert "`S_Battery` has no value `full`" in ran.stdout
    assert "That is the state already." in ran.stdout
    states = json.loads(trace.read_text())["states"]
    assert [state["tumato::executed"]["#set"] for state in states] == [[], ["deliver_workpiece"]]


def test_a_run_by_itself(cli: Cli) -> None:
    """One run is a trace; the exit code says whether the goal is met."""
    ran = cli("run", "amr.json", "amr.tum", *UNSAFE, "--faults", "none")
    assert ran.code == 0
    assert ran.out.splitlines()[-1] == "The goal is met after 3 steps."
    short = cli("run", "amr.json", "amr.tum", *UNSAFE, "--steps", "2", "--output-format", "json")
    found = json.loads(short.out)
    assert (short.code, found["verdict"], found["trace"]["end"]) == (1, "missed", "bound")
    assert [event["decision"] for event in found["trace"]["events"]] == [["stop_conveyor"], ["move_to_charger"]]


def test_the_same_seed_gives_the_same_bytes(cli: Cli) -> None:
    """Of text, JSON and traces; another seed gives others."""
    for options in ((), ("--output-format", "json")):
        command = ("run", "amr.json", "amr.tum", "--faults", "random", "--disturb", "0.2", "--runs", "200", *options)
        runs = [cli(*command, "--seed", seed).out for seed in ("5", "5", "6")]
        assert runs[0] == runs[1] != runs[2]
    traces = []
    for seed in ("1", "1", "2"):
        cli("run", "amr.json", "amr.tum", "--faults", "random", "--seed", seed, "--itf", "trace.json")
        traces.append(Path("trace.json").read_bytes())
    assert traces[0] == traces[1] != traces[2]


def test_many_runs_are_summarized(cli: Cli) -> None:
    """Steps, durations, restorations; the numbers add up."""
    ran = cli(
        "run",
        "amr.json",
        "amr.tum",
        "--faults",
        "random",
        "--disturb",
        ".5",
        "--runs",
        "300",
        "--output-format",
        "json",
    )
    found = json.loads(ran.out)
    assert (ran.code, found["verdict"], found["runs"], found["unsafe"]) == (0, "met", 300, 0)
    assert sum(each["runs"] for each in found["steps"]) == found["ends"]["goal"] == 300
    assert found["restorations"] > 0
    assert found["trace"] is None
    text = cli("run", "amr.json", "amr.tum", "--runs", "300").out
    assert text.startswith("300 runs of amr.json: nominal effects, seed 0\n  300 runs: met the goal\n")


def test_the_worst_case(cli: Cli) -> None:
    """From one state it is a number of steps; where outcomes can go on for ever, a loop and exit code 1."""
    best = cli("run", "amr.json", "amr.tum", *UNSAFE, "--faults", "worst", "--output-format", "json")
    found = json.loads(best.out)
    assert (best.code, found["verdict"], found["steps"], found["starts"]) == (0, "met", 3, 1)
    ran = cli("run", "amr.json", "amr.tum", "--faults", "worst", "--itf", "-")
    assert ran.code == 1
    assert "for ever" in ran.err
    trace = json.loads(ran.out)
    assert 0 <= trace["loop"] < len(trace["states"])


def test_too_many_states_for_the_worst_case(cli: Cli, monkeypatch: pytest.MonkeyPatch) -> None:
    """There is no verdict then, and the way out is named."""
    monkeypatch.setattr("tumato_symbolic.simulation.worst.MOST_OUTCOMES", 20)
    ran = cli("run", "amr.json", "amr.tum", "--faults", "worst")
    assert (ran.code, ran.err) == (3, "")
    assert "outcomes can follow" in ran.out
    assert "verify --guarantees" in ran.out


def test_what_does_not_go_together_is_said(cli: Cli) -> None:
    """As mistakes in the command line; unknown variables and values as diagnostics."""
    for options in (
        ("--faults", "worst", "--runs", "3"),
        ("--runs", "2", "--itf", "x.json"),
        ("--output-format", "json"),
        ("--timeout", "3"),
        ("--disturb", "2"),
        ("S_Battery=full",),
        ("S_Batery=low",),
        ("low",),
        ("--itf", "amr.tum"),
    ):
        assert cli("run", "amr.json", "amr.tum", *options).code == 2, options
    assert cli("run", "-", "amr.tum").code == 2


def test_undecided_states(cli: Cli) -> None:
    """A run that comes to a state without a decision says so, and misses its goal."""
    policy = json.loads(Path("amr.json").read_text())
    for section in ("Certificate", "Digest"):
        policy.pop(section, None)
    policy["Policy"] = [row for row in policy["Policy"] if row["S_Location"] != "charger"]
    Path("holed.json").write_text(json.dumps(policy))
    ran = cli("run", "holed.json", "amr.tum", *UNSAFE, "--runs", "2")
    assert ran.code == 1
    assert "came to a state that the policy does not decide" in ran.out
    assert "The policy does not decide S_Location=charger" in ran.out
    none = cli("run", "holed.json", "amr.tum", "S_Location=charger", "--runs", "2")
    assert (none.code, none.out) == (1, "")
    assert "decides no valid state" in none.err
    assert cli("run", "holed.json", "amr.tum", *UNSAFE, "--faults", "worst").code == 1


def test_a_diagram_runs_like_its_table(cli: Cli) -> None:
    """From the same state with the same seed; drawn starts may differ."""
    policy = load("amr.json")
    save(replace(policy, decisions=as_diagram(policy)), Path("diagram.json"))
    ran = [
        cli("run", name, "amr.tum", *LOADED, "--faults", "random", "--disturb", "0.3", "--seed", "4").out
        for name in ("amr.json", "diagram.json")
    ]
    assert ran[0] == ran[1]
    assert cli("run", "diagram.json", "amr.tum", "--faults", "random", "--runs", "50").code == 0


@pytest.mark.skipif(os.name != "posix", reason="signals")
def test_interrupted_it_leaves_no_file(tmp_path: Path) -> None:
    """Ctrl-C while a command is waited for: exit code 130, and neither the trace nor a temporary file."""
    write_inputs(tmp_path)
    before = set(tmp_path.iterdir())
    command = [sys.executable, "-c", HEEDING + ENTRY, "run", "amr.json", "amr.tum", *UNSAFE, "--itf", "trace.json"]
    with subprocess.Popen(command, cwd=tmp_path, stdin=subprocess.PIPE, stdout=subprocess.PIPE) as process:
        assert process.stdout is not None
        assert process.stdout.readline()
        time.sleep(0.1)
        process.send_signal(signal.SIGINT)
        assert process.wait(10) == 130
    assert set(tmp_path.iterdir()) == before


def test_traces_are_read_by_another_program(cli: Cli) -> None:
    """`itf-py`, where it is installed, reads what is written; states have a value for every variable."""
    cli("run", "amr.json", "amr.tum", *LOADED, "--faults", "worst", "--itf", "trace.json")
    trace = json.loads(Path("trace.json").read_text())
    assert all(set(state) == {"#meta", *trace["vars"]} for state in trace["states"])
    assert [state["#meta"]["index"] for state in trace["states"]] == list(range(len(trace["states"])))
    itf = pytest.importorskip("itf_py", reason="itf-py is not installed")
    read = itf.trace_from_json(trace)
    assert read.vars == trace["vars"]
    assert read.loop == trace["loop"]
    assert read.states[0].values["S_Load"] == "loaded"


def test_a_terminal_gets_a_prompt(tmp_path: Path) -> None:
    """On a terminal each command is asked for, and ends where the user ends the input."""
    pty = pytest.importorskip("pty", reason="there are no terminals")
    write_inputs(tmp_path)
    ours, theirs = pty.openpty()
    command = [*PROGRAM, "run", "amr.json", "amr.tum", *UNSAFE]
    with subprocess.Popen(command, cwd=tmp_path, stdin=theirs, stdout=subprocess.PIPE, stderr=theirs) as process:
        os.write(ours, b"\nq\n")
        assert process.stdout is not None
        out = process.stdout.read()
        assert process.wait(10) == 0
    assert out.count(b"decides") == 2
    assert b"> " in os.read(ours, 1000)
    os.close(ours)
    os.close(theirs)


def test_the_commands_are_in_the_help(cli: Cli) -> None:
    """`--help` names every one that may be typed between steps."""
    text = cli("run", "--help").out
    assert all(each in text for each in ("Enter", "`s VAR=VALUE`", "`b`", "`w`", "`?`", "`q`"))
