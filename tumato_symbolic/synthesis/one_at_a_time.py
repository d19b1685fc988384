"""The remark about a policy of one action at a time, or that such a policy does not do."""

from __future__ import annotations

from tumato_symbolic.diagnostics import Code, Diagnostic
from tumato_symbolic.diagnostics.wording import count
from tumato_symbolic.game import Problem
from tumato_symbolic.synthesis.result import Statistics

_WAY_OUT = (
    "let actions that need not run together share a resource, or say which only where it matters: "
    "`Who does it with whom` in docs/performance.md"
)


def one_at_a_time(problem: Problem, statistics: Statistics) -> tuple[Diagnostic, ...]:
    """The remark about a policy, where it was looked for among sets of one action only."""
    if not problem.steps.one_at_a_time:
        return ()
    beside = ", beside what reaction rules ask for" if problem.spec.reaction_rules else ""
    longest = count(statistics.longest_run or 0, "step")
    message = (
        "the sets of several actions are too many to be compared, so the policy executes one action at a time"
        f"{beside}, and reaches one goal after the other where that can be: runs take at most {longest}, and may be "
        "longer than they need be"
    )
    return (Diagnostic(Code.TUM358, message, None, _WAY_OUT),)


def not_enough() -> Diagnostic:
    """The remark that sets of several actions are needed, where they are many."""
    message = (
        "the sets of several actions are too many to be compared soon, and no policy of one action at a time was found"
    )
    return Diagnostic(Code.TUM358, message, None, _WAY_OUT)
