"""What development and CI install and run: pinned versions, the Makefile, the workflow, the hooks for pre-commit."""

from __future__ import annotations

import re
import shlex
import tomllib
from contextlib import suppress
from importlib.metadata import PackageNotFoundError, requires
from itertools import chain
from typing import Any

import yaml
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

from tests.repo.documents import ROOT

PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())
MAKEFILE = (ROOT / "Makefile").read_text()
WORKFLOW: dict[str, Any] = yaml.safe_load((ROOT / ".github/workflows/ci.yml").read_text())
HOOKS: dict[str, Any] = yaml.safe_load((ROOT / ".pre-commit-config.yaml").read_text())


def checks() -> set[str]:
    """The commands of `make check`, without the folder of their programs."""
    (recipe,) = re.findall(r"^check: .*\n((?:\t.*\n)+)", MAKEFILE, re.MULTILINE)
    return {line.removeprefix("\t$(BIN)/") for line in recipe.splitlines()}


def pins() -> dict[str, str]:
    """The version of each package in `constraints.txt`."""
    lines = [line for line in (ROOT / "constraints.txt").read_text().splitlines() if not line.startswith("#")]
    found = {str(canonicalize_name(name)): version for name, _, version in (line.partition("==") for line in lines)}
    assert all(found.values())
    assert len(found) == len(lines), "each once"
    assert "pip" not in found, "it is what installs"
    return found


def named() -> list[Requirement]:
    """What pyproject.toml names: dependencies, those of extras, development tools, and what `make tools` installs."""
    project, groups = PROJECT["project"], PROJECT["dependency-groups"]
    extras = chain.from_iterable(project["optional-dependencies"].values())
    return [Requirement(text) for text in (*project["dependencies"], *extras, *groups["dev"], *groups["tools"])]


def test_what_is_installed_is_pinned() -> None:
    """`constraints.txt` pins all that pyproject.toml names, to a version that it allows; that of a tool is given."""
    assert all("==" in text for text in PROJECT["dependency-groups"]["tools"])
    for each in named():
        assert each.specifier.contains(pins()[canonicalize_name(each.name)]), each


def test_what_that_needs_is_pinned() -> None:
    """What is named needs other packages, and these others: as far as they are installed here, all have a version."""
    waiting, known = named(), set[str]()
    for each in waiting:
        name = canonicalize_name(each.name)
        assert name in pins(), each
        if name not in known:
            known.add(name)
            with suppress(PackageNotFoundError):
                needed = [Requirement(text) for text in requires(name) or ()]
                waiting += [other for other in needed if other.marker is None or other.marker.evaluate({"extra": ""})]


def test_the_makefile_installs_pinned_versions() -> None:
    """Every installation of the Makefile goes through the command that names `constraints.txt`."""
    (install,) = re.findall(r"^.*pip install.*$", MAKEFILE, re.MULTILINE)
    assert install.startswith("INSTALL := ")
    assert "--constraint constraints.txt" in install


def test_make_help_names_every_target() -> None:
    """Every target of the Makefile has a rule and a line in `make help`."""
    (line,) = re.findall(r"^\.PHONY: (.*)$", MAKEFILE, re.MULTILINE)
    targets = set(line.split())
    assert "constraints" in targets
    assert all(re.search(rf"^{target}:", MAKEFILE, re.MULTILINE) for target in targets)
    assert set(re.findall(r'@echo "make ([\w-]+) ', MAKEFILE)) == targets - {"help"}


def test_the_workflow_runs_ci_on_every_supported_version() -> None:
    """One job runs `.ci/run`, which exists, for each version of Python that pyproject.toml names."""
    job = WORKFLOW["jobs"]["test"]
    commands = [step["run"] for step in job["steps"] if "run" in step]
    assert commands == ["bash .ci/run"]
    assert (ROOT / ".ci/run").is_file()
    prefix = "Programming Language :: Python :: "
    classifiers = PROJECT["project"]["classifiers"]
    supported = [name.removeprefix(prefix) for name in classifiers if name.startswith(prefix)]
    assert job["strategy"]["matrix"]["python-version"] == supported
    assert PROJECT["project"]["requires-python"] == f">={supported[0]}"
    for step in job["steps"]:
        assert ("uses" in step) != ("run" in step)
        if path := step.get("with", {}).get("cache-dependency-path"):
            assert (ROOT / path).is_file()


def test_ci_runs_what_a_change_has_to_pass() -> None:
    """`.ci/run` calls targets that the Makefile has; `make test` begins with `make check`."""
    targets = set(re.findall(r"^make --no-print-directory (\w+)", (ROOT / ".ci/run").read_text(), re.MULTILINE))
    assert targets == {"proofs", "test", "tools"}
    assert all(re.search(rf"^{target}: ", MAKEFILE, re.MULTILINE) for target in targets)
    assert re.search(r"^test: check$", MAKEFILE, re.MULTILINE)


def test_hooks_run_the_tools_of_the_makefile() -> None:
    """Hooks are local, fetch nothing, and are `make check` and the check of the examples; their patterns find files."""
    (repository,) = HOOKS["repos"]
    assert repository["repo"] == "local"
    files = [str(path.relative_to(ROOT)) for top in ("examples", "proofs") for path in (ROOT / top).iterdir()]
    entries = set()
    for hook in repository["hooks"]:
        assert hook["language"] == "system"
        assert hook["id"]
        assert hook["name"]
        program, *arguments = shlex.split(hook["entry"])
        assert program.startswith(".venv/bin/")
        whole = " ".join(
            [program.removeprefix(".venv/bin/"), *(each for each in arguments if each != "--force-exclude")]
        )
        entries.add(f"{whole} ." if whole.startswith("ruff") else whole)
        assert "types" in hook or any(re.search(hook["files"], file) for file in [*files, "pyproject.toml"])
    assert entries == checks() | {"tumato-sym check"}
