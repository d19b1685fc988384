"""What docs/architecture.md says of the house is so."""

import re
import sys
from pathlib import Path

import pytest

from tumato_symbolic.cli import commands
from tumato_symbolic.cli.main import main

ROOT = Path(__file__).parents[2]
PACKAGE = ROOT / "tumato_symbolic"
TEXT = (ROOT / "docs" / "architecture.md").read_text(encoding="utf-8")
NAMED = re.findall(r"`([\w./-]+)`", TEXT)


def test_every_room_is_named() -> None:
    """Packages below the package, and those inside a room."""
    rooms = {path.parent.relative_to(PACKAGE).as_posix() for path in PACKAGE.glob("*/__init__.py")}
    rooms |= {path.parent.relative_to(PACKAGE).as_posix() for path in PACKAGE.glob("*/*/__init__.py")}
    assert rooms <= {name.rstrip("/") for name in NAMED}


def test_every_file_that_is_named_exists() -> None:
    """From the root, from the package, or by a name that only one file of the package has."""
    placeholders = {"cli/commands/NAME.py", "cli/commands/count.py"}
    names = [name for name in NAMED if re.search(r"\.(py|md|lark|toml)$", name) and name not in placeholders]
    assert len(names) > 50
    known = [path.name for path in PACKAGE.rglob("*.py")]
    for name in names:
        found = (ROOT / name).exists() or (PACKAGE / name).exists() or known.count(name) == 1
        assert found, name


def test_every_name_in_the_glossary_is_in_the_code() -> None:
    """The last column: a name, or an attribute of a class, is defined somewhere."""
    glossary = TEXT[TEXT.index("## Glossary") : TEXT.index("## Where a change goes")]
    code = "\n".join(path.read_text(encoding="utf-8") for path in PACKAGE.rglob("*.py"))
    rows = [line.rsplit("|", 2)[1] for line in glossary.splitlines() if line.startswith("| ")][1:]
    names = [name for row in rows for name in re.findall(r"`([\w.]+)`", row)]
    assert len(names) > 25
    for name in names:
        for part in name.split("."):
            defined = rf"^\s*(?:(?:class|def) {part}\b|{part}(?:: | = ))"
            assert re.search(defined, code, re.MULTILINE), name


def test_kernels_are_as_large_as_is_said() -> None:
    """Lines that are not blank, to within a tenth."""
    rows = re.findall(r"^\| (`.*?`) \| (\d+) \|", TEXT, re.MULTILINE)
    assert len(rows) == 11
    for kernel, size in rows:
        lines = sum(map(_size, re.findall(r"`([\w./]+)`", kernel)))
        assert 0.9 * int(size) <= lines <= 1.1 * int(size), (kernel, lines)


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
    folder = ROOT / "docs" / "decisions"
    listed = re.findall(r"\((\d{4}-[\w-]+\.md)\)", (folder / "README.md").read_text(encoding="utf-8"))
    assert listed == sorted(path.name for path in folder.glob("0*.md"))
    for name in listed:
        text = (folder / name).read_text(encoding="utf-8")
        assert all(f"**{part}.**" in text for part in ("Context", "Decision", "Rejected", "Consequences")), name


def _size(name: str) -> int:
    path = next(path for path in (PACKAGE / name, ROOT / name) if path.exists())
    files = [path] if path.is_file() else sorted(path.rglob("*.py"))
    return sum(1 for file in files for line in file.read_text(encoding="utf-8").splitlines() if line.strip())
