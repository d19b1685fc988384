"""A policy as a tree for BehaviorTree.CPP 4.

Rules are nested `WhileDoElse` nodes. In a fallback of sequences, an action that fails would start those of later rules,
and a changed decision would leave the old action running.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from string import Template
from textwrap import fill
from typing import Final
from xml.sax.saxutils import quoteattr

from msgspec import Struct

from tumato_symbolic.export.decisions import DecisionRule, rules_of
from tumato_symbolic.export.identifiers import distinct, identifier
from tumato_symbolic.export.request import Request
from tumato_symbolic.spec import Ordering

RULES_IN_A_TREE = 40
"""So many rules are nested at most before the rest goes into a subtree: readers of XML limit the depth."""

_PROMISE = (
    "Where `tumato-sym verify` proves the policy, only actions that it decides in the state on the blackboard run "
    "after a tick, and all of them do that have not returned yet; that is safe {whatever}, and nominal effects reach "
    "the goals; for that, the robot's code must write the whole state to the blackboard before every tick, tick "
    "{again}, let an action return only when its effects are on the blackboard, and keep one that is halted from "
    "having an effect later."
)

_ORDERINGS: Final[Mapping[Ordering, Mapping[str, str]]] = {
    "any": {"whatever": "whatever effects occur, in any order", "again": "again and again"},
    "first": {
        "whatever": "whatever effect occurs first",
        "again": "as soon as an effect has occurred and before another can",
    },
}

_FILE = Template("""\
<?xml version="1.0" encoding="UTF-8"?>
<!-- What to do in a state: the decisions of a policy. Written by `tumato-sym export btcpp`.

$promise

The tree fails where an action fails, where the policy says nothing of the state, and where a value is none of the
variable's. It succeeds where all actions have, and where nothing is to be done. Tick it again in either case.

Entries of the blackboard, all of them strings:
$entries-->
<root BTCPP_format="4" main_tree_to_execute="$main">
$trees
  <TreeNodesModel>
$model  </TreeNodesModel>
</root>
""")

_MAIN: Final = "Policy"
"""The tree to tick."""

_NODES: Final = """
Action Condition Control Decorator SubTree BehaviorTree TreeNodesModel root include
AlwaysFailure AlwaysSuccess AsyncFallback AsyncSequence ConsumeQueue Delay EntryUpdated Fallback ForceFailure
ForceSuccess IfThenElse Inverter KeepRunningUntilFailure LoopBool LoopDouble LoopInt LoopString ManualSelector Parallel
ParallelAll PopFromQueue Precondition QueueSize ReactiveFallback ReactiveSequence Repeat RetryUntilSuccessful
RetryUntilSuccesful RunOnce Script ScriptCondition Sequence SequenceStar SequenceWithMemory SetBlackboard
SkipUnlessUpdated Sleep SubTreePlus Switch2 Switch3 Switch4 Switch5 Switch6 TestNode Timeout TryCatch UnsetBlackboard
UpdatedAction WaitValueUpdate WasEntryUpdated WhileDoElse
"""
"""Names of nodes that the library brings along."""

_WORDS: Final = "true false"
"""What is no name in scripts."""


class Names(Struct, frozen=True):
    """The entries of the blackboard and their values, and the nodes of actions."""

    entries: Mapping[str, str]
    values: Mapping[str, Sequence[str]]
    nodes: Mapping[str, str]


def files(request: Request) -> tuple[str]:
    """The text of the tree. Raises `UserError` (TUM508) where the policy has no short list of rules."""
    rules = rules_of(request.policy)
    parts = [rules[start : start + RULES_IN_A_TREE] for start in range(0, len(rules), RULES_IN_A_TREE)]
    trees = [_MAIN, *(f"Rules_{number}" for number in range(1, len(parts) + 1))]
    names = names_of(request, trees)
    text = _FILE.substitute(
        promise=fill(_PROMISE.format(**_ORDERINGS[request.ordering]) + request.from_starts, 119),
        entries="".join(_entries(names)),
        main=_MAIN,
        trees="\n".join(_trees(names, trees, parts)),
        model="".join(f"    <Action ID={quoteattr(node)}/>\n" for node in names.nodes.values()),
    )
    return (text,)


def names_of(request: Request, trees: Sequence[str] = ()) -> Names:
    """The names for a policy; `trees` are in use for something else."""
    vocabulary = request.policy.vocabulary
    return Names(
        distinct({name: identifier(name) for name, _ in vocabulary.variables}, _WORDS.split()),
        dict(vocabulary.variables),
        distinct({action: action for action in vocabulary.actions}, (*_NODES.split(), *trees)),
    )


def _entries(names: Names) -> Iterator[str]:
    for name, entry in names.entries.items():
        yield f"  {entry}: {', '.join(names.values[name])}\n".replace("--", "- -")


def _trees(names: Names, trees: Sequence[str], parts: Sequence[Sequence[DecisionRule]]) -> Iterator[str]:
    """The tree that looks whether there is such a state, and those of the rules, each of which goes on to the next."""
    known = [_is_one_of(names, name, values) for name, values in names.values.items()]
    yield _tree(trees[0], _while(" && ".join(known) or "true", _subtree(trees[1]), _failure("no such state")))
    for place, rules in enumerate(parts, 1):
        last = rules[-1]
        if place < len(parts):
            below = _while(condition(names, last), _decision(names, last), _subtree(trees[place + 1]))
        else:
            below = _decision(names, last)
        for rule in reversed(rules[:-1]):
            below = _while(condition(names, rule), _decision(names, rule), below)
        yield _tree(trees[place], below)


def _tree(name: str, root: Sequence[str]) -> str:
    return "\n".join([f'  <BehaviorTree ID="{name}">', *(f"    {line}" for line in root), "  </BehaviorTree>"])


def _while(condition: str, then: Sequence[str], otherwise: Sequence[str]) -> list[str]:
    inside = [f"<ScriptCondition code={quoteattr(condition)}/>", *then, *otherwise]
    return ["<WhileDoElse>", *(f"  {line}" for line in inside), "</WhileDoElse>"]


def _subtree(name: str) -> list[str]:
    return [f'<SubTree ID="{name}" _autoremap="true"/>']


def _failure(why: str) -> list[str]:
    return [f'<AlwaysFailure name="{why}"/>']


def _decision(names: Names, rule: DecisionRule) -> list[str]:
    if rule.actions is None:
        return _failure("undecided")
    if not rule.actions:
        return ['<AlwaysSuccess name="do nothing"/>']
    nodes = [f"<Action ID={quoteattr(names.nodes[action])}/>" for action in rule.actions]
    if len(nodes) == 1:
        return nodes
    return ['<Parallel success_count="-1" failure_count="1">', *(f"  {node}" for node in nodes), "</Parallel>"]


def condition(names: Names, rule: DecisionRule) -> str:
    """A script that tells whether a rule matches."""
    return " && ".join(_is_one_of(names, name, values) for name, values in rule.condition) or "true"


def _is_one_of(names: Names, name: str, values: Sequence[str]) -> str:
    entry, others = names.entries[name], [each for each in names.values[name] if each not in values]
    if others and len(others) < len(values):
        return " && ".join(f"{entry} != '{value}'" for value in others)
    text = " || ".join(f"{entry} == '{value}'" for value in values)
    return f"({text})" if len(values) > 1 else text
