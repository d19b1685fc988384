"""The closed table of codes, each with its severity.

A code never changes its meaning and is never used again. TUM1xx input and syntax, TUM2xx names, TUM3xx what a
specification says, TUM4xx why there is no policy, TUM5xx policies and their certificates.
"""

from __future__ import annotations

from enum import Enum
from typing import Literal, TypeAlias

Severity: TypeAlias = Literal["error", "warning", "remark"]
"""Whether a finding stops the work, is probably a mistake, or is worth knowing."""


class Code(Enum):
    """A code and its severity."""

    TUM101 = ("error", "input cannot be read")
    TUM102 = ("error", "input is not UTF-8 text")
    TUM103 = ("error", "input is too large")
    TUM104 = ("error", "a character that the language does not use")
    TUM105 = ("error", "a word or symbol that does not fit here")
    TUM106 = ("error", "a comment is not closed")
    TUM107 = ("error", "a block is not closed")
    TUM108 = ("error", "a block is closed by the wrong name")
    TUM109 = ("error", "a chain of IFONLYIF")
    TUM110 = ("error", "an implication or equivalence needs parentheses")
    TUM111 = ("error", "a keyword in the wrong case")
    TUM112 = ("error", "a condition directly after a condition")
    TUM113 = ("error", "not a name")
    TUM114 = ("error", "not a whole number")
    TUM115 = ("error", "nested too deeply")
    TUM116 = ("error", "too many mistakes to go on")
    TUM117 = ("error", "output cannot be written")
    TUM118 = ("error", "output that is an input or another output")
    TUM119 = ("error", "a cluster that cannot be used")
    TUM120 = ("error", "results of another sweep")

    TUM201 = ("error", "an unknown name")
    TUM202 = ("error", "a value that the variable does not have")
    TUM203 = ("error", "declared twice")
    TUM204 = ("error", "a name that is in use for something else")
    TUM205 = ("error", "a reserved word used as a name")
    TUM206 = ("error", "an alias that is defined by itself")
    TUM207 = ("error", "a name of another kind")

    TUM301 = ("error", "no state vector")
    TUM302 = ("error", "a repeated block")
    TUM303 = ("error", "a repeated field or setting")
    TUM304 = ("error", "`executing` where it has no meaning")
    TUM305 = ("error", "nominal effects that do not denote exactly one assignment")
    TUM306 = ("error", "alternative effects that denote no assignment")
    TUM307 = ("error", "effects that denote too many assignments")
    TUM308 = ("error", "predicates that are too large with their aliases expanded")
    TUM309 = ("error", "a duration out of range")
    TUM310 = ("error", "a plan bound or a severity out of range")
    TUM311 = ("error", "too many declarations")
    TUM312 = ("error", "no valid state")
    TUM313 = ("error", "a setting that a command does not support")
    TUM314 = ("error", "a range that is none")
    TUM315 = ("error", "a comparison of values that are not numbers")
    TUM316 = ("error", "copies that cannot be made")
    TUM317 = ("error", "no valid state is a start")
    TUM318 = ("error", "a relative effect that has no meaning")
    TUM319 = ("error", "conditions of effects that make too many cases")

    TUM321 = ("warning", "an unused resource")
    TUM322 = ("warning", "an unused alias")
    TUM323 = ("warning", "a predicate that is always true")
    TUM324 = ("warning", "a predicate that is never true")
    TUM325 = ("warning", "no actions")
    TUM326 = ("warning", "no goals")
    TUM327 = ("warning", "an action without nominal effects")
    TUM328 = ("warning", "a resource listed twice")
    TUM329 = ("warning", "an unused parameter")
    TUM330 = ("warning", "copies of which there are none")
    TUM331 = ("warning", "a relative effect that may leave the range of its variable")
    TUM341 = ("warning", "a state variable that nothing mentions")
    TUM342 = ("warning", "values that nothing tells apart")
    TUM343 = ("remark", "a value that nothing mentions")
    TUM344 = ("remark", "state variables that no action changes")
    TUM345 = ("remark", "a value that no action leaves")
    TUM346 = ("warning", "actions that command the environment")
    TUM347 = ("remark", "a state rule of several parts, where safety may take several steps to restore")
    TUM348 = ("warning", "an implication among effects")
    TUM351 = ("warning", "a goal that is never entered")
    TUM352 = ("warning", "a rule that no valid state breaks")
    TUM353 = ("warning", "an action that is allowed nowhere")
    TUM354 = ("warning", "actions executed together, of which one may falsify a precondition of another")
    TUM355 = ("warning", "a goal that holds already wherever it is active")
    TUM356 = ("remark", "a policy that leaves the region of a goal on the way to it")
    TUM357 = ("warning", "an environment that may lead out of what a policy from the starts decides")
    TUM358 = ("remark", "sets of several actions that are too many to be compared")

    TUM401 = ("error", "states without an allowed set of actions")
    TUM402 = ("error", "states without a plan")
    TUM403 = ("error", "goals that conflict")
    TUM404 = ("error", "unsafe states from which safety is not restored")

    TUM501 = ("error", "a policy that cannot be read")
    TUM502 = ("error", "a policy of the wrong shape")
    TUM503 = ("error", "a policy with unknown or missing variables")
    TUM504 = ("error", "a policy with an unknown value")
    TUM505 = ("error", "a policy with an unknown action")
    TUM506 = ("error", "a policy that contradicts itself")
    TUM507 = ("warning", "a certificate that does not fit")
    TUM508 = ("error", "a policy that is too large")
    TUM509 = ("error", "state cannot be read")
    TUM510 = ("error", "policy cannot be written")
    TUM511 = ("error", "a policy made for another effect ordering, or a weaker restoration")

    def __init__(self, severity: Severity, title: str) -> None:
        self.severity = severity
        self.title = title
