"""Mutants through the checker of `proofs/coq`: many in one file, which Coq computes at once."""

from __future__ import annotations

import re
import subprocess
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

from msgspec import Struct
from msgspec.structs import replace

from tests.conformance.by_coq import compiled
from tests.export.compiler import COQC
from tests.mutants.truth import Rows, decisions, is_right_policy
from tumato_symbolic.export import coq
from tumato_symbolic.export.coq_specification import specification
from tumato_symbolic.export.efforts import nominal_sums
from tumato_symbolic.policy import Policy, bind
from tumato_symbolic.semantics import Effort, Restorations, State, all_states, is_safe, is_valid
from tumato_symbolic.spec import Spec

Efforts = dict[State, Effort]


class Question(Struct, frozen=True):
    """Whether Coq accepts decisions with what is told of their efforts, and whether it has to."""

    kind: str
    spec: Spec
    rows: Rows
    worst: Efforts
    sums: Efforts
    right: bool


def questions(policy: Policy, spec: Spec) -> Iterator[Question]:
    """Its decisions with their own efforts, and with those that its certificate claims, where these are others.

    Coq takes the least efforts only; so it refuses some that a certificate may claim.
    """
    rows = {state: chosen for state, chosen in decisions(policy, spec).items() if is_valid(spec, state)}
    several = spec.restoration != "one_step"
    unsafe = [state for state in all_states(spec) if is_valid(spec, state) and not is_safe(spec, state)]
    own = Question(
        "policy",
        spec,
        rows,
        dict(Restorations(spec, rows, spec.ordering).worst) if several else {},
        nominal_sums(spec, rows) if spec.restoration == "fair" else {},
        is_right_policy(spec, rows, spec.ordering),
    )
    yield own
    claimed = _claimed(policy, own, unsafe) if several else None
    if claimed is not None and any(_told(claimed, state) != _told(own, state) for state in unsafe):
        yield claimed


def _told(question: Question, state: State) -> tuple[Effort | None, Effort | None]:
    return question.worst.get(state), question.sums.get(state)


def _claimed(policy: Policy, own: Question, unsafe: Iterable[State]) -> Question | None:
    """With the efforts of the certificate; where one has a worst effort, it says nothing of nominal effects."""
    certificate = bind(policy, own.spec).certificate
    if certificate is None or certificate.restoring is None:
        return None
    restoring, worst, sums = certificate.restoring, Efforts(), dict(own.sums)
    for state in unsafe:
        most = restoring.efforts.evaluate(restoring.worst, state)
        if most is not None:
            worst[state] = most
        elif own.spec.restoration == "fair":
            nominal = restoring.efforts.evaluate(restoring.nominal, state)
            sums.pop(state, None)
            sums |= {} if nominal is None else {state: nominal}
    return replace(own, kind="efforts", worst=worst, sums=sums, right=False)


def examine(asked: Sequence[tuple[str, Question]], folder: Path, judged: Counter[str]) -> Iterator[str]:
    """Complaints about named questions, asked in one file and each once; counts what was judged."""
    different = {(question.spec, _definitions(question)): (name, question) for name, question in asked}
    if not different:
        return
    found = answers("\n".join(written([question for _, question in different.values()])), folder)
    for (name, question), accepted in zip(different.values(), found, strict=True):
        judged[f"{question.kind}, {'right' if question.right else 'wrong'}"] += 1
        if accepted != question.right:
            yield f"{name}: coq {'accepts' if accepted else 'rejects'} a {question.kind} that is not so"


def written(questions: Sequence[Question]) -> Iterator[str]:
    """What asks the checker in Coq, in this order."""
    specs = {question.spec: number for number, question in enumerate(questions)}
    for spec, number in specs.items():
        yield from (f"Module S{number}.", *specification(spec), f"End S{number}.")
    for number, question in enumerate(questions):
        order, several = question.spec.ordering.capitalize(), question.spec.restoration != "one_step"
        check = f"check S{specs[question.spec]}.spec {order} decisions {'known' if several else 'no_efforts'}"
        yield f"Module C{number}.\n{_definitions(question)}\nEval vm_compute in {check}.\nEnd C{number}."


def _definitions(question: Question) -> str:
    told = coq._known(question.spec, question.worst, question.sums)
    return "\n".join((*coq._decisions(question.spec, question.rows), *told))


def answers(text: str, folder: Path) -> list[bool]:
    """What Coq computes where a file asks for it."""
    (folder / "asked.v").write_text(f"{_HEAD}\n{text}", encoding="utf-8")
    command = [str(COQC), "-q", "-R", compiled(), "Tumato", "asked.v"]
    answer = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    assert answer.returncode == 0, answer.stderr
    return [word == "true" for word in re.findall(r"= (true|false)\b", answer.stdout)]


_HEAD = "From Coq Require Import List NArith. From Tumato Require Import Semantics Checker. Import ListNotations."
