"""Pages in Chromium: opened, filtered, stepped through, compared."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from collections.abc import Sequence
from functools import cache
from pathlib import Path
from typing import Any

from tests.page.judged import NODE

PROGRAM = Path(__file__).with_name("browser.cjs")


@cache
def missing() -> str | None:
    """What is not installed that a browser takes; None where all is there."""
    if NODE is None:
        return "node is not installed"
    if not any(map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))):
        return "Chromium is not installed"
    found = subprocess.run([NODE, "-e", "require('playwright-core')"], capture_output=True, check=False)
    return None if found.returncode == 0 else "NODE_PATH leads to no playwright-core"


def seen(pages: Sequence[tuple[Path, Path]]) -> list[dict[str, Any]]:
    """What there is to see on pages, each compared with a policy file."""
    return _answered([{"page": str(page.resolve()), "other": str(other.resolve())} for page, other in pages])


def read(page: Path, acts: Sequence[tuple[object, ...]]) -> list[Any]:
    """What `text` and `property` find on a page, among other acts: name, selector, and a detail."""
    (found,) = _answered([{"page": str(page.resolve()), "acts": acts}])
    assert (found["errors"], found["requests"]) == ([], [])
    values: list[Any] = found["read"]
    return values


def _answered(asked: Sequence[dict[str, object]]) -> list[dict[str, Any]]:
    command = [str(NODE), str(PROGRAM)]
    ran = subprocess.run(command, input=json.dumps(asked), capture_output=True, text=True, check=False, env=os.environ)
    assert ran.returncode == 0, ran.stderr
    found: list[dict[str, Any]] = json.loads(ran.stdout)
    return found
