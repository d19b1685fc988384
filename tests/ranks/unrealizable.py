"""Changed distances and layers: certificates of unrealizability, held against what they have to prove."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from random import Random

from msgspec.structs import replace

from tests.oracle import World
from tests.ranks.campaign import Tally
from tests.ranks.lines import LENGTHS
from tests.ranks.numbers import CHANGES, KINDS
from tests.ranks.unrealizable_truth import first_layers, is_proof
from tests.unrealizability import claim_is_true
from tumato_symbolic import Unrealizable, parse, synthesize
from tumato_symbolic.diagrams import DiagramBuilder
from tumato_symbolic.policy.unrealizability import Conflict, Layers, NoPlan, Unrealizability
from tumato_symbolic.semantics import State
from tumato_symbolic.spec import Spec
from tumato_symbolic.verify import verify_unrealizable


def examine(seed: int, each: int, folder: Path) -> Tally:
    """Changed certificates of one specification without a policy, and of the same with another plan bound."""
    random, tally = Random(f"refusals {seed}"), Tally()
    length = LENGTHS[seed % len(LENGTHS)]
    spec = parse((crossing if seed % 2 else dead_end)(random, length))
    outcome = synthesize(spec)
    if not isinstance(outcome, Unrealizable):
        return tally
    certificate = outcome.certificate
    if certificate is None or not isinstance(certificate.reason, Conflict | NoPlan):
        return tally
    for number in range(4 * each):
        kind = KINDS[(seed + number) % len(KINDS)]
        judged = replace(spec, max_plan_length=_other_bound(spec, random)) if random.random() < 0.3 else spec
        changed = _changed(World(spec, "any"), certificate, kind, random)
        for complaint in _judge(World(judged, "any"), changed, kind, tally):
            tally.complaints.append(f"{seed} {type(changed.reason).__name__} {kind}: {complaint}")
    return tally


def _other_bound(spec: Spec, random: Random) -> int | None:
    bound = spec.max_plan_length
    return random.choice((1, 3, 7, 8, 16)) if bound is None else random.choice((max(1, bound - 1), bound + 1, None))


def _judge(world: World, certificate: Unrealizability, kind: str, tally: Tally) -> Iterator[str]:
    reason = certificate.reason
    assert isinstance(reason, Conflict | NoPlan)
    right = is_proof(world, reason)
    tally.cases += 1
    tally.kinds[type(reason).__name__, kind, right] += 1
    found = verify_unrealizable(certificate, world.spec, ordering="any")
    if found.verdict != ("proved" if right else "refuted"):
        yield f"{found.verdict} ({found.reason}) what is {'a' if right else 'no'} proof"
    if found.verdict == "proved" and not claim_is_true(world, certificate):
        yield "proved, and there is a policy"


def crossing(random: Random, length: int) -> str:
    """Two runs cross in one place, and each has a line of its own to go on: no policy serves both."""
    lines = {side: [f"{side}{place}" for place in range(length + 1)] for side in "lr"}
    every = ["a", "b", "m", *lines["l"], *lines["r"]]
    moves = [("a", "m"), ("b", "m"), ("m", lines["l"][-1]), ("m", lines["r"][random.randint(0, length)])]
    for places in lines.values():
        moves += [(places[place], places[place - 1]) for place in range(1, length + 1)]
    if random.random() < 0.3:
        moves.append((lines["l"][0], "m"))
    bound = random.choice((None, length + 3, length + 4, 2 * length + 8))
    return _text(random, every, moves, [("a", "r0"), ("b", "l0")], bound)


def dead_end(random: Random, length: int) -> str:
    """A line that is longer than a plan may be, or ends before the goal."""
    places = [f"t{place}" for place in range(length + 1)]
    every = [*places, "far", "trap"]
    moves = [(places[place], places[place - 1]) for place in range(1, length + 1)]
    moves += [("far", random.choice(places)), (random.choice(places), "trap")]
    bound = random.choice((None, max(1, length), max(1, length - 1), length + 1))
    return _text(random, every, moves, [(random.choice((places[-1], "far")), random.choice(("t0", "far")))], bound)


def _text(
    random: Random, every: list[str], moves: list[tuple[str, str]], goals: list[tuple[str, str]], bound: int | None
) -> str:
    random.shuffle(every)
    random.shuffle(moves)
    return "\n".join(
        [
            f"BEGIN STATE VECTOR state S_P can be {', '.join(every)} END STATE VECTOR",
            "BEGIN RESOURCES resource WHEELS END RESOURCES",
            "BEGIN ACTIONS",
            *(
                f"  action go{number} controlled resources: WHEELS preconditions: S_P is {here} "
                f"nominal effects: S_P is {there}"
                for number, (here, there) in enumerate(moves)
            ),
            "END ACTIONS",
            "BEGIN GOALS goal type: priority",
            *(f"  when S_P is {here} then goal: S_P is {there}" for here, there in goals),
            "END GOALS",
            *([] if bound is None else [f"BEGIN CONFIG max_plan_length: {bound} END CONFIG"]),
            "",
        ]
    )


def _changed(world: World, certificate: Unrealizability, kind: str, random: Random) -> Unrealizability:
    reason = certificate.reason
    if isinstance(reason, Conflict):
        return replace(certificate, reason=_changed_distances(world, reason, kind, random))
    assert isinstance(reason, NoPlan)
    return replace(certificate, reason=_changed_layers(world, reason, kind, random))


def _changed_distances(world: World, reason: Conflict, kind: str, random: Random) -> Conflict:
    roots = {goal.root for goal in reason.goals}
    chosen = {random.choice(sorted(roots))} if random.random() < 0.7 else roots
    tables: dict[int, dict[State, int]] = {}
    for root in sorted(roots):
        numbers = {s: n for s in world.safe if (n := reason.distances.evaluate(root, s)) is not None}
        tables[root] = CHANGES[kind](numbers, world.safe, random) if root in chosen else numbers
    leaves = sorted({number for table in tables.values() for number in table.values()})
    builder = DiagramBuilder[int | None](range(len(world.spec.variables)), [None, *leaves])
    sizes = [len(variable.values) for variable in world.spec.variables]
    drawn = {root: builder.from_table(sizes, table, None) for root, table in tables.items()}
    goals = tuple(replace(goal, root=drawn[goal.root]) for goal in reason.goals)
    return replace(reason, distances=builder.finish(), goals=goals)


def _changed_layers(world: World, reason: NoPlan, kind: str, random: Random) -> NoPlan:
    """Layers from the changed number of the first layer that holds a state: those alone, or with all before."""
    builder = DiagramBuilder[bool](range(len(world.spec.variables)), (False, True))
    sizes = [len(variable.values) for variable in world.spec.variables]
    goals: list[Layers] = []
    for goal in reason.goals:
        numbers = CHANGES[kind](dict(first_layers(world, reason, goal)), world.safe, random)
        growing = random.random() < 0.7
        deepest = max(numbers.values(), default=-1) if random.random() < 0.5 else len(goal.roots) - 1
        layers = [
            {s: True for s, first in numbers.items() if first == number or (growing and first < number)}
            for number in range(deepest + 1)
        ]
        goals.append(replace(goal, roots=tuple(builder.from_table(sizes, layer, False) for layer in layers)))
    return NoPlan(reason.state, builder.finish(), tuple(goals))
