"""The figures in docs/performance.md, written from one run: `python -m benchmarks.document RESULTS DOCUMENT`."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from benchmarks.bars import judged
from benchmarks.table import Case, known, peak, size, units

BEGIN, END = "<!-- figures -->\n", "\n<!-- end of figures -->"
"""What is between these lines of the document is written anew."""

COLUMNS = (
    "case", "valid states", "actions", "sets", "stages of `synth` that cost most, s", "proof, s", "MB", "nodes",
    "bytes", "proved by", "`synth`", "`verify`", "no policy", "Python",
)  # fmt: skip

SHOWN = 2
"""How many stages are named."""

PROVERS = {"z3": "Z3", "walk": "walk", "explicit": "states"}


def main() -> None:
    """Write the figures of a file of results into a document."""
    results, document = map(Path, sys.argv[1:3])
    text = renewed(document.read_text(encoding="utf-8"), json.loads(results.read_text(encoding="utf-8")), results.name)
    document.write_text(text, encoding="utf-8")


def renewed(document: str, result: Mapping[str, Any], name: str) -> str:
    """A document with the figures of a run, which are in the file of this name."""
    before, _, rest = document.partition(BEGIN)
    _, mark, after = rest.partition(END)
    assert mark, "the document says where figures stand"
    return before + BEGIN + figures(result, name) + END + after


def figures(result: Mapping[str, Any], name: str) -> str:
    """The machine, the table and the bars."""
    rows = [COLUMNS, ("---",) * len(COLUMNS), *map(_row, result["cases"])]
    table = "\n".join(f"| {' | '.join(row)} |" for row in rows)
    bars = f"The demands on these figures, and whether they are kept:\n\n```\n{judged(result)}\n```"
    return "\n\n".join((_machine(result, name), table, bars, *_peers(result)))


def _machine(result: Mapping[str, Any], name: str) -> str:
    machine, unit = result["machine"], result["unit"]
    return (
        f"Figures of `benchmarks/results/{name}`: {machine['cpu']}, {machine['cores']} cores; "
        f"Python {machine['python']}; one unit is {unit['seconds']:.2f} s, {unit['cpu']:.2f} s of them computing."
    )


def _row(case: Case) -> tuple[str, ...]:
    if "states" not in case:
        return (case["case"], case["verdict"], *["–"] * (len(COLUMNS) - 2))
    unit: float = case["unit"]["seconds"]
    stages: dict[str, float] = dict(case["stages"])
    stages["extraction"] = stages.get("extraction", 0.0) + stages.pop("write", 0.0)
    most = sorted(stages.items(), key=lambda each: -each[1])[:SHOWN]
    proof = case.get("proof", {})
    provers = dict.fromkeys(PROVERS.get(each["proved_by"], each["proved_by"] or "–") for each in proof.values())
    return (
        case["case"],
        size(case["valid"]),
        str(case["actions"]),
        known(case.get("allowed_sets"), size),
        ", ".join(f"{stage} {seconds:.2f}" for stage, seconds in most),
        f"{sum(each['seconds'] for each in proof.values()):.2f}" if proof else "–",
        str(peak(case)),
        known(case.get("nodes"), size),
        known(case.get("bytes"), size),
        ", ".join(provers) or "–",
        units(case.get("synth"), unit),
        units(case.get("verify"), unit),
        units(case["twin"], unit),
        known(case.get("pure_python"), "{:.1f}".format),
    )


def _peers(result: Mapping[str, Any]) -> Iterator[str]:
    """What other tools took in the same run, where any were there."""
    peers = result.get("peers", [])
    if peers:
        rows = [("case", "tool", "its s", "its MB", "our s, with policy and proof"), ("---",) * 5]
        for each in peers:
            theirs = f"{each['seconds']:.2f}" if each["exit"] == 0 else "no answer"
            rows.append(
                (each["case"], each["tool"], theirs, str(each["peak_mb"]), known(each["ours"], "{:.2f}".format))
            )
        yield "Other tools, in the same run:\n\n" + "\n".join(f"| {' | '.join(row)} |" for row in rows)


if __name__ == "__main__":
    main()
