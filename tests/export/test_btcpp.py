"""Policies as behaviour trees, run by BehaviorTree.CPP."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from html import escape
from itertools import product
from random import Random

import pytest
from msgspec.structs import replace

from tests.export.behaviour_trees import Running, entries, fallback, fresh, needs_library
from tests.export.cases import generated
from tests.export.mixed import FROM_STARTS, mixed
from tests.export.policies import EXAMPLES, decisions, example, exported, random_request, request, written
from tumato_symbolic.export import btcpp
from tumato_symbolic.export.decisions import rules_of
from tumato_symbolic.export.request import Request
from tumato_symbolic.semantics import State, apply, is_safe

Named = Mapping[str, str]


class Watched:
    """A tree and what its policy says: complaints about each tick."""

    def __init__(self, made: Request, text: str | None = None) -> None:
        self.text = text or btcpp.files(made)[0]
        own = btcpp.files(made)[0]
        variables = made.policy.vocabulary.variables
        nodes = Running(self.text).nodes
        node_of = dict(zip(made.policy.vocabulary.actions, nodes, strict=True))
        self.action_of = {node: action for action, node in node_of.items()}
        self.wanted = {
            state: None if actions is None else [node_of[each] for each in actions]
            for state, actions in decisions(made)
        }
        self.named: dict[State, Named] = {
            state: {
                entry: values[value] for entry, (_, values), value in zip(entries(own), variables, state, strict=True)
            }
            for state in self.wanted
        }

    def complaints(self, tree: Running, state: State) -> list[str]:
        """Tick in a state, and say what runs or is started that the policy does not want there."""
        tree.tick(self.named[state])
        wanted = self.wanted[state] or []
        return [
            *(f"{state}: {node} is started" for node in tree.started if node not in wanted),
            *(f"{state}: {node} still runs" for node in tree.running if node not in wanted),
        ]


def _in_every_state(watched: Watched) -> list[str]:
    """From a halted tree: exactly the decision is started, and runs; where nothing is decided, the tree fails."""
    found = []
    with fresh(watched.text) as tree:
        for state, wanted in watched.wanted.items():
            status = tree.tick(watched.named[state])
            expected = "FAILURE" if wanted is None else "RUNNING" if wanted else "SUCCESS"
            if (status, tree.started, tree.running) != (expected, wanted or [], set(wanted or [])):
                found.append(f"{state}: {status}, started {tree.started}, running {tree.running}")
            tree.halt()
            assert not tree.running
    return found


def _where_actions_fail(watched: Watched) -> list[str]:
    """Each action of a decision fails, at once or later: nothing else is started, and nothing is left running."""
    found = []
    with fresh(watched.text) as tree:
        for (state, wanted), late in product(watched.wanted.items(), (False, True)):
            for failing in wanted or []:
                tree.returns = {} if late else {failing: "FAILURE"}
                found += watched.complaints(tree, state)
                if late:
                    tree.returns = {failing: "FAILURE"}
                    found += watched.complaints(tree, state)
                found += [f"{state}: {node} runs after {failing} failed" for node in tree.running]
                tree.returns = {}
                tree.halt()
    return found


def _where_the_state_changes(watched: Watched, states: list[State]) -> list[str]:
    """From one state to another while actions run: those of the old decision that are not in the new one are halted."""
    found = []
    with fresh(watched.text) as tree:
        for first, then in product(states, states):
            found += watched.complaints(tree, first) + watched.complaints(tree, then)
            if first != then and tree.running != set(watched.wanted[then] or []):
                found.append(f"{first}, {then}: {tree.running} run")
            tree.halt()
    return found


@needs_library
@pytest.mark.parametrize("name", EXAMPLES)
def test_every_example_does_what_the_policy_says(name: str) -> None:
    """In every state, wherever an action fails, and wherever the state changes while actions run."""
    watched = Watched(example(name, diagram=name == "amr"))
    assert _in_every_state(watched) == []
    states = list(watched.wanted)
    some = Random(name).sample(states, min(130, len(states)))
    assert _where_the_state_changes(watched, some[:32]) == []
    watched.wanted = {state: watched.wanted[state] for state in some}
    assert _where_actions_fail(watched) == []


@needs_library
@pytest.mark.parametrize("seed", range(20))
def test_random_policies_with_nasty_names(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Names of nodes and words of scripts, undecided states, sets of several actions, rules in many subtrees."""
    monkeypatch.setattr(btcpp, "RULES_IN_A_TREE", 1 + seed % 4)
    made = random_request(seed)
    watched = Watched(made)
    states = Random(seed).sample(list(watched.wanted), min(60, len(watched.wanted)))
    watched.wanted = {state: watched.wanted[state] for state in states}
    assert _in_every_state(watched) == []
    assert _where_actions_fail(watched) == []
    assert _where_the_state_changes(watched, states[:12]) == []


@needs_library
@pytest.mark.parametrize("seed", FROM_STARTS)
def test_policies_from_starts(seed: int) -> None:
    """Where nothing is decided the tree fails, and nothing that ran before goes on."""
    watched = Watched(exported(mixed(seed)[0]))
    assert None in watched.wanted.values()
    assert _in_every_state(watched) == []
    assert _where_the_state_changes(watched, list(watched.wanted)) == []


@needs_library
def test_names_of_the_library() -> None:
    """Actions and variables may be called like nodes, words of scripts, and our own trees."""
    actions = ["Sequence", "Parallel", "WhileDoElse", "SubTree", "Policy", "Rules_1", "AlwaysFailure", "Action", "root"]
    spec = written({"True": "true, false", "_private": "0..2", "x_private": "a, b"}, actions)
    states = list(product(range(2), range(3), range(2)))
    watched = Watched(request(spec, {state: frozenset({n % 9, 3 * n % 9}) for n, state in enumerate(states)}))
    assert _in_every_state(watched) == []


@needs_library
def test_values_that_are_none_fail() -> None:
    """An entry with another text starts nothing, and halts what runs."""
    watched = Watched(example("amr"))
    good = watched.named[0, 0, 0, 1]
    with fresh(watched.text) as tree:
        for entry in good:
            assert tree.tick(good) == "RUNNING"
            assert tree.tick({**good, entry: "elsewhere"}) == "FAILURE"
            assert (tree.started, tree.running) == ([], set())


def _random_ticks(made: Request, watched: Watched, ticks: int, random: Random) -> list[str]:
    """Effects in any order, failures, disturbances: what runs outside the policy, and unsafe states after effects."""
    spec, found = made.spec, []
    numbers = {action.name: number for number, action in enumerate(spec.actions)}
    state = random.choice(list(watched.wanted))
    with fresh(watched.text) as tree:
        for _ in range(ticks):
            tree.returns = {}
            found += watched.complaints(tree, state)
            running = sorted(tree.running)
            fate = random.random()
            if running and fate < 0.7:
                node = random.choice(running)
                effects = spec.actions[numbers[watched.action_of[node]]].effects
                if effects:
                    state = apply(random.choice(effects), state)
                    if not is_safe(spec, state):
                        found.append(f"{state} is not safe after {node}")
                tree.returns = {node: random.choice(("SUCCESS", "SUCCESS", "FAILURE"))}
                watched.wanted.setdefault(state, None)
                # The node returns in the next tick, with its effect on the blackboard, or is halted then.
                found += watched.complaints(tree, state)
            elif fate > 0.9:
                state = random.choice(list(watched.wanted))
    return found


@needs_library
@pytest.mark.parametrize("name", ["amr", "amr_two_loads", "concurrent"])
def test_random_ticks_of_the_examples(name: str) -> None:
    """Nothing runs that the policy does not want, and no effect makes an unsafe state."""
    made = example(name)
    assert _random_ticks(made, Watched(made), 1500, Random(name)) == []


@needs_library
@pytest.mark.parametrize("profile", ["concurrent", "overlapping"])
def test_random_ticks_of_generated_policies(profile: str) -> None:
    """The same where sets of several actions are executed."""
    realizable = (found for seed in range(300, 400) if (found := generated(profile, seed, 0)))
    for case, _ in zip(realizable, range(4), strict=False):
        made = replace(request(case[0].spec, case[0].rows), ordering=case[0].ordering)
        assert _random_ticks(made, Watched(made), 300, Random(profile)) == []


@needs_library
@pytest.mark.parametrize("fault", [_where_actions_fail, lambda each: _where_the_state_changes(each, list(each.wanted))])
def test_a_fallback_of_sequences_is_no_such_tree(fault: Callable[[Watched], list[str]]) -> None:
    """The naive form starts actions of later rules where one fails, and leaves old ones running: it is noticed."""
    made = example("amr")
    own = btcpp.files(made)[0]
    names = btcpp.names_of(made)
    rules = [(escape(btcpp.condition(names, rule)), list(rule.actions or ())) for rule in rules_of(made.policy)]
    naive = Watched(made, fallback(rules, made.policy.vocabulary.actions))
    assert fault(naive) != []
    assert fault(Watched(made, own)) == []


def test_the_form_of_the_file() -> None:
    """Version 4, all actions in the model, sets as a parallel node that fails with the first of them."""
    spec = written({"S": "a, b"}, ["left", "right"])
    text = btcpp.files(request(spec, {(0,): frozenset((0, 1)), (1,): frozenset()}))[0]
    assert '<root BTCPP_format="4" main_tree_to_execute="Policy">' in text
    assert '<Parallel success_count="-1" failure_count="1">\n' in text
    assert text.count('<Action ID="left"/>') == 2
    assert '<AlwaysSuccess name="do nothing"/>' in text
    assert "undecided" not in text
    assert 'name="undecided"' in btcpp.files(request(spec, {(0,): frozenset((0, 1))}))[0]
