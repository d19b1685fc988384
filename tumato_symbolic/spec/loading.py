"""From a source text to a specification, with all diagnostics in the order of the text."""

from __future__ import annotations

import re
from collections.abc import Iterable

from msgspec import Struct

from tumato_symbolic.diagnostics import Diagnostic, Source, not_allowed
from tumato_symbolic.diagnostics.copies import merged
from tumato_symbolic.spec.collector import MAX_FINDINGS, Findings
from tumato_symbolic.spec.lint import lint
from tumato_symbolic.spec.resolve import resolve
from tumato_symbolic.spec.specification import Spec
from tumato_symbolic.syntax import parse


class Loaded(Struct, frozen=True):
    """A specification, None where there is an error, and what there is to say in the order of the text."""

    spec: Spec | None
    diagnostics: tuple[Diagnostic, ...]


def load(source: Source) -> Loaded:
    """Parse, resolve and lint. Several mistakes are all reported; a mistake of the user never raises."""
    parsed = parse(source)
    findings = Findings()
    tree = parsed.tree
    if tree is not None and _MAY_COPY.search(source.text):
        from tumato_symbolic.spec.copies import copies_in, written_out

        tree = None if parsed.diagnostics and copies_in(tree) else written_out(tree, findings, parsed.lost)
    if tree is None:
        return Loaded(None, _ordered((*parsed.diagnostics, *findings.diagnostics), findings))
    resolution = resolve(parsed, tree, source, findings)
    warnings = () if resolution.spec is None else lint(resolution.spec, tree, resolution)[:MAX_FINDINGS]
    found = not_allowed((*parsed.diagnostics, *resolution.diagnostics, *warnings), source)
    return Loaded(resolution.spec, _ordered(found, findings))


_MAY_COPY = re.compile(r"\{|\b(?:for|all|some|exactly)\b")
"""Without one of these, a text has neither copies nor quantifiers."""


def _ordered(diagnostics: Iterable[Diagnostic], findings: Findings) -> tuple[Diagnostic, ...]:
    told = merged(diagnostics, findings.copies)
    return tuple(sorted(told, key=lambda each: (each.span.line, each.span.column) if each.span else (0, 0)))
