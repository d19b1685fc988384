"""In which order kinds of repairs are looked for, and when there are enough: state rules are given up last."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from types import MappingProxyType
from typing import Literal, TypeAlias

from msgspec.structs import replace

from tumato_symbolic.explain.adding import composed, controlling_the_environment, derived, settings, single_additions
from tumato_symbolic.explain.additions import Addition, with_additions
from tumato_symbolic.explain.cores import element_list
from tumato_symbolic.explain.dropping import ROUNDS, Search, droppable, harmless, serves_without
from tumato_symbolic.explain.elements import Element, Elements, without
from tumato_symbolic.explain.explanation import Change, Explanation, Repair
from tumato_symbolic.explain.failing_states import FailingStates
from tumato_symbolic.explain.new_actions import any_action, robots_new, robots_own
from tumato_symbolic.explain.requirements import Requirements
from tumato_symbolic.explain.trial import trial
from tumato_symbolic.explain.trouble import Trouble
from tumato_symbolic.explain.weaken import weakening
from tumato_symbolic.explain.work import Work
from tumato_symbolic.limits import LimitReachedError
from tumato_symbolic.synthesis import Realizable, Unrealizable

SHARE = 0.6
"""The part of its time in which repairs are looked for that keep all state rules; the rest is for the others."""

MOST_LINES = 2
"""Beside a repair, others that take more lines are told only up to so many."""

MOST_WEAKENED = 3
"""Of a repair of more elements no line is changed rather than dropped."""

Unavoidable: TypeAlias = Literal["failing", "conflict"]
"""Why no dropping helps: with everything dropped but the assumptions, states still fail, or goals conflict."""


def repairs_found(work: Work, found: Explanation) -> Iterator[Explanation]:
    """Ways to make the specification realizable: first what can be added, then the smallest sets of lines to drop.

    No state rule is dropped or weakened, but where nothing else serves, or all ways are asked for.
    """
    requirements = work.requirements
    work.context.tell("repairs: finding out whether there is one")
    found = replace(found, unavoidable=_unavoidable(requirements))
    if work.wanted_repairs == 0:
        yield replace(found, repairs_complete=found.unavoidable is not None)
        return
    try:
        with work.within(SHARE):
            for known in _keeping_rules(work, found):
                yield (found := known)
    except LimitReachedError:
        requirements.manager.context.check()
        found = replace(found, others_untried=True)
    if found.unavoidable is None and (not found.repairs or work.wanted_repairs == "all"):
        for known in _giving_up_rules(work, found):
            yield (found := known)
    if found.others_untried:
        raise LimitReachedError(work.share_met())
    yield found


def _unavoidable(requirements: Requirements) -> Unavoidable | None:
    outcome = trial(requirements, without(requirements.spec, droppable(requirements)))
    if isinstance(outcome, Realizable):
        return None
    conflicts = not isinstance(outcome, Unrealizable) or outcome.failures[0].kind == "conflict"
    return "conflict" if conflicts else "failing"


def _keeping_rules(work: Work, found: Explanation) -> Iterator[Explanation]:
    """The repairs that drop and weaken no state rule."""
    requirements = work.requirements
    work.context.tell("repairs: trying what could be added")
    trouble = Trouble.of(work.oracle)
    joint = () if found.restorability is None else (each.effects for each in found.restorability.joint)
    for additions in single_additions(trouble, joint):
        yield (found := _with(found, Repair(additions=additions)))
    if found.unavoidable is None and serves_without(requirements, harmless(requirements)):
        search = Search(work.oracle, (frozenset(each.core) for each in found.reasons), harmless(requirements))
        dropped = search.next()
        if not found.repairs and (dropped is None or len(dropped) > MOST_LINES):
            work.context.tell("repairs: trying what could be added together")
            if (together := composed(trouble, robots_new)) is not None:
                yield (found := _with(found, Repair(additions=together)))
        for known in _searched(work, found, search, requirements, first=dropped):
            yield (found := known)
    elif found.unavoidable is None:
        yield (found := replace(found, repairs_complete=True))
    if found.repairs:
        return
    work.context.tell("repairs: trying what could be added together")
    for additions in controlling_the_environment(trouble):
        yield (found := _with(found, Repair(additions=additions)))
        return
    together = composed(trouble, robots_own)
    if together is not None:
        yield _with(found, Repair(additions=together))
        return
    for setting in settings(requirements.spec):
        other = derived(requirements, with_additions(requirements.spec, (setting,)))
        if serves_without(other, harmless(other)):
            search = Search(FailingStates(other), (), harmless(other))
            yield from _searched(work, found, search, other, (setting,))
            return
    together = composed(trouble, any_action)
    if together is not None:
        yield _with(found, Repair(additions=together))


def _giving_up_rules(work: Work, found: Explanation) -> Iterator[Explanation]:
    """The repairs that drop or weaken a state rule."""
    requirements = work.requirements
    cores = (frozenset(each.core) for each in found.reasons)
    rules = frozenset(each for each in requirements.elements if each.kind == "state-rule")
    search = Search(work.oracle, cores, droppable(requirements), rules)
    for repair in found.repairs:
        if repair.changes and not repair.additions:
            search.exclude(frozenset(change.element for change in repair.changes))
    yield from _searched(work, found, search, requirements)


def _searched(
    work: Work,
    found: Explanation,
    search: Search,
    requirements: Requirements,
    additions: tuple[Addition, ...] = (),
    *,
    first: Elements | None = None,
) -> Iterator[Explanation]:
    """The repairs of a search beside some additions, as many as are wanted; one at least, where there is one.

    `first` is what the search has found by now.
    """
    number, wanted = 0, work.wanted_repairs
    while wanted == "all" or number < wanted:
        number += 1
        work.context.tell(f"repairs: {number}" if wanted == "all" else f"repairs: {number} of {wanted}")
        dropped, first = (search.next(), None) if first is None else (first, None)
        if dropped is None and not found.repairs and not search.complete:
            dropped, number = search.any_repair(), ROUNDS
        if dropped is None:
            found = replace(found, repairs_complete=search.complete)
            break
        if wanted != "all" and found.repairs and len(dropped) > max(MOST_LINES, len(found.repairs[-1].changes)):
            break
        try:
            repair = _lightest(requirements, dropped, additions)
        except LimitReachedError:
            yield _with(found, _dropping(requirements, dropped, additions))
            raise
        yield (found := _with(found, repair))
    yield found


def _with(found: Explanation, repair: Repair) -> Explanation:
    return replace(found, repairs=(*found.repairs, repair))


def _lightest(requirements: Requirements, dropped: Elements, additions: tuple[Addition, ...]) -> Repair:
    """A repair with lines changed rather than dropped where that can be."""
    weaker = weakening(requirements, dropped) if len(dropped) <= MOST_WEAKENED else None
    texts = {edit.element: edit.text for edit in weaker.edits} if weaker is not None else {}
    return _dropping(requirements, dropped, additions, texts)


def _dropping(
    requirements: Requirements,
    dropped: Elements,
    additions: tuple[Addition, ...],
    texts: Mapping[Element, str] = MappingProxyType({}),
) -> Repair:
    elements = element_list(requirements, dropped)
    return Repair(tuple(Change(each, texts.get(each)) for each in elements), additions)
