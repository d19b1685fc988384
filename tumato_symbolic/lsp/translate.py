"""Records of `editor` as messages of the protocol: positions, severities, kinds of names."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final

from lsprotocol import types

from tumato_symbolic.diagnostics import Diagnostic, Span
from tumato_symbolic.editor.answer import Failure, Hint
from tumato_symbolic.editor.checking import Fix
from tumato_symbolic.editor.completion import Completion
from tumato_symbolic.editor.outline import Entry
from tumato_symbolic.editor.positions import Position, Positions
from tumato_symbolic.syntax.edits import Edit

_SEVERITIES: Final = {
    "error": types.DiagnosticSeverity.Error,
    "warning": types.DiagnosticSeverity.Warning,
    "remark": types.DiagnosticSeverity.Information,
}
_COMPLETIONS: Final = {
    "state variable": types.CompletionItemKind.Variable,
    "value": types.CompletionItemKind.EnumMember,
    "alias": types.CompletionItemKind.Function,
    "named list": types.CompletionItemKind.Enum,
    "resource": types.CompletionItemKind.Unit,
    "action": types.CompletionItemKind.Method,
    "keyword": types.CompletionItemKind.Keyword,
}
_SYMBOLS: Final = {
    "block": types.SymbolKind.Namespace,
    "copies": types.SymbolKind.Array,
    "state variable": types.SymbolKind.Variable,
    "alias": types.SymbolKind.Function,
    "named list": types.SymbolKind.Enum,
    "resource": types.SymbolKind.Object,
    "action": types.SymbolKind.Method,
    "rule": types.SymbolKind.Boolean,
    "goal": types.SymbolKind.Event,
}


def range_of(positions: Positions, span: Span) -> types.Range:
    """A span."""
    return types.Range(*(_position(each) for each in positions.range(span)))


def _position(position: Position) -> types.Position:
    return types.Position(position.line, position.character)


def diagnostic(positions: Positions, found: Diagnostic, uri: str) -> types.Diagnostic:
    """A finding, with its way out in the message; one without a place is shown at the beginning."""
    message = found.message if found.help is None else f"{found.message}\n{found.help}"
    related = [
        types.DiagnosticRelatedInformation(types.Location(uri, range_of(positions, note.span)), note.message)
        for note in found.notes
    ]
    return types.Diagnostic(
        range_of(positions, found.span or Span(1, 1, 1, 1)),
        message,
        _SEVERITIES[found.severity],
        found.code.name,
        source="tumato-sym",
        related_information=related or None,
    )


def failure(positions: Positions, found: Failure) -> types.Diagnostic:
    """States without a policy."""
    where = range_of(positions, found.span)
    return types.Diagnostic(where, found.message, types.DiagnosticSeverity.Error, found.code, source="tumato-sym synth")


def edits(positions: Positions, found: Iterable[Edit]) -> list[types.TextEdit]:
    """Changes of one text."""
    return [types.TextEdit(range_of(positions, each.span), each.text) for each in found]


def completion(found: Completion, rank: int) -> types.CompletionItem:
    """A text that fits; editors sort by `sort_text`, and are to keep our order."""
    return types.CompletionItem(
        found.text, kind=_COMPLETIONS[found.kind], detail=found.kind, sort_text=f"{rank:05}", insert_text=found.text
    )


def symbol(positions: Positions, entry: Entry) -> types.DocumentSymbol:
    """An entry of the outline, with what is in it."""
    return types.DocumentSymbol(
        entry.name,
        _SYMBOLS[entry.kind],
        range_of(positions, entry.span),
        range_of(positions, entry.name_span),
        children=[symbol(positions, each) for each in entry.entries],
    )


def hint(positions: Positions, found: Hint) -> types.InlayHint:
    """A count at the end of a line."""
    return types.InlayHint(_position(positions.position(found.line, found.column)), found.text, padding_left=True)


def action(positions: Positions, fix: Fix, uri: str) -> types.CodeAction:
    """A change that a user may choose."""
    mended = [diagnostic(positions, fix.diagnostic, uri)] if fix.diagnostic is not None else None
    edit = types.WorkspaceEdit({uri: edits(positions, fix.edits)})
    return types.CodeAction(fix.title, types.CodeActionKind.QuickFix, mended, edit=edit)
