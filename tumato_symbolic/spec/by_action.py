"""From actions to their cases, and back, in what formulas say of the actions that are executed."""

from __future__ import annotations

from msgspec.structs import replace

from tumato_symbolic.spec.fold import FORMULAS, fold
from tumato_symbolic.spec.formula import And, Executing, Formula, Iff, Is, Not, Or
from tumato_symbolic.spec.specification import Rule, Spec


def executing_cases(spec: Spec) -> Spec:
    """The same with the cases of an action where its number in the order of declaration was resolved."""
    several: list[Formula] = []
    for cases in spec.cases:
        atoms = tuple(map(Executing, cases))
        several.append(Or(atoms) if len(atoms) > 1 else atoms[0])

    def written(atom: Is | Executing) -> Formula:
        return atom if isinstance(atom, Is) else several[atom.action]

    def rules(given: tuple[Rule, ...]) -> tuple[Rule, ...]:
        return tuple(replace(rule, formula=fold(rule.formula, written, FORMULAS)) for rule in given)

    return replace(spec, reaction_rules=rules(spec.reaction_rules), bodies=rules(spec.bodies))


def executing_actions(spec: Spec, formula: Formula) -> Formula:
    """The same with the first case of an action in the place of all of them, one of which is executed."""
    if not spec.has_cases:
        return formula
    match formula:
        case Or(operands):
            first = _first_of_all(spec, operands)
            return Or(tuple(executing_actions(spec, part) for part in operands)) if first is None else first
        case And(operands):
            return And(tuple(executing_actions(spec, part) for part in operands))
        case Not(operand):
            return Not(executing_actions(spec, operand))
        case Iff(left, right):
            return Iff(executing_actions(spec, left), executing_actions(spec, right))
        case _:
            return formula


def _first_of_all(spec: Spec, operands: tuple[Formula, ...]) -> Executing | None:
    """The first of several formulas, where they are the cases of an action, all of them and in their order."""
    first = operands[0]
    if not isinstance(first, Executing) or len(operands) == 1:
        return None
    start, end = first.action, first.action + len(operands)
    whole = [None, *(action.name for action in spec.actions[start:end]), None]
    whole[0] = spec.actions[start - 1].name if start else None
    whole[-1] = spec.actions[end].name if end < len(spec.actions) else None
    same = len(whole) == len(operands) + 2 and len(set(whole[1:-1])) == 1 and whole[1] not in (whole[0], whole[-1])
    return first if same and all(each == Executing(start + n) for n, each in enumerate(operands)) else None
