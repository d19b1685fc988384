"""Where the time of a command went."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Profile:
    """Seconds by stage, and the most memory that the process took, in MB; None where the system does not tell."""

    stages: tuple[tuple[str, float], ...]
    megabytes: int | None


def profile_text(profile: Profile) -> str:
    """One line for every stage, with its share of the time."""
    total = sum(seconds for _, seconds in profile.stages) or 1.0
    lines = [f"  {seconds:8.3f} s {seconds / total:5.0%}  {stage}" for stage, seconds in profile.stages]
    memory = [] if profile.megabytes is None else [f"  {profile.megabytes:8,} MB at most"]
    return "\n".join(("Where the time went:", *lines, *memory))
