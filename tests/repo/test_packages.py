"""What is published works outside the checkout."""

import subprocess
import sys
import sysconfig
import tarfile
import zipfile
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.repo.documents import ROOT


@pytest.fixture(scope="module", autouse=True)
def _no_other_modules() -> Iterator[None]:
    """What `PYTHONPATH` names would be found before what is installed."""
    with pytest.MonkeyPatch.context() as patched:
        patched.delenv("PYTHONPATH", raising=False)
        yield


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the sdist, and the wheel that is built from the sdist."""
    folder = tmp_path_factory.mktemp("dist")
    subprocess.run(
        [sys.executable, "-m", "build", "--no-isolation", "--outdir", str(folder), str(ROOT)],
        capture_output=True,
        text=True,
        check=True,
        timeout=300,
    )
    return folder


def test_the_wheel_installs_and_runs_outside_the_checkout(built: Path, tmp_path: Path) -> None:
    """Installed from the wheel into an environment of its own, `tumato-sym` checks, synthesizes, verifies, decides."""
    (wheel,) = built.glob("*.whl")
    environment = tmp_path / "environment"
    # Without a pip of its own, which takes longer than all else here: ours installs into it.
    subprocess.run([sys.executable, "-m", "venv", "--without-pip", str(environment)], check=True, timeout=120)
    python = str(environment / "bin" / "python")
    pip = [sys.executable, "-m", "pip", "--python", python]
    install = [*pip, "install", "--quiet", "--no-index", "--no-deps", "--no-compile", str(wheel)]
    subprocess.run(install, check=True, timeout=120)
    # Dependencies come from here, so that the test needs no network; our own editable install does not come along.
    packages = sysconfig.get_path("purelib", vars={"base": str(environment), "platbase": str(environment)})
    (Path(packages) / "dependencies.pth").write_text(sysconfig.get_path("purelib") + "\n")
    (tmp_path / "amr.tum").write_text((ROOT / "examples" / "amr.tum").read_text())
    state = ["S_Location=corridor", "S_Battery=low", "S_Load=free", "S_Conveyor=off"]
    for arguments in (
        ["check", "amr.tum"],
        ["synth", "amr.tum"],
        ["verify", "policy.json", "amr.tum"],
        ["decide", "policy.json", *state],
    ):
        command = [str(environment / "bin" / "tumato-sym"), *arguments]
        ran = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=60, check=False)
        assert ran.returncode == 0, ran.stderr
    where = subprocess.run(
        [python, "-c", "import tumato_symbolic; print(tumato_symbolic.__file__)"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=True,
    )
    assert where.stdout.startswith(str(environment))


def test_the_wheel_holds_what_it_needs(built: Path) -> None:
    """The wheel has the grammar, its table, the schema, the page, the type marker and the licence; no tests."""
    (wheel,) = built.glob("*.whl")
    names = zipfile.ZipFile(wheel).namelist()
    assert "tumato_symbolic/syntax/tumato.lark" in names
    assert "tumato_symbolic/syntax/tumato.table.json" in names
    assert "tumato_symbolic/py.typed" in names
    assert {f"tumato_symbolic/report/html/{name}" for name in ("page.html", "page.css", "judge.mjs")} <= set(names)
    assert any(name.endswith(".schema.json") for name in names)
    assert any(name.endswith("LICENSE") for name in names)
    assert all(name.startswith(("tumato_symbolic/", "tumato_symbolic-")) for name in names)


def test_the_sdist_holds_the_repository(built: Path) -> None:
    """The sdist has what `make test` needs."""
    (sdist,) = built.glob("*.tar.gz")
    with tarfile.open(sdist) as archive:
        names = {name.partition("/")[2] for name in archive.getnames()}
    wanted = ["grammar/tumato.lark", "examples/amr.tum", "docs/semantics.md", "proofs/amr.policy.json", "Makefile"]
    assert names.issuperset([*wanted, "tests/repo/test_packages.py", "CHANGELOG.md", "CONTRIBUTING.md", "LICENSE"])
