"""Faults that change nothing that is promised, each with the reason: `harmless.toml`."""

from __future__ import annotations

import tomllib
from pathlib import Path


def harmless() -> dict[str, str]:
    """The reason by the name of the fault."""
    found: dict[str, str] = {}
    text = Path(__file__).with_name("harmless.toml").read_text(encoding="utf-8")
    for group in tomllib.loads(text).get("group", []):
        for name in group["faults"]:
            found[name] = group["reason"]
    return found
