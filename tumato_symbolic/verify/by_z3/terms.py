"""Z3 terms with constants folded: a term is a Python bool or a Z3 Boolean.

Folding keeps what a constant effect makes of a rule as small as it is on paper. Terms are made by the functions of
Z3's C interface, because `z3.And` and its like look at the sort of every part anew, which takes longer than the proof
of a small policy.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Any, TypeAlias

import z3

Term: TypeAlias = Any
"""`bool` or `z3.BoolRef`."""
Number: TypeAlias = Any
"""`z3.BitVecRef`."""
Context: TypeAlias = Any
"""`z3.Context`: where terms live. Each prover has its own, so that no answer depends on what others were asked."""


def negation(term: Term) -> Term:
    """Not `term`."""
    return not term if isinstance(term, bool) else z3.BoolRef(z3.Z3_mk_not(term.ctx_ref(), term.as_ast()), term.ctx)


def conjunction(terms: Iterable[Term]) -> Term:
    """All of `terms`."""
    kept = []
    for term in terms:
        if term is False:
            return False
        if term is not True:
            kept.append(term)
    if not kept:
        return True
    return kept[0] if len(kept) == 1 else _joined(z3.Z3_mk_and, kept)


def disjunction(terms: Iterable[Term]) -> Term:
    """One of `terms` at least."""
    kept = []
    for term in terms:
        if term is True:
            return True
        if term is not False:
            kept.append(term)
    if not kept:
        return False
    return kept[0] if len(kept) == 1 else _joined(z3.Z3_mk_or, kept)


def implies(left: Term, right: Term) -> Term:
    """`right` wherever `left`."""
    return disjunction((negation(left), right))


def same(left: Term, right: Term) -> Term:
    """Both or neither."""
    if isinstance(left, bool):
        return right if left else negation(right)
    if isinstance(right, bool):
        return left if right else negation(left)
    return z3.BoolRef(z3.Z3_mk_eq(left.ctx_ref(), left.as_ast(), right.as_ast()), left.ctx)


def either(condition: Term, then: Term, otherwise: Term) -> Term:
    """`then` where `condition` holds, `otherwise` elsewhere; both Booleans or both numbers."""
    if isinstance(condition, bool):
        return then if condition else otherwise
    if then is otherwise:
        return then
    if isinstance(then, bool):
        return disjunction((condition, otherwise)) if then else conjunction((negation(condition), otherwise))
    if isinstance(otherwise, bool):
        return disjunction((negation(condition), then)) if otherwise else conjunction((condition, then))
    made = z3.Z3_mk_ite(condition.ctx_ref(), condition.as_ast(), then.as_ast(), otherwise.as_ast())
    return (z3.BoolRef if isinstance(then, z3.BoolRef) else z3.BitVecRef)(made, condition.ctx)


def at_most_one(terms: Iterable[Term]) -> Term:
    """No two of `terms`."""
    kept = [term for term in terms if term is not False]
    others = [term for term in kept if term is not True]
    if len(others) < len(kept):
        return len(others) == len(kept) - 1 and conjunction(map(negation, others))
    return True if len(kept) < 2 else z3.AtMost(*kept, 1)


def code_at_most(bits: Sequence[Term], largest: int) -> Term:
    """The number with these bits (least significant first) is at most `largest`."""
    term: Term = True
    for place, bit in enumerate(bits):
        zero = negation(bit)
        term = disjunction((zero, term)) if largest >> place & 1 else conjunction((zero, term))
    return term


def _joined(make: Callable[..., Any], terms: list[Term]) -> Term:
    parts = (z3.Ast * len(terms))(*(term.as_ast() for term in terms))
    return z3.BoolRef(make(terms[0].ctx_ref(), len(parts), parts), terms[0].ctx)
