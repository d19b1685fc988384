"""A sample of the campaign on limits: `python -m tests.limits` has as many as wanted."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.limits.campaign import COMMANDS, on_generated
from tumato_symbolic.limits.processes import can_fork

pytestmark = pytest.mark.skipif(not can_fork(), reason="limits are heeded between steps only")


NUMBERS = dict(zip(COMMANDS, (2, 9, 16, 23, 30, 37, 44, 50, 60, 65), strict=True))
"""Of each family of specifications; where a policy is needed, of those for which it takes no time to make one."""


@pytest.mark.parametrize("command", COMMANDS)
def test_a_command_with_a_limit_ends_well(command: str, tmp_path: Path) -> None:
    """Half a second for a large specification: a right exit code, a whole report, no file and no process left.

    How long it took is for the campaign to say, on a machine that does nothing else.
    """
    assert on_generated(command, NUMBERS[command], 0.5, tmp_path).problems == ()
