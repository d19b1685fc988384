"""States as whole numbers, and predicates that are remembered by the variables they mention."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence

from tumato_symbolic.semantics import NOTHING, ActionSet, State, holds
from tumato_symbolic.spec import And, Assignment, Formula, Rule, Spec, conjuncts, variables_of

Code = int
"""A state: the values of its variables side by side, in a few bits each."""

REMEMBERED_BITS = 12
"""Rules are asked of as one where all that they mention takes so many bits: few values to remember it for."""


class Packing:
    """States as numbers and back."""

    def __init__(self, spec: Spec) -> None:
        widths = [(len(variable.values) - 1).bit_length() for variable in spec.variables]
        self._shifts = [sum(widths[:number]) for number in range(len(widths))]
        self._masks = [((1 << width) - 1) << shift for width, shift in zip(widths, self._shifts, strict=True)]

    def pack(self, state: State) -> Code:
        """The number of a state."""
        code = 0
        for value, shift in zip(state, self._shifts, strict=True):
            code |= value << shift
        return code

    def unpack(self, code: Code) -> State:
        """The state with a number."""
        return tuple([(code & mask) >> shift for mask, shift in zip(self._masks, self._shifts, strict=True)])

    def mask(self, variables: Iterable[int]) -> int:
        """The bits of some variables."""
        return sum(self._masks[variable] for variable in variables)

    def writes(self, assignment: Assignment) -> tuple[int, int]:
        """`(keep, put)`: the number of the state after an assignment is `code & keep | put`."""
        put = sum(value << self._shifts[variable] for variable, value in assignment)
        return ~self.mask(variable for variable, _ in assignment), put


class Remembered:
    """Whether a formula holds while `executed` runs: asked of `holds` once for the values of what it mentions.

    `known` has the answers, by the bits of a state that `mask` keeps.
    """

    def __init__(self, packing: Packing, formula: Formula, executed: ActionSet = NOTHING) -> None:
        self._packing, self._formula, self._executed = packing, formula, executed
        self.mask = packing.mask(variables_of(formula))
        self.known: dict[Code, bool] = {}

    def __call__(self, code: Code) -> bool:
        """Its truth in a state."""
        key = code & self.mask
        found = self.known.get(key)
        if found is None:
            found = self.known[key] = holds(self._formula, self._packing.unpack(key), self._executed)
        return found


def all_hold(packing: Packing, rules: Sequence[Rule], executed: ActionSet = NOTHING) -> Callable[[Code], bool]:
    """Whether all of some rules hold; those that mention few variables together are asked of as one."""
    tests = [Remembered(packing, formula, executed) for formula in _together(packing, rules)]
    known = [(test.mask, test.known.get, test) for test in tests]

    def hold(code: Code) -> bool:
        for mask, answer, ask in known:
            found = answer(code & mask)
            if not (ask(code) if found is None else found):
                return False
        return True

    return hold


def _together(packing: Packing, rules: Sequence[Rule]) -> Iterator[Formula]:
    """Conjunctions of some rules' conjuncts, each with the first that mentions little enough beside it."""
    groups: list[tuple[int, list[Formula]]] = []
    for formula in (each for rule in rules for each in conjuncts(rule.formula)):
        mask = packing.mask(variables_of(formula))
        fitting = (
            number for number, (bits, _) in enumerate(groups) if mask | bits in {mask, bits} or _are_few(mask | bits)
        )
        number = next(fitting, len(groups))
        groups[number:] = groups[number:] or [(0, [])]
        groups[number] = groups[number][0] | mask, [*groups[number][1], formula]
    return (formulas[0] if len(formulas) == 1 else And(tuple(formulas)) for _, formulas in groups)


def _are_few(bits: int) -> bool:
    return bits.bit_count() <= REMEMBERED_BITS


def valid_states(spec: Spec, packing: Packing) -> Iterator[State]:
    """All valid states in their order."""
    return states_where(spec, packing, [rule.formula for rule in spec.validity])


def states_where(spec: Spec, packing: Packing, formulas: Iterable[Formula]) -> Iterator[State]:
    """All states in which formulas hold, in their order; each is asked as soon as all that it mentions has a value."""
    settled: list[list[Remembered]] = [[] for _ in range(len(spec.variables) + 1)]
    for formula in formulas:
        settled[max(variables_of(formula), default=-1) + 1].append(Remembered(packing, formula))
    sizes = [len(variable.values) for variable in spec.variables]
    undone: State = (0,) * len(sizes)
    waiting: list[State] = [()]
    while waiting:
        begun = waiting.pop()
        code = packing.pack((*begun, *undone[len(begun) :]))
        if not all(test(code) for test in settled[len(begun)]):
            continue
        if len(begun) == len(sizes):
            yield begun
        else:
            waiting += [(*begun, value) for value in reversed(range(sizes[len(begun)]))]
