"""Which tests are meant for which module of the trusted base, the quickest first."""

from __future__ import annotations

from pathlib import Path

from msgspec import Struct

RULES = "tests/conformance"


def asking(engine: str) -> str:
    """Of the tests of all engines, those that ask this one."""
    return f"not (conformance and not {engine})"


SEMANTICS = (
    "tests/semantics/test_literal.py",
    "tests/semantics/test_goals.py",
    "tests/semantics/test_restoration.py",
    RULES,
    "tests/clauses/test_cases.py",
    "-k",
    asking("explicit"),
)
EXECUTIONS = ("tests/simulation", "tests/semantics/test_guarantees.py", "tests/cli/test_run.py")
STEPS = ("tests/symbolic/test_steps.py", "tests/restoration/test_synthesis.py", RULES, "-k", asking("bdd"))
NUMBERS = ("tests/policy/test_numbers.py",)
BINDING = (
    *NUMBERS,
    "tests/policy/test_bind.py",
    "tests/verify/test_verify.py::test_a_policy_for_first_where_any_is_meant",
)
JUDGED = "tests/verify/test_against_semantics.py"
STRANGERS = tuple(
    f"{JUDGED}::test_strangers_are_judged_as_by_the_explicit_meaning[{case}-auto]"
    for case in ("any-restoring", "first-interacting")
)
COUNTS = "tests/verify/test_counts.py"
BY_STATES = (
    "tests/verify/test_closed_loop.py",
    COUNTS,
    "tests/verify/test_by_states.py",
    "tests/verify/test_forged_steps.py",
    "tests/verify/test_portfolio.py",
    "tests/verify/test_verify.py",
    "tests/verify/test_forged_ranks.py",
    "tests/verify/test_without_effects.py",
    f"{JUDGED}::test_a_certificate_changes_no_verdict[explicit]",
    *(
        f"{JUDGED}::test_strangers_are_judged_as_by_the_explicit_meaning[{case}-explicit]"
        for case in ("any-restoring", "first-interacting", "any-concurrent")
    ),
    "tests/verify/test_restoring_claims.py",
    "tests/verify/test_several_steps.py",
    "tests/starts/test_starts.py",
    RULES,
    "-k",
    f"not walk and not z3 and not once and not parts and {asking('states')}",
)
WALK = (
    "tests/verify/test_cases.py",
    "tests/verify/test_closed_loop.py",
    COUNTS,
    "tests/verify/test_portfolio.py",
    "tests/verify/test_forged_steps.py",
    "tests/verify/test_forged_ranks.py",
    "tests/verify/test_walk.py",
    "tests/verify/test_restoring_claims.py",
    "tests/verify/test_several_steps.py",
    "tests/starts/test_starts.py",
    RULES,
    "-k",
    "not z3 and not once and not parts and not -explicit and not agree_also and not concurrent and not mixed"
    f" and not interacting-by-case and {asking('walk')}",
)
WALK_PROVER = (
    "tests/verify/test_effort.py",
    "tests/verify/test_workers.py",
    "tests/verify/test_jobs.py",
    *WALK[:-1],
    f"{WALK[-1]} and not depend",
)
PROCESSES = (
    "tests/verify/test_workers.py",
    "tests/verify/test_closed_loop.py",
    "tests/verify/test_jobs.py",
    "-k",
    "not depend",
)
Z3 = (
    "tests/verify/test_effort.py",
    "tests/verify/test_terms.py",
    "tests/verify/test_false_answers.py",
    COUNTS,
    "tests/verify/test_steps.py",
    "tests/verify/test_verify.py",
    "tests/verify/test_forged_steps.py",
    *STRANGERS,
    f"{JUDGED}::test_a_certificate_changes_no_verdict[at-once]",
    "tests/verify/test_forged_ranks.py",
    "tests/verify/test_restoring_claims.py",
    "tests/verify/test_several_steps.py",
    "tests/starts/test_starts.py",
    RULES,
    "-k",
    f"not walk and not limit and not -explicit and not -7] and {asking('z3')}",
)
NO_POLICY = (
    "tests/verify/test_false_answers.py",
    "tests/verify/test_unrealizable_parts.py",
    "tests/verify/test_unrealizable_by_hand.py",
    "tests/verify/test_forged_unrealizable.py",
    "tests/verify/test_no_restoration.py",
    "tests/verify/test_no_plan.py",
    "tests/verify/test_unrealizable.py",
    "tests/starts/test_starts.py",
)
VERIFY = (
    "tests/verify/test_effort.py",
    "tests/verify/test_amr.py",
    "tests/verify/test_without_effects.py",
    "tests/verify/test_jobs.py",
    "tests/verify/test_closure.py",
    COUNTS,
    "tests/verify/test_portfolio.py",
    "tests/verify/test_verify.py",
    *STRANGERS,
    "tests/verify/test_forged_ranks.py",
    "tests/verify/test_restoring_claims.py",
    "tests/verify/test_many_goals.py",
    "-k",
    "not -7] and not depend",
)
GUARANTEES = (
    "tests/verify/test_guarantees.py",
    "tests/checker/test_guarantees.py",
    "tests/cli/test_guarantees.py",
)
CHECKER = (
    "tests/checker/test_limits.py",
    "tests/checker/test_world.py",
    "tests/checker/test_witnesses.py",
    "tests/checker/test_entries.py",
    "tests/checker/test_broken_parts.py",
    "tests/checker/test_files.py",
    "tests/checker/test_language.py",
    "tests/checker/test_cubes.py",
    "tests/checker/test_layers.py",
    "tests/checker/test_conflicts.py",
    "tests/checker/test_unrealizable.py",
    "tests/checker/test_forged.py",
    "tests/checker/test_restoration.py",
    "tests/checker/test_stepwise.py",
    "tests/checker/test_efforts.py",
    "tests/checker/test_guarantees.py",
    "tests/readers/test_readers.py",
    "tests/readers/test_files.py",
)
TESTS: dict[str, tuple[str, ...]] = {
    "tumato_symbolic/semantics/guarantees.py": ("tests/semantics/test_guarantees.py",),
    "tumato_symbolic/semantics/shortcomings.py": (
        "tests/semantics/test_guarantees.py",
        "tests/verify/test_guarantees.py",
    ),
    "tumato_symbolic/semantics/traces.py": EXECUTIONS,
    "tumato_symbolic/semantics/exclusion.py": STEPS,
    "tumato_symbolic/semantics": SEMANTICS,
    "tumato_symbolic/symbolic/steps.py": STEPS,
    "tumato_symbolic/policy/decisions/binding.py": BINDING,
    "tumato_symbolic/diagrams/diagram.py": NUMBERS,
    "tumato_symbolic/diagrams/conjunction.py": ("tests/diagrams/test_conjunction.py",),
    "tumato_symbolic/verify/by_states": BY_STATES,
    "tumato_symbolic/verify/by_diagrams/parallel.py": PROCESSES,
    "tumato_symbolic/verify/by_diagrams/prover.py": WALK_PROVER,
    "tumato_symbolic/verify/by_diagrams/closed_loop.py": ("tests/verify/test_guarantees.py", *WALK),
    "tumato_symbolic/verify/by_diagrams": WALK,
    "tumato_symbolic/verify/by_z3": Z3,
    "tumato_symbolic/verify/unrealizability": NO_POLICY,
    "tumato_symbolic/verify/guarantees": GUARANTEES,
    "tumato_symbolic/verify/workers.py": PROCESSES,
    "tumato_symbolic/verify": VERIFY,
    "proofs/checker.py": CHECKER,
}
"""Module or folder, and what pytest is told; the first entry that fits a module counts."""

ONLY_WARN = {"tumato_symbolic/semantics/lint.py", "tumato_symbolic/semantics/lint_findings.py"}
"""Modules in these folders on which no verdict depends."""


class Covered(Struct, frozen=True):
    """A module of the trusted base, its file, and its tests."""

    module: str
    path: str
    tests: tuple[str, ...]


def covered(root: Path) -> list[Covered]:
    """Every module of the trusted base."""
    found: dict[str, Covered] = {}
    for place, tests in TESTS.items():
        files = [root / place] if place.endswith(".py") else sorted((root / place).rglob("*.py"))
        for file in files:
            path = file.relative_to(root).as_posix()
            module = path.removesuffix(".py").replace("/", ".")
            if file.name != "__init__.py" and path not in ONLY_WARN:
                found.setdefault(module, Covered(module, path, tests))
    return list(found.values())
