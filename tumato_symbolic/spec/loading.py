"""From a source text to a specification, with everything there is to say about it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from tumato_symbolic.diagnostics import Diagnostic, Source
from tumato_symbolic.spec.collector import MAX_FINDINGS
from tumato_symbolic.spec.lint import lint
from tumato_symbolic.spec.resolve import resolve
from tumato_symbolic.spec.specification import Spec
from tumato_symbolic.syntax import parse


@dataclass(frozen=True, slots=True)
class Loaded:
    """A specification, None where there is an error, and the errors and warnings in the order of the text."""

    spec: Spec | None
    diagnostics: tuple[Diagnostic, ...]


def load(source: Source) -> Loaded:
    """Parse, resolve and lint. Several mistakes are all reported; a mistake of the user never raises."""
    parsed = parse(source)
    if parsed.tree is None:
        return Loaded(None, _ordered(parsed.diagnostics))
    resolution = resolve(parsed, parsed.tree, source)
    warnings = () if resolution.spec is None else lint(resolution.spec, parsed.tree, resolution)[:MAX_FINDINGS]
    return Loaded(resolution.spec, _ordered((*parsed.diagnostics, *resolution.diagnostics, *warnings)))


def _ordered(diagnostics: Iterable[Diagnostic]) -> tuple[Diagnostic, ...]:
    return tuple(sorted(diagnostics, key=lambda each: (each.span.line, each.span.column) if each.span else (0, 0)))
