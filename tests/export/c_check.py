"""The program that checks an exported policy in C, run on many policies of one specification."""

from __future__ import annotations

import re
import subprocess
from collections.abc import Sequence
from pathlib import Path

from msgspec import Struct
from msgspec.structs import replace

from tests.export.c_compiler import compile_c
from tests.export.compiler import Case
from tests.export.policies import write
from tumato_symbolic.export import c99
from tumato_symbolic.export.request import Request
from tumato_symbolic.semantics import judge

_COUNTS = re.compile(r"undecided (\d+), not allowed (\d+), goals not reached (\d+), safety not restored (\d+)")
_OTHERS = re.compile(r"others decided (\d+)")


class Counted(Struct, frozen=True):
    """The exit code, the faults of each kind, and how many states are decided though they are not valid."""

    code: int
    faults: tuple[int, ...]
    invalid: int = 0


def counts(requests: Sequence[Request], folder: Path) -> list[Counted]:
    """What the check counts for policies of one specification.

    The sources are compiled into one program, as functions of different names.
    """
    first = replace(requests[0], check=True)
    _, _, check = write(folder, first, c99.files(first), (".c", ".h", "_check.c"))
    parts = []
    for number, made in enumerate(requests):
        (folder / f"decide{number}.c").write_text(c99.files(made)[0], encoding="utf-8")
        parts.append(f'#define policy_decide decide{number}\n#include "decide{number}.c"\n#undef policy_decide\n')
    listed = ", ".join(f"decide{number}" for number in range(len(requests)))
    (folder / "policies.c").write_text(
        '#include "policy.h"\n#include <stdlib.h>\n'
        + "".join(f"policy_status decide{n}(const policy_state *s, policy_actions *a);\n" for n in range(len(requests)))
        + "".join(parts)
        + f"static policy_status (*const all[])(const policy_state *, policy_actions *) = {{ {listed} }};\n"
        + "policy_status policy_decide(const policy_state *s, policy_actions *a)\n"
        + '{\n    return all[atoi(getenv("POLICY"))](s, a);\n}\n'
    )
    program = compile_c([folder / "policies.c", check], folder)
    found = []
    for number in range(len(requests)):
        ran = subprocess.run([program], env={"POLICY": str(number)}, capture_output=True, text=True, check=False)
        said, others = _COUNTS.search(ran.stdout), _OTHERS.search(ran.stdout)
        assert said is not None, (ran.stdout, ran.stderr)
        invalid = 0 if others is None else int(others[1])
        found.append(Counted(ran.returncode, tuple(map(int, said.groups())), invalid))
    return found


def expected(case: Case) -> Counted:
    """What the explicit meaning counts."""
    found = judge(case.spec, case.rows, case.ordering)
    faults = tuple(map(len, (found.missing, found.not_allowed, found.goal_missed, found.not_restored)))
    return Counted(int(any(faults) or bool(found.invalid)), faults, len(found.invalid))


def grouped(cases: Sequence[Case]) -> list[list[Case]]:
    """The cases of each specification and ordering together."""
    groups: dict[tuple[int, str], list[Case]] = {}
    for case in cases:
        groups.setdefault((id(case.spec), case.ordering), []).append(case)
    return list(groups.values())
