"""Messages for users: codes, spans, rendering."""

from tumato_symbolic.diagnostics.allowing import allowed_on, not_allowed
from tumato_symbolic.diagnostics.codes import Code, Severity
from tumato_symbolic.diagnostics.diagnostic import CopySpan, Diagnostic, Note, Source, Span, UserError
from tumato_symbolic.diagnostics.render import render
