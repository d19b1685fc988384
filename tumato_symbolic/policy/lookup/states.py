"""A state as it is given from outside: by name, as words, as a line of JSON."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from itertools import islice
from typing import cast

from tumato_symbolic.diagnostics import Code, Diagnostic, UserError
from tumato_symbolic.diagnostics.wording import listed
from tumato_symbolic.policy.records import Vocabulary
from tumato_symbolic.policy.text import MOST, as_object, as_value, fault, parse_json, show, way_out
from tumato_symbolic.spec import Value, text_of, value_of


def check_state(vocabulary: Vocabulary, state: Mapping[str, Value]) -> dict[str, str]:
    """The values of a state as the policy names them; a number may be given as a number or as its digits.

    Raises `UserError` with what keeps `state` from being one of the policy's states (TUM503, TUM504, TUM509).
    """
    if not isinstance(state, Mapping):
        example = {name: values[0] for name, values in vocabulary.variables[:2]}
        message = f"a state maps every variable to its value, and is not of type {type(state).__name__}"
        raise fault(Code.TUM509, message, f"such as {example}")
    named = {name: text_of(value) for name, value in state.items()}
    problems = tuple(islice(_problems(vocabulary, named), MOST))
    if problems:
        raise UserError(problems)
    return cast("dict[str, str]", named)


def _problems(vocabulary: Vocabulary, state: Mapping[str, object], whole: bool = True) -> Iterator[Diagnostic]:
    known = dict(vocabulary.variables)
    for name, value in state.items():
        if name not in known:
            message = f"the policy has no variable {show(name)}"
            if not isinstance(name, str):
                message = f"{show(name)} is not the name of a variable"
            yield Diagnostic(Code.TUM503, message, help=way_out(name, known, "variables"))
        elif not isinstance(value, str):
            message = f"the value of {show(name)} is {show(value)}"
            yield Diagnostic(Code.TUM504, message, help=f"its values: {listed(known[name])}")
        elif value not in known[name]:
            message = f"{show(name)} has no value {show(value)}"
            yield Diagnostic(Code.TUM504, message, help=way_out(value, known[name], "values"))
    for name, values in known.items():
        if whole and name not in state:
            yield Diagnostic(Code.TUM503, f"{show(name)} has no value", help=f"its values: {listed(values)}")


def parse_assignments(vocabulary: Vocabulary, words: Sequence[str], *, whole: bool = True) -> dict[str, str]:
    """The state that words such as `S_Location=corridor` describe; where it need not be `whole`, a part of one.

    Raises `UserError` (TUM503, TUM504, TUM509) where they do not give every variable exactly one of its values.
    """
    state: dict[str, str] = {}
    problems = []
    for word in words:
        name, equals, value = word.partition("=")
        name, value = name.strip(), value.strip()
        if not equals:
            problems.append(Diagnostic(Code.TUM509, f"{show(word)} is not of the form VARIABLE=VALUE"))
        elif state.setdefault(name, value) != value:
            message = f"{show(name)} is given two values, {show(state[name])} and {show(value)}"
            problems.append(Diagnostic(Code.TUM509, message))
    problems.extend(islice(_problems(vocabulary, state, whole), MOST))
    if problems:
        raise UserError(tuple(problems[:MOST]))
    return state


def parse_state(vocabulary: Vocabulary, line: str) -> dict[str, str]:
    """The state that one JSON object such as `{"S_Location": "corridor", "S_Level": 3}` describes.

    Raises `UserError` (TUM503, TUM504, TUM509) like `parse_assignments`.
    """
    try:
        section = as_object(parse_json(line, "state"), "the state")
        state = {name: as_value(value, f"the value of {show(name)}") for name, value in section.items()}
    except UserError as error:
        message = error.diagnostics[0].message
        example = json.dumps({name: value_of(values[0]) for name, values in vocabulary.variables[:2]})
        raise fault(Code.TUM509, f"the line is not a state: {message}", f"write one like {example}") from None
    return check_state(vocabulary, state)
