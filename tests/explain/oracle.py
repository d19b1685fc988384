"""Whether an explanation is right, by the explicit meaning alone."""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import product
from random import Random

from msgspec.structs import replace

from tests.generate import NOWHERE
from tests.oracle import Together, World, conflict_is_minimal, decide_world, world_of
from tests.printing import print_spec
from tests.restoration.oracle import decide_stepwise
from tumato_symbolic import parse
from tumato_symbolic.explain.additions import NewAction, NoGoalWhile, Setting, with_additions
from tumato_symbolic.explain.elements import Element, elements_of, keep_only, replace_rule, rule_of
from tumato_symbolic.explain.explanation import Explanation, Reason, Repair
from tumato_symbolic.report.possible_changes import added_lines
from tumato_symbolic.semantics import State, all_states, allowed_sets, is_valid
from tumato_symbolic.spec import (
    FORMULAS,
    And,
    Executing,
    Formula,
    Is,
    Or,
    Ordering,
    Rule,
    Spec,
    fold,
)

SAMPLED = 4
"""Of so many states of every reason the core is checked."""


def complaints(explanation: Explanation) -> Iterator[str]:
    """Everything that is wrong with an explanation."""
    spec, ordering = explanation.spec, explanation.ordering
    yield from _wrong_states(explanation)
    for reason in explanation.reasons:
        yield from _wrong_cores(spec, ordering, reason)
    yield from _wrong_repairs(explanation)
    yield from _wrong_part(explanation)


def _wrong_states(explanation: Explanation) -> Iterator[str]:
    """The reasons hold exactly the failing states, by kind, in disjoint cubes."""
    spec = explanation.spec
    verdict = decide_world(world_of(spec, explanation.ordering))
    if verdict.kind == "realizable":
        yield "there is a policy"
    for kind, expected in (("no-allowed-set", verdict.no_allowed_set), ("no-plan", verdict.no_plan)):
        listed = [state for reason in explanation.reasons if reason.kind == kind for state in states_of(spec, reason)]
        if len(listed) != len(set(listed)):
            yield f"cubes of {kind} overlap"
        if set(listed) != expected:
            yield f"the states of {kind} are wrong"
    for reason in explanation.reasons:
        states = set(states_of(spec, reason))
        if len(states) != reason.count or reason.example not in states:
            yield f"count or example of {reason.kind} is wrong"
        if reason.kind == "conflict":
            if states != set(reason.together):
                yield "the cubes of the conflict are wrong"
            if not conflict_is_minimal(spec, explanation.ordering, reason.together):
                yield "the conflict is none, or not minimal"


def states_of(spec: Spec, reason: Reason) -> list[State]:
    """The valid states in the cubes of a reason, with repetitions where cubes overlap."""
    return [state for cube in reason.cubes for state in product(*cube) if is_valid(spec, state)]


def _wrong_cores(spec: Spec, ordering: Ordering, reason: Reason) -> Iterator[str]:
    states = list(dict.fromkeys([reason.example, *states_of(spec, reason)]))[:SAMPLED]
    for number, core in enumerate(reason.cores):
        for state in states if number == 0 and reason.kind != "conflict" else states[:1]:
            if not _fails(spec, ordering, reason, state, frozenset(core)):
                yield f"a core of {reason.kind} is not sufficient: {core}"
            for element in core:
                if _fails(spec, ordering, reason, state, frozenset(core) - {element}):
                    yield f"a core of {reason.kind} is not minimal: {core} without {element}"


def _fails(spec: Spec, ordering: Ordering, reason: Reason, state: State, kept: frozenset[Element]) -> bool:
    """Whether the state (of a conflict: all states together) fails as the reason says with these elements only."""
    rest = keep_only(spec, kept)
    if reason.kind == "no-allowed-set":
        return next(allowed_sets(rest, state, ordering), None) is None
    world = world_of(rest, ordering)
    if reason.kind == "no-plan":
        return not any(map(world.has_plan, world.options[state]))
    return TogetherWhereDefined(world).serve(reason.together) is None


class TogetherWhereDefined(Together):
    """Policies that need not be defined where no set is allowed: dropping assumptions makes such states."""

    def _choose_one(self, state: State) -> None:
        if self._world.options[state]:
            super()._choose_one(state)
        else:
            self._pick[state], self._option[state] = {}, {}


def realizable(spec: Spec, ordering: Ordering) -> bool:
    """By the explicit meaning."""
    if spec.restores_stepwise:
        return decide_stepwise(spec, ordering).policy is not None
    return decide_world(world_of(spec, ordering)).kind == "realizable"


def _wrong_repairs(explanation: Explanation) -> Iterator[str]:
    spec, ordering = explanation.spec, explanation.ordering
    everything = frozenset(elements_of(spec))
    sizes = [len(repair.changes) for repair in explanation.repairs if repair.changes and not repair.gives_up_safety]
    if sizes != sorted(sizes):
        yield "the repairs are not ordered by size"
    for repair in explanation.repairs:
        if not realizable(repaired(spec, repair), ordering):
            yield f"a repair does not repair: {repair}"
        if repair.changes:
            yield from _too_much(spec, ordering, repair, everything)
    assumptions = frozenset(each for each in everything if each.kind == "assumption")
    if (explanation.unavoidable is None) != realizable(keep_only(spec, assumptions), ordering):
        yield "whether there is hope is wrong"
    if explanation.unavoidable is None and not explanation.repairs:
        yield "there is hope, but no repair"


def _too_much(spec: Spec, ordering: Ordering, repair: Repair, everything: frozenset[Element]) -> Iterator[str]:
    """A repair that drops an assumption, or where fewer lines would do."""
    spec = repaired(spec, Repair(additions=repair.additions))
    touched = frozenset(change.element for change in repair.changes)
    if any(element.kind == "assumption" for element in touched):
        yield "a repair drops an assumption"
    for element in touched:
        if realizable(keep_only(spec, everything - (touched - {element})), ordering):
            yield f"a repair is not minimal: {touched}"


def repaired(spec: Spec, repair: Repair) -> Spec:
    """The specification that is read when a repair is made in the text of it; with clauses, that is meant."""
    spec = edited(spec, repair)
    if spec.has_cases:
        return with_additions(spec, repair.additions)
    names = [f"act{number}" for number in range(len(spec.actions))]
    renamed = (replace(action, name=name) for action, name in zip(spec.actions, names, strict=True))
    text = print_spec(replace(spec, actions=tuple(renamed)), Random(0))
    for addition in repair.additions:
        lines = added_lines(spec, addition)
        match addition:
            case Setting():
                text = re.sub(r" *restoration: \w+\n", "", text) + "\n".join(("BEGIN CONFIG", *lines, "END CONFIG\n"))
                text = _one_config(text)
            case NewAction():
                name = f"act{len(names)}"
                names.append(name)
                text = text.replace("END ACTIONS", "\n".join([*lines, "END ACTIONS"]).replace("NAME", name))
            case NoGoalWhile():
                before, _, goals = text.partition("BEGIN GOALS")
                if "…" in lines:
                    goals, _, after = goals.rpartition("END GOALS")
                    inside = "\n".join(lines).replace("…", goals)
                    text = f"{before}BEGIN GOALS\n{inside}\nEND GOALS{after}"
                else:
                    free = "\n".join(lines)
                    text = f"{before}BEGIN GOALS{goals.replace('priority', 'priority ' + free, 1)}"
    return parse(text)


def _one_config(text: str) -> str:
    """A text whose CONFIG blocks are one."""
    blocks = re.findall(r"BEGIN CONFIG\n(.*?)END CONFIG\n", text, re.DOTALL)
    rest = re.sub(r"BEGIN CONFIG\n.*?END CONFIG\n", "", text, flags=re.DOTALL)
    return f"{rest}BEGIN CONFIG\n{''.join(blocks)}END CONFIG\n"


def edited(spec: Spec, repair: Repair) -> Spec:
    """The specification with the changes of a repair made, texts read as the language says."""
    dropped = set()
    for change in repair.changes:
        if change.text is None:
            dropped.add(change.element)
        elif change.element.kind == "plan-bound":
            spec = replace(spec, max_plan_length=int(change.text.split()[1]))
        else:
            rule = rule_of(spec, change.element)
            assert rule is not None
            spec = replace_rule(spec, change.element, replace(rule, formula=read_predicate(spec, change.text)))
    return keep_only(spec, frozenset(elements_of(spec)) - dropped)


def read_predicate(spec: Spec, text: str) -> Formula:
    """What a predicate means among the names of a specification."""
    variables = " ".join(f"state {each.name} can be {', '.join(each.values)}" for each in spec.variables)
    actions = " ".join(f"action {name} preconditions: none nominal effects: none" for name in spec.action_names)
    read = parse(
        f"BEGIN STATE VECTOR {variables} END STATE VECTOR BEGIN ACTIONS {actions} END ACTIONS "
        f"BEGIN REACTION RULES rule: {text} END REACTION RULES"
    )
    return _by_cases(spec, read.reaction_rules[0].formula)


def _by_cases(spec: Spec, formula: Formula) -> Formula:
    """A formula of a rule that numbers actions, with one of their cases instead."""

    def atom(atom: Is | Executing) -> Formula:
        if isinstance(atom, Is):
            return atom
        cases = tuple(map(Executing, spec.cases[atom.action]))
        return Or(cases) if len(cases) > 1 else cases[0]

    return fold(formula, atom, FORMULAS)


def _wrong_part(explanation: Explanation) -> Iterator[str]:
    spec, ordering = explanation.spec, explanation.ordering
    greatest = greatest_part(spec, ordering)
    part = explanation.part
    if part is None:
        if greatest and realizable(confined(spec, greatest), ordering):
            yield "there is a realizable part"
        return
    assumed = replace(spec, assumptions=(*spec.assumptions, Rule(read_predicate(spec, part.text), part.text, NOWHERE)))
    states = {state for state in all_states(spec) if is_valid(assumed, state)}
    valid = {state for state in all_states(spec) if is_valid(spec, state)}
    if (len(states), len(valid) - len(states)) != (part.states, part.given_up):
        yield "the part is counted wrongly"
    if not realizable(assumed, ordering):
        yield "the part is not realizable"
    if part.unique and states != greatest:
        yield "the part is not the greatest one"
    if not part.unique and (not states <= greatest or realizable(confined(spec, greatest), ordering)):
        yield "the part should be the greatest one"
    for state in sorted(greatest - states)[:SAMPLED]:
        if realizable(confined(spec, states | {state}), ordering):
            yield "the part is not maximal"


def greatest_part(spec: Spec, ordering: Ordering) -> set[State]:
    """The greatest set of valid states in which none fails."""
    states = {state for state in all_states(spec) if is_valid(spec, state)}
    while states:
        verdict = decide_failing(confined(spec, states), ordering)
        if not verdict:
            return states
        states -= verdict
    return states


def decide_failing(spec: Spec, ordering: Ordering) -> set[State]:
    """The states that fail, by either kind."""
    world = World(spec, ordering)
    return {state for state in world.valid if not any(map(world.has_plan, world.options[state]))}


def confined(spec: Spec, states: set[State]) -> Spec:
    """The specification with a set of states as one more assumption."""
    cubes: list[Formula] = [And((*(Is(*pair) for pair in enumerate(state)), Is(0, state[0]))) for state in states]
    return replace(spec, assumptions=(*spec.assumptions, Rule(Or((*cubes, cubes[0])), "", NOWHERE)))
