"""The file formats of policies and certificates (`docs/policy.md`): tables of fields, and what is derived from them."""

from tumato_symbolic.policy.formats.policies import FILES, UNREALIZABLE, fields_of, policy_fields, policy_text
from tumato_symbolic.policy.formats.rows import fits_table
