"""Certificates of unrealizability: records, file, and in the numbers of a specification (`docs/certificate.md`).

Only who needs one loads this room: the face of `policy` does not.
"""

from tumato_symbolic.policy.unrealizability.binding import bind
from tumato_symbolic.policy.unrealizability.file import FILE, dumps, load, loads, save, unrealizability_of
from tumato_symbolic.policy.unrealizability.records import (
    ActionEffect,
    Case,
    Choice,
    Conflict,
    Cube,
    Cut,
    Divided,
    Layers,
    NoAllowedSet,
    NoPart,
    NoPlan,
    NoRestoration,
    Reason,
    Removal,
    StartRemoved,
    Unrealizability,
    Violation,
    ViolationKind,
)
