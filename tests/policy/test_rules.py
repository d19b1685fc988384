"""Policies as ordered lists of rules."""

import inspect
import subprocess
import sys
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from unittest.mock import patch

import pytest
from hypothesis import given

from tests.policy.strategies import QUICK, policies, rows_of
from tumato_symbolic.diagnostics import UserError
from tumato_symbolic.diagrams import Coverer, DiagramBuilder
from tumato_symbolic.policy import (
    DecisionDiagram,
    Policy,
    Rule,
    Table,
    Vocabulary,
    count_defined,
    dumps,
    loads,
    minimal_rules,
)

PROOFS = Path(__file__).parents[2] / "proofs"


def decide(rules: Sequence[Rule], state: Mapping[str, str]) -> tuple[str, ...] | None:
    """What the first rule that matches says; None where there is none."""
    matching = (rule for rule in rules if all(state[name] in values for name, values in rule.condition))
    return next((rule.actions for rule in matching), None)


def named_rows(policy: Policy) -> Iterator[tuple[dict[str, str], tuple[str, ...]]]:
    """Every decided state by names, and what is done there."""
    variables = policy.vocabulary.variables
    for state in rows_of(policy):
        named = {name: values[value] for (name, values), value in zip(variables, state, strict=True)}
        yield named, policy.decide(named)


@QUICK
@given(policies())
def test_rules_decide_like_the_policy(policy: Policy) -> None:
    """In every decided state the first rule that matches has the actions of the policy."""
    rules = minimal_rules(policy)
    assert all(decide(rules, state) == actions for state, actions in named_rows(policy))


@QUICK
@given(policies())
def test_every_rule_is_needed(policy: Policy) -> None:
    """Without any one of the rules, some decided state is decided otherwise; only the last has no condition."""
    rules, rows = minimal_rules(policy), list(named_rows(policy))
    for place, rule in enumerate(rules):
        assert (rule.condition == ()) == (rule is rules[-1])
        fewer = rules[:place] + rules[place + 1 :]
        assert any(decide(fewer, state) != actions for state, actions in rows)


@QUICK
@given(policies())
def test_every_value_is_needed(policy: Policy) -> None:
    """No rule names a value with which it decides no state, nor all values of a variable."""
    rules, rows = minimal_rules(policy), list(named_rows(policy))
    known = dict(policy.vocabulary.variables)
    for place, rule in enumerate(rules):
        mine = [
            state for state, _ in rows if decide(rules[:place], state) is None and decide([rule], state) is not None
        ]
        for name, values in rule.condition:
            assert {state[name] for state in mine} == set(values) < set(known[name])


@QUICK
@given(policies())
def test_the_rules_depend_on_the_policy_alone(policy: Policy) -> None:
    """Its text, read again, gives the same rules."""
    assert minimal_rules(loads(dumps(policy))) == minimal_rules(policy)


@pytest.mark.parametrize("name", ["amr", "amr_reaction_rules", "amr_two_loads", "coin", "concurrent", "grid3"])
def test_the_examples_need_one_rule_for_every_decision(name: str) -> None:
    """No list can be shorter: as many rules as there are different sets of actions (the AMR: 8 for 32 states)."""
    policy = Policy.load(PROOFS / f"{name}.policy.json")
    assert len(minimal_rules(policy)) == len({actions for _, actions in named_rows(policy)})


def tasks(number: int) -> Policy:
    """`number` tasks, of which the first that is still to do is done: 2^number states, and some that never occur."""
    variables = tuple((f"T{place}", ("todo", "done", "void")) for place in range(number))
    builder = DiagramBuilder(range(number), (False, True))
    finished, defined, first = 1, 1, list[int]()
    for level in reversed(range(number)):
        first = [builder.node(level, (0, root, 0)) for root in first]
        first.append(builder.node(level, (defined, 0, 0)))
        defined = builder.node(level, (defined, defined, 0))
        finished = builder.node(level, (0, finished, 0))
    roots = (*reversed(first), 0)
    vocabulary = Vocabulary(variables, (*(f"do{place}" for place in range(number)), "never"))
    return Policy(vocabulary, DecisionDiagram(builder.finish(), roots, defined))


def test_very_many_states_take_few_rules() -> None:
    """Forty tasks, 10^12 states, are forty-one rules, each of one condition."""
    policy = tasks(40)
    assert count_defined(policy) == 2**40
    *rules, last = minimal_rules(policy)
    assert rules[:39] == [Rule(((f"T{place}", ("todo",)),), (f"do{place}",)) for place in range(39)]
    assert rules[39:] == [Rule((("T39", ("done",)),), ())]
    assert last == Rule((), ("do39",))


def test_many_variables_are_no_difficulty() -> None:
    """Recursion is as deep as there are variables, which may be more than Python's limit."""
    number = 150
    builder = DiagramBuilder(range(number), (False, True))
    root = 1
    for level in reversed(range(number)):
        root = builder.node(level, (0, root))
    vocabulary = Vocabulary(tuple((f"v{place}", ("no", "yes")) for place in range(number)), ("go",))
    policy = Policy(vocabulary, DecisionDiagram(builder.finish(), (root,), 1))
    before = sys.getrecursionlimit()
    low = len(inspect.stack()) + 100
    try:
        sys.setrecursionlimit(low)
        rules = minimal_rules(policy)
        assert sys.getrecursionlimit() == low
    finally:
        sys.setrecursionlimit(before)
    assert rules == (Rule(tuple((name, ("yes",)) for name, _ in vocabulary.variables), ("go",)), Rule((), ()))


def parity(number: int) -> Policy:
    """One action where an odd number of variables is `yes`, another elsewhere."""
    builder = DiagramBuilder(range(number), (False, True))
    even, odd = 1, 0
    for level in reversed(range(number)):
        even, odd = builder.node(level, (even, odd)), builder.node(level, (odd, even))
    vocabulary = Vocabulary(tuple((f"v{place}", ("no", "yes")) for place in range(number)), ("a", "b"))
    return Policy(vocabulary, DecisionDiagram(builder.finish(), (even, odd), 1))


def test_what_has_no_short_list_is_refused() -> None:
    """A decision that needs too many rules is an error of the user's, with a reason, and soon."""
    assert len(minimal_rules(parity(4))) == 9
    with pytest.raises(UserError, match=r"TUM508.*needs more than 2,000 rules"):
        minimal_rules(parity(40))


def test_too_many_decisions_are_refused() -> None:
    """So are more different sets of actions than anybody would read."""
    number = 13
    builder = DiagramBuilder(range(number), (False, True))
    roots = tuple(builder.node(level, (0, 1)) for level in range(number))
    vocabulary = Vocabulary(
        tuple((f"v{place}", ("no", "yes")) for place in range(number)), tuple(f"a{place}" for place in range(number))
    )
    with pytest.raises(UserError, match=r"TUM508.*more than 5,000 different decisions"):
        minimal_rules(Policy(vocabulary, DecisionDiagram(builder.finish(), roots, 1)))


def test_wrong_rules_are_never_given() -> None:
    """Rules are compared with the policy; a difference is a bug, not an answer."""
    policy = Policy(Vocabulary((("S", ("x", "y", "z")),), ("a",)), Table({(0,): frozenset({0}), (1,): frozenset()}))
    with patch.object(Coverer, "cover", lambda *_: (((0, (0,)),),)), pytest.raises(RuntimeError, match="do not say"):
        minimal_rules(policy)


def test_a_policy_without_states_has_no_rules() -> None:
    """Where nothing is decided there is nothing to say."""
    assert minimal_rules(Policy(Vocabulary((("S", ("x",)),), ("a",)), Table({}))) == ()


def test_rules_load_no_engine() -> None:
    """`tumato-sym show --format rules` imports neither lark nor dd nor z3."""
    script = (
        "import sys; from tumato_symbolic.cli.main import main; code = main(sys.argv[1:]);"
        "print(code, sorted({'lark', 'dd', 'z3'} & set(sys.modules)))"
    )
    command = [sys.executable, "-c", script, "show", str(PROOFS / "amr.policy.json"), "--format", "rules"]
    run = subprocess.run(command, capture_output=True, text=True, check=True)
    assert run.stdout.endswith("0 []\n")
