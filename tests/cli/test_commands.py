"""A command is one module and one line in the table of commands."""

import ast
import inspect
import json
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.cli.conftest import Cli
from tests.limits import campaign
from tests.repo.documents import ROOT
from tumato_symbolic.cli import commands
from tumato_symbolic.cli.commands import COMMANDS, load
from tumato_symbolic.cli.options import Argument, CommandOptions

CLI = ROOT / "tumato_symbolic" / "cli"

TOY = """
from tumato_symbolic.cli import arguments
from tumato_symbolic.cli.options import CommandOptions, OutputFormat, Target, argument
from tumato_symbolic.cli.output import show_as

ABOUT = "Count the bytes of a specification."
EXAMPLES = "examples:\\n  tumato-sym count-bytes amr.tum\\n"


class Options(CommandOptions, frozen=True):
    specs: tuple[str, ...] = arguments.specs()
    times: int = argument("--times", type=int, default=1, metavar="N", help="count so often")
    output: str | None = argument("--output", metavar="FILE", help="a copy of the number", writes=Target("number"))
    output_format: OutputFormat = arguments.output_format("json")

    def mistake(self):
        return "--times is for people who doubt" if self.times > 3 else None


def run(options, context):
    from pathlib import Path

    size = len(Path(options.specs[0]).read_bytes())
    context.learn(size)
    context.check()
    show_as(options, text=lambda _: f"{size} bytes", json=lambda: {"bytes": size})
    return 0


def stopped(known, why, options):
    show_as(options, text=lambda _: f"{known} bytes, {why}", json=lambda: {"bytes": known})
    return 3
"""
"""A command as somebody might add it."""


@pytest.fixture
def toy(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Add the toy: its module, and its line in the table."""
    folder = tmp_path / "commands"
    folder.mkdir()
    (folder / "count_bytes.py").write_text(TOY)
    monkeypatch.setattr(commands, "__path__", [*commands.__path__, str(folder)])
    monkeypatch.setitem(COMMANDS, "count-bytes", "how large a specification is")
    yield
    del sys.modules[f"{commands.__name__}.count_bytes"]


@pytest.mark.usefixtures("toy")
def test_a_module_and_a_line_make_a_command(cli: Cli, tmp_path: Path) -> None:
    """It has help, options, mistakes, formats, and its outputs are guarded, with nothing else touched."""
    assert "  count-bytes  how large a specification is" in cli("--help").out
    said = cli("count-bytes", "--help").out
    assert "Count the bytes" in said
    assert "--times N" in said
    assert "exit codes:" in said
    size = (tmp_path / "amr.tum").stat().st_size
    assert cli("count-bytes", "amr.tum").out == f"{size} bytes\n"
    assert json.loads(cli("count-bytes", "amr.tum", "--output-format", "json").out) == {"bytes": size}
    apart = cli("count-bytes", "amr.tum", "--output", "-")
    assert (apart.out, apart.err) == ("", f"{size} bytes\n")
    for words, expected in (
        ("--times 4", "tumato-sym: error: count-bytes: --times is for people who doubt"),
        ("--output amr.tum", "TUM118"),
        ("--output nowhere/copy", "TUM510"),
        ("--frobnicate", "tumato-sym count-bytes: error: unrecognized arguments: --frobnicate"),
    ):
        ran = cli("count-bytes", "amr.tum", *words.split())
        assert (ran.code, expected in ran.err) == (2, True), words


def test_every_module_is_in_the_table() -> None:
    """No command is without a module, and no module without a command."""
    modules = {path.stem for path in (CLI / "commands").glob("*.py")} - {"__init__"}
    assert modules == {name.replace("-", "_") for name in COMMANDS}


@pytest.mark.parametrize("name", COMMANDS)
def test_commands_have_one_face(name: str) -> None:
    """Texts, a frozen record of options, `run`, and `stopped` where something is learned."""
    command = load(name)
    assert command.ABOUT.endswith("\n")
    assert command.EXAMPLES.endswith("\n")
    assert f"  tumato-sym {name} " in command.EXAMPLES
    options = command.Options
    assert issubclass(options, CommandOptions)
    assert all(isinstance(each, Argument) for each in options.arguments().values()), "made by `argument`"
    assert len(inspect.signature(command.run).parameters) == 2
    if hasattr(command, "stopped"):
        assert len(inspect.signature(command.stopped).parameters) == 3


def test_nothing_else_names_commands() -> None:
    """Outside their modules and the table, the command line does not say of which command it speaks."""
    for path in CLI.glob("*.py"):
        named = {node.value for node in ast.walk(ast.parse(path.read_text())) if isinstance(node, ast.Constant)}
        assert not named & set(COMMANDS), path.name


def test_options_of_several_commands_are_defined_once() -> None:
    """A flag that two commands know is in `arguments`, and in no module of a command."""
    spelled = []
    for path in (CLI / "commands").glob("*.py"):
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "argument":
                spelled += [each.value for each in node.args if isinstance(each, ast.Constant)]
    assert "--strict" in spelled
    assert len(spelled) == len(set(spelled))


def test_limits_are_tried_on_every_command_that_has_some() -> None:
    """The campaign on limits knows every command with a time limit."""
    limited = {name for name in COMMANDS if "timeout" in load(name).Options.__struct_fields__}
    assert set(campaign.COMMANDS) == limited


@pytest.mark.parametrize(
    ("words", "meant"),
    [
        ("synt amr.tum", "synth"),
        ("synth --timeot 3 amr.tum", "--timeout"),
        ("synth --jbos=2 amr.tum", "--jobs"),
        ("export pyton amr.json amr.tum", "python"),
        ("verify amr.json amr.tum --prover wlk", "walk"),
    ],
)
def test_a_mistyped_word_is_recognized(cli: Cli, words: str, meant: str) -> None:
    """A command, an option, a target and a choice: what is meant is said at the end; nothing where nothing is near."""
    ran = cli(*words.split())
    assert ran.code == 2
    assert ran.err.endswith(f"; did you mean {meant}?\n")
    ran = cli("qqqqq", "amr.tum")
    assert ran.code == 2
    assert "did you mean" not in ran.err


def test_the_documents_know_every_command() -> None:
    """The README or a document shows each command being called."""
    documents = "".join(path.read_text() for path in (ROOT / "README.md", *(ROOT / "docs").glob("*.md")))
    assert [name for name in COMMANDS if f"tumato-sym {name}" not in documents] == []


@pytest.mark.parametrize(
    "words",
    [
        "run amr.json amr.tum --faults none S_Location=corridor S_Battery=low S_Load=free S_Conveyor=on",
        "run amr.json amr.tum S_Location=corridor --faults none S_Battery=low --seed 1 S_Load=free S_Conveyor=on",
        "verify amr.json --prover walk amr.tum",
        "decide amr.json S_Location=corridor S_Battery=low S_Load=free S_Conveyor=on",
    ],
)
def test_words_may_follow_options(cli: Cli, words: str) -> None:
    """Where any number of words may stand, they may stand after options; an unknown option is still refused."""
    assert cli(*words.split()).code == 0
    refused = cli(*words.split(), "--unknown", "word")
    assert refused.code == 2
    assert "unrecognized arguments: --unknown word" in refused.err
