"""What docs/architecture.md says of the house is so."""

import ast
import re
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.repo.index import MAP, about, constants, files, first_sentence, name_of, with_index
from tumato_symbolic.cli import commands
from tumato_symbolic.cli.main import main

ROOT = Path(__file__).parents[2]
PACKAGE = ROOT / "tumato_symbolic"
DECISIONS = ROOT / "docs" / "decisions"
TEXT = MAP.read_text(encoding="utf-8")
NAMED = re.findall(r"`([\w./-]+)`", TEXT)
TRUSTED = TEXT[TEXT.index("## What has to be trusted") : TEXT.index("## Glossary")]
KERNELS = re.findall(r"^\| (`.*?`) \| (\d+) \|", TRUSTED, re.MULTILINE)
CHANGES = TEXT[TEXT.index("## Where a change goes") : TEXT.index("**A worked example")]
EXAMPLES = {"cli/commands/NAME.py", "cli/commands/count.py"}
"""Files that are to be written."""

_ENDING = re.compile(r"\w\.(?:py|md|mjs|json|lark|toml|tum|v|cpp|hpp|el|vim|ya?ml|txt)$")


def test_every_room_is_named() -> None:
    """Packages below the package, and those inside a room."""
    rooms = {path.parent.relative_to(PACKAGE).as_posix() for path in PACKAGE.glob("*/__init__.py")}
    rooms |= {path.parent.relative_to(PACKAGE).as_posix() for path in PACKAGE.glob("*/*/__init__.py")}
    assert rooms <= {name.rstrip("/") for name in NAMED}


def test_every_path_leads_somewhere() -> None:
    """A path begins at the root or in the package, not in a folder that was named before, and means one file."""
    paths = [name for name in NAMED if _is_path(name) and name not in EXAMPLES]
    assert len(paths) > 200
    assert [name for name in paths if len(_places(name)) != 1] == []


def test_a_shortened_path_is_noticed() -> None:
    """The name of a file alone, or what is no file at all."""
    assert all(map(_is_path, ("goals.py", "semantics/goals.py", "export/nothing", ".ci/run", "pyproject.toml")))
    assert not any(map(_is_path, ("Steps.valid", "report", "Makefile", ".mjs")))
    assert [len(_places(name)) for name in ("goals.py", "export/nothing", "semantics/goals.py", ".ci/run")] == [
        0,
        0,
        1,
        1,
    ]


def test_paths_in_decisions_lead_somewhere() -> None:
    """In the same way."""
    for document in DECISIONS.glob("*.md"):
        names = re.findall(r"`([\w./-]+)`", document.read_text(encoding="utf-8"))
        assert [name for name in names if _is_path(name) and len(_places(name)) != 1] == [], document.name


def test_what_a_room_offers_is_taken() -> None:
    """Each name that the `__init__` of a room imports is imported from it, or asked of it, somewhere else."""
    trees = [ast.parse(path.read_text(encoding="utf-8")) for path in _sources()]
    nodes = [node for tree in trees for node in ast.walk(tree)]
    taken = {(node.module, name.name) for node in nodes if isinstance(node, ast.ImportFrom) for name in node.names}
    asked = {node.attr for node in nodes if isinstance(node, ast.Attribute)}
    offered = [
        (room, name.name)
        for path in PACKAGE.glob("*/**/__init__.py")
        for room in [".".join(path.parent.relative_to(ROOT).parts)]
        for each in ast.parse(path.read_text(encoding="utf-8")).body
        if isinstance(each, ast.ImportFrom)
        for name in each.names
        if str(each.module).startswith(f"{room}.")
    ]
    assert len(offered) > 300
    assert [(room, name) for room, name in offered if (room, name) not in taken and name not in asked] == []


def _sources() -> Iterator[Path]:
    for folder in ("tumato_symbolic", "tests", "benchmarks", "playground"):
        yield from (ROOT / folder).rglob("*.py")


def test_what_is_in_a_file_is_there() -> None:
    """`NAME` in `PATH`: a function, a class, a constant or a field of that name."""
    found = [pair for pair in re.findall(r"`(\w+)` in `([\w./-]+)`", TEXT) if _places(pair[1])[0].is_file()]
    assert len(found) > 20
    for name, path in found:
        assert _defines(_places(path)[0].read_text(encoding="utf-8"), name), (name, path)


def test_every_name_in_the_glossary_is_in_the_code() -> None:
    """The last column: a name, or an attribute of a class, is defined somewhere."""
    glossary = TEXT[TEXT.index("## Glossary") : TEXT.index("## Where a change goes")]
    code = "\n".join(path.read_text(encoding="utf-8") for path in PACKAGE.rglob("*.py"))
    rows = [line.rsplit("|", 2)[1] for line in glossary.splitlines() if line.startswith("| ")][1:]
    names = [name for row in rows for name in re.findall(r"`([\w.]+)`", row)]
    assert len(names) > 25
    for name in names:
        assert all(_defines(code, part) for part in name.split(".")), name


def test_kernels_are_as_large_as_is_said() -> None:
    """Lines that are not blank, to within a tenth."""
    assert len(KERNELS) > 10
    for kernel, size in KERNELS:
        lines = sum(_size(name) for name in _names(kernel))
        assert 0.9 * int(size) <= lines <= 1.1 * int(size), (kernel, lines)


def test_every_file_of_the_verifier_is_in_one_row_of_what_is_trusted() -> None:
    """By itself, or with its folder."""
    trusted = [name for kernel, _ in KERNELS for name in _names(kernel)]
    for path in sorted((PACKAGE / "verify").rglob("*.py")):
        name = path.relative_to(PACKAGE).as_posix()
        assert [each for each in trusted if name == each or name.startswith(f"{each}/")] != [], name
    assert len(set(trusted)) == len(trusted)


def test_every_room_is_trusted_or_said_not_to_be() -> None:
    """In a row, or in what is said of the others."""
    rooms = {path.parent.name for path in PACKAGE.glob("*/__init__.py")}
    assert rooms - {"verify"} <= set(_names(TRUSTED))


def test_every_change_has_one_row_that_says_where_to_begin() -> None:
    """Three columns, the second with a file, a folder or something to look for; no change is there twice."""
    rows = list(_rows(CHANGES))
    assert len(rows) > 70
    for row in rows:
        assert len(row) == 3, row
        assert "`" in row[1], row
    assert len({change for change, *_ in rows}) == len(rows)


def test_the_index_is_up_to_date() -> None:
    """Every file and every limit, as the sources describe them: `make regenerate`."""
    assert with_index(TEXT) == TEXT


def test_every_file_says_what_it_is() -> None:
    """In a sentence, and no two say the same."""
    said = [about(path) for path in files()]
    assert len(said) > 350
    assert [name_of(path) for path in files() if not about(path).endswith(".")] == []
    assert len(set(said)) == len(said)


def test_every_limit_says_what_it_limits() -> None:
    """Where it is defined."""
    assert len(constants()) > 300
    assert [constant.line() for constant in constants() if not constant.about] == []


def test_a_first_sentence_ends_where_the_next_begins() -> None:
    """Not at a point inside of a name or a number; without another one, the text is the sentence."""
    assert (
        first_sentence("A tree for BehaviorTree.CPP 4\n(2.1.0). `Rules` nest.")
        == "A tree for BehaviorTree.CPP 4 (2.1.0)."
    )
    assert first_sentence("See `files.py`, and so on.") == "See `files.py`, and so on."
    assert first_sentence("No point") == "No point"


def test_the_worked_example_works(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """The module as it stands there, and the line in the table, are a command."""
    module = re.search(r"```python\n(.*?)```", TEXT, re.DOTALL)
    line = re.search(r'`"count": "(.*?)",`', TEXT)
    assert module is not None
    assert line is not None
    (tmp_path / "count.py").write_text(module[1], encoding="utf-8")
    monkeypatch.setattr(commands, "__path__", [*commands.__path__, str(tmp_path)])
    monkeypatch.setitem(commands.COMMANDS, "count", line[1])
    try:
        assert main(["count", str(ROOT / "examples" / "coin.tum")]) == 0
    finally:
        sys.modules.pop(f"{commands.__name__}.count", None)
    assert capsys.readouterr().out.strip().isdigit()


def test_every_decision_is_listed() -> None:
    """And has a context, what was decided, what was rejected, and what follows."""
    listed = re.findall(r"\((\d{4}-[\w-]+\.md)\)", (DECISIONS / "README.md").read_text(encoding="utf-8"))
    assert listed == sorted(path.name for path in DECISIONS.glob("0*.md"))
    for name in listed:
        text = (DECISIONS / name).read_text(encoding="utf-8")
        assert all(f"**{part}.**" in text for part in ("Context", "Decision", "Rejected", "Consequences")), name


def _is_path(name: str) -> bool:
    """Whether a name in code marks is that of a file, or of something in a folder."""
    return "/" in name or _ENDING.search(name) is not None


def _places(name: str) -> list[Path]:
    """What a path that is written in full leads to."""
    return [path for path in (PACKAGE / name, ROOT / name) if path.exists()]


def _names(text: str) -> list[str]:
    return re.findall(r"`([\w./]+)`", text)


def _rows(text: str) -> Iterator[list[str]]:
    """The rows of all tables in a text, without their heads."""
    for line in text.splitlines():
        if line.startswith("| ") and not line.startswith("| change |"):
            yield [cell.strip() for cell in line.strip().strip("|").split(" |")]


def _defines(code: str, name: str) -> bool:
    return (
        re.search(rf"^\s*(?:(?:class|def) {name}\b|(?:(?:export )?const )?{name}(?:: | = ))", code, re.MULTILINE)
        is not None
    )


def _size(name: str) -> int:
    path = _places(name)[0]
    files = [path] if path.is_file() else sorted(path.rglob("*.py"))
    return sum(1 for file in files for line in file.read_text(encoding="utf-8").splitlines() if line.strip())
