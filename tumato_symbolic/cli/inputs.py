"""Reading a specification, and a policy for it, for the commands that need usable ones."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING

from msgspec.structs import replace

from tumato_symbolic.cli.console import note, wants_colour
from tumato_symbolic.cli.options import CommandOptions
from tumato_symbolic.diagnostics import Diagnostic, Source, UserError, render
from tumato_symbolic.spec import Restoration, Spec, load
from tumato_symbolic.syntax import read_source

if TYPE_CHECKING:
    from tumato_symbolic.limits import Context
    from tumato_symbolic.policy import Policy


def read_spec(path: str, restoration: Restoration | None = None) -> tuple[Source, Spec, tuple[Diagnostic, ...]]:
    """The text, the specification and its warnings; `restoration` overrules what the text says of it.

    Remarks are for those who ask for them with `check`. Raises `UserError` where there are errors.
    """
    source = read_source(path)
    loaded = load(source)
    if loaded.spec is None:
        raise UserError(loaded.diagnostics, source)
    spec = loaded.spec if restoration is None else replace(loaded.spec, restoration=restoration)
    return source, spec, tuple(each for each in loaded.diagnostics if each.severity != "remark")


def read_policy(
    options: CommandOptions, restoration: Restoration | None, context: Context, fit: Callable[[Policy, Spec], Policy]
) -> tuple[Source, Spec, Policy]:
    """The text, the specification, and the policy as `fit` makes it fit. Raises `UserError` where it does not."""
    from tumato_symbolic.policy import Policy

    context.tell("reading the specification")
    source, spec, _ = read_spec(options.specs[0], restoration)
    context.tell(f"reading {options.policy}")
    policy = Policy.load(options.policy)
    with errors_in(source):
        return source, spec, fit(policy, spec)


@contextmanager
def errors_in(source: Source) -> Iterator[None]:
    """Let errors of later stages that point into the specification say in which file that is."""
    try:
        yield
    except UserError as error:
        if error.source is None and any(diagnostic.span for diagnostic in error.diagnostics):
            raise UserError(error.diagnostics, source) from None
        raise


def show_warnings(warnings: Sequence[Diagnostic], source: Source, options: CommandOptions) -> None:
    """Warnings for a person, ahead of the report; the other formats carry them inside."""
    if warnings and options.output_format == "text":
        note(render(tuple(warnings), source, color=wants_colour(sys.stderr)))
