"""What generated specifications look like: four profiles, each with its own weight on what is hard."""

from __future__ import annotations

from typing import TypeAlias

from msgspec import Struct

Range: TypeAlias = tuple[int, int]


class Profile(Struct, frozen=True):
    """What specifications look like: inclusive ranges of counts, and probabilities between 0 and 1."""

    variables: Range = (2, 5)
    values: Range = (1, 4)
    states: Range = (4, 100)
    actions: Range = (1, 6)
    durations: Range = (0, 4)
    preconditions: Range = (0, 2)
    state_rules: Range = (0, 2)
    reaction_rules: Range = (0, 2)
    assumptions: Range = (0, 1)
    goals: Range = (1, 3)
    resources: Range = (0, 2)
    helpers: float = 0.7  # an action becomes a strong one: no alternatives, no preconditions, one variable
    alternatives: float = 0.4  # another action has alternatives
    wide: float = 0.4  # an alternative denotes several assignments
    owns: float = 0.35  # an action controls a given resource
    forcing: float = 0.2  # a reaction rule forces an action rather than forbidding one
    collisions: float = 0.0  # a state rule or an assumption excludes two effects at once
    together: float = 0.0  # a reaction rule ties two actions: both run, or neither
    no_goals: float = 0.08
    nested: float = 0.2
    conditional: float = 0.65
    executing: float = 0.25
    repeated: float = 0.15  # a goal has the body of an earlier one
    bounded: float = 0.5
    bound: Range = (1, 6)
    aliases: float = 0.15
    effectless: float = 0.0  # an action has no effects
    throughout: float = 0.0  # preconditions have to hold until the action takes effect


MIXED = Profile()
INTERACTING = Profile(
    variables=(2, 3),
    values=(2, 3),
    states=(6, 60),
    actions=(5, 6),
    preconditions=(0, 1),
    state_rules=(0, 1),
    reaction_rules=(0, 1),
    assumptions=(0, 0),
    goals=(2, 3),
    resources=(1, 1),
    owns=1.0,
    helpers=0.3,
    alternatives=0.05,
    no_goals=0.0,
    nested=0.05,
    conditional=0.95,
    executing=0.2,
    repeated=0.0,
    bounded=0.15,
    bound=(3, 9),
)
"""Goals that need each other's help: about one in twenty is realizable and defeats the fixpoint of the own region."""

RESTORING = Profile(
    variables=(2, 4),
    values=(2, 3),
    actions=(4, 6),
    preconditions=(0, 1),
    state_rules=(1, 2),
    reaction_rules=(0, 1),
    goals=(1, 2),
    durations=(0, 3),
    alternatives=0.3,
    wide=0.5,
    owns=0.2,
    no_goals=0.1,
    nested=0.35,
    executing=0.4,
    repeated=0.3,
    bounded=0.3,
)
"""Unsafe states, and actions that write the same variables together."""

CONCURRENT = Profile(
    variables=(3, 4),
    values=(2, 3),
    states=(8, 60),
    actions=(3, 5),
    preconditions=(0, 0),
    state_rules=(0, 1),
    reaction_rules=(1, 2),
    assumptions=(2, 4),
    goals=(1, 2),
    resources=(0, 0),
    helpers=0.1,
    alternatives=0.6,
    wide=0.15,
    forcing=0.1,
    collisions=0.9,
    together=0.8,
    no_goals=0.25,
    executing=0.6,
    bounded=0.3,
)
"""Sets of actions for which the order of effects matters: one in five has states where `any` and `first` differ."""

NOTIFYING = Profile(
    variables=(2, 4),
    values=(2, 3),
    states=(4, 40),
    actions=(3, 5),
    preconditions=(0, 1),
    state_rules=(1, 2),
    reaction_rules=(0, 2),
    goals=(1, 2),
    resources=(0, 1),
    durations=(0, 2),
    alternatives=0.3,
    owns=0.2,
    helpers=0.3,
    together=0.5,
    effectless=0.35,
    throughout=0.5,
)
"""Actions without effects beside those that restore safety; half of the time, preconditions have to hold throughout."""

OVERLAPPING = Profile(
    variables=(2, 3),
    values=(2, 3),
    states=(4, 27),
    actions=(3, 5),
    preconditions=(1, 1),
    state_rules=(0, 1),
    reaction_rules=(0, 1),
    assumptions=(0, 0),
    goals=(1, 2),
    resources=(0, 0),
    alternatives=0.3,
    helpers=0.2,
    together=0.7,
    bounded=0.3,
    effectless=0.1,
    throughout=1.0,
)
"""Preconditions that have to hold throughout, and others' effects that falsify them."""

PROFILES = {"mixed": MIXED, "interacting": INTERACTING, "restoring": RESTORING, "concurrent": CONCURRENT}

ALL_PROFILES = {**PROFILES, "notifying": NOTIFYING, "overlapping": OVERLAPPING}
"""`PROFILES`, which stay as they are, so that what is made from them can be compared over time, and later ones."""
