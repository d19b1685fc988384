"""A playground in Chromium: built, served, used."""

from __future__ import annotations

import json
import subprocess
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache, partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any

from benchmarks.families import FAMILIES
from playground.assemble import assemble
from tests.page.in_browser import missing as no_browser
from tests.page.judged import NODE
from tests.repo.documents import ROOT

PROGRAM = Path(__file__).with_name("browser.cjs")
AMR = (ROOT / "examples" / "amr.tum").read_text(encoding="utf-8")
WRONG = AMR.replace("when S_Battery is low", "when S_Batery is low")


@cache
def pyodide() -> Path | None:
    """The folder of the npm package; None where it is not installed."""
    resolve = "process.stdout.write(require.resolve('pyodide/package.json'))"
    found = subprocess.run(
        [str(NODE), "-e", resolve], capture_output=True, text=True, cwd=ROOT / "playground", check=False
    )
    return Path(found.stdout).parent if found.returncode == 0 else None


@cache
def missing() -> str | None:
    """What is not installed; None where all is there."""
    if (lacking := no_browser()) is not None:
        return lacking
    return None if pyodide() else "neither playground/node_modules nor NODE_PATH has pyodide"


def used(folder: Path, pictures: Path | None = None) -> dict[str, Any]:
    """Build a playground in a folder, and say what is seen of it; pictures go to another folder."""
    runtime = pyodide()
    assert runtime is not None
    assemble(runtime, folder)
    slow = FAMILIES["plant"].text(10, True)
    with _served(folder) as address:
        asked = {"address": address, "wrong": WRONG, "slow": slow, "pictures": pictures and str(pictures.resolve())}
        command = [str(NODE), str(PROGRAM)]
        ran = subprocess.run(command, input=json.dumps(asked), capture_output=True, text=True, check=False)
    assert ran.returncode == 0, ran.stderr
    found: dict[str, Any] = json.loads(ran.stdout)
    return found


class _Server(ThreadingHTTPServer):
    def handle_error(self, request: object, client_address: object) -> None:
        """Nothing: a worker that is ended no longer wants what it asked for."""


class _Silent(SimpleHTTPRequestHandler):
    def log_message(self, format: str, *args: object) -> None:
        """Nothing."""


@contextmanager
def _served(folder: Path) -> Iterator[str]:
    server = _Server(("127.0.0.1", 0), partial(_Silent, directory=str(folder)))
    thread = threading.Thread(target=server.serve_forever, daemon=True)
    thread.start()
    try:
        yield f"http://127.0.0.1:{server.server_port}/"
    finally:
        server.shutdown()
        server.server_close()
