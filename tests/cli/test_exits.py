"""Exit codes, streams, and no file but a whole one."""

import json
import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

from tests.cli.conftest import Cli
from tests.cli.inputs import state
from tests.repo.documents import ROOT
from tumato_symbolic.cli.commands import COMMANDS, load
from tumato_symbolic.verify import prove


def test_synth_then_verify(cli: Cli, tmp_path: Path) -> None:
    """The two main commands work one after the other: 0 and 0, the report on the standard output, nothing beside it."""
    synth = cli("synth", "amr.tum")
    assert (synth.code, synth.err) == (0, "")
    assert "realizable" in synth.out
    verify = cli("verify", "policy.json", "amr.tum")
    assert (verify.code, verify.err) == (0, "")
    assert (tmp_path / "policy.json").exists()


def test_the_package_is_the_command(tmp_path: Path) -> None:
    """`python -m tumato_symbolic` answers as `tumato-sym` does, with its exit codes."""
    (tmp_path / "no.tum").write_text("BEGIN ACTIONS")
    done = subprocess.run(
        [sys.executable, "-m", "tumato_symbolic", "check", tmp_path / "no.tum"],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 2
    assert "TUM301" in done.stdout


def test_without_the_package_that_every_command_needs(tmp_path: Path) -> None:
    """It says which, and exits with 3: a traceback exits with 1, which says that there is no policy."""
    (tmp_path / "msgspec.py").write_text("raise ImportError('_core.so: wrong architecture')")
    done = subprocess.run(
        [sys.executable, "-m", "tumato_symbolic", "synth", "amr.tum"],
        env={**os.environ, "PYTHONPATH": os.pathsep.join([str(tmp_path), str(ROOT)])},
        capture_output=True,
        text=True,
        check=False,
    )
    assert (done.returncode, done.stdout) == (3, "")
    assert done.stderr == (
        "tumato-sym: msgspec is needed by every command, and cannot be imported here; "
        "install it with `pip install msgspec`\n"
    )


def test_no_policy_is_1_and_leaves_the_old_file_alone(cli: Cli, tmp_path: Path) -> None:
    """`synth` on an unrealizable specification exits with 1 and does not touch an existing policy.json."""
    (tmp_path / "policy.json").write_text("precious")
    assert cli("synth", "no_plan.tum").code == 1
    assert (tmp_path / "policy.json").read_text() == "precious"


def test_policy_on_the_standard_output(cli: Cli, tmp_path: Path) -> None:
    """`-o -` writes the policy to the standard output, the report to the standard error stream, and no file."""
    ran = cli("synth", "amr.tum", "-o", "-")
    assert ran.code == 0
    assert json.loads(ran.out)["Type"] == "policy"
    assert "realizable" in ran.err
    assert not (tmp_path / "policy.json").exists()


def test_without_a_proof_the_report_says_so(cli: Cli) -> None:
    """`--no-verify` writes the policy, exits with 0, and says that nothing was proved."""
    ran = cli("synth", "amr.tum", "--no-verify")
    assert ran.code == 0
    assert "Not proved" in ran.out
    assert "Z3" not in ran.out
    assert json.loads(cli("synth", "amr.tum", "--no-verify", "--output-format", "json").out)["proof"] is None


@pytest.mark.parametrize("command", [("synth", "typo.tum"), ("verify", "amr.json", "typo.tum"), ("check", "typo.tum")])
def test_a_specification_with_errors_is_2(cli: Cli, command: tuple[str, ...], tmp_path: Path) -> None:
    """Errors in a specification: exit 2 in every command, every mistake with its place, and no policy."""
    ran = cli(*command)
    assert ran.code == 2
    assert "typo.tum:7:" in ran.out + ran.err
    assert "typo.tum:8:" in ran.out + ran.err
    assert "S_Battery" in ran.out + ran.err
    assert not (tmp_path / "policy.json").exists()


def test_warnings_alone_are_0(cli: Cli) -> None:
    """A warning is shown and changes no exit code."""
    check, synth = cli("check", "warned.tum"), cli("synth", "warned.tum")
    assert (check.code, synth.code) == (0, 0)
    assert "PLUG" in check.out
    assert "PLUG" in synth.err
    assert "PLUG" not in synth.out


@pytest.mark.parametrize("name", ["missing.tum", ".", "binary.tum", "empty.tum", "no_block.tum", "latin1.tum"])
def test_what_is_no_specification_is_2(cli: Cli, tmp_path: Path, name: str) -> None:
    """A missing file, a folder, bytes, nothing, prose, another encoding: exit 2 and one message, never a traceback."""
    (tmp_path / "binary.tum").write_bytes(bytes(range(256)))
    (tmp_path / "empty.tum").write_text("")
    (tmp_path / "no_block.tum").write_text("This is not a specification.\n")
    (tmp_path / "latin1.tum").write_bytes("// für".encode("latin-1"))
    for command in (("synth", name), ("check", name), ("verify", "amr.json", name)):
        ran = cli(*command)
        assert ran.code == 2
        assert "Traceback" not in ran.err
        assert "TUM" in ran.out + ran.err


@pytest.mark.parametrize("name", ["missing.json", ".", "amr.tum", "half.json", "list.json", "empty.json"])
def test_what_is_no_policy_is_2(cli: Cli, tmp_path: Path, name: str) -> None:
    """A policy that cannot be read or used: exit 2 with a diagnostic in `verify` and `decide`."""
    text = (tmp_path / "amr.json").read_text()
    (tmp_path / "half.json").write_text(text[: len(text) // 2])
    Path("list.json").write_text("[]")
    (tmp_path / "empty.json").write_text("")
    for command in (("verify", name, "amr.tum"), ("decide", name, "S_Location=corridor")):
        ran = cli(*command)
        assert ran.code == 2
        assert "TUM5" in ran.err
        assert ran.out == ""


def test_a_policy_that_contradicts_itself_is_2(cli: Cli, tmp_path: Path) -> None:
    """Two rows that decide a state differently: exit 2, and both are named."""
    document = json.loads((tmp_path / "amr.json").read_text())
    document["Policy"].append({**document["Policy"][0], "Actions": []})
    (tmp_path / "twice.json").write_text(json.dumps(document))
    ran = cli("verify", "twice.json", "amr.tum")
    assert ran.code == 2
    assert "TUM506" in ran.err
    assert f"rows 1 and {len(document['Policy'])} of `Policy` decide the same state differently" in ran.err


@pytest.mark.parametrize("form", ["table", "diagram"])
def test_what_comes_next_can_be_typed(cli: Cli, form: str) -> None:
    """The commands that a report ends with work as they stand, whatever the form of the policy."""
    ran = cli("synth", "amr.tum", "--policy-format", form, "-o", "my policy.json")
    commands = [shlex.split(line) for line in ran.out.splitlines() if line.startswith("  tumato-sym ")]
    assert [words[1] for words in commands] == ["decide", "verify"]
    assert [cli(*words[1:]).code for words in commands] == [0, 0]


ONE_STATE = """\
BEGIN STATE VECTOR
state S_Coin can be heads, tails
END STATE VECTOR
BEGIN ASSUMPTIONS
assume: S_Coin is heads
END ASSUMPTIONS
"""


def test_one_is_singular(cli: Cli, tmp_path: Path) -> None:
    """Where there is one of a kind, the sentence says so."""
    (tmp_path / "one.tum").write_text(ONE_STATE)
    synth, verify = cli("synth", "one.tum", "-o", "one.json"), cli("verify", "one.json", "one.tum")
    for ran in (synth, verify, cli("check", "one.tum")):
        assert ran.code == 0
        assert not re.search(r"\b1 \w+s\b|\b1 valid states", ran.out)
    assert "the policy decides the one valid state. Found" in synth.out
    assert "Proved by Z3 for the one valid state" in synth.out
    assert "for the one valid state" in verify.out


def test_a_policy_for_another_specification_is_2(cli: Cli) -> None:
    """A policy with other variables cannot be judged."""
    ran = cli("verify", "amr.json", "warned.tum")
    assert ran.code == 2
    assert "S_Location" in ran.err


@pytest.mark.parametrize("policy", ["slower.json", "unsafe.json", "lazy.json"])
def test_a_refuted_policy_is_1(cli: Cli, policy: str) -> None:
    """`verify` exits with 1 when a property that was asked does not hold."""
    assert cli("verify", policy, "amr.tum").code == 1


def test_only_what_is_asked_counts(cli: Cli) -> None:
    """A policy that is not minimal passes when minimality is not asked, and the report says that it was not."""
    ran = cli("verify", "slower.json", "amr.tum", "--properties", "total,safe,goals")
    assert ran.code == 0
    assert "Not checked: minimal" in ran.out


def test_a_report_says_of_which_states_it_speaks(cli: Cli) -> None:
    """Nothing is called proved for all valid states of a policy that does not decide all of them."""
    policy = json.loads(Path("amr.json").read_text(encoding="utf-8"))
    Path("partial.json").write_text(json.dumps({**policy, "Policy": policy["Policy"][:1]}), encoding="utf-8")
    asked = cli("verify", "partial.json", "amr.tum", "--properties", "safe")
    assert (asked.code, "for the 1 of 32 valid states that it decides" in asked.out) == (0, True)
    assert "all" not in asked.out.splitlines()[0]
    whole = cli("verify", "partial.json", "amr.tum")
    assert (whole.code, "states: the 1 of 32 valid states that it decides" in whole.out) == (1, True)


@pytest.mark.parametrize("output", ["missing/policy.json", ".", "amr.tum/policy.json"])
def test_where_nothing_can_be_written_is_2(cli: Cli, output: str) -> None:
    """An output that cannot be is found out before the work: exit 2 with a way out, and no report."""
    ran = cli("synth", "amr.tum", "-o", output)
    assert ran.code == 2
    assert "TUM510" in ran.err
    assert ran.out == ""


@pytest.mark.parametrize(
    "arguments",
    [
        [],
        ["solve"],
        ["synth"],
        ["synth", "amr.tum", "--effect-ordering", "last"],
        ["synth", "amr.tum", "-o", ""],
        ["verify", "amr.json"],
        ["verify", "amr.json", "amr.tum", "--properties", "total,nice"],
        ["decide", "amr.json"],
        ["decide", "amr.json", "S_Location=corridor", "--stdin"],
        ["check"],
        ["check", "amr.tum", "--output", "x"],
    ],
    ids=" ".join,
)
def test_wrong_usage_is_2(cli: Cli, arguments: list[str]) -> None:
    """A command line that makes no sense: exit 2, the usage on the standard error stream."""
    ran = cli(*arguments)
    assert ran.code == 2
    assert "usage: tumato-sym" in ran.err
    assert ran.out == ""


@pytest.mark.parametrize("command", ["", *COMMANDS])
def test_help_teaches_with_an_example(cli: Cli, command: str) -> None:
    """`--help` shows a command to copy and the exit codes, everywhere."""
    ran = cli(*command.split(), "--help")
    assert ran.code == 0
    assert f"  tumato-sym {command or 'check'} " in ran.out or f"| tumato-sym {command} " in ran.out
    assert "exit codes:" in ran.out


def test_decide(cli: Cli) -> None:
    """`decide` prints one action a line."""
    words = [f"{name}={value}" for name, value in state("corridor", "low", "free", "off").items()]
    ran = cli("decide", "amr.json", *words)
    assert (ran.code, ran.out, ran.err) == (0, "move_to_charger\n", "")


def test_decide_where_nothing_is_to_be_done(cli: Cli) -> None:
    """An empty decision prints nothing on the standard output, and says so beside it."""
    words = [f"{name}={value}" for name, value in state("corridor", "ok", "free", "off").items()]
    ran = cli("decide", "lazy.json", *words)
    assert (ran.code, ran.out) == (0, "")
    assert "do nothing" in ran.err


def test_decide_wants_a_whole_state(cli: Cli) -> None:
    """A missing variable, an unknown value: exit 2 and both are named."""
    ran = cli("decide", "amr.json", "S_Location=kitchen", "S_Battery=ok", "S_Load=free")
    assert ran.code == 2
    assert "kitchen" in ran.err
    assert "S_Conveyor" in ran.err


def test_decide_where_the_policy_is_silent(cli: Cli, tmp_path: Path) -> None:
    """A state that the policy does not decide: exit 1, nothing on the standard output."""
    policy = json.loads((tmp_path / "amr.json").read_text())
    kept = {name: policy[name] for name in ("PolicyFrameworkVersion", "Type", "Actions", "States")}
    (tmp_path / "part.json").write_text(json.dumps({**kept, "Policy": policy["Policy"][1:]}))
    row = policy["Policy"][0]
    ran = cli("decide", "part.json", *(f"{name}={value}" for name, value in row.items() if name != "Actions"))
    assert (ran.code, ran.out) == (1, "")
    assert "does not decide" in ran.err


@pytest.mark.parametrize(
    "command",
    [
        "synth typo.tum -o - --output-format json",
        "synth typo.tum -o - --output-format github",
        "explain typo.tum --write - --output-format json",
        "explain typo.tum --write - --output-format github",
        "explain typo.tum --write - --output-format sarif",
    ],
)
def test_the_standard_output_is_for_what_is_made(cli: Cli, command: str) -> None:
    """Where a command writes its file to the standard output, what is wrong with its input is reported apart."""
    ran = cli(*command.split())
    assert (ran.code, ran.out) == (2, "")
    assert "TUM201" in ran.err


def test_a_bug_is_70_with_its_traceback(cli: Cli, monkeypatch: pytest.MonkeyPatch) -> None:
    """An uncaught exception exits with 70, keeps the traceback and asks for a report."""
    monkeypatch.setattr("tumato_symbolic.cli.commands.check.run", lambda *_: 1 // 0)
    ran = cli("check", "amr.tum")
    assert ran.code == 70
    assert "ZeroDivisionError" in ran.err
    assert "report" in ran.err


def test_out_of_memory_is_undecided(cli: Cli, monkeypatch: pytest.MonkeyPatch) -> None:
    """No memory, no verdict: exit 3."""

    def exhausted(*_: object) -> int:
        raise MemoryError

    monkeypatch.setattr("tumato_symbolic.cli.commands.check.run", exhausted)
    assert cli("check", "amr.tum").code == 3


@pytest.mark.parametrize("limit", [("--timeout", "0.000001"), ("--memory", "1")])
def test_a_limit_is_undecided(cli: Cli, tmp_path: Path, limit: tuple[str, str]) -> None:
    """A limit that is met ends in 3, says which, and writes nothing; one that is not met changes nothing."""
    ran = cli("synth", "amr.tum", *limit)
    if ran.code == 3:
        assert "limit of" in ran.out + ran.err
        assert not (tmp_path / "policy.json").exists()
    else:
        assert limit[0] == "--memory"
        assert ran.code == 0


@pytest.mark.parametrize(
    ("command", "file"),
    [
        ("synth amr.tum", "amr.tum"),
        ("verify amr.json amr.tum", "amr.tum"),
        ("show amr.json", "amr.json"),
        ("diff amr.json unsafe.json", "unsafe.json"),
        ("diff amr.tum warned.tum", "warned.tum"),
    ],
)
def test_what_met_a_limit_is_named(cli: Cli, command: str, file: str) -> None:
    """Before anything is known, an answer says at least what it is about."""
    ran = cli(*command.split(), "--timeout", "0.000001")
    assert ran.code == 3
    assert ran.out.startswith(f"{file}: undecided: the time limit of")


NO_NUMBERS = ["", "0", "-1", "soon", "nan", "inf", "1e400", "1_0", "٣", "²", "9" * 20, "9" * 5000]


@pytest.mark.parametrize("number", NO_NUMBERS, ids=ascii)
def test_numbers_are_positive_and_not_absurd(cli: Cli, number: str) -> None:
    """Every option that takes a number refuses what is none, in one line that says so."""
    for command in (
        "synth amr.tum --timeout",
        "synth amr.tum --memory",
        "synth amr.tum --jobs",
        "explain amr.tum --cores",
        "explain amr.tum --max-cubes",
    ):
        *words, option = command.split()
        ran = cli(*words, f"{option}={number}")
        assert ran.code == 2
        said = ran.err.splitlines()[-1]
        assert f"argument {option}: " in said
        assert "is not a" in said or "is more than 1,000,000,000" in said
        assert len(said) < 200


def test_a_half_is_no_whole_number(cli: Cli) -> None:
    """Time alone may be divided."""
    assert cli("synth", "amr.tum", "--timeout", "59.5").code == 0
    assert cli("synth", "amr.tum", "--memory", "1.5").code == 2


@pytest.mark.parametrize(
    "command",
    [name for name in COMMANDS if {"policy", "specs"} <= set(load(name).Options.__struct_fields__)],
)
def test_files_the_wrong_way_round(cli: Cli, command: str) -> None:
    """A specification and then a policy: exit 2, and the command that was meant."""
    rest = ["S_Load=free"] if command == "why" else []
    first = ["coq"] if command == "export" else []
    ran = cli(command, *first, "amr.tum", "amr.json", *rest)
    assert (ran.code, ran.out) == (2, "")
    assert "`amr.tum` is a specification and `amr.json` a policy" in ran.err
    assert " ".join(["tumato-sym", command, *first, "amr.json", "amr.tum", *rest]) in ran.err


@pytest.mark.parametrize(
    ("command", "said"),
    [
        ("decide amr.tum S_Load=free", "`amr.tum` is a specification, but a policy belongs here"),
        ("show amr.tum", "`amr.tum` is a specification, but a policy belongs here"),
        ("diff amr.json amr.json amr.json", "`amr.json` is a policy, but a specification belongs here"),
        ("format amr.json", "`amr.json` is a policy, but a specification belongs here"),
        ("verify amr.tum amr.tum", "`amr.tum` is a specification, but a policy belongs here"),
        ("synth amr.json", "`amr.json` is a policy, but a specification belongs here"),
        ("explain holed.unrealizable.json", "`holed.unrealizable.json` is a certificate, but a specification belongs"),
        ("verify two_robots.tum holed.unrealizable.json", "`holed.unrealizable.json` a certificate: swap them"),
    ],
)
def test_a_file_of_the_other_kind(cli: Cli, command: str, said: str) -> None:
    """A specification where a policy belongs, and the other way round: exit 2, and both kinds are named."""
    ran = cli(*command.split())
    assert (ran.code, ran.out) == (2, "")
    assert said in ran.err


@pytest.mark.parametrize("command", ["check", "synth", "explain"])
@pytest.mark.parametrize(
    ("name", "said", "way_out"),
    [
        ("amr.json", "is a policy, but a specification belongs here", "`tumato-sym verify amr.json SPEC` proves it"),
        ("holed.unrealizable.json", "is a certificate, but a specification", "`tumato-sym verify holed.unreal"),
        ("package.json", "is a JSON file, but a specification belongs here", "a specification is a text of blocks"),
        ("list.json", "is a JSON file, but a specification belongs here", "a specification is a text of blocks"),
        ("notes.md", "unexpected `#`", "a specification is a text of blocks"),
    ],
)
def test_no_specification(cli: Cli, command: str, name: str, said: str, way_out: str) -> None:
    """Where a specification belongs, another file is said to be one, with a way out; `check` goes on with the rest."""
    Path("package.json").write_text('{"name": "robot"}', encoding="utf-8")
    Path("list.json").write_text("[1, 2]", encoding="utf-8")
    Path("notes.md").write_text("# Notes\n", encoding="utf-8")
    ran = cli(command, name, *(["amr.tum"] if command == "check" else []))
    assert ran.code == 2
    assert said in ran.out + ran.err
    assert f"  help: {way_out}" in ran.out + ran.err
    assert command != "check" or "amr.tum: no findings" in ran.out


def test_our_own_refuted_policy_is_a_bug_and_is_not_written(
    cli: Cli, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """If the verifier refutes what `synth` found, nothing is written and the exit code is 70."""
    from tumato_symbolic import verify
    from tumato_symbolic.policy import Policy

    def against_the_wrong_policy(_: Policy, *arguments: object, **settings: object) -> object:
        return verify(Policy.load("lazy.json"), *arguments, **settings)  # type: ignore[arg-type]

    monkeypatch.setattr(prove, "verify", against_the_wrong_policy)
    ran = cli("synth", "amr.tum")
    assert ran.code == 70
    assert not (tmp_path / "policy.json").exists()


def test_an_unproved_policy_is_undecided_and_not_written(
    cli: Cli, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """If the verifier meets its limits, nothing is written, the exit code is 3 and the verdict `undecided`."""
    from msgspec.structs import replace

    from tumato_symbolic import verify

    def giving_up(*arguments: object, **settings: object) -> object:
        return replace(verify(*arguments, **settings), verdict="undecided")  # type: ignore[arg-type]

    monkeypatch.setattr(prove, "verify", giving_up)
    ran = cli("synth", "amr.tum", "--output-format", "json")
    report = json.loads(ran.out)
    assert (ran.code, report["verdict"], report["policy"]) == (3, "undecided", None)
    assert "may be realizable" in cli("synth", "amr.tum").out
    assert not (tmp_path / "policy.json").exists()


def test_another_ordering_has_to_be_said_again(cli: Cli) -> None:
    """A policy that was asked for under `first` is no policy where nobody asks for `first`; the next steps say so."""
    ran = cli("synth", "amr.tum", "--effect-ordering", "first")
    assert (ran.code, ran.out.splitlines()[-1]) == (
        0,
        "  tumato-sym verify policy.json amr.tum --effect-ordering first",
    )
    assert cli("verify", "policy.json", "amr.tum", "--effect-ordering", "first").code == 0
    refused = cli("verify", "policy.json", "amr.tum")
    assert refused.code == 1
    assert "ordering refuted" in refused.out


def test_help_says_which_ordering_counts(cli: Cli, tmp_path: Path) -> None:
    """A policy does not choose what it is held against, and help does not say so; a certificate says what it is for."""
    text = (tmp_path / "amr.tum").read_text()
    (tmp_path / "first.tum").write_text(text.replace("max_plan_length", "effect_ordering: first\nmax_plan_length"))
    assert cli("synth", "two_robots.tum", "--effect-ordering", "first").code == 1
    claims = ("amr.json", "first.tum"), ("policy.unrealizable.json", "two_robots.tum")
    for command in ("verify", "report", "why", "export"):
        said = " ".join(cli(command, "--help").out.split())
        assert "(default: the specification's, else any" in said
        assert ("the one that it records" in said) == (command in ("verify", "report"))
    for claim in claims:
        answer = json.loads(cli("verify", *claim, "--output-format", "json").out)
        assert answer["effect_ordering"] == "first"
