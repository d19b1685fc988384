"""Synthesis in a child process, which ends when its answer is not wanted."""

import asyncio
import os
from pathlib import Path

import pytest

from tests.cli.inputs import NO_PLAN
from tumato_symbolic.lsp.answering import ask


def _children() -> set[str]:
    """The processes that this one has started."""
    return set(Path(f"/proc/self/task/{os.getpid()}/children").read_text().split())


def test_a_child_answers() -> None:
    """What `answer` says, by another process."""
    answer = asyncio.run(ask("text.tum", NO_PLAN, 20.0))
    assert (answer.verdict, answer.failures[0].code) == ("unrealizable", "TUM402")
    assert answer.repairs


@pytest.mark.skipif(not Path("/proc/self/task").is_dir(), reason="children are listed on Linux only")
def test_a_cancelled_child_ends() -> None:
    """However much it had still to do."""

    async def cancelled() -> set[str]:
        before = _children()
        task = asyncio.create_task(ask("text.tum", NO_PLAN, 60.0))
        while not (started := _children() - before):
            await asyncio.sleep(0.01)
        task.cancel()
        with pytest.raises(asyncio.CancelledError):
            await task
        return started & _children()

    assert asyncio.run(cancelled()) == set()
