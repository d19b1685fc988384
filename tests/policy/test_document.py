"""`docs/policy.md` is true."""

import doctest
import re
import subprocess
import sys
from pathlib import Path

import pytest

from tumato_symbolic.diagnostics import Code
from tumato_symbolic.policy import Policy, as_diagram, as_table, dumps, loads
from tumato_symbolic.policy.text import MAX_BYTES

DOCUMENT = Path(__file__).parents[2] / "docs" / "policy.md"
TABLE, DIAGRAM = re.findall(r"```json\n(.*?)```", DOCUMENT.read_text(encoding="utf-8"), re.DOTALL)


def test_the_examples_are_what_is_written() -> None:
    """Both examples are read, and written again character by character; they are the same policy."""
    table, diagram = loads(TABLE), loads(DIAGRAM)
    assert dumps(table) == TABLE
    assert dumps(diagram) == DIAGRAM
    assert as_diagram(table) == diagram.decisions
    assert as_table(diagram, 3) == table.decisions
    assert dumps(Policy(table.vocabulary, as_diagram(table), table.ordering)) == DIAGRAM


def test_the_python_example_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The session prints what the document says."""
    monkeypatch.chdir(tmp_path)
    Path("policy.json").write_text(TABLE, encoding="utf-8")
    assert doctest.testfile(str(DOCUMENT), module_relative=False, encoding="utf-8") == (0, 9)


def test_the_codes_and_the_limit_are_named() -> None:
    """Every error code of policies stands in the document, and the size limit is the true one."""
    text = DOCUMENT.read_text(encoding="utf-8")
    errors = [code.name for code in Code if code.name.startswith("TUM5") and code.severity == "error"]
    assert all(name in text for name in errors)
    assert f"more than {MAX_BYTES // 1024**2} MiB" in text


def test_asking_a_policy_loads_no_engine() -> None:
    """Importing the room and asking a policy imports neither lark nor dd nor z3."""
    script = (
        "import sys; from tumato_symbolic.policy import loads;"
        "loads(sys.stdin.read()).decide({'S_Place': 'dock', 'S_Belt': 'off'});"
        "print(sorted({'lark', 'dd', 'z3', 'tempfile', 'jsonschema'} & set(sys.modules)))"
    )
    run = subprocess.run([sys.executable, "-c", script], input=TABLE, capture_output=True, text=True, check=True)
    assert run.stdout == "[]\n"
