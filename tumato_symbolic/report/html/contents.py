"""What a page says of a policy, or of a specification without one: the records of other rooms as plain data."""

from __future__ import annotations

import re

from msgspec import Struct

from tumato_symbolic.diagnostics import Source
from tumato_symbolic.explain.explanation import Explanation
from tumato_symbolic.policy import Policy, RuleList
from tumato_symbolic.report.explained import Explained
from tumato_symbolic.report.explained_data import as_json as explanation_json
from tumato_symbolic.report.explained_data import largest_first
from tumato_symbolic.report.html.record import Json, alternatives_record, elements_record, policy_record, spec_record
from tumato_symbolic.report.objections import Place
from tumato_symbolic.report.possible_changes import left_out_lines, repair_pieces
from tumato_symbolic.report.proof import claim_of, prover_names, provers, refutation_text, states_covered
from tumato_symbolic.report.unrealizable import proof_line, proved_by
from tumato_symbolic.spec import Ordering, Spec
from tumato_symbolic.verify.result import PropertyResult, UnrealizabilityVerdict, Verification

MOST_RULES = 500
"""A page lists so many rules."""


class PolicyPage(Struct, frozen=True):
    """A policy in the vocabulary of its specification, and what is known of it.

    `proof` is None where nothing was proved; where there are no `rules`, they are why.
    """

    source: Source
    spec: Spec
    name: str
    policy: Policy
    ordering: Ordering
    proof: Verification | None
    rules: RuleList | str


class NoPolicyPage(Struct, frozen=True):
    """A specification without a policy, with the certificate of that (`name` is its file) and why it is so."""

    source: Source
    spec: Spec
    name: str
    ordering: Ordering
    verdict: UnrealizabilityVerdict | None
    explained: Explained


def contents(page: PolicyPage | NoPolicyPage) -> dict[str, Json]:
    """All that the page carries."""
    record = {"spec": spec_record(page.spec, page.source, page.ordering), "file": page.name}
    if isinstance(page, NoPolicyPage):
        record |= {"alternatives": alternatives_record(page.spec)}
        return record | {"verdict": _no_verdict(page), "no": _explanation(page)}
    return record | {
        "verdict": _verdict(page),
        "policy": policy_record(page.policy, page.name),
        "rules": page.rules if isinstance(page.rules, str) else _rules(page.spec, page.rules),
    }


def _verdict(page: PolicyPage) -> dict[str, Json]:
    """What is proved, and by whom."""
    proof = page.proof
    if proof is None:
        return {"verdict": "unproved", "by": None, "states": None, "properties": []}
    return {
        "verdict": proof.verdict,
        "by": provers(proof) or None,
        "states": states_covered(proof),
        "properties": [_property(page, proof, result) for result in proof.properties],
    }


def _property(page: PolicyPage, proof: Verification, result: PropertyResult) -> dict[str, Json]:
    refutation = result.refutation
    found = {
        "name": result.name,
        "verdict": result.verdict,
        "by": prover_names(result.proved_by) if result.proved_by else None,
        "claim": claim_of(result, proof),
        "reason": result.reason,
        "refutation": None if refutation is None else refutation_text(Place(page.spec, page.source.name), refutation),
        "state": None if refutation is None or refutation.state is None else list(refutation.state),
    }
    return {name: value for name, value in found.items() if value is not None}


def _rules(spec: Spec, found: RuleList) -> dict[str, Json]:
    """Rules in numbers; the first that matches decides."""
    variables = {variable.name: number for number, variable in enumerate(spec.variables)}
    actions = {name: number for number, name in enumerate(spec.action_names)}

    def condition(name: str, values: tuple[str, ...]) -> list[int]:
        number = variables[name]
        return [number, *map(spec.variables[number].values.index, values)]

    return {
        "list": [
            [[condition(*each) for each in rule.condition], [actions[name] for name in rule.actions]]
            for rule in found.rules[:MOST_RULES]
        ],
        "more": max(0, len(found.rules) - MOST_RULES),
        "left": found.left,
        "limit": found.limit,
    }


def _no_verdict(page: NoPolicyPage) -> dict[str, Json]:
    found = page.verdict
    if found is None:
        return {"verdict": "unproved", "by": None, "line": None}
    return {
        "verdict": found.verdict,
        "by": proved_by(found),
        "line": proof_line(page.spec, found) if found.verdict == "proved" else found.reason,
    }


def _explanation(page: NoPolicyPage) -> dict[str, Json]:
    """The explanation as `explain` tells programs; what would change it also as it tells people."""
    done = page.explained
    record = explanation_json(done)
    wanted = ("verdict", "failing_states", "groups", "failures", "omitted", "realizable_part", "limit")
    found: dict[str, Json] = {name: record[name] for name in wanted}
    if not isinstance(done.found, Explanation):
        return found | {"repairs": [], "left_out": []}
    reasons = [
        failure
        | {
            "elements": elements_record(done.spec, reason.core),
            "later": reason.later,
            "near": [_by_line(each["story"], done.source.name) for each in failure["near"]],
        }
        for failure, reason in zip(found["failures"], largest_first(done.found.reasons), strict=True)
    ]
    return found | {
        "failures": reasons,
        "repairs": [piece.strip("\n") for piece in repair_pieces(done.place, done.found)],
        "left_out": [each.strip() for each in left_out_lines(done.found)] if done.found.left_out else [],
    }


def _by_line(text: str, file: str) -> str:
    """A text in which places in the one file of the page are lines."""
    return re.sub(rf"{re.escape(file)}:(\d+)", r"line \1", text)
