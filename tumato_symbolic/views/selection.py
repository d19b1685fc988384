"""Which part of a policy is looked at: some values of variables, and actions that are executed."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import suppress
from typing import NoReturn

from msgspec import Struct

from tumato_symbolic.diagnostics import Code, Diagnostic, UserError
from tumato_symbolic.diagnostics.wording import listed, nearest, quoted
from tumato_symbolic.policy import Vocabulary


class Selection(Struct, frozen=True):
    """The states in which variables have one of the `values` given, by name, and all actions of `executing` start.

    Both come in the order of declaration; a variable that may have any of its values is not there.
    """

    values: tuple[tuple[str, tuple[str, ...]], ...] = ()
    executing: tuple[str, ...] = ()


def parse_selection(vocabulary: Vocabulary, words: Sequence[str], executing: str = "") -> Selection:
    """What `VAR=VALUE`, `VAR=VALUE,VALUE`, `VAR!=VALUE` and a list of actions select together.

    Raises `UserError` (TUM503, TUM504, TUM505, TUM509) where they name what is not there, or nothing can be selected.
    """
    known = dict(vocabulary.variables)
    chosen: dict[str, set[str]] = {}
    problems: list[Diagnostic] = []
    for word in words:
        try:
            name, values = _allowed(vocabulary, word)
        except UserError as error:
            problems += error.diagnostics
        else:
            chosen[name] = chosen.get(name, set(known[name])) & values
    for name, values in chosen.items():
        if not values:
            message = f"no value is left for {quoted(name)}"
            problems.append(Diagnostic(Code.TUM509, message, help=f"its values: {listed(known[name])}"))
    actions = {name.strip() for name in executing.split(",") if name.strip()}
    problems += _unknown(vocabulary, sorted(actions))
    if problems:
        raise UserError(tuple(problems))
    return Selection(
        tuple(
            (name, tuple(value for value in values if value in chosen[name]))
            for name, values in vocabulary.variables
            if name in chosen and len(chosen[name]) < len(values)
        ),
        tuple(name for name in vocabulary.actions if name in actions),
    )


def _allowed(vocabulary: Vocabulary, word: str) -> tuple[str, set[str]]:
    """The variable of a word, and the values that it may have."""
    name, equals, text = word.partition("=")
    if not equals:
        _no_selection(vocabulary, word)
    excluding = name.rstrip().endswith("!")
    name, text = name.rstrip().removesuffix("!").strip(), text.strip()
    values = dict(vocabulary.variables).get(name, ())
    named = [text] if text in values else [each.strip() for each in text.split(",")]
    problems: list[Diagnostic] = []
    from tumato_symbolic.policy import parse_assignments

    for each in named:
        try:
            parse_assignments(vocabulary, [f"{name}={each}"], whole=False)
        except UserError as error:
            problems += [found for found in error.diagnostics if found not in problems]
    if problems:
        raise UserError(tuple(problems))
    return name, set(values) - set(named) if excluding else set(named)


def _no_selection(vocabulary: Vocabulary, word: str) -> NoReturn:
    """Raise what is wrong with a word without `=`."""
    known = dict(vocabulary.variables)
    help_ = "write VARIABLE=VALUE, or name a specification that exists"
    with suppress(KeyError):
        help_ = f"write {word}={known[word][0]}, or another of its values: {listed(known[word])}"
    raise UserError((Diagnostic(Code.TUM509, f"{quoted(word)} is not of the form VARIABLE=VALUE", help=help_),))


def _unknown(vocabulary: Vocabulary, actions: Sequence[str]) -> Iterator[Diagnostic]:
    for name in actions:
        if name not in vocabulary.actions:
            similar = nearest(name, vocabulary.actions)
            help_ = f"did you mean {quoted(similar)}?" if similar else f"its actions: {listed(vocabulary.actions)}"
            yield Diagnostic(Code.TUM505, f"the policy has no action {quoted(name)}", help=help_)
