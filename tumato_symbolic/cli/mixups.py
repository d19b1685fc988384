"""Files that stand where the other kind belongs: a policy for a specification, or the two the wrong way round."""

from __future__ import annotations

import re
import shlex
from collections.abc import Sequence
from pathlib import Path
from typing import Literal

from tumato_symbolic.cli.options import CommandOptions
from tumato_symbolic.diagnostics import Code, Diagnostic, UserError
from tumato_symbolic.diagnostics.wording import quoted

Kind = Literal["specification", "policy", "certificate", "JSON file"]

_LOOKED_AT = 100_000
"""Bytes at the beginning of a file that tell its kind."""

_BLOCK = re.compile(rb"\bBEGIN\s+[A-Z]")
_PAGE = re.compile(rb"\s*<!DOCTYPE html", re.IGNORECASE)
_CERTIFICATE = re.compile(rb'"Type"\s*:\s*"unrealizable"')
_POLICY = re.compile(rb'"PolicyFrameworkVersion"|"Type"\s*:\s*"policy')


def recognized(error: UserError, options: CommandOptions, typed: Sequence[str]) -> UserError:
    """That an input is of the other kind, if it is, else what `error` says. `typed` are the words of the command."""
    policy, first = options.policy, next(iter(options.specs), "")
    found = [kind_of(spec) for spec in options.specs]
    kind = kind_of(policy) if policy else None
    if kind == "specification" and found and found[0] in ("policy", "certificate"):
        message = f"{quoted(policy)} is a specification and {quoted(first)} a {found[0]}: swap them"
        return _fault(message, _swapped(typed, policy, first))
    if kind == "specification":
        help_ = f"`tumato-sym synth {shlex.quote(policy)} -o FILE` makes a policy"
        return _fault(f"{quoted(policy)} is a specification, but a policy belongs here", help_)
    for name, kind in zip(options.specs, found, strict=True):
        other = _no_specification(name, kind)
        if other is not None:
            return UserError((other,))
    return error


def misplaced(name: str) -> Diagnostic | None:
    """That the file `name` is of another kind, where a specification belongs; None where it may be one."""
    return _no_specification(name, kind_of(name))


def _no_specification(name: str, kind: Kind | None) -> Diagnostic | None:
    if kind in (None, "specification"):
        return None
    help_ = f"`tumato-sym verify {shlex.quote(name)} SPEC` proves it"
    if kind == "JSON file":
        help_ = "a specification is a text of blocks, such as `BEGIN STATE VECTOR` … `END STATE VECTOR`"
    return Diagnostic(Code.TUM501, f"{quoted(name)} is a {kind}, but a specification belongs here", help=help_)


def _fault(message: str, help_: str) -> UserError:
    return UserError((Diagnostic(Code.TUM501, message, help=help_),))


def _swapped(typed: Sequence[str], one: str, other: str) -> str:
    """The command with its files the right way round."""
    places = {one: other, other: one}
    return f"say `tumato-sym {shlex.join(places.get(word, word) for word in typed)}`"


def kind_of(name: str) -> Kind | None:
    """What a file seems to be; None where that cannot be told."""
    try:
        path = Path(name)
        if not path.is_file():
            return None
        with path.open("rb") as file:
            head = file.read(_LOOKED_AT)
    except (OSError, ValueError):
        return None
    if head.removeprefix(b"\xef\xbb\xbf").lstrip().startswith((b"{", b"[")):
        return "certificate" if _CERTIFICATE.search(head) else "policy" if _POLICY.search(head) else "JSON file"
    return "specification" if _BLOCK.search(head) and not _PAGE.match(head) else None
