"""The example notebook runs from the first cell to the last."""

from __future__ import annotations

import ast
import importlib.util
import json
from typing import Any

import pytest

from tests.repo.documents import ROOT

NOTEBOOK: dict[str, Any] = json.loads((ROOT / "examples" / "notebook.ipynb").read_text())


def needs(cell: dict[str, Any]) -> list[str]:
    """The packages without which a cell is left out."""
    return [tag.removeprefix("needs-") for tag in cell["metadata"].get("tags", ()) if tag.startswith("needs-")]


def run(source: str, names: dict[str, Any]) -> object:
    """Execute a cell, and return the value of its last line, if that is an expression."""
    tree = ast.parse(source)
    *_, last = tree.body
    value = ast.Expression(tree.body.pop().value) if isinstance(last, ast.Expr) else None  # type: ignore[attr-defined]
    exec(compile(tree, "cell", "exec"), names)
    return None if value is None else eval(compile(value, "cell", "eval"), names)


def test_every_cell_runs(monkeypatch: pytest.MonkeyPatch) -> None:
    """In order, in the folder of the notebook; what it shows is what its text says."""
    monkeypatch.chdir(ROOT / "examples")
    names: dict[str, Any] = {}
    shown = {}
    for cell in NOTEBOOK["cells"]:
        if cell["cell_type"] == "code" and all(importlib.util.find_spec(name) for name in needs(cell)):
            shown[cell["id"]] = run("".join(cell["source"]), names)
    found: list[Any] = list(shown.values())
    assert "Not proved yet" in found[0]._repr_html_()
    assert (found[1].verdict, found[2]) == ("proved", ("move_to_charger",))
    assert found[-2], "there is a state in which it rests"
    assert found[-1][0] == (("charger", "ok", "free", "off"), ("move_to_corridor",))


def test_it_is_a_notebook_without_output() -> None:
    """Format 4.5: every cell has an identifier of its own; outputs are not kept."""
    assert (NOTEBOOK["nbformat"], NOTEBOOK["nbformat_minor"]) == (4, 5)
    identifiers = [cell["id"] for cell in NOTEBOOK["cells"]]
    assert len({*identifiers}) == len(identifiers)
    code = [cell for cell in NOTEBOOK["cells"] if cell["cell_type"] == "code"]
    assert all((cell["outputs"], cell["execution_count"]) == ([], None) for cell in code)
