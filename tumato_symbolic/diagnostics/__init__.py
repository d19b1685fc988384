"""Messages for users: codes, spans, rendering."""

from tumato_symbolic.diagnostics.codes import Code
from tumato_symbolic.diagnostics.diagnostic import CopySpan, Diagnostic, Note, Severity, Source, Span, UserError
from tumato_symbolic.diagnostics.render import render

__all__ = ["Code", "CopySpan", "Diagnostic", "Note", "Severity", "Source", "Span", "UserError", "render"]
