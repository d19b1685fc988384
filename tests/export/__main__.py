"""The theorem of every example: `python -m tests.export`, or `make proofs`.

Builds `proofs/coq`, writes the theorem of every policy in `proofs/` whose specification has at most 1,000 states, as
`tumato-sym export coq` does, and compiles it. Exits with 1 where one is refused or rests on an assumption. Where Coq
is not installed it says so, and exits with 0: then nothing is claimed.
"""

from __future__ import annotations

import re
import subprocess
import tempfile
import time
from contextlib import redirect_stderr
from io import StringIO
from pathlib import Path

from tests.export.compiler import COQC, SOURCES
from tumato_symbolic import parse
from tumato_symbolic.cli.main import main as tumato_sym
from tumato_symbolic.semantics import count_states

MOST_STATES = 1000
ROOT = SOURCES.parents[1]
CLOSED = "Closed under the global context"


def main() -> int:
    """Prove what can be proved here, and say what cannot."""
    problem = _missing()
    if problem:
        print(f"The theorems are NOT checked: {problem}. Install Coq 8.16 or later (apt-get install coq).")
        return 0
    started = time.monotonic()
    built = subprocess.run(["make", "--no-print-directory", "-C", str(SOURCES)], check=False)
    if built.returncode != 0:
        print("proofs/coq does not compile.")
        return 1
    print(f"proofs/coq is compiled, in {time.monotonic() - started:.0f} s. The examples:", flush=True)
    with tempfile.TemporaryDirectory() as folder:
        failed = [path for path in sorted((ROOT / "proofs").glob("*.policy.json")) if not _proved(path, Path(folder))]
    return 1 if failed else 0


def _missing() -> str | None:
    """Why Coq cannot be used here."""
    if COQC is None:
        return "there is no coqc on the path"
    said = subprocess.run([COQC, "--print-version"], capture_output=True, text=True, check=False).stdout
    version = re.match(r"(\d+)\.(\d+)", said)
    if version is None or (int(version[1]), int(version[2])) < (8, 16):
        return f"coqc is of version {said.split(' ')[0].strip() or 'unknown'}"
    return None


def _proved(policy: Path, folder: Path) -> bool:
    """Compile the theorem of one policy; too many states are no failure."""
    name = policy.name.removesuffix(".policy.json")
    spec = ROOT / "examples" / f"{name}.tum"
    states = count_states(parse(spec.read_text(encoding="utf-8")))
    if states > MOST_STATES:
        print(f"  {name}: {states:,} states, more than {MOST_STATES:,}: left to `tumato-sym verify`", flush=True)
        return True
    theorem = folder / "exported.v"
    with redirect_stderr(StringIO()) as said:
        exported = tumato_sym(["export", "coq", str(policy), str(spec), "-o", str(theorem)])
    if exported != 0:
        print(f"  {name}: NOT exported\n{said.getvalue()}", flush=True)
        return False
    started = time.monotonic()
    command = [str(COQC), "-q", "-R", str(SOURCES), "Tumato", theorem.name]
    answer = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    took = f"{states:,} states, {time.monotonic() - started:.1f} s"
    if answer.returncode == 0 and answer.stdout.strip() == CLOSED:
        print(f"  {name}: proved ({took}); {CLOSED.lower()}", flush=True)
        return True
    print(f"  {name}: NOT proved ({took})\n{answer.stdout}{answer.stderr}", flush=True)
    return False


if __name__ == "__main__":
    raise SystemExit(main())
