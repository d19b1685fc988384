"""A child process of the server: it reads a text from the standard input and writes what synthesis says of it.

It is killed where the answer is no longer wanted: a search may be in one call of a solver, which nothing interrupts.
"""

from __future__ import annotations

import asyncio
import os
import sys

from tumato_symbolic.diagnostics import Source
from tumato_symbolic.editor.answer import Answer, answer, dumps, loads
from tumato_symbolic.limits import Context, Limits
from tumato_symbolic.limits.processes import end_with

GRACE = 5.0
"""Seconds beyond its limit after which a child is killed."""


async def ask(name: str, text: str, seconds: float) -> Answer:
    """What synthesis says of a text, by a child that takes so many seconds at most, and none if this is cancelled."""
    command = (sys.executable, "-m", __name__, name, str(seconds), str(os.getpid()))
    pipe = asyncio.subprocess.PIPE
    child = await asyncio.create_subprocess_exec(*command, stdin=pipe, stdout=pipe, stderr=asyncio.subprocess.DEVNULL)
    try:
        said, _ = await asyncio.wait_for(child.communicate(text.encode()), seconds + GRACE)
    except TimeoutError:
        return Answer("undecided", f"undecided: the time limit of {seconds:g} s was met")
    finally:
        if child.returncode is None:
            child.kill()
            await child.wait()
    return loads(said.decode()) if child.returncode == 0 else Answer("undecided", "undecided: synthesis broke down")


def main(name: str, seconds: str, parent: str) -> None:
    """Answer once."""
    end_with(int(parent))
    source = Source(name, sys.stdin.buffer.read().decode())
    print(dumps(answer(source, Context(Limits(float(seconds))))))


if __name__ == "__main__":
    main(*sys.argv[1:])
