"""Messages for users: codes, spans, rendering."""

from tumato_symbolic.diagnostics.codes import Code
from tumato_symbolic.diagnostics.diagnostic import Diagnostic, Note, Severity, Source, Span, UserError
from tumato_symbolic.diagnostics.render import render

__all__ = ["Code", "Diagnostic", "Note", "Severity", "Source", "Span", "UserError", "render"]
