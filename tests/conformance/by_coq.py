"""The checker in Coq, of which proofs/coq/Correct.v proves that it means what Semantics.v says."""

from __future__ import annotations

import re
import shutil
import subprocess
from collections.abc import Iterable, Iterator
from itertools import chain
from weakref import finalize

from tests.conformance.roles import Rows
from tests.conformance.world import World
from tests.export.compiler import COQC, Library
from tumato_symbolic.export import coq, coq_specification
from tumato_symbolic.semantics import ActionSet, Effort, State, is_valid
from tumato_symbolic.spec import Ordering, Spec

TOPLEVEL = shutil.which("coqtop") if COQC else None

_HEAD = "From Coq Require Import Bool List NArith. From Tumato Require Import Semantics Checker. Import ListNotations."


class Coq:
    """`proofs/coq/Checker.v`, asked in one session of Coq's toplevel."""

    name = "coq"

    def __init__(self) -> None:
        self._session: Session | None = None
        self._modules: dict[Spec, str] = {}

    def valid(self, world: World, state: State) -> bool:
        """`assumed`."""
        return self._truth(f"assumed {self._spec(world)} {_list(state)}")

    def safe(self, world: World, state: State) -> bool:
        """`keeps_rules`."""
        return self._truth(f"keeps_rules {self._spec(world)} {_list(state)}")

    def allowed(self, world: World, state: State, chosen: ActionSet) -> bool:
        """`is_ok`."""
        return self._truth(self._ok(world, state, chosen))

    def successor(self, world: World, state: State, chosen: ActionSet) -> State:
        """`delta`."""
        found = self._ask(f"delta {self._spec(world)} {_list(state)} {_list(sorted(chosen))}")
        return tuple(map(int, re.findall(r"\d+", found)))

    def meets(self, world: World, state: State, chosen: ActionSet, there: State) -> bool:
        """Whether all that `active` lists holds."""
        bodies = f"active {self._spec(world)} {_list(state)}"
        return self._truth(f"forallb (holds {_list(there)} {_list(sorted(chosen))}) ({bodies})")

    def faults(self, world: World, rows: Rows) -> set[str]:
        """The parts of `check`, which has to agree with them."""
        decided = {state: chosen for state, chosen in rows.items() if is_valid(world.spec, state)}
        spec, order, table = self._spec(world), _order(world.ordering), self._table(world, decided)
        states, valid, safe = f"(all_states (sizes {spec}))", f"(assumed {spec})", f"(keeps_rules {spec})"
        policy, efforts = f"(policy_of {table}.decisions)", f"{table}.known"
        pairs = _list(f"({_list(state)}, {_list(sorted(chosen))})" for state, chosen in decided.items())
        serves = f"serves {spec} {safe} (length {states}) {policy} (fst p) (snd p)"
        known = f"{valid} {safe} {states} (length {states}) {policy} {efforts}"
        ok = f"is_ok {spec} {order} (is_kept {spec} {valid} {safe} (fst p)) (fst p) (snd p)"
        restored = f"is_restoring {spec} {order} {valid} {efforts} (fst p) (snd p)"
        if world.spec.restores_stepwise and world.spec.restoration == "one_step":
            restored = f"next_fine {spec} {order} (is_restored {spec} {valid} (fst p)) (fst p) (snd p)"
        better = f"no_better {spec} {order} {known} (fst p) (snd p)"
        parts = {
            "total": f"forallb (fun s => negb ({valid} s) || (match entry {table}.decisions s with Some _ => true"
            f" | None => false end)) {states}",
            "safe": f"forallb (fun p => {ok}) {pairs}",
            "goals": f"forallb (fun p => negb ({ok}) || {serves}) {pairs}",
            "minimal": f"forallb (fun p => {safe} (fst p) || {better}) {pairs}",
        }
        if world.spec.restores_stepwise:
            parts["restoring"] = f"forallb (fun p => {safe} (fst p) || {restored}) {pairs}"
        found = {name for name, question in parts.items() if not self._truth(question)}
        assert self._truth(f"check {spec} {order} {table}.decisions {efforts}") == (not found)
        return found

    def following(self, world: World, state: State, chosen: ActionSet) -> set[State]:
        """The states without which `next_fine` is false."""
        spec, here = self._spec(world), f"{_list(state)} {_list(sorted(chosen))}"
        fine = f"next_fine {spec} {_order(world.ordering)} (fun t => negb (same_list t u)) {here}"
        found = self._ask(f"filter (fun u => negb ({fine})) (all_states (sizes {spec}))")
        return {tuple(map(int, re.findall(r"\d+", each))) for each in re.findall(r"\[([\d; ]+)\]", found)}

    def level(self, world: World, state: State) -> int:
        """`level`."""
        return int(self._ask(f"level {self._spec(world)} {_list(state)}"))

    def efforts(self, world: World, rows: Rows) -> dict[State, Effort]:
        """The least efforts that are enough by `takes`, from what is known of the states after."""
        spec, order = self._spec(world), _order(world.ordering)
        largest = sum(action.duration for action in world.spec.actions) * len(rows)
        efforts = _list(f"({d}, {k})%N" for d in range(largest + 1) for k in range(1, len(rows) + 1))
        found: dict[State, Effort] = {}
        waiting = [state for state in rows if not self.safe(world, state)]
        while True:
            told = "None"
            for state, (d, k) in found.items():
                told = f"if same_list t {_list(state)} then Some ({d}, {k})%N else {told}"
            takes = f"takes {spec} (assumed {spec}) not_more (fun t => {told}) (next_fine {spec} {order})"
            more = {}
            for state in waiting:
                answer = self._ask(f"find ({takes} {_list(state)} {_list(sorted(rows[state]))}) {efforts}")
                if answer != "None":
                    duration, steps = map(int, re.findall(r"\d+", answer))
                    more[state] = duration, steps
            if not more:
                return found
            found |= more
            waiting = [state for state in waiting if state not in more]

    def _ok(self, world: World, state: State, chosen: ActionSet) -> str:
        spec, here = self._spec(world), _list(state)
        kept = f"(is_kept {spec} (assumed {spec}) (keeps_rules {spec}) {here})"
        return f"is_ok {spec} {_order(world.ordering)} {kept} {here} {_list(sorted(chosen))}"

    def _spec(self, world: World) -> str:
        if world.spec not in self._modules:
            self._modules[world.spec] = self._module(coq_specification.specification(world.spec))
        return f"{self._modules[world.spec]}.spec"

    def _table(self, world: World, rows: Rows) -> str:
        """A module with the decisions, and what Coq is told of their efforts."""
        several, own = world.spec.restoration != "one_step", dict(rows)
        efforts = coq._efforts(world.spec, own, world.ordering) if several else ["Definition known := no_efforts."]
        return self._module(chain(coq._decisions(world.spec, own), efforts))

    def _module(self, lines: Iterator[str]) -> str:
        self._session = self._session or Session()
        return self._session.define("\n".join(lines))

    def _truth(self, question: str) -> bool:
        found = self._ask(question)
        assert found in ("true", "false"), found
        return found == "true"

    def _ask(self, question: str) -> str:
        assert self._session is not None, "a specification comes first"
        return self._session.ask(question)


class Session:
    """Coq's toplevel with the two files that compute."""

    def __init__(self) -> None:
        self._process = subprocess.Popen(
            [str(TOPLEVEL), "-q", "-R", ".", "Tumato"],
            cwd=compiled(),
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            text=True,
        )
        finalize(self, _end, self._process)
        self._count = 0
        self._write(_HEAD)

    def define(self, text: str) -> str:
        """A module with some definitions; its name."""
        self._count += 1
        self._write(f"Module M{self._count}.\n{text}\nEnd M{self._count}.")
        return f"M{self._count}"

    def ask(self, question: str) -> str:
        """What a term is. Coq answers an error with nothing, so a second answer follows each."""
        self._write(f"Eval vm_compute in ({question}).\nEval vm_compute in tt.")
        assert self._process.stdout is not None
        found = ""
        while "= tt" not in found:
            line = self._process.stdout.readline()
            assert line, "Coq has ended"
            found += line
        self._process.stdout.readline()
        match = re.search(r"= (.*?)\s+: ", found.partition("= tt")[0], re.DOTALL)
        assert match is not None, f"Coq does not understand: {question}"
        return " ".join(match[1].split())

    def _write(self, text: str) -> None:
        assert self._process.stdin is not None
        self._process.stdin.write(f"{text}\n")
        self._process.stdin.flush()


def compiled() -> str:
    """A folder with the two files that compute, compiled."""
    return str(Library.shared("Checker.vo").folder)


def _end(process: subprocess.Popen[str]) -> None:
    process.kill()
    process.communicate()


def _order(ordering: Ordering) -> str:
    return ordering.capitalize()


def _list(numbers: Iterable[object]) -> str:
    return f"[{'; '.join(map(str, numbers))}]"
