"""What each of the two readers makes of a policy or a certificate beside its specification, in one form."""

from __future__ import annotations

import io
from contextlib import redirect_stderr, redirect_stdout
from itertools import product
from pathlib import Path
from typing import Any

from tests.checker.standalone import checker
from tests.readers.meaning import REFUSED, Meaning, deep
from tumato_symbolic.diagnostics import UserError
from tumato_symbolic.policy import Policy, as_table, bind, load_claim
from tumato_symbolic.semantics import all_states, is_safe
from tumato_symbolic.spec import Spec, canonical_text
from tumato_symbolic.verify import verify_unrealizable
from tumato_symbolic.verify.claimed_ranks import ClaimedRanks

Found = Meaning | str
"""What a policy says, the verdict on a certificate of unrealizability, or that the file is refused."""


def claim_by_package(path: Path, spec: Spec) -> Found:
    """What the package reads in a file for a specification."""
    try:
        claim = load_claim(str(path))
        if not isinstance(claim, Policy):
            return verify_unrealizable(claim, spec).verdict
        policy = bind(claim, spec)
    except UserError:
        return REFUSED
    table = as_table(policy, 10**6)
    assert table is not None
    names = [(variable.name, variable.values) for variable in spec.variables]
    actions = [action.name for action in spec.actions]
    return {
        "decisions": {
            tuple(values[value] for (_, values), value in zip(names, state, strict=True)): sorted(
                actions[number] for number in chosen
            )
            for state, chosen in table.rows.items()
        },
        "ordering": policy.ordering,
        "restoration": policy.restoration,
        "certificate": _ranks_by_package(policy, spec),
    }


def _ranks_by_package(policy: Policy, spec: Spec) -> Any:
    """The ranks of the safe states by residual goal, or why there are none."""
    claimed = ClaimedRanks(spec, policy, lambda: True)
    if claimed.use.status != "unneeded" or policy.certificate is None:
        return claimed.use.status
    safe = [state for state in all_states(spec) if is_safe(spec, state)]
    names = [variable.values for variable in spec.variables]
    return {
        (
            frozenset(canonical_text(spec, spec.bodies[body].formula) for body in goal.bodies),
            frozenset(spec.actions[action].name for action in goal.executed),
        ): {
            tuple(values[value] for values, value in zip(names, state, strict=True)): policy.certificate.ranks.evaluate(
                root, state
            )
            for state in safe
        }
        for goal, root in claimed.roots.items()
    }


def claim_by_checker(path: Path, text: Path) -> Found:
    """What the checker reads in the same file."""
    try:
        with deep():
            spec = checker.read_specification(text.read_bytes())
            document = checker.read_document(path.read_bytes())
            if document.get("Type") == "unrealizable":
                return _verdict_of_no(path, text)
            policy = checker.read_policy(document, spec)
            every = product(*spec.variables.values())
            decided = ((state, policy.decide(state)) for state in every)
            return {
                "decisions": {state: sorted(chosen) for state, chosen in decided if chosen is not None},
                "ordering": policy.document.get("EffectOrdering"),
                "restoration": policy.document["Restoration"],
                "certificate": _ranks_by_checker(policy, spec),
            }
    except (checker.Unreadable, UnicodeDecodeError, RecursionError):
        return REFUSED


def _ranks_by_checker(policy: Any, spec: Any) -> Any:
    if "Certificate" not in policy.document:
        return "absent"
    if policy.document.get("SpecificationDigest") != checker.digest(spec):
        return "stale"
    try:
        world = checker.World(spec, "any")
        checker.read_restoring(world, policy.document)
        found = checker.read_ranks(world, policy.document)
    except (checker.Unreadable, checker.Refuted):
        return "wrong"
    return {(frozenset(checker.text_of(body, spec) for body in goal[0]), goal[1]): of for goal, of in found.items()}


def _verdict_of_no(path: Path, text: Path) -> str:
    with redirect_stdout(io.StringIO()), redirect_stderr(io.StringIO()):
        return {0: "proved", 1: "refuted", 2: REFUSED}[checker.main([str(path), str(text)])]
