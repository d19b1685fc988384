"""Whether advice trades safety away: `python -m tests.explain.advice N [FILE …]`.

Explains the robots of `robots.py`, the files, and generated specifications until N of each form have no policy: plain
ones, those with clauses of effects, and those with starts. Counts state
rules that are given up before every other way was tried, exceptions that leave nothing of a rule or have nothing to do
with it, and what is assumed of the environment and not said. Exits with 1 if there is any.
"""

from __future__ import annotations

import argparse
import re
import time
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from pathlib import Path
from random import Random
from typing import Literal, TypeAlias

from msgspec.structs import replace

from tests.clauses.generate import RESTORATIONS, random_pair
from tests.explain.oracle import read_predicate, realizable, repaired
from tests.explain.robots import ROBOTS, battery
from tests.generate import NOWHERE, PROFILES, random_spec
from tests.printing import print_spec
from tests.starts.campaign import with_starts as with_start_conditions
from tumato_symbolic import Realizable, parse, synthesize
from tumato_symbolic.diagnostics import Source, UserError
from tumato_symbolic.explain.elements import elements_of, keep_only, rule_of
from tumato_symbolic.explain.explain import explain
from tumato_symbolic.explain.explanation import Change, Explanation, Repair
from tumato_symbolic.explain.writing import with_assumption, with_starts
from tumato_symbolic.limits import Context, Limits
from tumato_symbolic.report.explained import Explained, as_text
from tumato_symbolic.semantics import State, active_goals, all_states, count_states, holds, is_start, is_valid
from tumato_symbolic.semantics.lint import lint
from tumato_symbolic.spec import (
    TRUE,
    Action,
    ConditionalGoal,
    GoalList,
    Is,
    Restoration,
    Rule,
    SimpleGoal,
    Spec,
    executing_atoms,
    variables_of,
)

Decide = Callable[[Spec], bool]
"""Whether a specification has a policy."""

GIVEN_UP = "a state rule is given up before every other way was tried"
TAUTOLOGY = "an exception leaves nothing of its rule"
UNRELATED = "an exception has nothing to do with its rule"
UNSAID = "an assumption about the environment is not said"
REMOVED = "removing a rule about the environment is advised"
USELESS = "a repair gives no policy"
KINDS = (GIVEN_UP, TAUTOLOGY, UNRELATED, UNSAID, REMOVED, USELESS)

Form: TypeAlias = Literal["plain", "clauses", "starts"]
"""What generated specifications have."""

FORMS: tuple[Form, ...] = ("plain", "clauses", "starts")

MOST_STATES = 20_000
"""Larger specifications are not looked at: their states are looked at one by one."""

_SETTINGS: dict[Restoration, tuple[Restoration, ...]] = {
    "one_step": ("one_step", "bounded", "fair"),
    "bounded": ("bounded", "fair"),
    "fair": ("fair",),
}


def bad_advice(spec: Spec, text: str, found: Explanation, decide: Decide) -> Iterator[str]:
    """What is wrong with the advice on a specification, one of `KINDS` for each time."""
    report = as_text(Explained(Source("x.tum", text), spec, found, (), None, False), False)
    for number, repair in enumerate(found.repairs, 1):
        yield from _bad_exceptions(spec, repair)
        if _unsaid_in_repair(spec, repair, report, number):
            yield UNSAID
        if not decide(repaired(spec, repair)):
            yield USELESS
    given_up = [repair.gives_up_safety for repair in found.repairs]
    if any(given_up) and (not all(given_up) or found.others_untried or any(map(decide, other_ways(spec)))):
        yield GIVEN_UP
    if ("Gives up safety" in report) != any(given_up):
        yield GIVEN_UP
    if found.part is not None and spec.starts:
        yield from _bad_starts(spec, text, found.part.text, report, decide)
    elif found.part is not None:
        yield from _bad_part(spec, text, found.part.text, report)
    if found.part is not None and found.part.steady is not None:
        yield from _bad_steady_part(spec, text, found.part.steady[1], decide)


def _bad_exceptions(spec: Spec, repair: Repair) -> Iterator[str]:
    for change in repair.changes:
        rule = rule_of(spec, change.element)
        if change.text is None or rule is None:
            continue
        wider = read_predicate(spec, change.text)
        if not executing_atoms(wider) and all(
            holds(wider, state) for state in all_states(spec) if is_valid(spec, state)
        ):
            yield TAUTOLOGY
        if not variables_of(wider) <= related(spec, change, rule):
            yield UNRELATED


def related(spec: Spec, change: Change, rule: Rule) -> frozenset[int]:
    """The variables of a rule, and those that an action (of a precondition: its own) or a rule has beside one."""
    own = variables_of(rule.formula)
    found = set(own)
    is_precondition = change.element.kind == "precondition"
    for action in [spec.actions[change.element.number]] if is_precondition else spec.actions:
        mentioned = {variable for effect in action.effects for variable, _ in effect}
        mentioned.update(*(variables_of(each.formula) for each in action.preconditions))
        found |= mentioned if mentioned & own else set()
    for other in () if is_precondition else (*spec.state_rules, *spec.reaction_rules):
        mentioned = set(variables_of(other.formula))
        found |= mentioned if mentioned & own else set()
    return frozenset(found)


def _unsaid_in_repair(spec: Spec, repair: Repair, report: str, number: int) -> bool:
    """Whether a repair takes a variable of the environment over, and its first line does not say so."""
    changed = repaired(spec, repair)
    taken = [spec.variables[variable].name for variable in spec.environment - changed.environment]
    first = next(line for line in report.splitlines() if re.match(rf"  {number}\. (add|change|drop) ", line))
    return any(name not in first.partition("no action controls ")[2] for name in taken)


def other_ways(spec: Spec) -> Iterator[Spec]:
    """The specification changed in every way of which one alone may serve, all of which keep the state rules."""
    kept = frozenset(each for each in elements_of(spec) if each.kind in ("assumption", "state-rule"))
    for restoration in _SETTINGS[spec.restoration]:
        yield replace(spec, restoration=restoration)
        yield keep_only(replace(spec, restoration=restoration), kept)
    for variable, declared in enumerate(spec.variables):
        for value in range(len(declared.values)):
            new = Action("new", 0, frozenset(), (), ((variable, value),), (), NOWHERE)
            yield replace(spec, actions=(*spec.actions, new))
            if variable in spec.environment and spec.goals is not None and not _silences(spec, variable, value):
                condition = Rule(Is(variable, value), "", NOWHERE)
                free = ConditionalGoal(condition, SimpleGoal(len(spec.bodies), "true", NOWHERE), NOWHERE)
                goals = GoalList("priority", (free, spec.goals), NOWHERE)
                yield replace(spec, goals=goals, bodies=(*spec.bodies, Rule(TRUE, "true", NOWHERE)))


def _silences(spec: Spec, variable: int, value: int) -> bool:
    """Whether some goal is active only where a variable has a value: to have none there gives it up."""
    valid = [state for state in all_states(spec) if is_valid(spec, state)]
    asked = frozenset[int]().union(*(active_goals(spec, state) for state in valid))
    left = frozenset[int]().union(*(active_goals(spec, state) for state in valid if state[variable] != value))
    return left < asked


def _unsaid(spec: Spec, states: Sequence[State], kept: set[State], report: str) -> Iterator[str]:
    """Whether the report leaves out what is taken from the environment where only some states are kept."""
    said = _said_of_the_part(report)
    if any(spec.variables[variable].name not in said for variable in _taken(spec, states, kept)):
        yield UNSAID


def _bad_part(spec: Spec, text: str, assumption: str, report: str) -> Iterator[str]:
    formula = read_predicate(spec, assumption)
    valid = [state for state in all_states(spec) if is_valid(spec, state)]
    kept = {state for state in valid if holds(formula, state)}
    yield from _unsaid(spec, valid, kept, report)
    guards = {rule.span for rule in spec.state_rules if spec.environment & variables_of(rule.formula)}
    idle = {each.span for each in lint(spec)}
    written = parse(with_assumption(Source("x.tum", text), assumption))
    for warning in lint(written):
        if warning.span in guards - idle and warning.help is not None and "remove" in warning.help:
            yield REMOVED


def _bad_starts(spec: Spec, text: str, condition: str, report: str, decide: Decide) -> Iterator[str]:
    formula = read_predicate(spec, condition)
    starts = [state for state in all_states(spec) if is_start(spec, state)]
    kept = {state for state in starts if holds(formula, state)}
    yield from _unsaid(spec, starts, kept, report)
    written = parse(with_starts(Source("x.tum", text), condition))
    if {state for state in all_states(spec) if is_start(written, state)} != kept or not decide(written):
        yield USELESS


def _bad_steady_part(spec: Spec, text: str, condition: str, decide: Decide) -> Iterator[str]:
    formula, source = read_predicate(spec, condition), Source("x.tum", text)
    states = [state for state in all_states(spec) if is_start(spec, state)]
    if _taken(spec, states, {state for state in states if holds(formula, state)}):
        yield UNSAID
    if not decide(parse((with_starts if spec.starts else with_assumption)(source, condition))):
        yield USELESS


def _said_of_the_part(report: str) -> str:
    first = next(line for line in report.splitlines() if "realizable part" in line)
    return first.partition("no action controls ")[2]


def _taken(spec: Spec, valid: Sequence[State], kept: set[State]) -> set[int]:
    """The variables of the environment by which alone a state that is kept differs from one that is left out."""
    environment = sorted(spec.environment)
    found: set[int] = set()
    for state in valid:
        if state not in kept:
            for variable in environment:
                if any(_put(state, variable, value) in kept for value in range(len(spec.variables[variable].values))):
                    found.add(variable)
    return found


def _put(state: State, variable: int, value: int) -> State:
    return (*state[:variable], value, *state[variable + 1 :])


def with_environment(spec: Spec, random: Random) -> Spec:
    """The specification with one variable that no action changes."""
    variable = random.randrange(len(spec.variables))
    actions = []
    for action in spec.actions:
        alternatives = tuple(
            each
            for each in action.alternatives
            if not any(written == variable for outcome in each.outcomes for written, _ in outcome)
        )
        nominal = tuple(pair for pair in action.nominal if pair[0] != variable)
        actions.append(replace(action, nominal=nominal, alternatives=alternatives))
    return replace(spec, actions=tuple(actions))


def generated(seed: int) -> Spec:
    """The specification of a seed; two of three have a variable that is the environment's."""
    spec = random_spec(seed, list(PROFILES.values())[seed % len(PROFILES)])
    return with_environment(spec, Random(seed)) if seed % 3 else spec


def generated_text(seed: int, form: Form) -> str:
    """The text of a seed."""
    if form == "clauses":
        return random_pair(seed).text
    spec, random = generated(seed), Random(seed)
    if form == "plain":
        return print_spec(spec, random)
    spec = with_start_conditions(replace(spec, restoration=random.choice(RESTORATIONS)), random)
    return print_spec(spec, random)


def examine_generated(seed: int, form: Form = "plain") -> list[str] | None:
    """What is wrong with the advice for a seed; None where there is a policy.

    By the explicit meaning, or as synthesis decides, where there are clauses or starts.
    """
    text = generated_text(seed, form)
    try:
        spec = parse(text)
        found = explain(spec)
    except UserError:
        return None
    if not isinstance(found, Explanation):
        return None
    decide = partial(realizable, ordering=spec.ordering) if form == "plain" else _has_policy
    return list(bad_advice(spec, text, found, decide))


def examine_text(text: str, seconds: float = 60.0) -> list[str] | None:
    """The same for a text, as synthesis decides; None where it has a policy, too many states, or that is not known."""
    spec = parse(text)
    if count_states(spec) > MOST_STATES:
        return None
    found = explain(spec, context=Context(Limits(seconds)))
    if not isinstance(found, Explanation):
        return None
    return list(bad_advice(spec, text, found, _has_policy))


def _has_policy(spec: Spec) -> bool:
    return isinstance(synthesize(spec, context=Context(Limits(60.0)), certify=False), Realizable)


def _texts(files: Sequence[str]) -> Iterator[tuple[str, str]]:
    yield from ROBOTS.items()
    yield "battery of 101 levels", battery(100)
    yield from ((file, Path(file).read_text(encoding="utf-8")) for file in files)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the campaign."""
    parser = argparse.ArgumentParser(prog="python -m tests.explain.advice", description=__doc__)
    parser.add_argument("count", type=int, help="how many generated specifications of each form without a policy")
    parser.add_argument("files", nargs="*", help="specifications beside these")
    parser.add_argument("--seed", type=int, default=0, help="the first seed (default 0)")
    parser.add_argument("--forms", nargs="+", choices=FORMS, default=FORMS, help="what is generated (default: all)")
    options = parser.parse_args(arguments)
    started, totals, explained = time.monotonic(), Counter[str](), 0
    for name, text in _texts(options.files):
        try:
            wrong = examine_text(text)
        except UserError:
            print(f"{name}: not a specification")
            continue
        explained += wrong is not None
        totals.update(wrong or ())
        print(
            f"{name}: {'; '.join(wrong or ('no policy, and no bad advice',)) if wrong is not None else 'passed over'}",
            flush=True,
        )
    for form in options.forms:
        told, seed = 0, options.seed
        while told < options.count:
            wrong = examine_generated(seed, form)
            told += wrong is not None
            totals.update(wrong or ())
            for each in wrong or ():
                print(f"seed {seed}, {form}: {each}", flush=True)
            seed += 1
        print(f"{told} generated without a policy: {form}", flush=True)
    for kind in KINDS:
        print(f"{kind:65}{totals[kind]:6}")
    print(f"and {explained} other specifications without a policy, {time.monotonic() - started:.0f} s")
    return 1 if any(totals.values()) else 0


if __name__ == "__main__":
    raise SystemExit(main())
