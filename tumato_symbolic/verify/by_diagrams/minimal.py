"""That no allowed set would restore safety in less time, where a step does (`docs/certificate.md`)."""

from __future__ import annotations

import operator

from tumato_symbolic.verify.by_diagrams.closed_loop import ClosedLoop
from tumato_symbolic.verify.by_diagrams.functions import FALSE
from tumato_symbolic.verify.by_diagrams.goals import WalkGoals
from tumato_symbolic.verify.by_diagrams.ranks import WalkRanks
from tumato_symbolic.verify.by_diagrams.witnesses import Witnesses
from tumato_symbolic.verify.result import PropertyResult


def minimal(model: ClosedLoop, goals: WalkGoals, ranks: WalkRanks, witnesses: Witnesses) -> PropertyResult:
    """The verdict on `minimal` where safety is restored in one step."""
    walk = model.walk
    unsafe = walk.without(model.decided, model.safe)
    if unsafe == FALSE:
        return PropertyResult("minimal", "proved", 1, "walk")
    takes = walk.select(unsafe, (FALSE, model.duration(model.policy)))  # nothing is shorter than 0
    cheaper = walk.apply(operator.lt, model.duration(model.chosen), takes)
    if cheaper != FALSE:
        cheaper = walk.all_of((cheaper, model.allowed))
    pending = ranks.aims(cheaper, model.chosen)
    step = model.successor(model.chosen)
    better = FALSE
    for goal, where in pending:
        near = ranks.near_at_least(goal)
        serves = walk.all_of((where, goals.own(goal, walk.compose(near, step), model.chosen)))
        if goal is not None and serves != FALSE and near != ranks.near(goal):
            at_least, serves = serves, walk.all_of((where, walk.compose(ranks.near(goal), step)))
            if serves != at_least:
                ranks.inexact(goal)
        better = walk.any_of((better, serves))
    if better == FALSE:
        return PropertyResult("minimal", "proved", 1 + len(pending), "walk")
    return witnesses.not_minimal(better)
