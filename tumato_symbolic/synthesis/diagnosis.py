"""What would restore unsafe states that cannot be as asked: settings, joint actions (`docs/semantics.md`, 9.8)."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal, TypeAlias

from msgspec import Struct
from msgspec.structs import replace

from tumato_symbolic.diagrams import Diagram, DiagramBuilder, Reference
from tumato_symbolic.game import Problem, Restorer, alone
from tumato_symbolic.semantics import Effort, State
from tumato_symbolic.spec import Action, Assignment, Spec
from tumato_symbolic.symbolic import Bdd, Extractor, build_steps, lay_out

Cure: TypeAlias = Literal["bounded", "fair", "nothing"]
"""The first way to restore safety that would do; `nothing` where none does."""

MOST_MOVES = 500
"""Where sets of actions nominally do more different things, no joint action is looked for."""

MOST_JOINT = 3
"""So many joint actions are proposed at most."""


class Cured(Struct, frozen=True):
    """The states for which one way to restore safety is the first that would do: how many, one of them, and all.

    `root` leads to the set in `Restorability.states`. Under `bounded`, `efforts` counts them by their least worst
    effort, the smallest first.
    """

    cure: Cure
    count: int
    example: State
    root: Reference
    efforts: tuple[tuple[Effort, int], ...] = ()

    @property
    def most_steps(self) -> int | None:
        """The largest number of steps that any of the states needs, where it is known."""
        return max((steps for (_, steps), _ in self.efforts), default=None)

    @property
    def worst(self) -> Effort | None:
        """The largest effort, where it is known."""
        return self.efforts[-1][0] if self.efforts else None


class JointAction(Struct, frozen=True):
    """An action that does at once what several do together: its effects, tried in the specification.

    Of the states that could not be restored in one step it leaves so many.
    """

    effects: Assignment
    left: int


class Restorability(Struct, frozen=True):
    """What would restore the unsafe states that are not restored as asked.

    Under `one_step` no set of actions is allowed in them; under `bounded` they have no way back.
    Whether runs from there reach their goals as well is another matter.
    """

    states: Diagram[bool]
    cured: tuple[Cured, ...]
    joint: tuple[JointAction, ...]


def restorability(problem: Problem) -> Restorability | None:
    """What would restore the states of a problem that cannot be; None where all can, or nothing less can be asked."""
    if problem.spec.restoration == "bounded":
        return _by_repetition(problem)
    steps = problem.steps
    stuck = steps.unsafe & ~steps.states_of(steps.allowed)
    if problem.spec.restoration != "one_step" or stuck == problem.false:
        return None
    problem.context.tell("looking for other ways to restore safety")
    fair = _several_steps(problem)
    found = Restorer(fair).restore((), problem.false, problem.false)
    efforts = [(effort, found.worst[effort] & stuck) for effort in sorted(found.worst)]
    union = problem.encoding.manager.union
    surely, nominally = union(states for _, states in efforts), union(found.nominal.values()) & stuck
    builder: DiagramBuilder[bool] = DiagramBuilder(problem.encoding.order, (False, True))
    extract, count = Extractor(problem.encoding, builder, default=False), problem.encoding.count_states
    cured = []
    parts: list[tuple[Cure, Bdd]] = [("bounded", surely), ("fair", nominally)]
    for cure, states in (*parts, ("nothing", stuck & ~surely & ~nominally)):
        if states != problem.false:
            counted = tuple((effort, count(part)) for effort, part in efforts if part != problem.false)
            cured.append(_cured(problem, extract, cure, states, counted if cure == "bounded" else ()))
    return Restorability(builder.finish(), tuple(cured), tuple(_joint_actions(problem, stuck)))


def _by_repetition(problem: Problem) -> Restorability | None:
    """Of the states that no bounded number of steps restores, those from where `fair` would."""
    stuck = problem.steps.unsafe & ~alone(problem).restorable
    if stuck == problem.false:
        return None
    problem.context.tell("looking for other ways to restore safety")
    fairly = stuck & alone(_several_steps(problem)).restorable
    builder: DiagramBuilder[bool] = DiagramBuilder(problem.encoding.order, (False, True))
    extract = Extractor(problem.encoding, builder, default=False)
    parts: list[tuple[Cure, Bdd]] = [("fair", fairly), ("nothing", stuck & ~fairly)]
    cured = tuple(_cured(problem, extract, cure, states) for cure, states in parts if states != problem.false)
    return Restorability(builder.finish(), cured, ())


def _cured(
    problem: Problem, extract: Extractor[bool], cure: Cure, states: Bdd, efforts: tuple[tuple[Effort, int], ...] = ()
) -> Cured:
    root = extract.function([(True, states)])
    return Cured(cure, problem.encoding.count_states(states), problem.encoding.first_state(states), root, efforts)


def _several_steps(problem: Problem) -> Problem:
    """The problem with `fair` in place of what it asks, and without goals."""
    spec = replace(problem.spec, restoration="fair")
    steps = build_steps(problem.encoding, spec, problem.steps.ordering)
    return Problem(spec, steps, problem.regions, ())


def _joint_actions(problem: Problem, stuck: Bdd) -> Iterator[JointAction]:
    """Actions with the nominal effects of sets that would restore in one step if they all took effect at once."""
    steps, encoding = problem.steps, problem.encoding
    restoring = encoding.manager.union(states & steps.before(upper) for states, upper in steps.levels)
    jumps = steps.candidates & stuck & restoring
    jumps = jumps & encoding.all_of(rule.formula for rule in problem.spec.reaction_rules)
    moves = steps.moves(jumps, MOST_MOVES)
    if moves is None:
        return
    left = stuck
    for _ in range(MOST_JOINT):
        helped = {
            effects: -encoding.count_states(states & left)
            for effects, states in moves.items()
            if (states & left) != problem.false
        }
        if not helped:
            return
        effects = min(helped, key=lambda each: (helped[each], len(each), each))
        left = left & ~moves[effects]
        yield JointAction(effects, _left_by(problem, effects))


def _left_by(problem: Problem, effects: Assignment) -> int:
    """How many unsafe states have no allowed set when there is one more action, with these effects."""
    spec = problem.spec
    joint = Action("joint action", 0, frozenset(), (), effects, (), spec.actions[0].span)
    spec = _with(spec, joint)
    layout = lay_out(spec, problem.encoding.manager.backend, problem.context)
    steps = build_steps(layout, spec, problem.steps.ordering)
    return layout.count_states(steps.unsafe & ~steps.states_of(steps.allowed))


def _with(spec: Spec, action: Action) -> Spec:
    return replace(spec, actions=(*spec.actions, action))
