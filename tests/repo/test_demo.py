"""`make demo` shows the main job."""

import os
import subprocess
import sys
from pathlib import Path

from tests.repo.documents import ROOT


def test_the_demo_runs_and_leaves_nothing(tmp_path: Path) -> None:
    """The demo's script ends well, shows a proof, and writes nowhere but in its own folder."""
    before = set(ROOT.iterdir()) | set((ROOT / "examples").iterdir())
    done = subprocess.run(
        ["sh", str(ROOT / "examples" / "demo.sh")],
        cwd=tmp_path,
        env={**os.environ, "BIN": str(Path(sys.executable).parent)},
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert (done.returncode, done.stderr) == (0, "")
    assert "$ tumato-sym synth amr.tum" in done.stdout
    assert "minimal" in done.stdout
    assert list(tmp_path.iterdir()) == []
    assert set(ROOT.iterdir()) | set((ROOT / "examples").iterdir()) == before
