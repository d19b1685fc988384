"""Whether a policy can be written where it is asked for: found out before the work, not after it."""

from __future__ import annotations

import os
from pathlib import Path

from tumato_symbolic.diagnostics import Code, Diagnostic, UserError


def check_writable(output: str) -> None:
    """Raise `UserError` (TUM510) where a policy surely cannot be written to `output` (`-` is the standard output)."""
    if output == "-":
        return
    target = Path(output)
    folder = target.parent
    if target.is_dir():
        problem, way_out = "is a folder", "name a file, such as " + str(target / "policy.json")
    elif not folder.exists():
        problem, way_out = "is in a folder that does not exist", f"make the folder {folder} first"
    elif not folder.is_dir():
        problem, way_out = f"cannot be: {folder} is not a folder", "name another file with -o FILE"
    elif target.exists() and not target.is_file():
        return  # a device or a pipe takes what is written to it
    elif not os.access(folder, os.W_OK | os.X_OK):
        problem, way_out = "is in a folder that you may not write to", "name another file with -o FILE"
    else:
        return
    raise UserError((Diagnostic(Code.TUM510, f"the policy cannot be written: {output} {problem}", help=way_out),))
