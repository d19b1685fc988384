"""A policy as a table of pandas."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tumato_symbolic.limits.packages import need
from tumato_symbolic.notebook.rows import few_rows
from tumato_symbolic.policy import Policy, fitted
from tumato_symbolic.semantics import in_json, is_safe
from tumato_symbolic.spec import Spec

if TYPE_CHECKING:
    from pandas import DataFrame


def to_dataframe(policy: Policy, spec: Spec, max_states: int) -> DataFrame:
    """See `Policy.to_dataframe`."""
    need("pandas", "notebook", "make a table of a policy")
    from pandas import DataFrame, MultiIndex, Series

    own = fitted(policy, spec)
    rows = few_rows(own, max_states, "table")
    names = {chosen: tuple(own.vocabulary.actions[each] for each in sorted(chosen)) for chosen in {*rows.values()}}
    index = MultiIndex.from_tuples(
        [tuple(in_json(spec, state).values()) for state in rows], names=[variable.name for variable in spec.variables]
    )
    actions = Series([names[chosen] for chosen in rows.values()], index=index, dtype=object)
    return DataFrame({"actions": actions, "safe": [is_safe(spec, state) for state in rows]}, index=index)
