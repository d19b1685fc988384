"""The time of a command by stage."""

from __future__ import annotations

from collections.abc import Mapping


def profile_text(stages: Mapping[str, float], megabytes: int | None) -> str:
    """One line for every stage, with its seconds and its share of them; then the most memory that was taken, in MB."""
    total = sum(stages.values()) or 1.0
    lines = [f"  {seconds:8.3f} s {seconds / total:5.0%}  {stage}" for stage, seconds in stages.items()]
    memory = [] if megabytes is None else [f"  {megabytes:8,} MB of memory at most"]
    return "\n".join(("Time by stage:", *lines, *memory))
