"""Policies and results in notebooks: as HTML, as tables of pandas, as graphs of networkx."""

from tumato_symbolic.notebook.failing import failing_html
from tumato_symbolic.notebook.graphs import to_networkx
from tumato_symbolic.notebook.markup import Tone, panel, table
from tumato_symbolic.notebook.policies import policy_html, rules_html
from tumato_symbolic.notebook.tables import to_dataframe
