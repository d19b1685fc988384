"""What users' repositories run: the hooks for pre-commit and the action for GitHub, as far as that goes offline."""

from __future__ import annotations

import json
import os
import re
import shlex
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
import yaml

from tests.repo.documents import ROOT

HOOKS: list[dict[str, Any]] = yaml.safe_load((ROOT / ".pre-commit-hooks.yaml").read_text())
ACTION: dict[str, Any] = yaml.safe_load((ROOT / "action.yml").read_text())
STEPS: list[dict[str, Any]] = ACTION["runs"]["steps"]


@pytest.fixture
def repository(tmp_path: Path) -> Path:
    """A user's repository: specifications in `robots` and below, policies in `proofs`."""
    for folder in ("robots/small", "proofs"):
        (tmp_path / folder).mkdir(parents=True)
    (tmp_path / "robots/amr.tum").write_text((ROOT / "examples/amr.tum").read_text())
    (tmp_path / "robots/small/coin.tmt").write_text((ROOT / "examples/coin.tum").read_text())
    for name in ("amr", "coin"):
        (tmp_path / f"proofs/{name}.policy.json").write_text((ROOT / f"proofs/{name}.policy.json").read_text())
    return tmp_path


def run(command: list[str], folder: Path, **settings: str) -> subprocess.CompletedProcess[str]:
    """Run a command there, with `tumato-sym` on the path."""
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    environment = {**os.environ, "PATH": path, **settings}
    return subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, check=False)


def hook(name: str, folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    """What pre-commit does with a hook when all files are committed; `arguments` overrule the hook's own."""
    found = next(each for each in HOOKS if each["id"] == name)
    files = sorted(str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file())
    matching = [file for file in files if re.search(found["files"], file)]
    assert matching
    own = list(arguments or found.get("args", []))
    return run([*shlex.split(found["entry"]), *own, *(matching if found.get("pass_filenames", True) else [])], folder)


def step(name: str, folder: Path, **inputs: str) -> subprocess.CompletedProcess[str]:
    """What a runner does in one step of the action, with its default inputs and the given ones."""
    found = next(each for each in STEPS if each.get("name") == name)
    values = {key: value["default"] for key, value in ACTION["inputs"].items()} | inputs

    def valued(text: str) -> str:
        return re.sub(r"\$\{\{ inputs\.([\w-]+) \}\}", lambda match: values[match[1]], text)

    script = folder / "step.sh"
    script.write_text(found["run"])
    settings = {key: valued(text) for key, text in found.get("env", {}).items()}
    assert found["shell"] == "bash"
    return run(["bash", "--noprofile", "--norc", "-eo", "pipefail", str(script)], folder, **settings)


def test_hooks_have_what_pre_commit_wants() -> None:
    """Every hook has an id, a name, an entry and the language Python, and a pattern of files that compiles."""
    assert [each["id"] for each in HOOKS] == ["tumato-check", "tumato-verify"]
    for each in HOOKS:
        assert each["language"] == "python"
        assert each["name"]
        assert shlex.split(each["entry"])[0] == "tumato-sym"
        assert re.compile(each["files"])


def test_the_check_hook_finds_mistakes(repository: Path) -> None:
    """`tumato-check` passes what is right and fails a specification with a mistake."""
    assert hook("tumato-check", repository).returncode == 0
    (repository / "robots/typo.tum").write_text("BEGIN STATE VECTOR\nstate S can bee a\nEND STATE VECTOR\n")
    failed = hook("tumato-check", repository)
    assert failed.returncode == 2
    assert "robots/typo.tum" in failed.stdout


def test_the_verify_hook_proves_a_folder(repository: Path) -> None:
    """`tumato-verify` proves all policies of the folder, strictly."""
    folders = ("proofs", "--specs", "robots", "--specs", "robots/small")
    passed = hook("tumato-verify", repository, *folders)
    assert (passed.returncode, passed.stderr) == (0, "")
    assert "2 files: 2 proved" in passed.stdout
    text = (repository / "robots/amr.tum").read_text()
    (repository / "robots/amr.tum").write_text(text.replace("max_plan_length: 5", "max_plan_length: 6"))
    assert hook("tumato-verify", repository, *folders).returncode == 1
    (repository / "robots").rename(repository / "examples")
    (repository / "examples/small/coin.tmt").rename(repository / "examples/coin.tmt")
    (repository / "examples/amr.tum").write_text(text)
    assert hook("tumato-verify", repository).returncode == 0, "without arguments: proofs/ and ../examples"


def test_the_action_is_well_formed() -> None:
    """A composite action whose inputs are described, have defaults, and are all used; every step can run."""
    assert ACTION["runs"]["using"] == "composite"
    assert all(value["description"] and "default" in value for value in ACTION["inputs"].values())
    used = set(re.findall(r"inputs\.([\w-]+)", json.dumps(STEPS)))
    assert used == set(ACTION["inputs"])
    for each in STEPS:
        assert ("uses" in each) != ("run" in each and each["shell"] == "bash")
        assert "${{" not in each.get("run", ""), "inputs come by the environment, never as a part of the script"


def test_the_action_installs_this_package() -> None:
    """It installs what it is checked out with; that such an installation works, test_packages holds."""
    (install,) = [each["run"] for each in STEPS if "pip install" in each.get("run", "")]
    assert shlex.split(install)[-1] == "$GITHUB_ACTION_PATH"


def test_the_action_checks(repository: Path) -> None:
    """The default pattern reaches all folders; mistakes fail with workflow commands; nothing to check is an error."""
    passed = step("Check the specifications", repository)
    assert passed.returncode == 0
    assert "2 specifications checked, 0 with errors" in passed.stdout
    (repository / "robots/typo.tum").write_text("BEGIN")
    failed = step("Check the specifications", repository, specs="robots/*.tum")
    assert failed.returncode == 2
    assert "::error file=robots/typo.tum" in failed.stdout
    assert step("Check the specifications", repository, specs="nowhere/*.tum").returncode == 2


def test_the_action_verifies(repository: Path) -> None:
    """Policies are proved against the specifications where the inputs say; `strict` is on unless it is turned off."""
    inputs = {"policies": "proofs", "spec-folders": "robots robots/small"}
    passed = step("Verify the policies", repository, **inputs)
    assert passed.returncode == 0
    assert "::notice::2 files: 2 proved" in passed.stdout
    policy = repository / "proofs/amr.policy.json"
    policy.write_text(policy.read_text().replace("sha256:", "sha257:"))
    assert step("Verify the policies", repository, **inputs).returncode == 1
    assert step("Verify the policies", repository, **inputs, strict="false").returncode == 0
    every = {**inputs, "strict": "false", "require-all": "true"}
    assert step("Verify the policies", repository, **every).returncode == 0
    policy.unlink()
    missing = step("Verify the policies", repository, **every)
    assert missing.returncode == 1
    assert "::error file=robots/amr.tum,title=missing" in missing.stdout


def test_the_documented_settings_are_the_real_ones() -> None:
    """docs/ci.md names hooks, inputs and defaults as they are."""
    text = (ROOT / "docs/ci.md").read_text()
    for block in re.findall(r"```yaml\n(.*?)```", text, re.DOTALL):
        assert yaml.safe_load(block)
    assert {each["id"] for each in HOOKS} == set(re.findall(r"- id: ([\w-]+)", text))
    table = dict(re.findall(r"^\| `([\w-]+)` \| ([^|]+) \|", text, re.MULTILINE))
    defaults = {
        key: f"`{value['default']}`" if value["default"] else "empty" for key, value in ACTION["inputs"].items()
    }
    assert table == defaults
