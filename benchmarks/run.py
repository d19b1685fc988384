"""`make bench`: every family in processes of its own, one table, the bars, and a file of results.

`python -m benchmarks.run --help` tells what can be chosen.
"""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
from datetime import UTC, datetime
from pathlib import Path

from benchmarks.bars import judged
from benchmarks.families import FAMILIES, Family
from benchmarks.measure import COMMAND, REPEATS, UNIT, best, machine, run
from benchmarks.table import table

RESULTS = Path(__file__).parent / "results"

Record = dict[str, object]

PEER_FAMILY = "loads"
"""The family that `benchmarks.peers` puts to other tools."""


def main() -> int:
    """Measure, print, write. Exits with 1 where a policy is not proved or a verdict is not the promised one."""
    options = _options()
    if options.show:
        return shown(json.loads(options.show.read_text(encoding="utf-8")))
    stamp = datetime.now(UTC).strftime("%Y%m%d-%H%M%S")
    repeats = 3 if options.quick else REPEATS
    result: Record = {
        "quick": options.quick,
        "machine": machine(),
        "unit": best(UNIT, options.limit, repeats).record(),
        "help": best((*COMMAND, "--help"), options.limit).record(),
    }
    cases: list[Record] = []
    peers: list[Record] = []
    out = options.out or RESULTS / f"{stamp}{'-quick' if options.quick else ''}.json"
    names = options.family or list(FAMILIES)
    kept = _other_cases(out, names)
    for name in names:
        family = FAMILIES[name]
        for size in family.quick if options.quick else family.sizes:
            print(f"{family.case(size)} …", end="\r", file=sys.stderr, flush=True)
            cases.append(measured(family, size, options.limit, repeats))
            result["cases"] = [*kept, *cases]
            if options.storm and family.name == PEER_FAMILY:
                peers.append(peer(options.storm, cases[-1], size, options.limit))
                result["peers"] = peers
            out.write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")
    code = shown(result)
    print(f"\nwritten: {out.name}")
    return code


def _other_cases(out: Path, names: list[str]) -> list[Record]:
    """What a file of results already holds of families that are not measured now."""
    if not out.exists():
        return []
    return [case for case in json.loads(out.read_text(encoding="utf-8"))["cases"] if case["family"] not in names]


def shown(result: Record) -> int:
    """Print the table, the bars and every promise that was broken; 1 where there is one, else 0."""
    cases = result["cases"]
    assert isinstance(cases, list)
    broken = [f"WRONG: {problem}" for case in cases for problem in problems(case)]
    print("\n".join((table(result), "", judged(result), *broken)))
    return 1 if broken else 0


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.run")
    parser.add_argument("--quick", action="store_true", help="small sizes only, best of three")
    parser.add_argument("--family", action="append", choices=FAMILIES, help="this family only; may be repeated")
    parser.add_argument("--limit", type=float, default=300, help="seconds that one process may take (default: 300)")
    parser.add_argument(
        "--out", type=Path, help="where the results go; other families in it stay (default: a new file)"
    )
    parser.add_argument(
        "--storm", metavar="PYTHON", help="an interpreter with stormpy, to be asked about `loads` as well"
    )
    parser.add_argument("--show", type=Path, metavar="FILE", help="only print what an earlier run found")
    return parser.parse_args()


def measured(family: Family, size: int, limit: float, repeats: int) -> Record:
    """One size of a family, and its twin: the unit, stages, then the commands as a user runs them.

    The unit is measured anew for every case: what else runs on the machine should weigh on both.
    """
    with tempfile.TemporaryDirectory() as folder:
        spec, policy, staged = (Path(folder) / name for name in ("case.tum", "policy.json", "staged.json"))
        spec.write_text(family.text(size, True), encoding="utf-8")
        record: Record = {"case": family.case(size), "family": family.name, "size": size, "limit": family.limit}
        record["unit"] = best(UNIT, limit, repeats).record()
        stages = run((sys.executable, "-m", "benchmarks.stages", str(spec), str(staged)), limit)
        if stages.code != 0:
            return record | {"verdict": "over the limit" if stages.code is None else f"exit {stages.code}"}
        record |= json.loads(stages.output)
        if size in family.quick and not family.limit:
            record["pure_python"] = _pure_python(spec, Path(folder) / "slowly.json", limit)
        if record["verdict"] == "realizable":
            record |= _commands(spec, policy, limit, repeats)
            same = policy.exists() and policy.read_bytes() == staged.read_bytes()
            record["reproduced"] = same
        spec.write_text(family.text(size, False), encoding="utf-8")
        twin = best((*COMMAND, "synth", str(spec), "--output-format", "json", "-o", str(policy)), limit, 1)
        record["twin"] = twin.record()
    return record


def peer(python: str, case: Record, size: int, limit: float) -> Record:
    """What Storm takes for a case, beside what `synth` took just before."""
    ran, ours = run((python, "-m", "benchmarks.peers", str(size)), limit), case.get("synth")
    seconds = ours["seconds"] if isinstance(ours, dict) else None
    return {"case": case["case"], "tool": "Storm, diagrams", **ran.record(), "ours": seconds}


def _pure_python(spec: Path, policy: Path, limit: float) -> float | None:
    """How many times as long the search takes in pure Python as with CUDD; None where it does not end."""
    seconds: list[float] = []
    for backend in ("cudd", "autoref"):
        ran = run((sys.executable, "-m", "benchmarks.stages", str(spec), str(policy), backend), limit)
        if ran.code != 0:
            return None
        stages = json.loads(ran.output)["stages"]
        seconds.append(sum(stages.values()) - stages["parse"] - stages.get("write", 0.0))
    return round(seconds[1] / seconds[0], 2)


def _commands(spec: Path, policy: Path, limit: float, repeats: int) -> Record:
    """`synth` with its proof and `verify`, as whole processes."""
    synth = best((*COMMAND, "synth", str(spec), "-o", str(policy)), limit, repeats)
    found: Record = {"synth": synth.record()}
    if not policy.exists():
        return found
    verify = best((*COMMAND, "verify", str(policy), str(spec), "--output-format", "json"), limit, repeats)
    found["verify"] = verify.record()
    if verify.code is not None and verify.output:
        properties = json.loads(verify.output)["properties"]
        found["proof"] = {
            name: {key: each[key] for key in ("verdict", "proved_by", "obligations", "seconds")}
            for name, each in properties.items()
        }
    return found


def problems(case: Record) -> list[str]:
    """What a measured case has that was promised otherwise. A family that shows a limit may end without an answer."""
    name, found = case["case"], []
    if case["limit"] and case["verdict"] == "over the limit":
        return []
    if case["verdict"] != "realizable":
        return [f"{name}: {case['verdict']}"]
    for command in ("synth", "verify"):
        ended = case.get(command)
        if not isinstance(ended, dict) or ended["exit"] != 0:
            found.append(f"{name}: {command} did not prove the policy")
    if not case.get("reproduced"):
        found.append(f"{name}: two runs gave different policies")
    twin = case["twin"]
    if isinstance(twin, dict) and twin["exit"] != 1:
        found.append(f"{name}: the twin is not called unrealizable (exit {twin['exit']})")
    return found


if __name__ == "__main__":
    sys.exit(main())
