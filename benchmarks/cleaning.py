"""Families with a goal for each of n things: 2^n residual goals."""

from __future__ import annotations

from benchmarks.writing import Text


def rooms(count: int, realizable: bool) -> str:
    """Every room that is dirty is to be clean, and each is cleaned by an action of its own, all at once.

    In the twin the last room cannot be cleaned.
    """
    text = Text(goal_type="constraint")
    for i in range(count):
        text.state(f"S_Room{i}", "dirty", "clean")
        if realizable or i < count - 1:
            text.action(f"clean_{i}", f"S_Room{i} is clean", when=f"S_Room{i} is dirty")
        text.goal(f"S_Room{i} is clean", when=f"S_Room{i} is dirty")
    return text.render()


def errands(count: int, realizable: bool) -> str:
    """The same, by one robot that goes from room to room by the hall: every run passes regions of other goals."""
    text = Text(goal_type="constraint")
    text.state("S_Place", "hall", *(f"room_{i}" for i in range(count)))
    text.resource("ROBOT")
    text.action("go_back", "S_Place is hall", when="NOT S_Place is hall", holds=("ROBOT",))
    for i in range(count):
        text.state(f"S_Room{i}", "dirty", "clean")
        text.action(f"go_to_{i}", f"S_Place is room_{i}", when="S_Place is hall", holds=("ROBOT",))
        if realizable or i < count - 1:
            dirty = f"S_Place is room_{i}, S_Room{i} is dirty"
            text.action(f"clean_{i}", f"S_Room{i} is clean", when=dirty, holds=("ROBOT",), takes=5)
        text.goal(f"S_Room{i} is clean", when=f"S_Room{i} is dirty")
    return text.render()
