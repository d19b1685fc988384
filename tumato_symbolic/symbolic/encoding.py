"""A specification in a layout: what its actions write, as constants for bits."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

from tumato_symbolic.limits import Context
from tumato_symbolic.spec import Assignment, Spec
from tumato_symbolic.symbolic.effect_tree import EffectTree, after_every, effect_tree
from tumato_symbolic.symbolic.layout import Layout, lay_out, number_bits
from tumato_symbolic.symbolic.manager import Backend, Bdd
from tumato_symbolic.symbolic.present import FEW_MOVES, Leading, present


@dataclass(frozen=True)
class Encoding(Layout):
    """A layout, and the specification that is looked at in it."""

    spec: Spec

    @classmethod
    def of(cls, layout: Layout, spec: Spec) -> Encoding:
        """A specification in a layout that was made for it, or for one with the same variables and groups."""
        if isinstance(layout, Encoding) and layout.spec is spec:
            return layout
        bits = layout.state_bits, layout.groups, layout.order, layout.choice_of, layout.goal_bits
        return cls(layout.manager, layout.sizes, *bits, spec)

    @cached_property
    def alone(self) -> list[Bdd]:
        """For every action, the choices that contain it, by any of its cases, and no other."""
        idle = {bit: value for group in self.groups for bit, value in self.idle_bits(group).items()}
        return [
            self.manager.union(self.manager.cube({**idle, **self.action_bits(case)}) for case in cases)
            for cases in self.spec.cases
        ]

    @cached_property
    def nominal_moves(self) -> list[list[tuple[Assignment, Bdd]]]:
        """For every group, its choices by what they nominally write; being idle writes nothing."""
        found = []
        for group in self.groups:
            moves: dict[Assignment, Bdd] = {(): self.idle(group)}
            for action in group.actions:
                effect = self.spec.actions[action].nominal
                moves[effect] = moves.get(effect, self.manager.false) | self.executing(action)
            found.append(list(moves.items()))
        return found

    @cached_property
    def nominal_writes(self) -> list[list[tuple[Mapping[str, bool], Bdd]]]:
        """`nominal_moves` with the constants for bits that stand for what is written."""
        return [[(self.assignment_bits(effect), choices) for effect, choices in moves] for moves in self.nominal_moves]

    @cached_property
    def leading(self) -> list[Leading]:
        """`nominal_moves` by where they lead."""
        return [Leading(self.manager, moves, self.assignment_bits) for moves in self.nominal_moves]

    def writes_in(self, group: int, relation: Bdd) -> Sequence[tuple[Mapping[str, bool], Bdd]]:
        """Those of `nominal_writes` of a group that choices in a relation make; perhaps some others."""
        moves = self.nominal_writes[group]
        if len(moves) <= FEW_MOVES:
            return moves
        codes = present(self.manager, relation, self.groups[group].bits, len(moves) // 2)
        if codes is None:
            return moves
        return [moves[number] for number in sorted({self._move_of_code[group][code] for code in codes})]

    @cached_property
    def _move_of_code(self) -> list[dict[tuple[bool, ...], int]]:
        """For every group, the number of the move in `nominal_writes` by the bits of the choice."""
        found = []
        for group in self.groups:
            effects = [(), *(self.spec.actions[action].nominal for action in group.actions)]
            numbers = {effect: number for number, effect in enumerate(dict.fromkeys(effects))}
            codes = (tuple(number_bits(group.bits, choice).values()) for choice in range(len(effects)))
            found.append({code: numbers[effect] for code, effect in zip(codes, effects, strict=True)})
        return found

    @cached_property
    def effect_trees(self) -> list[EffectTree]:
        """For every action, its effects."""
        return [effect_tree(action.effects) for action in self.spec.actions]

    def after_every_effect(self, action: int, target: Bdd) -> Bdd:
        """The pairs from where each effect of an action leads into a set."""
        return after_every(self.manager, self.effect_trees[action], target, self.assignment_bits)


def encode(spec: Spec, backend: Backend, context: Context | None = None) -> Encoding:
    """A specification in a layout of its own."""
    return Encoding.of(lay_out(spec, backend, context), spec)
