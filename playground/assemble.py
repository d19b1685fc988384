"""Puts the playground together: static files that ask no other host for anything. `make playground` runs it.

The Python packages are those of the interpreter that runs this; they are compiled to byte code by the Pyodide that will
run them, with node.
"""

from __future__ import annotations

import argparse
import json
import re
import shutil
import subprocess
import sys
import tempfile
import zipfile
from collections.abc import Iterator
from importlib.metadata import distribution
from pathlib import Path
from typing import Final

from tumato_symbolic.report.html.contents import NoPolicyPage, PolicyPage
from tumato_symbolic.report.html.page import sources

HERE: Final = Path(__file__).parent
ROOT: Final = HERE.parent

RUNTIME: Final = ("pyodide.mjs", "pyodide.asm.mjs", "pyodide.asm.wasm", "python_stdlib.zip", "pyodide-lock.json")
"""What Pyodide loads."""

DISTRIBUTIONS: Final = ("dd", "astutils", "ply")
"""Packages that synthesis needs, in pure Python."""

COMPILED: Final = ("msgspec",)
"""Packages that have a wheel for Pyodide's platform."""

PAGE_FILES: Final = ("playground.css", "app.mjs", "answer.mjs", "editor.mjs", "python.mjs", "sharing.mjs", "worker.mjs")


def assemble(pyodide: Path, target: Path) -> None:
    """Write all of it to a folder, in place of what an earlier build left there."""
    if missing := [name for name in RUNTIME if not (pyodide / name).is_file()]:
        sys.exit(f"{pyodide} has no {missing[0]}: `npm install pyodide` brings it")
    shutil.rmtree(target, ignore_errors=True)
    (target / "runtime").mkdir(parents=True)
    for name in RUNTIME:
        shutil.copyfile(pyodide / name, target / "runtime" / name)
    for name in PAGE_FILES:
        shutil.copyfile(HERE / name, target / name)
    (target / "index.html").write_text(_index(), encoding="utf-8")
    (target / "examples.json").write_text(json.dumps(dict(_examples())), encoding="utf-8")
    with tempfile.TemporaryDirectory() as folder:
        plain = Path(folder) / "packages.zip"
        with zipfile.ZipFile(plain, "w", zipfile.ZIP_DEFLATED) as archive:
            for name, path in sorted((*_packaged(), *_compiled(pyodide, Path(folder) / "wheels"))):
                archive.write(path, name)
        command = ["node", str(HERE / "compile.mjs"), str(pyodide.resolve()), str(plain), str(target / "packages.zip")]
        subprocess.run(command, check=True)


def _index() -> str:
    """The page, with a policy that lets it load what is beside it, and show pages of reports in a frame."""
    pages = [sources(kind) for kind in (PolicyPage, NoPolicyPage)]

    def allowed(what: str) -> str:
        return " ".join(dict.fromkeys((what, "'self'", *(each[what] for each in pages))))

    policy = "; ".join(
        (
            *("default-src 'none'", allowed("script-src"), allowed("style-src"), "connect-src 'self'"),
            *("worker-src 'self'", "frame-src blob:", "img-src data:", "base-uri 'none'", "form-action 'none'"),
        )
    )
    return (HERE / "index.html").read_text(encoding="utf-8").replace("{{policy}}", policy)


def _examples() -> Iterator[tuple[str, str]]:
    for path in sorted((ROOT / "examples").glob("*.tum")):
        yield path.stem, path.read_text(encoding="utf-8")


def _packaged() -> Iterator[tuple[str, Path]]:
    """Names in the archive, and the files: the package, what runs it in the worker, and what it needs."""
    for top in ("tumato_symbolic", "playground"):
        wanted = r"__init__\.py|session\.py" if top == "playground" else r".*\.(py|json|mjs|css|html)"
        for path in (ROOT / top).rglob("*"):
            if re.fullmatch(wanted, path.name) and not {"lsp", "build", "node_modules"} & set(path.parts):
                yield path.relative_to(ROOT).as_posix(), path
    yield "tumato_symbolic/syntax/tumato.lark", ROOT / "grammar" / "tumato.lark"
    yield "tumato_symbolic/LICENSE", ROOT / "LICENSE"
    yield "proofs/checker.py", ROOT / "proofs" / "checker.py"
    for name in DISTRIBUTIONS:
        for file in distribution(name).files or ():
            if file.suffix == ".py" or "LICENSE" in file.name:
                yield file.as_posix(), Path(str(file.locate()))


def _compiled(pyodide: Path, folder: Path) -> Iterator[tuple[str, Path]]:
    """The same of the packages that are compiled, in the versions that are installed here, from the package index."""
    runtime = json.loads((pyodide / "pyodide-lock.json").read_text(encoding="utf-8"))["info"]
    major, minor, *_ = runtime["python"].split(".")
    platform = f"pyemscripten_{runtime['abi_version']}_{runtime['arch']}"
    wanted = [f"{name}=={distribution(name).version}" for name in COMPILED]
    about = ["--platform", platform, "--python-version", f"{major}.{minor}", "--abi", f"cp{major}{minor}"]
    pip = [sys.executable, "-m", "pip", "download", "--quiet", "--disable-pip-version-check", "--no-deps"]
    subprocess.run([*pip, "--only-binary=:all:", *about, "--dest", str(folder), *wanted], check=True)
    for wheel in folder.glob("*.whl"):
        with zipfile.ZipFile(wheel) as archive:
            archive.extractall(folder / wheel.stem)
        for path in (folder / wheel.stem).rglob("*"):
            if path.suffix in {".py", ".so"} or "LICENSE" in path.name:
                yield path.relative_to(folder / wheel.stem).as_posix(), path


def main() -> None:
    """Read the command line, and build."""
    parser = argparse.ArgumentParser(prog="python -m playground.assemble", description=__doc__)
    pyodide = HERE / "node_modules" / "pyodide"
    parser.add_argument("--pyodide", type=Path, default=pyodide, help="the folder of the npm package")
    parser.add_argument("-o", "--output", type=Path, default=HERE / "build", help="where to (default: %(default)s)")
    options = parser.parse_args()
    assemble(options.pyodide, options.output)
    size = sum(path.stat().st_size for path in options.output.rglob("*") if path.is_file())
    print(f"{options.output} is written, {size / 1e6:.1f} MB: serve it, as `python3 -m http.server -d` does")


if __name__ == "__main__":
    main()
