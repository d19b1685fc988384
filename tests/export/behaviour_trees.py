"""BehaviorTree.CPP, where it is installed: trees are run by the real library, and watched."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import Any
from xml.etree import ElementTree

import pytest

try:
    import behaviortreepy as library
except ImportError:
    library = None

needs_library = pytest.mark.skipif(
    library is None, reason="behaviortreepy is not installed: no tree is run by BehaviorTree.CPP"
)


class Running:
    """A tree with actions that only say that they run; what they return is settable.

    `running` are the actions that were started and have neither returned nor been halted; `started` and `halted` what
    happened in the last tick, in order.
    """

    def __init__(self, text: str) -> None:
        self.nodes = [node.attrib["ID"] for node in ElementTree.fromstring(text).iterfind("TreeNodesModel/Action")]
        self.returns: dict[str, str] = {}
        self.running: set[str] = set()
        self.started: list[str] = []
        self.halted: list[str] = []
        self._blackboard = library.Blackboard.create()
        self._factory = library.BehaviorTreeFactory()
        for node in self.nodes:
            self._register(node)
        self._factory.register_behavior_tree_from_text(text)
        main = ElementTree.fromstring(text).attrib["main_tree_to_execute"]
        self._tree = self._factory.create_tree(main, self._blackboard)

    def _register(self, node: str) -> None:
        def result(_: object) -> Any:
            status = self.returns.get(node, "RUNNING")
            if status != "RUNNING":
                self.running.discard(node)
            return getattr(library.NodeStatus, status)

        def start(_: object) -> Any:
            self.started.append(node)
            self.running.add(node)
            return result(_)

        def halt(_: object) -> None:
            self.halted.append(node)
            self.running.discard(node)

        self._factory.register_simple_stateful_action(node, start, result, halt)

    def tick(self, state: Mapping[str, str]) -> str:
        """Write the state to the blackboard, by its entries, and tick once; what the tree returns."""
        self.started, self.halted = [], []
        for entry, value in state.items():
            self._blackboard.set_string(entry, value)
        return str(library.to_string(self._tree.tick_exactly_once()))

    def halt(self) -> None:
        """Halt the whole tree."""
        self._tree.halt_tree()


def entries(text: str) -> list[str]:
    """The entries of the blackboard in the order of the variables, as the file lists them."""
    listed = re.search(r"all of them strings:\n(.*?)-->", text, re.DOTALL)
    assert listed is not None
    return [line.split(":")[0].strip() for line in listed[1].splitlines()]


@contextmanager
def fresh(text: str) -> Iterator[Running]:
    """A tree that is halted in the end."""
    tree = Running(text)
    try:
        yield tree
    finally:
        tree.halt()


def fallback(rules: Sequence[tuple[str, Sequence[str]]], actions: Sequence[str]) -> str:
    """The naive form: a fallback of sequences, each with a condition in front. It is wrong."""
    sequences = ""
    for condition, done in rules:
        nodes = "".join(f'<Action ID="{name}"/>' for name in done)
        sequences += f'<Sequence><ScriptCondition code="{condition}"/>{nodes}</Sequence>'
    model = "".join(f'<Action ID="{action}"/>' for action in actions)
    return (
        '<root BTCPP_format="4" main_tree_to_execute="Policy"><BehaviorTree ID="Policy">'
        f"<Fallback>{sequences}</Fallback></BehaviorTree><TreeNodesModel>{model}</TreeNodesModel></root>"
    )
