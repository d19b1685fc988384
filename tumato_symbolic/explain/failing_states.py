"""Which states have a plan when only some elements are kept, each state taken alone."""

from __future__ import annotations

from msgspec.structs import replace

from tumato_symbolic.explain.elements import Element, Elements
from tumato_symbolic.explain.requirements import Requirements
from tumato_symbolic.game import Problem, chances, way_of, winning_alone
from tumato_symbolic.semantics import ActiveGoals, State
from tumato_symbolic.symbolic import Bdd, Regions, targets


def build_kept_problem(
    requirements: Requirements, kept: Elements, regions: Regions, within: Bdd | None = None
) -> Problem:
    """The synthesis problem when only these elements are kept, for the states of `regions`; `within` as in `steps`."""
    steps = requirements.steps(kept, within)
    bound = requirements.spec.max_plan_length if Element("plan-bound") in kept else None
    spec = replace(steps.encoding.spec, max_plan_length=bound)
    return Problem(spec, steps, regions, tuple(targets(steps, regions)))


def failing(requirements: Requirements, kept: Elements, states: Bdd) -> Bdd:
    """Those of some valid states that fail, either way, when only these elements are kept."""
    problem = build_kept_problem(requirements, kept, restricted(requirements.regions, states, requirements.false))
    return states & ~winning_alone(problem, requirements.compatible)


class FailingStates:
    """Which states fail when only some elements are kept: asked for a whole region at once, and remembered.

    Whatever fails goes on to fail when more is kept: an answer also answers for all that contains more, or less. With
    several severities that is not so: without a severe rule, milder ones have to be kept.
    """

    def __init__(self, requirements: Requirements) -> None:
        self.requirements = requirements
        self._known: dict[ActiveGoals, list[tuple[Elements, Bdd]]] = {}
        self._lost: dict[Elements, Bdd] = {}
        self._parts: dict[Elements, Bdd] = {}
        self._monotone = len(requirements.spec.tiers) == 1

    def fails(self, state: State, kept: Elements) -> bool:
        """Whether one valid state fails."""
        return self.failing(kept, self.requirements.encoding.state_cube(state)) != self.requirements.false

    def lost(self, kept: Elements) -> Bdd:
        """The valid states that are unsafe and cannot be restored, where that may take several steps."""
        if kept not in self._lost:
            problem = build_kept_problem(self.requirements, kept, self.requirements.regions)
            way = way_of(problem, self.requirements.compatible) if problem.spec.restoration != "one_step" else None
            restorable = problem.steps.valid if way is None else way.restorable
            self._lost[kept] = self.requirements.valid & problem.steps.unsafe & ~restorable
        return self._lost[kept]

    def left_out(self, kept: Elements, states: Bdd) -> Bdd:
        """Those of some valid states that no policy decides which never leaves what it decides, goals apart.

        Without a policy from a state where a step may lead, that step is not allowed.
        """
        if kept not in self._parts:
            self._parts[kept] = self._part(kept)
        return states & ~self._parts[kept]

    def _part(self, kept: Elements) -> Bdd:
        """The greatest set of states that decisions need not leave, and in which none of the valid states fails."""
        requirements = self.requirements
        part = requirements.steps(kept).valid
        while True:
            requirements.manager.context.check()
            inside = restricted(requirements.regions, part, requirements.false)
            problem = build_kept_problem(requirements, kept, inside, part)
            lost = part & requirements.valid & ~winning_alone(problem, requirements.compatible)
            if lost == requirements.false:
                return part
            part = part & ~lost

    def failing(self, kept: Elements, states: Bdd) -> Bdd:
        """Those of some valid states that fail. What is not known is asked once, for all its regions."""
        requirements, false, union = self.requirements, self.requirements.false, self.requirements.manager.union
        sure, unknown = [], {}
        for active, part in restricted(requirements.regions, states, false).items():
            surely, left = self._remembered(active, kept, part)
            sure.append(surely)
            if left != false:
                unknown[active] = left
        if not unknown:
            return union(sure)
        found = failing(requirements, kept, union(requirements.regions[active] for active in unknown))
        for active in unknown:
            self._known[active].append((kept, found & requirements.regions[active]))
        return union([*sure, found & union(unknown.values())])

    def _remembered(self, active: ActiveGoals, kept: Elements, states: Bdd) -> tuple[Bdd, Bdd]:
        """Of some states of a region, those that are known to fail, and those of which it is not known."""
        surely, left = self.requirements.false, states
        for asked, found in reversed(self._known.setdefault(active, [])):
            if asked != kept and not self._monotone:
                continue
            if asked <= kept:
                surely, left = surely | (left & found), left & ~found
            if asked >= kept:
                left = left & found
            if left == self.requirements.false:
                break
        return surely, left


def restricted(regions: Regions, states: Bdd, false: Bdd) -> Regions:
    """The regions with only these states in them."""
    return {active: part for active, region in regions.items() if (part := region & states) != false}


def shortest_plan(requirements: Requirements, state: Bdd) -> int | None:
    """The fewest steps in which a state reaches its goal without a plan bound; None where it never does."""
    kept = requirements.everything - {Element("plan-bound")}
    problem = build_kept_problem(requirements, kept, restricted(requirements.regions, state, requirements.false))
    apart, pairs = chances(problem, way_of(problem, requirements.compatible))
    found = [
        rank + 1
        for target, layers in zip(problem.targets, apart, strict=True)
        for rank, layer in enumerate(layers)
        if (problem.steps.predecessor(target.pending & pairs, layer) & state) != requirements.false
    ]
    return min(found, default=None)
