"""JSON values to a certificate of unrealizability. The format is described in `docs/certificate.md`."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Literal, TypeVar

from tumato_symbolic.diagnostics import Code
from tumato_symbolic.diagnostics.wording import count
from tumato_symbolic.diagrams import Diagram, Reference, rebuild
from tumato_symbolic.policy.formats import (
    UNREALIZABLE,
    check_version,
    read_diagram,
    read_digest,
    read_ordering,
    read_restoration,
    read_vocabulary,
)
from tumato_symbolic.policy.records import RankedGoal, Vocabulary, canonical
from tumato_symbolic.policy.text import (
    as_list,
    as_names,
    as_object,
    as_text,
    as_whole,
    fault,
    member,
    show,
    way_out,
    wrong,
)
from tumato_symbolic.policy.unrealizability.records import (
    ActionEffect,
    Choice,
    Conflict,
    Cube,
    Cut,
    Layers,
    NoAllowedSet,
    NoPlan,
    NoRestoration,
    Unrealizability,
    Violation,
)
from tumato_symbolic.semantics import State

Entry = TypeVar("Entry")

WHERE = "the certificate"

_CONDITIONS = (
    '"precondition", "resource", "nominal-conflict", "reaction-rule", "unsafe", "falsified", "idle" or "nominal-unsafe"'
)


def unrealizability_of(document: dict[str, Any]) -> Unrealizability:
    """The certificate that a JSON object describes. Raises `UserError` (TUM502 to TUM505) where it describes none."""
    form = as_text(member(document, "Type", WHERE), "`Type`")
    if form != UNREALIZABLE:
        raise fault(Code.TUM502, f"`Type` is {show(form)}", f'expected "{UNREALIZABLE}"')
    check_version(document)
    vocabulary = read_vocabulary(document, WHERE)
    ordering, digest = read_ordering(document), read_digest(document)
    if ordering is None or digest is None:
        lost = "EffectOrdering" if ordering is None else "SpecificationDigest"
        raise fault(Code.TUM502, f"{WHERE} has no `{lost}`")
    reason = _Reader(vocabulary).reason(as_object(member(document, "Reason", WHERE), "`Reason`"))
    return Unrealizability(vocabulary, ordering, digest, reason, read_restoration(document))


class _Reader:
    """Reads by the names of one vocabulary."""

    def __init__(self, vocabulary: Vocabulary) -> None:
        self._vocabulary = vocabulary
        self._actions = {name: number for number, name in enumerate(vocabulary.actions)}
        self._variables = {name: number for number, (name, _) in enumerate(vocabulary.variables)}
        self._values = [{value: number for number, value in enumerate(values)} for _, values in vocabulary.variables]

    def reason(self, section: dict[str, Any]) -> NoAllowedSet | NoRestoration | NoPlan | Conflict:
        """What `Reason` holds."""
        match member(section, "Kind", "`Reason`"):
            case "no-allowed-set":
                return self._no_allowed_set(section)
            case "no-restoration":
                return self._no_restoration(section)
            case "no-plan":
                return self._no_plan(section)
            case "conflict":
                return self._conflict(section)
            case kind:
                raise wrong("`Reason.Kind`", '"no-allowed-set", "no-restoration", "no-plan" or "conflict"', kind)

    def _no_allowed_set(self, section: dict[str, Any]) -> NoAllowedSet:
        state = self._state(member(section, "State", "`Reason`"), "`Reason.State`")
        cubes = member(section, "Cubes", "`Reason`")
        return NoAllowedSet(state, None if cubes is None else _each(cubes, "Cubes", "cube", self._cube))

    def _cube(self, value: object, where: str) -> Cube:
        section = as_object(value, where)
        executed = self._action_list(member(section, "Executed", where), f"`Executed` of {where}")
        idle = self._action_list(member(section, "Idle", where), f"`Idle` of {where}")
        violation = self._violation(member(section, "Violation", where), f"`Violation` of {where}")
        return Cube(frozenset(executed), frozenset(idle), violation)

    def _violation(self, value: object, where: str) -> Violation:
        section = as_object(value, where)
        match member(section, "Kind", where):
            case "precondition" as kind:
                return Violation(kind, self._named(section, where, 1))
            case "resource" | "nominal-conflict" as kind:
                return Violation(kind, self._named(section, where, 2))
            case "reaction-rule" as kind:
                return Violation(kind, rule=as_text(member(section, "Rule", where), f"`Rule` in {where}"))
            case "unsafe" as kind:
                return Violation(kind, outcome=self._effects(section, where))
            case "falsified" as kind:
                return Violation(kind, self._named(section, where, 1), outcome=self._effects(section, where))
            case "idle" | "nominal-unsafe" as kind:
                return Violation(kind)
            case found:
                raise wrong(f"`Kind` in {where}", _CONDITIONS, found)

    def _named(self, section: dict[str, Any], where: str, wanted: int) -> tuple[int, ...]:
        """`Actions` of a violation, which names so many."""
        actions = self._action_list(member(section, "Actions", where), f"`Actions` in {where}")
        if len(actions) != wanted:
            message = f"`Actions` in {where} has {count(len(actions), 'entry', 'entries')}, expected {wanted}"
            raise fault(Code.TUM502, message)
        return actions

    def _effects(self, section: dict[str, Any], where: str) -> tuple[ActionEffect, ...]:
        entries = as_list(member(section, "Outcome", where), f"`Outcome` in {where}")
        return tuple(self._effect(entry, f"effect {n} of {where}") for n, entry in enumerate(entries))

    def _effect(self, value: object, where: str) -> ActionEffect:
        section = as_object(value, where)
        action = self._action(member(section, "Action", where), f"`Action` of {where}")
        effect = as_object(member(section, "Effect", where), f"`Effect` of {where}")
        return action, tuple(sorted(self._assigned(name, value, where) for name, value in effect.items()))

    def _no_restoration(self, section: dict[str, Any]) -> NoRestoration:
        state = self._state(member(section, "State", "`Reason`"), "`Reason.State`")
        found, end = self._sets(section)
        diagram, (root,) = rebuild(found, (as_whole(member(section, "Root", "`Reason`"), "`Reason.Root`", end),))
        return NoRestoration(state, diagram, root)

    def _sets(self, section: dict[str, Any]) -> tuple[Diagram[bool], int]:
        """A diagram of sets, and how many references there are to it."""
        order, leaves, nodes = read_diagram(section, "Reason", self._vocabulary)
        if leaves != [False, True] or any(type(leaf) is not bool for leaf in leaves):
            raise fault(Code.TUM502, "`Reason.Leaves` must be [false, true]")
        return Diagram(order, tuple(leaves), nodes), len(leaves) + len(nodes)

    def _no_plan(self, section: dict[str, Any]) -> NoPlan:
        state = self._state(member(section, "State", "`Reason`"), "`Reason.State`")
        found, end = self._sets(section)

        def goal(value: object, where: str) -> Layers:
            bodies, executed, entry = self._goal(value, where)
            layers = _numbers(member(entry, "Layers", where), f"`Layers` of {where}", end)
            if not layers:
                raise fault(Code.TUM502, f"`Layers` of {where} is empty")
            return Layers(bodies, executed, layers)

        goals = _each(member(section, "Goals", "`Reason`"), "Goals", "goal", goal)
        return canonical(NoPlan(state, found, goals))

    def _conflict(self, section: dict[str, Any]) -> Conflict:
        order, leaves, nodes = read_diagram(section, "Reason", self._vocabulary)
        for leaf in leaves:
            if leaf is not None:
                as_whole(leaf, "an entry of `Reason.Leaves`")
        if len(set(leaves)) != len(leaves):
            raise fault(Code.TUM502, "`Reason.Leaves` has an entry twice")
        end = len(leaves) + len(nodes)

        def goal(value: object, where: str) -> RankedGoal:
            bodies, executed, entry = self._goal(value, where)
            return RankedGoal(bodies, executed, as_whole(member(entry, "Root", where), f"`Root` of {where}", end))

        goals = _each(member(section, "Goals", "`Reason`"), "Goals", "goal", goal)
        choices = _each(
            member(section, "Choices", "`Reason`"),
            "Choices",
            "choice",
            lambda value, where: self._choice(value, where, len(goals)),
        )
        cuts = _each(
            member(section, "Cuts", "`Reason`"),
            "Cuts",
            "cut",
            lambda value, where: self._cut(value, where, len(goals), len(choices)),
        )
        starts = _numbers(member(section, "Starts", "`Reason`"), "`Reason.Starts`", len(choices))
        found: Diagram[int | None] = Diagram(order, tuple(leaves), nodes)
        distances, roots = rebuild(found, [each.root for each in goals])
        named = tuple(RankedGoal(each.bodies, each.executed, root) for each, root in zip(goals, roots, strict=True))
        return Conflict(starts, choices, cuts, distances, named)

    def _choice(self, value: object, where: str, goals: int) -> Choice:
        section = as_object(value, where)
        state = self._state(member(section, "State", where), f"`State` of {where}")
        options = []
        for number, entry in enumerate(as_list(member(section, "Options", where), f"`Options` of {where}")):
            here = f"option {number} of {where}"
            option = as_object(entry, here)
            successor = self._state(member(option, "Successor", here), f"`Successor` of {here}")
            goal = as_whole(member(option, "Goal", here), f"`Goal` of {here}", goals)
            options.append((successor, goal))
        return Choice(state, tuple(options))

    def _cut(self, value: object, where: str, goals: int, choices: int) -> Cut:
        section = as_object(value, where)
        kind: Literal["path", "loop"]
        end: State | None
        match member(section, "Kind", where):
            case "path":
                kind, end = "path", self._state(member(section, "End", where), f"`End` of {where}")
            case "loop":
                kind, end = "loop", None
                if "End" in section:
                    raise fault(Code.TUM502, f'{where} is of kind "loop", and must not have `End`')
            case found:
                raise wrong(f"`Kind` of {where}", '"path" or "loop"', found)
        goal = as_whole(member(section, "Goal", where), f"`Goal` of {where}", goals)
        states = _numbers(member(section, "States", where), f"`States` of {where}", choices)
        if not states:
            raise fault(Code.TUM502, f"`States` of {where} is empty")
        return Cut(kind, goal, states, end)

    def _goal(self, value: object, where: str) -> tuple[tuple[str, ...], tuple[str, ...], dict[str, Any]]:
        """Bodies, executed actions, and the whole entry."""
        section = as_object(value, where)
        bodies = as_names(member(section, "Bodies", where), f"`Bodies` of {where}")
        executed = self._action_list(member(section, "Executed", where), f"`Executed` of {where}")
        return bodies, tuple(self._vocabulary.actions[number] for number in executed), section

    def _action_list(self, value: object, where: str) -> tuple[int, ...]:
        """Different actions."""
        return tuple(self._action(name, where) for name in as_names(value, where))

    def _action(self, value: object, where: str) -> int:
        name = as_text(value, where)
        if name not in self._actions:
            message = f"{where} mentions the unknown action {show(name)}"
            raise fault(Code.TUM505, message, way_out(name, self._actions, "actions"))
        return self._actions[name]

    def _state(self, value: object, where: str) -> State:
        """A value for every variable, and nothing else."""
        section = as_object(value, where)
        values = dict(self._assigned(name, value, where) for name, value in section.items())
        for number, (name, _) in enumerate(self._vocabulary.variables):
            if number not in values:
                raise fault(Code.TUM503, f"{where} has no value for {show(name)}")
        return tuple(values[number] for number in range(len(values)))

    def _assigned(self, name: str, value: object, where: str) -> tuple[int, int]:
        """One variable and its value, by numbers."""
        if name not in self._variables:
            message = f"{where} has the unknown variable {show(name)}"
            raise fault(Code.TUM503, message, way_out(name, self._variables, "variables"))
        variable = self._variables[name]
        text = as_text(value, f"{show(name)} in {where}")
        known = self._values[variable]
        if text not in known:
            message = f"{where} gives {show(name)} the unknown value {show(text)}"
            raise fault(Code.TUM504, message, way_out(text, known, "values"))
        return variable, known[text]


def _each(value: object, title: str, noun: str, read: Callable[[object, str], Entry]) -> tuple[Entry, ...]:
    """Every entry of a list, read."""
    entries = as_list(value, f"`Reason.{title}`")
    return tuple(read(entry, f"{noun} {number} of `Reason`") for number, entry in enumerate(entries))


def _numbers(value: object, where: str, below: int) -> tuple[Reference, ...]:
    return tuple(as_whole(number, f"an entry of {where}", below) for number in as_list(value, where))
