"""The loop of examples/ros2, compiled, and spoken to line by line."""

from __future__ import annotations

import subprocess
from pathlib import Path
from types import TracebackType

from msgspec import Struct
from msgspec.structs import replace

from tests.export.c_compiler import compile_cpp
from tests.export.policies import write
from tests.repo.documents import ROOT
from tumato_symbolic.export import cpp
from tumato_symbolic.export.request import Request
from tumato_symbolic.semantics import State

PACKAGE = ROOT / "examples" / "ros2"
HEADER = PACKAGE / "include" / "amr_policy" / "loop.hpp"

_DRIVER = """\
#include <cstdio>
#include <vector>
#include "amr_policy/loop.hpp"

namespace {{

amr_policy::Time at(int milliseconds) {{ return amr_policy::Time{{}} + std::chrono::milliseconds{{milliseconds}}; }}

struct Printed : amr_policy::Robot {{
    void start(amr::Action action) override {{ std::printf("start %d ", static_cast<int>(action)); }}
    void halt(amr::Action action) override {{ std::printf("halt %d ", static_cast<int>(action)); }}
}};

}} // namespace

int main()
{{
    Printed robot;
    amr_policy::Loop loop{{robot, {{at({state}) - at(0), at({action}) - at(0), at({halting}) - at(0)}}, at(0)}};
    std::vector<amr_policy::Asked> asked;
    char command = ' ';
    int now = 0, number = 0;
    while (std::scanf(" %c %d %d", &command, &now, &number) == 3) {{
        if (command == 'a') {{
            asked.push_back(loop.ask(at(now)));
        }} else if (command == 'e') {{
            loop.ended(static_cast<amr::Action>(number));
        }} else if (command == 'c') {{
            loop.check(at(now));
        }} else {{
            amr::State state;
            int value = 0;
{reads}            loop.seen(state, asked.at(static_cast<std::size_t>(number)), at(now));
        }}
        std::printf("stop %d\\n", static_cast<int>(loop.stopped()));
        std::fflush(stdout);
    }}
}}
"""

STOPS = ("no", "undecided", "invalid", "stale", "no_result")


class Limits(Struct, frozen=True):
    """Milliseconds: see `Limits` of the loop."""

    state: int = 1_000_000_000
    action: int = 1_000_000_000
    halting: int = 1_000_000_000


class Said(Struct, frozen=True):
    """What the loop does when it is told something."""

    started: tuple[int, ...]
    halted: tuple[int, ...]
    stop: str


def compiled(made: Request, folder: Path, limits: Limits | None = None, header: str | None = None) -> Path:
    """A program that runs the loop, or a changed one, with a policy."""
    limits = limits or Limits()
    made = replace(made, name="amr")
    place = folder / "amr_policy"
    place.mkdir()
    write(place, made, cpp.files(made), (".hpp",))
    (place / "loop.hpp").write_text(HEADER.read_text() if header is None else header)
    names = cpp.Names.of(made)
    reads = "".join(
        f'            if (std::scanf("%d", &value) != 1) {{ return 1; }}\n'
        f"            state.{field} = static_cast<amr::{type_}>(value);\n"
        for field, type_ in zip(names.fields, names.types, strict=True)
    )
    source = folder / "driver.cpp"
    source.write_text(_DRIVER.format(state=limits.state, action=limits.action, halting=limits.halting, reads=reads))
    return compile_cpp([source], folder, ["-I", str(folder)])


class Loop:
    """A running loop; time passes only as it is told."""

    def __init__(self, program: Path) -> None:
        self.now = 0
        self._asked = 0
        self._process = subprocess.Popen([program], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)

    def __enter__(self) -> Loop:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._process.communicate()
        assert self._process.returncode == 0

    def ask(self) -> int:
        """The state is asked for: the number of the question."""
        self._tell(f"a {self.now} 0")
        self._asked += 1
        return self._asked - 1

    def seen(self, state: State, question: int) -> Said:
        """A question is answered."""
        return self._tell(f"s {self.now} {question} {' '.join(map(str, state))}")

    def ended(self, action: int) -> Said:
        """An action has ended."""
        return self._tell(f"e {self.now} {action}")

    def check(self) -> Said:
        """Time has passed."""
        return self._tell(f"c {self.now} 0")

    def _tell(self, line: str) -> Said:
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        self._process.stdin.write(line + "\n")
        self._process.stdin.flush()
        words = self._process.stdout.readline().split()
        pairs = list(zip(words[::2], map(int, words[1::2]), strict=True))
        started, halted = (tuple(number for word, number in pairs if word == which) for which in ("start", "halt"))
        assert pairs, "the loop is gone"
        return Said(started, halted, STOPS[pairs[-1][1]])
