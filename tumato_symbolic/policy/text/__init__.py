"""Texts in and out: files, strict JSON, and how this room says what is wrong. Knows nothing of policies."""

from tumato_symbolic.policy.text.messages import MOST, described, fault, show, way_out
from tumato_symbolic.policy.text.reading import read_text
from tumato_symbolic.policy.text.rows import Row
from tumato_symbolic.policy.text.saving import save_text
from tumato_symbolic.policy.text.strict_json import (
    MAX_BYTES,
    as_list,
    as_names,
    as_object,
    as_text,
    as_value,
    as_whole,
    member,
    parse_json,
    too_large,
    wrong,
)
