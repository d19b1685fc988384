"""The file formats of policies and certificates (`docs/policy.md`): JSON to records, and records to JSON."""

from tumato_symbolic.policy.formats.read import (
    FORMAT_VERSION,
    UNREALIZABLE,
    check_version,
    fields_of,
    policy_fields,
    read_digest,
    read_ordering,
    read_restoration,
    read_vocabulary,
)
from tumato_symbolic.policy.formats.read_diagrams import read_diagram
from tumato_symbolic.policy.formats.write import fits_table, policy_text, variable_entries
from tumato_symbolic.policy.formats.write_diagrams import block, diagram_lines

__all__ = [
    "FORMAT_VERSION",
    "UNREALIZABLE",
    "block",
    "check_version",
    "diagram_lines",
    "fields_of",
    "fits_table",
    "policy_fields",
    "policy_text",
    "read_diagram",
    "read_digest",
    "read_ordering",
    "read_restoration",
    "read_vocabulary",
    "variable_entries",
]
