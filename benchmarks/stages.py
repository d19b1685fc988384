"""One synthesis in a process of its own: `python -m benchmarks.stages SPEC POLICY [BACKEND]` tells what it took.

The backend is `cudd` or `autoref`, which is pure Python; without one it is the one that `synth` takes.
"""

from __future__ import annotations

import hashlib
import json
import resource
import sys
import time
from pathlib import Path
from typing import Any

from tumato_symbolic.diagnostics import Source
from tumato_symbolic.limits import Context
from tumato_symbolic.policy import Policy, as_diagram, dumps
from tumato_symbolic.spec import Spec, load
from tumato_symbolic.synthesis import Realizable, SynthesisResult, Undecided, Unrealizable, synthesize

STAGES = {
    "encoding": "encode",
    "finding": "predecessor",
    "solving": "own region",
    "measuring": "interaction",
    "routing": "interaction",
    "overriding": "interaction",
    "repairing": "interaction",
    "reverting": "interaction",
    "choosing": "restoring",
    "extracting": "extraction",
}
"""Columns of the table by the first word of what `synthesize` announces."""

COUNTED_UP_TO = 2.0
"""Allowed sets are counted where finding them takes no more seconds than this."""


class Stopwatch:
    """Seconds by stage: a stage lasts until the next one is announced."""

    def __init__(self) -> None:
        self.seconds: dict[str, float] = {}
        self._stage: str | None = None
        self._since = 0.0

    def __call__(self, message: str | None) -> None:
        """The next stage begins; None: nothing does."""
        now = time.perf_counter()
        if self._stage is not None:
            self.seconds[self._stage] = self.seconds.get(self._stage, 0.0) + now - self._since
        self._stage = message and STAGES.get(message.split()[0], message)
        self._since = now


def main() -> None:
    """Measure one synthesis, write its policy, and print the record."""
    source, target = Path(sys.argv[1]), Path(sys.argv[2])
    backend: Any = next(iter(sys.argv[3:]), None)
    watch = Stopwatch()
    watch("parse")
    spec = load(Source(source.name, source.read_text(encoding="utf-8"))).spec
    assert spec is not None, "benchmarks are correct specifications"
    outcome = synthesize(spec, backend=backend, context=Context(progress=watch))
    record = _outcome(spec, outcome)
    if isinstance(outcome, Realizable):
        watch("write")
        text = dumps(outcome.policy)
        target.write_text(text, encoding="utf-8")
        watch(None)
        record |= _policy(outcome.policy, text)
    watch(None)
    record["stages"] = {stage: round(seconds, 4) for stage, seconds in watch.seconds.items()}
    record["peak_mb"] = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss // 1024
    record["allowed_sets"] = _allowed_sets(spec) if watch.seconds.get("predecessor", 0.0) <= COUNTED_UP_TO else None
    print(json.dumps(record))


def _outcome(spec: Spec, outcome: SynthesisResult) -> dict[str, object]:
    record: dict[str, object] = {
        "variables": len(spec.variables),
        "actions": len(spec.actions),
        "goals": len(spec.bodies),
        "with_alternatives": sum(bool(action.alternatives) for action in spec.actions),
    }
    if found := outcome.statistics:
        record |= {
            "states": found.total,
            "valid": found.valid,
            "unsafe": found.unsafe,
            "longest_run": found.longest_run,
            "changed": found.changed,
        }
    match outcome:
        case Unrealizable(failures):
            record |= {"verdict": "unrealizable", "failures": {each.kind: each.count for each in failures}}
        case Undecided(limit):
            record |= {"verdict": "undecided", "limit": limit}
        case _:
            record["verdict"] = "realizable"
    return record


def _policy(policy: Policy, text: str) -> dict[str, object]:
    ranks = policy.certificate.ranks.nodes if policy.certificate else ()
    return {
        "nodes": len(as_diagram(policy).diagram.nodes),
        "rank_nodes": len(ranks),
        "bytes": len(text.encode()),
        "digest": hashlib.sha256(text.encode()).hexdigest()[:16],
    }


def _allowed_sets(spec: Spec) -> int:
    """How many sets of actions are allowed in some state."""
    from tumato_symbolic.symbolic import available_backend, build_steps, lay_out

    steps = build_steps(lay_out(spec, available_backend()), spec, spec.ordering)
    encoding = steps.encoding
    sets = encoding.manager.exists(encoding.all_state_bits, steps.allowed)
    return encoding.manager.count(sets, encoding.all_choice_bits)


if __name__ == "__main__":
    main()
