"""The text of a module of TLA+ for the closed loop of a policy, with places for what it decides and what is claimed."""

from __future__ import annotations

from string import Template
from typing import Final

MODULE = Template("""\
---- MODULE $module ----
\\* The closed loop of a policy, and what is claimed of it. Written by `tumato-sym export tlaplus`.
\\*
$promise
\\*
$about
\\*
\\*   tlc $module.tla

EXTENDS Naturals

VARIABLES
$variables
vars == <<$names>>

\\* The most steps of a nominal run$uncounted.
Bound == $bound

States == [
$states]

\\* The decisions of the policy: what the first rule says that matches.
Undecided == {"-"}
Decision(s) ==
$rules
Decided == decision # Undecided

$executed
Executed == $executed_set

\\* No action that is executed has effects.
Quiet == $quiet

\\* What is assumed of every state.
Valid == $valid

\\* And all state rules.
Safe == $safe

\\* Preconditions, what excludes each other, and reaction rules: at every decision.
Allowed ==$allowed

\\* After every effect.
AsRequired ==$required
$lasting
\\* The goals that were active where a nominal run began.
Met ==$met

\\* All nominal effects of some actions at once.
AfterNominal(actions) == $nominal

Init ==
  /\\ state \\in States
  /\\ decision = Decision(state)
  /\\ $begins
  /\\ mode \\in {"effects", "nominal"}
  /\\ acting = FALSE
  /\\ acted = FALSE
  /\\ waiting = {}
  /\\ steps = 0
$init
Decide ==
  /\\ mode = "effects" /\\ ~acting /\\ Decided
  /\\ acting' = TRUE
  /\\ acted' = Quiet
  /\\ waiting' = Executed
$decide
Takes(action, after) ==
  /\\ acting$once /\\ action \\in waiting
  /\\ acted' = TRUE
  /\\ waiting' = waiting \\ {action}
  /\\ state' = after
  /\\ decision' = Decision(state')
$takes
Effect ==
$effects
Halt ==
  /\\ acting /\\ acted
  /\\ acting' = FALSE
  /\\ acted' = FALSE
  /\\ waiting' = {}
$halt
NominalStep ==
  /\\ mode = "nominal" /\\ ~(steps > 0 /\\ Met) /\\ Decided
  /\\ state' = AfterNominal(Executed)
  /\\ decision' = Decision(state')
  /\\ steps' = IF steps < Bound THEN steps + 1 ELSE steps
$step
Next == Decide \\/ Effect \\/ Halt \\/ NominalStep

Spec == Init /\\ [][Next]_vars /\\ WF_vars(Next)

$claims====
""")


ABOUT: Final = (
    "From {begins}, in the mode `effects`: the policy decides; then effects of the set occur, in any order, until the "
    "robot halts what is left, after any of them. In the mode `nominal`, a step is all nominal effects of a set at "
    "once, until the goals are reached. Whether a cheaper set would restore safety as well is not asked. To check all "
    "of it:"
)


LASTING = Template("""\

\\* Preconditions of what has not taken effect yet.
StillPossible ==$possible
""")


AT_ONCE: Final = """\
  \\/ /\\ acting /\\ ~acted /\\ ~Quiet
     /\\ acted' = TRUE
     /\\ waiting' = {}
     /\\ state' = AfterNominal(waiting)
     /\\ decision' = Decision(state')
"""
