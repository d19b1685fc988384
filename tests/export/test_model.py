"""How formulas are written for model checkers."""

from __future__ import annotations

import re
from itertools import product
from random import Random

from tests.export.policies import example
from tumato_symbolic.export.model import infix
from tumato_symbolic.export.targets import load
from tumato_symbolic.semantics import holds
from tumato_symbolic.spec import And, Constant, Executing, Formula, Iff, Is, Not, Or, fold

_PYTHON = infix(true="True", false="False", negation="not ", conjunction="and", disjunction="or", equivalence="==")


def _atom(each: Is | Executing) -> str:
    assert isinstance(each, Is)
    return f"v{each.variable}"


def _formula(random: Random, depth: int) -> Formula:
    kind = random.randrange(6) if depth else random.randrange(2)
    if kind == 0:
        return Constant(random.random() < 0.5)
    if kind == 1:
        return Is(random.randrange(3), 1)
    if kind == 2:
        return Not(_formula(random, depth - 1))
    if kind == 3:
        return Iff(_formula(random, depth - 1), _formula(random, depth - 1))
    parts = tuple(_formula(random, depth - 1) for _ in range(random.randrange(4)))
    return And(parts) if kind == 4 else Or(parts)


def test_formulas_are_written_without_constants() -> None:
    """And mean the same in every state; a constant is written only where it is the whole formula."""
    random, constants = Random(14), 0
    for _ in range(1_000):
        formula = _formula(random, 4)
        text = fold(formula, _atom, _PYTHON)
        constants += text in {"True", "False"}
        assert text in {"True", "False"} or not re.search("True|False", text), text
        for state in product((False, True), repeat=3):
            named = {f"v{number}": value for number, value in enumerate(state)}
            assert eval(text, {}, named) == holds(formula, state), text
    assert 50 < constants < 950


def test_no_model_joins_a_constant() -> None:
    """Neither as an operand, nor as one of the conditions below each other."""
    joined = re.compile(r"(/\\|\\/|&|\||~|!|=>|->) *\(?(TRUE|FALSE|true|false)\b(?! *:| ->)")
    for target in ("nusmv", "promela", "tlaplus", "prism"):
        for name in ("amr", "amr_reaction_rules", "brake", "concurrent", "forklift", "lid", "nested_goals"):
            for text in load(target)(example(name)):
                assert not joined.search(text), (target, name, joined.search(text))
