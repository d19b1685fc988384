"""The command line as a process: pipes, signals, terminals."""

import json
import os
import pty
import re
import subprocess
import sys
from pathlib import Path

import pytest

from tests.cli.inputs import state, write_inputs

TUMATO = str(Path(sys.executable).parent / "tumato-sym")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with the shared inputs."""
    write_inputs(tmp_path)
    return tmp_path


def _run(folder: Path, *arguments: str, stdin: str = "", **environment: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [TUMATO, *arguments],
        cwd=folder,
        input=stdin,
        capture_output=True,
        text=True,
        env={**os.environ, **environment},
        timeout=60,
        check=False,
    )


def test_lines_in_lines_out(folder: Path) -> None:
    """`decide --stdin` answers 10,000 lines, one list for each object, in order."""
    states = [state("corridor", "low", "free", "off"), state("workstation_2", "ok", "free", "on")]
    lines = [json.dumps(states[number % 2]) for number in range(10_000)]
    ran = _run(folder, "decide", "amr.json", "--stdin", stdin="\n".join(lines) + "\n")
    assert (ran.returncode, ran.stderr) == (0, "")
    assert ran.stdout == ('["move_to_charger"]\n["stop_conveyor"]\n') * 5_000


def test_a_silent_policy_answers_null(folder: Path) -> None:
    """A line about which the policy says nothing is answered with null, the lines after it as usual; exit 1."""
    policy = json.loads((folder / "amr.json").read_text())
    rows = [row for row in policy["Policy"] if row["S_Location"] != "charger"]
    kept = {name: policy[name] for name in ("PolicyFrameworkVersion", "Type", "Actions", "States")}
    (folder / "part.json").write_text(json.dumps({**kept, "Policy": rows}))
    asked = [state("charger", "ok", "free", "off"), state("corridor", "low", "free", "off")]
    ran = _run(folder, "decide", "part.json", "--stdin", stdin="".join(json.dumps(each) + "\n" for each in asked))
    assert (ran.returncode, ran.stdout) == (1, 'null\n["move_to_charger"]\n')
    assert "line 1" in ran.stderr


BAD_LINES = {
    b"": "the input is empty",
    b"{": "this is not JSON",
    b"[]": "a list, expected an object",
    b"null": "null, expected an object",
    b"[" * 100_000: "nested",
    b'{"S_Location": "corridor"}': "`S_Battery` has no value",
    b'{"S_Location": "moon", "S_Battery": "low", "S_Load": "free", "S_Conveyor": "off"}': "no value `moon`",
    b'{"S_Location": 3}': "has no value `3`",
    b'{"S_Location": null}': "null, expected a string or a whole number",
    b'{"S_Location": NaN}': "not JSON",
    b'{"S_Load": "free", "S_Load": "free"}': "twice",
    b'{"S_Load": "\\ud800"}': "not valid Unicode",
    b"\0": "this is not JSON",
    b"\xff\xfe": "the line is not UTF-8 text",
    b" " * 2_500_000: "the line is longer than 1,000,000 bytes",
}
"""Lines that are no state of the AMR, and what is said of them."""


def test_a_bad_line_is_answered_and_ends_nothing(folder: Path) -> None:
    """Every line has one answer: a bad one says what is wrong with it, the next one is decided; exit 1 at the end."""
    good = json.dumps(state("corridor", "low", "free", "off")).encode()
    lines = [line for bad in BAD_LINES for line in (bad, good)]
    ran = subprocess.run(
        [TUMATO, "decide", "amr.json", "--stdin"],
        cwd=folder,
        input=b"\n".join(lines),
        capture_output=True,
        timeout=60,
        check=False,
    )
    answers = [json.loads(line) for line in ran.stdout.splitlines()]
    assert answers[1::2] == [["move_to_charger"]] * len(BAD_LINES)
    for answer, expected in zip(answers[::2], BAD_LINES.values(), strict=True):
        assert list(answer) == ["error"]
        assert expected in answer["error"]
    assert ran.returncode == 1
    assert ran.stderr.decode().splitlines() == [
        "tumato-sym: line 1: the line is not a state: the input is empty",
        f"tumato-sym: {len(BAD_LINES)} lines were not answered with actions; the first of them is named above",
    ]


def test_answers_come_at_once(folder: Path) -> None:
    """A robot that asks line by line gets each answer before it asks again."""
    question = json.dumps(state("corridor", "low", "free", "off")) + "\n"
    with subprocess.Popen(
        [TUMATO, "decide", "amr.json", "--stdin"], cwd=folder, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    ) as process:
        assert process.stdin is not None
        assert process.stdout is not None
        for _ in range(2):
            process.stdin.write(question)
            process.stdin.flush()
            assert process.stdout.readline() == '["move_to_charger"]\n'
        process.stdin.close()
        assert process.wait(timeout=10) == 0


@pytest.mark.parametrize("command", ["synth amr.tum -o -", "check amr.tum typo.tum", "--help"])
def test_a_reader_that_goes_is_no_error(folder: Path, command: str) -> None:
    """`tumato-sym … | true` prints nothing on the standard error stream, and exits as SIGPIPE would."""
    reader, writer = os.pipe()
    os.close(reader)
    ran = subprocess.run(
        [TUMATO, *command.split()],
        cwd=folder,
        stdout=writer,
        stderr=subprocess.PIPE,
        text=True,
        timeout=60,
        check=False,
    )
    os.close(writer)
    assert ran.returncode == 141
    assert ran.stderr == ""


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs /dev/full")
def test_a_full_disk_is_2(folder: Path) -> None:
    """Output that cannot be written is not a success, for reports, for the policy and for a policy on a device."""
    for command in ("check amr.tum > /dev/full", "synth amr.tum -o - > /dev/full", "synth amr.tum -o /dev/full"):
        ran = subprocess.run(
            ["sh", "-c", f"{TUMATO} {command}"], cwd=folder, capture_output=True, text=True, timeout=60, check=False
        )
        assert ran.returncode == 2, command
        assert "No space left" in ran.stderr
        assert "Traceback" not in ran.stderr


@pytest.mark.parametrize(
    "command",
    [
        "check - <&-",
        "synth - <&-",
        "verify - amr.tum <&-",
        "decide amr.json --stdin <&-",
        "decide - S_Load=free <&-",
        "synth amr.tum -o - >&-",
        "synth amr.tum -o /dev/stdout >&-",
        "export coq amr.json amr.tum >&-",
        "explain no_plan.tum --write - >&-",
        "decide amr.json --stdin >&-",
        "synth amr.tum -o - >> amr.tum",
        "export coq amr.json - < amr.tum >> amr.tum",
        "--help > /dev/full",
        "--version > /dev/full",
    ],
)
def test_streams_that_are_closed_full_or_inputs_are_2(folder: Path, command: str) -> None:
    """An input that is not there, and an answer that would be lost, or would end up in the input: a word and exit 2."""
    before = (folder / "amr.tum").read_bytes()
    ran = subprocess.run(
        ["sh", "-c", f"{TUMATO} {command}"], cwd=folder, capture_output=True, text=True, timeout=60, check=False
    )
    assert ran.returncode == 2
    assert "Traceback" not in ran.stderr
    code = {"<&-": "TUM[15]01", ">&-": "TUM117", ">>": "TUM118", ">": "TUM117"}
    expected = next(each for stream, each in code.items() if stream in command)
    assert re.search(rf"error\[{expected}\]", ran.stdout + ran.stderr)
    assert (folder / "amr.tum").read_bytes() == before


@pytest.mark.parametrize("redirection", ["2>&-", "2>/dev/full", ">/dev/null 2>&-", ">&- 2>&-"])
@pytest.mark.parametrize(("command", "code"), [("check amr.tum", 0), ("synth no_plan.tum", 1), ("synth nope.tum", 2)])
def test_a_lost_message_changes_no_exit_code(folder: Path, command: str, code: int, redirection: str) -> None:
    """A standard error stream that is closed or full takes no part in the verdict."""
    ran = subprocess.run(
        ["sh", "-c", f"{TUMATO} {command} {redirection}"], cwd=folder, capture_output=True, timeout=60, check=False
    )
    assert ran.returncode == code


def test_a_policy_replaces_the_old_one_as_a_whole(folder: Path) -> None:
    """An old policy is replaced; nothing else is left in the folder."""
    (folder / "policy.json").write_text("old")
    before = set(folder.iterdir())
    assert _run(folder, "synth", "amr.tum").returncode == 0
    assert json.loads((folder / "policy.json").read_text())["Type"] == "policy"
    assert set(folder.iterdir()) == before


def test_two_runs_write_the_same_bytes(folder: Path) -> None:
    """The same specification gives the same policy, whatever Python hashes."""
    texts = [_run(folder, "synth", "amr.tum", "-o", "-", PYTHONHASHSEED=seed).stdout for seed in ("1", "2")]
    assert texts[0] == texts[1] != ""


def test_plain_text_in_a_pipe(folder: Path) -> None:
    """No colour and no progress where the output is not a terminal."""
    for arguments in (["synth", "amr.tum"], ["verify", "slower.json", "amr.tum"], ["check", "typo.tum"]):
        ran = _run(folder, *arguments, TERM="xterm")
        assert "\x1b" not in ran.stdout + ran.stderr


@pytest.mark.parametrize(("settings", "coloured"), [({}, True), ({"NO_COLOR": "1"}, False), ({"TERM": "dumb"}, False)])
def test_colour_on_a_terminal(folder: Path, settings: dict[str, str], coloured: bool) -> None:
    """A terminal gets colour, unless its user does not want it."""
    environment = {name: value for name, value in os.environ.items() if name != "NO_COLOR"}
    parent, child = pty.openpty()
    subprocess.run(
        [TUMATO, "check", "amr.tum"],
        cwd=folder,
        stdout=child,
        stderr=child,
        env={**environment, "TERM": "xterm", **settings},
        timeout=60,
        check=True,
    )
    os.close(child)
    shown = os.read(parent, 65536).decode()
    os.close(parent)
    assert ("\x1b[" in shown) is coloured
    assert "no findings" in shown


def test_names_that_the_terminal_cannot_show(folder: Path) -> None:
    """An encoding without umlauts does not stop a report."""
    (folder / "größe.tum").write_text((folder / "amr.tum").read_text())
    ran = _run(folder, "check", "größe.tum", PYTHONIOENCODING="ascii")
    assert ran.returncode == 0
    assert "gr\\xf6\\xdfe.tum" in ran.stdout
