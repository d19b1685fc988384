"""The JSON Schemas of policies and certificates, from the tables by which they are read and written."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import tumato_symbolic.policy
from tumato_symbolic.policy.formats import FILES
from tumato_symbolic.policy.formats.diagrams import NODES, ORDER
from tumato_symbolic.policy.formats.kinds import STATE, TEXTS
from tumato_symbolic.policy.guarantees import FILE as GUARANTEES
from tumato_symbolic.policy.unrealizability import FILE as UNREALIZABILITY

FOLDER = Path(tumato_symbolic.policy.__file__).parent

SHARED = {"order": ORDER, "nodes": NODES, "assignment": STATE.schema, "names": TEXTS.schema}
"""What is described once, and referred to."""

WIDTH = 90
"""Columns that a value may take on one line."""


def schemas() -> Iterator[tuple[Path, str]]:
    """Each schema file, and what it should hold."""
    yield _file("policy", "Tumato policy", _ABOUT_POLICIES, _policy())
    yield _file("unrealizable", "Tumato certificate of unrealizability", _ABOUT_UNREALIZABILITY, UNREALIZABILITY.schema)
    yield _file("guarantees", "What a policy guarantees", _ABOUT_GUARANTEES, GUARANTEES.schema)


_ABOUT_POLICIES = (
    'What to do in every valid state: as a table (Type "policy", as Tumato 2.0 writes it) or as a decision diagram '
    '(Type "policy-diagram"). docs/policy.md says what the parts mean and what a schema cannot express.'
)
_ABOUT_UNREALIZABILITY = (
    "Why a specification has no policy. docs/certificate.md says what the parts claim, how they are checked, and what "
    "a schema cannot express."
)
_ABOUT_GUARANTEES = (
    "A certificate of what a policy guarantees beyond nominal runs. docs/certificate.md says what the parts mean and "
    "what a schema cannot express."
)


def _policy() -> dict[str, Any]:
    """The keys of both forms; each form has its own decisions, and not those of the other."""
    properties: dict[str, Any] = {}
    forms, bodies = [], [body for _, body in FILES.values()]
    for word, (table, body) in FILES.items():
        found, required = table.describe()
        properties = {**found, **properties, "Type": {"enum": list(FILES)}}
        others = {other: False for other in bodies if other != body}
        forms.append({"properties": {"Type": {"const": word}, **others}, "required": [body]})
        common = [key for key in required if key not in bodies]
    return {"type": "object", "required": common, "properties": properties, "oneOf": forms}


def _file(name: str, title: str, about: str, schema: dict[str, Any]) -> tuple[Path, str]:
    head = {"$schema": "https://json-schema.org/draft/2020-12/schema", "title": title, "description": about}
    body = _shared(schema)
    definitions = {key: _shared(value, key) for key, value in SHARED.items()}
    used = json.dumps([body, definitions])
    definitions = {key: value for key, value in definitions.items() if f'#/$defs/{key}"' in used}
    whole = {**head, **body, "$defs": definitions}
    return FOLDER / f"{name}.schema.json", f"{_text(whole, '')}\n"


def _shared(schema: Any, defined: str = "") -> Any:
    """A schema with references to what is described once; the one that is being `defined` stands as it is."""
    if isinstance(schema, dict):
        for name, each in SHARED.items():
            if name != defined and schema.items() >= each.items():
                rest = {key: value for key, value in schema.items() if key not in each}
                return {**rest, "$ref": f"#/$defs/{name}"}
        return {key: _shared(value) for key, value in schema.items()}
    return [_shared(each) for each in schema] if isinstance(schema, list) else schema


def _text(value: Any, indent: str) -> str:
    """JSON on one line where it fits, otherwise with a line for each entry."""
    short = json.dumps(value, ensure_ascii=False)
    if not isinstance(value, dict | list) or len(indent) + len(short) <= WIDTH:
        return short
    deeper = f"{indent}  "
    opening, closing = "{}" if isinstance(value, dict) else "[]"
    entries = (
        [f"{json.dumps(key)}: {_text(each, deeper)}" for key, each in value.items()]
        if isinstance(value, dict)
        else [_text(each, deeper) for each in value]
    )
    return f"{opening}\n{deeper}" + f",\n{deeper}".join(entries) + f"\n{indent}{closing}"
