"""A family in another tool, measured in the same run: `python -m benchmarks.peers SIZE`, where stormpy is installed.

Storm's diagram engine is asked less than `synth` is: whether each goal of `loads` can surely be reached from all valid
states by single actions that keep the rules. No policy is made, sets of actions and orders of effects are left out.
"""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Sequence
from importlib import import_module
from itertools import combinations
from pathlib import Path
from typing import Any

CORRIDOR, CHARGER, SOURCE, SINK = range(4)
"""Where the robot is; conveyors have to be off in the first two."""


def model(count: int) -> str:
    """`loads` as a Markov decision process in the language of PRISM, with every valid state among the initial ones."""
    loads = range(count)
    lines = ["mdp", "module robot", f"loc: [0..{SINK}];", "full: bool;"]
    for i in loads:
        lines += [f"load{i}: bool;", f"on{i}: bool;"]
    off = " & ".join(f"!on{i}" for i in loads)
    for place in (CHARGER, SOURCE, SINK):
        lines.append(f"[] loc={CORRIDOR} & {off} -> (loc'={place});")
    lines.append(f"[] loc!={CORRIDOR} & {off} -> (loc'={CORRIDOR});")
    lines.append(f"[] loc={CHARGER} & {off} -> (full'=true);")
    for i in loads:
        lines.append(f"[] loc={SOURCE} & !load{i} -> (load{i}'=true) & (on{i}'=true);")
        lines.append(f"[] loc={SINK} & load{i} -> (load{i}'=false) & (on{i}'=true);")
        lines.append(f"[] on{i} -> (on{i}'=false);")
    pairs = " & ".join(f"!(on{i} & on{j})" for i, j in combinations(loads, 2)) or "true"
    return "\n".join((*lines, "endmodule", f"init loc>{CHARGER} | ({pairs}) endinit\n"))


def claims(count: int) -> Sequence[str]:
    """What is asked of the model: each goal."""
    bodies = ["full", *(f"!load{i}" for i in range(count)), " & ".join(f"load{i}" for i in range(count))]
    return [f"Pmax>=1 [F {body}]" for body in bodies]


def main() -> None:
    """Ask Storm; exits with 1 where some goal cannot be reached."""
    storm: Any = import_module("stormpy")
    count = int(sys.argv[1])
    with tempfile.TemporaryDirectory() as folder:
        text = Path(folder) / "model.prism"
        text.write_text(model(count), encoding="utf-8")
        program = storm.parse_prism_program(str(text))
    asked = storm.parse_properties("; ".join(claims(count)), program)
    found = storm.build_symbolic_model(program, asked)
    first = storm.create_filter_initial_states(found)
    verdicts = []
    for claim in asked:
        result = storm.model_checking(found, claim)
        result.filter(first)
        verdicts.append(result.forall_true())
    sys.exit(0 if all(verdicts) else 1)


if __name__ == "__main__":
    main()
