"""A policy as a theorem for Coq: the specification, the table, and a proof that is checked by computing.

The meaning and the theorem are in `proofs/coq`. Nothing is checked here: a wrong policy gives a file that Coq rejects.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import islice

from tumato_symbolic.diagnostics import Code, Diagnostic, UserError
from tumato_symbolic.export.coq_specification import in_brackets, specification
from tumato_symbolic.export.efforts import nominal_sums
from tumato_symbolic.export.request import Request
from tumato_symbolic.policy import Policy, as_table, bind
from tumato_symbolic.semantics import (
    ActionSet,
    Effort,
    Restorations,
    State,
    action_names,
    all_states,
    count_states,
    is_start,
    is_valid,
    named,
)
from tumato_symbolic.spec import (
    Ordering,
    Spec,
)

MOST_STATES = 30_000
"""Coq goes through all states, valid or not; so many take it about a minute (`proofs/coq/README.md`)."""

_HEAD = """\
(* Compiling this file proves that the policy below is sound, complete and minimal for the specification below.
   What that means is written in Semantics.v, that the checker tells the truth is proved in Correct.v (proofs/coq).
   Written by `tumato-sym export coq`; comments are for readers and prove nothing. *)

From Coq Require Import List NArith.
From Tumato Require Import Semantics Checker Correct Starts.
Import ListNotations.
"""

_CASES = """\
(* An action whose effects depend on the state stands here as several, its cases, one for each thing that it may do: the
   guard of a case tells in which states the action does that. *)
"""

_THEOREM = """\
(* Coq computes the check. Where the policy is wrong, it says here that `true` is not what comes out;
   `tumato-sym verify` tells why. *)
Lemma accepted : check spec {ordering} decisions {efforts} = true.
Proof. vm_cast_no_check (eq_refl true). Qed.

Theorem policy_is_right :
  sound_and_complete spec {ordering} (policy_of decisions) /\\ minimal spec {ordering} (policy_of decisions).
Proof. exact (checker_sound spec {ordering} decisions {efforts} accepted). Qed.

Print Assumptions policy_is_right.
"""

_THEOREM_FROM_STARTS = """\
(* Coq computes the check. Where the policy is wrong, it says here that `true` is not what comes out;
   `tumato-sym verify` tells why. *)
Lemma accepted : check_from_starts spec {ordering} decisions {efforts} = true.
Proof. vm_cast_no_check (eq_refl true). Qed.

Theorem policy_is_right : right_from_starts spec {ordering} (decides decisions) (policy_of decisions).
Proof. exact (starts_sound spec {ordering} decisions {efforts} accepted). Qed.

Print Assumptions policy_is_right.
"""


def files(request: Request) -> tuple[str]:
    """The text of the theorem."""
    return (export(request.policy, request.spec, request.ordering),)


def export(policy: Policy, spec: Spec, ordering: Ordering) -> str:
    """The text of a Coq file that compiles when `policy` is sound, complete and minimal under `ordering`.

    What that means is section 5 of `docs/semantics.md`, with starts section 12; `proofs/coq/README.md` tells how to
    compile. Raises `UserError` where the policy does not fit the specification (`bind`), where it leaves a valid state,
    with starts a start, undecided (TUM502), or where the specification has more than `MOST_STATES` states (TUM508).
    """
    rows = _rows(bind(policy, spec), spec)
    several = spec.restoration != "one_step"
    theorem = (_THEOREM_FROM_STARTS if spec.starts else _THEOREM).format(
        ordering=ordering.capitalize(), efforts="known" if several else "no_efforts"
    )
    efforts = _efforts(spec, rows, ordering) if several else ()
    return "\n".join(
        [
            _HEAD,
            *([_CASES] if spec.has_cases else []),
            *specification(spec),
            *_decisions(spec, rows),
            *efforts,
            theorem,
        ]
    )


def _rows(policy: Policy, spec: Spec) -> dict[State, ActionSet]:
    """The decisions in the valid states; with starts all decisions, for there are to be none in other states."""
    count = count_states(spec)
    if count > MOST_STATES:
        message = f"the specification has {count:,} states; Coq goes through each, for up to {MOST_STATES:,}"
        help = "`tumato-sym verify` proves all states at once; `proofs/checker.py`, on its own, up to 2,000,000"
        raise _fault(Code.TUM508, message, help)
    table = as_table(policy, count)
    rows = {} if table is None else table.rows
    valid = [state for state in all_states(spec) if is_valid(spec, state)]
    missing = next((state for state in valid if state not in rows and is_start(spec, state)), None)
    if missing is not None:
        state = ", ".join(f"{name} is {value}" for name, value in islice(named(spec, missing).items(), 20))
        what = "start" if spec.starts else "valid state"
        raise _fault(Code.TUM502, f"the policy decides nothing in the {what} ({state})", "synthesize it again")
    return dict(rows) if spec.starts else {state: rows[state] for state in valid}


def _fault(code: Code, message: str, help: str) -> UserError:
    return UserError((Diagnostic(code, message, help=help),))


def _decisions(spec: Spec, rows: dict[State, ActionSet]) -> Iterator[str]:
    """Every set that occurs, by a name, and the tree of the decisions: one level for every variable."""
    chosen = sorted({tuple(sorted(decision)) for decision in rows.values()})
    yield "(* The decisions. *)"
    yield "Definition none : option actions := None. (* an invalid state *)"
    for number, decision in enumerate(chosen):
        names = ", ".join(action_names(spec, frozenset(decision))) or "nothing"
        yield f"Definition d{number} : option actions := Some {in_brackets(map(str, decision))}. (* {names} *)"
    names_of = {frozenset(decision): f"d{number}" for number, decision in enumerate(chosen)}
    leaves = [f"Leaf {names_of[rows[state]] if state in rows else 'none'}" for state in all_states(spec)]
    yield f"\nDefinition decisions : table :=\n{_tree(spec, leaves)}.\n"


def _efforts(spec: Spec, rows: dict[State, ActionSet], ordering: Ordering) -> Iterator[str]:
    """The least efforts by the decisions, as a hint that the checker verifies."""
    sums = nominal_sums(spec, rows) if spec.restoration == "fair" else {}
    yield from _known(spec, Restorations(spec, rows, ordering).worst, sums)


def _known(spec: Spec, worst: Mapping[State, Effort], sums: Mapping[State, Effort]) -> Iterator[str]:
    """Efforts in the worst case and by nominal effects, as the checker needs them."""
    found = sorted({*worst.values(), *sums.values()})
    yield "(* The efforts (duration, steps) that restoring takes by these decisions; the checker tests them. *)"
    yield "Definition no : option effort := None. (* a safe state, or no effort suffices *)"
    yield from (f"Definition e{number} : option effort := Some ({d}, {k})%N." for number, (d, k) in enumerate(found))
    number_of = {effort: number for number, effort in enumerate(found)}

    def tree(efforts: Mapping[State, Effort]) -> str:
        leaves = (f"Leaf e{number_of[efforts[state]]}" if state in efforts else "Leaf no" for state in all_states(spec))
        return _tree(spec, list(leaves)) if efforts else "Node []"

    yield f"\n(* Whatever happens. *)\nDefinition in_the_worst_case : tree (option effort) :=\n{tree(worst)}.\n"
    yield f"(* If only nominal effects occur. *)\nDefinition as_planned : tree (option effort) :=\n{tree(sums)}.\n"
    yield "Definition known : efforts := {| worst := in_the_worst_case; nominal_sum := as_planned |}.\n"


def _tree(spec: Spec, leaves: list[str]) -> str:
    """The tree with the given leaves, in the order of the states; the leaves of one node share a line."""
    trees = leaves
    for depth, variable in reversed(list(enumerate(spec.variables, 1))):
        size, indent = len(variable.values), "  " * depth
        groups = [trees[start : start + size] for start in range(0, len(trees), size)]
        if depth == len(spec.variables):
            trees = [f"{indent}Node {in_brackets(group)}" for group in groups]
        else:
            comments = [f"{indent} (* {variable.name} is {value} *)\n" for value in variable.values]
            members = (";\n".join(map("".join, zip(comments, group, strict=True))) for group in groups)
            trees = [f"{indent}Node [\n{below}]" for below in members]
    return trees[0]
