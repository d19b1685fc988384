"""A specification in a layout: what its actions write, as constants for bits."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cached_property
from itertools import groupby

from tumato_symbolic.limits import Context
from tumato_symbolic.spec import Assignment, Spec
from tumato_symbolic.symbolic.effect_tree import EffectTree, after_every, effect_tree
from tumato_symbolic.symbolic.layout import Group, Layout, lay_out, number_bits
from tumato_symbolic.symbolic.manager import Backend, Bdd
from tumato_symbolic.symbolic.present import FEW_MOVES, Leading, Written, by_values, next_values, written_by


class Encoding(Layout, frozen=True, dict=True):
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

    def before(self, target: Bdd) -> Bdd:
        """`{(s, A) : δ(s, A) ∈ target}`, group by group: agreeing effects commute.

        Of a group with many moves the next value of every bit is put in its place; otherwise the predecessor under each
        is a cofactor.
        """
        for group in self.lowest_first:
            moves, following = self._leading[group], self._following[group]
            target = moves.into(target) if following is None else self.manager.compose(target, following)
        return target

    @cached_property
    def lowest_first(self) -> list[int]:
        """The groups by where their bits stand in the order: those below first, which keeps sets small for longest."""
        places = [self.manager.level(group.bits[0]) for group in self.groups]
        return sorted(range(len(places)), key=places.__getitem__, reverse=True)

    @cached_property
    def _leading(self) -> list[Leading]:
        return [Leading(self.manager, moves, self.assignment_bits) for moves in self.nominal_moves]

    @cached_property
    def _following(self) -> list[Mapping[str, Bdd] | None]:
        """For every group with many moves, the next value of each bit that it writes."""
        return [
            next_values(self.manager, written) if len(moves) > FEW_MOVES else None
            for moves, written in zip(self.nominal_writes, self._written, strict=True)
        ]

    @cached_property
    def _written(self) -> list[Written]:
        return [written_by(self.manager, moves) for moves in self.nominal_writes]

    def next_state(self, policy: Bdd) -> Mapping[str, Bdd]:
        """`s ↦ δ(s, π(s))` for a functional relation, as one function for every bit that some action writes.

        A state without a decision stays where it is.
        """
        manager, found = self.manager, dict[str, tuple[Bdd, Bdd]]()
        for group, written in zip(self.groups, self._written, strict=True):
            chosen = self._of_group(policy, group)
            for bit, choices in written.items():
                zeros, ones = (manager.and_exists(group.bits, chosen, each) for each in choices)
                others = found.get(bit, (manager.false, manager.false))
                found[bit] = (others[0] | zeros, others[1] | ones)
        return next_values(manager, found)

    def _of_group(self, relation: Bdd, group: Group) -> Bdd:
        """The states of a relation with the choices of one group alone."""
        return self.manager.exists([bit for bit in self.all_choice_bits if bit not in group.bits], relation)

    def parts_by_writes(self, number: int, relation: Bdd) -> list[tuple[Mapping[str, bool], Bdd]]:
        """What is left of a relation for all that a group's choices in it write, by number, without these choices."""
        group, parts = self.groups[number], dict[int, Bdd]()
        for code, part in by_values(self.manager, relation, group.bits):
            move = self._move_of_code[number].get(code)
            if move is not None:
                parts[move] = parts.get(move, self.manager.false) | part
        return [(self.nominal_writes[number][move][0], part) for move, part in parts.items()]

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

    def states_executing(self, relation: Bdd) -> list[Bdd]:
        """For every action, the states that a relation relates to a set with it."""
        found = [self.manager.false] * len(self.choice_of)
        for group in self.groups:
            by_code = dict(by_values(self.manager, self._of_group(relation, group), group.bits))
            for action in group.actions:
                found[action] = by_code.get(tuple(self.action_bits(action).values()), self.manager.false)
        return found

    @cached_property
    def sets_by_size(self) -> list[Bdd]:
        """The sets of 0, 1, 2, … actions."""
        sizes = [self.manager.true]
        for group in self.groups:
            idle = self.idle(group)
            longer = [*sizes, self.manager.false]
            sizes = [
                (longer[size] & idle) | ((sizes[size - 1] & ~idle) if size else self.manager.false)
                for size in range(len(longer))
            ]
        return sizes

    @cached_property
    def declared(self) -> list[tuple[Bdd, Sequence[str]]]:
        """The choices that contain an action, as declared; many of one group that follow each other are one.

        These come with the bits of their group, whose numbers rise in the same order.
        """
        found: list[tuple[Bdd, Sequence[str]]] = []
        for group, run in groupby(self.spec.cases, self._home):
            parts = [self.executing_any(cases) for cases in run]
            if group is None or len(parts) <= len(group.bits) + 1:
                found += [(part, ()) for part in parts]
            else:
                found.append((self.manager.union(parts), group.bits))
        return found

    def _home(self, cases: Sequence[int]) -> Group | None:
        """The group of an action; None where its cases are in several."""
        homes = {self.choice_of[case][0] for case in cases}
        return self.groups[homes.pop()] if len(homes) == 1 else None

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
