"""The closed loop of a policy as a graph of networkx."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tumato_symbolic.limits.packages import need
from tumato_symbolic.notebook.rows import few_rows
from tumato_symbolic.policy import Policy, bind
from tumato_symbolic.semantics import State, action_names, in_json, is_safe, nominal_agrees, outcomes, successor
from tumato_symbolic.spec import Spec, Value

if TYPE_CHECKING:
    from networkx import DiGraph


def to_networkx(policy: Policy, spec: Spec, max_states: int) -> DiGraph:
    """See `Policy.to_networkx`."""
    need("networkx", "notebook", "make a graph of a policy")
    from networkx import DiGraph

    def node(state: State) -> tuple[Value, ...]:
        return tuple(in_json(spec, state).values())

    rows = few_rows(bind(policy, spec), max_states, "graph")
    graph = DiGraph(variables=tuple(variable.name for variable in spec.variables), ordering=spec.ordering)
    for state, chosen in rows.items():
        graph.add_node(node(state), actions=action_names(spec, chosen), safe=is_safe(spec, state))
    for state, chosen in rows.items():
        following = dict.fromkeys(outcomes(spec, state, chosen, spec.ordering), "deviation")
        if nominal_agrees(spec, chosen):
            following[successor(spec, state, chosen)] = "nominal"
        for there, kind in following.items():
            if there not in rows:
                graph.add_node(node(there), actions=None, safe=is_safe(spec, there))
            graph.add_edge(node(state), node(there), kind=kind)
    return graph
