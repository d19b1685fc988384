"""The methods of the server, and when a text is checked or synthesized; the functions of `editor` answer."""

from __future__ import annotations

import asyncio
import contextlib
import time
from collections.abc import AsyncIterator, Iterator
from functools import partial
from typing import Any
from uuid import uuid4

from lsprotocol import types
from pygls.lsp.server import LanguageServer

import tumato_symbolic
from tumato_symbolic.diagnostics import UserError
from tumato_symbolic.editor import checking, completion, format, hover, mentions, outline, renaming
from tumato_symbolic.editor.answer import Answer
from tumato_symbolic.lsp import translate
from tumato_symbolic.lsp.answering import ask
from tumato_symbolic.lsp.document import Document
from tumato_symbolic.syntax.edits import Edit, whole

TRIGGERS = (" ", ":", ",", "{")
"""Characters after which editors ask for completions by themselves."""


PROMPT = 0.1
"""A text that takes longer to check is checked when the user has paused for as long."""


def make_server(seconds: float) -> Any:  # noqa: ANN401 - a `LanguageServer`; pygls may be missing where types are checked
    """A server that synthesizes what is saved, for so many seconds at most; with 0, it does not."""
    server = LanguageServer("tumato-sym", tumato_symbolic.__version__)
    service = _Service(server, seconds)
    answers: dict[str, tuple[Any, Any]] = {
        types.TEXT_DOCUMENT_DID_OPEN: (service.opened, None),
        types.TEXT_DOCUMENT_DID_CHANGE: (service.changed, None),
        types.TEXT_DOCUMENT_DID_SAVE: (service.saved, None),
        types.TEXT_DOCUMENT_DID_CLOSE: (service.closed, None),
        types.TEXT_DOCUMENT_HOVER: (service.hover, None),
        types.TEXT_DOCUMENT_DEFINITION: (service.definition, None),
        types.TEXT_DOCUMENT_REFERENCES: (service.references, None),
        types.TEXT_DOCUMENT_PREPARE_RENAME: (service.prepare_rename, None),
        types.TEXT_DOCUMENT_RENAME: (service.rename, types.RenameOptions(prepare_provider=True)),
        types.TEXT_DOCUMENT_COMPLETION: (service.complete, types.CompletionOptions(trigger_characters=TRIGGERS)),
        types.TEXT_DOCUMENT_DOCUMENT_SYMBOL: (service.symbols, None),
        types.TEXT_DOCUMENT_CODE_ACTION: (service.actions, types.CodeActionOptions([types.CodeActionKind.QuickFix])),
        types.TEXT_DOCUMENT_FORMATTING: (service.format, None),
        types.TEXT_DOCUMENT_INLAY_HINT: (service.hints, None),
    }
    for name, (method, options) in answers.items():
        server.feature(name, options)(partial(method))
    return server


class _Service:
    """The answers, and what is remembered between them, by document."""

    def __init__(self, server: Any, seconds: float) -> None:  # noqa: ANN401 - see `make_server`
        self._server = server
        self._seconds = seconds
        self._documents: dict[str, Document] = {}
        self._indexes: dict[str, mentions.Index] = {}
        self._answers: dict[str, Answer] = {}
        self._tasks: dict[str, asyncio.Task[None]] = {}
        self._waiting: dict[str, asyncio.TimerHandle] = {}
        self._took = 0.0

    # Documents.

    def opened(self, params: types.DidOpenTextDocumentParams) -> None:
        """Show what is wrong with a text."""
        self._publish(params.text_document.uri, True)

    def changed(self, params: types.DidChangeTextDocumentParams) -> None:
        """Show what is wrong now, as far as that is known at once."""
        uri = params.text_document.uri
        self._forget(uri)
        delay = self._took if self._took > PROMPT else 0.0
        self._waiting[uri] = asyncio.get_running_loop().call_later(delay, self._publish, uri, False)

    def closed(self, params: types.DidCloseTextDocumentParams) -> None:
        """Forget a text."""
        uri = params.text_document.uri
        self._forget(uri)
        self._documents.pop(uri, None)
        self._indexes.pop(uri, None)
        self._server.text_document_publish_diagnostics(types.PublishDiagnosticsParams(uri, []))

    def saved(self, params: types.DidSaveTextDocumentParams) -> None:
        """Show all that is wrong, and begin to synthesize what is right."""
        uri = params.text_document.uri
        self._forget(uri)
        if self._publish(uri, True) and self._seconds:
            self._tasks[uri] = asyncio.ensure_future(self._synthesize(uri))

    async def _synthesize(self, uri: str) -> None:
        """Ask what synthesis says of a text, and show it if that is still the text."""
        asked = self._document(uri)
        async with self._progress(f"synthesizing {asked.source.name}"):
            answer = await ask(asked.source.name, asked.source.text, self._seconds)
        if self._document(uri) is asked:
            self._answers[uri] = answer
            self._publish(uri, True)
            self._refresh()
            said = f"{asked.source.name}: {answer.summary}"
            self._server.window_log_message(types.LogMessageParams(types.MessageType.Info, said))

    def _document(self, uri: str) -> Document:
        shown = self._server.workspace.get_text_document(uri)
        known = self._documents.get(uri)
        if known is None or known.version != shown.version or known.text != shown.source:
            known = Document(uri, shown.source, shown.version, self._server.workspace.position_encoding)
            self._documents[uri] = known
        return known

    def _publish(self, uri: str, thorough: bool) -> bool:
        """Show what is wrong with a text; whether it could be a specification all the same."""
        shown, began = self._document(uri), time.monotonic()
        found = checking.findings(shown.source, thorough)
        self._took = time.monotonic() - began
        told = [translate.diagnostic(shown.positions, each, uri) for each in found]
        answer = self._answers.get(uri)
        if answer is not None:
            told += [translate.failure(shown.positions, each) for each in answer.failures]
        self._server.text_document_publish_diagnostics(types.PublishDiagnosticsParams(uri, told, shown.version))
        return not any(each.severity == "error" for each in found)

    def _forget(self, uri: str) -> None:
        """Nothing more is wanted of an earlier text."""
        waiting = self._waiting.pop(uri, None)
        if waiting is not None:
            waiting.cancel()
        task = self._tasks.pop(uri, None)
        if task is not None:
            task.cancel()
        self._answers.pop(uri, None)

    # Questions.

    def hover(self, params: types.HoverParams) -> types.Hover | None:
        """What a name stands for."""
        shown = self._document(params.text_document.uri)
        text = hover.hover(shown.index, *shown.place(params.position))
        return None if text is None else types.Hover(types.MarkupContent(types.MarkupKind.Markdown, text))

    def definition(self, params: types.DefinitionParams) -> list[types.Location]:
        """Where it is declared."""
        shown = self._document(params.text_document.uri)
        symbols = dict.fromkeys(each.symbol for each in shown.index.at(*shown.place(params.position)))
        spans = dict.fromkeys(span for symbol in symbols for span in shown.index.declarations(symbol))
        return [types.Location(shown.uri, translate.range_of(shown.positions, span)) for span in spans]

    def references(self, params: types.ReferenceParams) -> list[types.Location]:
        """Where it is mentioned."""
        shown = self._document(params.text_document.uri)
        wanted = params.context.include_declaration
        symbols = dict.fromkeys(each.symbol for each in shown.index.at(*shown.place(params.position)))
        found = (each for symbol in symbols for each in shown.index.of_symbol[symbol])
        spans = dict.fromkeys(each.span for each in found if wanted or each.use != "declared")
        return [types.Location(shown.uri, translate.range_of(shown.positions, span)) for span in spans]

    def prepare_rename(self, params: types.PrepareRenameParams) -> types.Range | None:
        """Which name would be changed; None, and a message, where none can be."""
        shown = self._document(params.text_document.uri)
        with self._told():
            span = renaming.renamable(shown.index, *shown.place(params.position))
            return translate.range_of(shown.positions, span)
        return None

    def rename(self, params: types.RenameParams) -> types.WorkspaceEdit | None:
        """Another name, everywhere."""
        shown = self._document(params.text_document.uri)
        with self._told():
            found = renaming.rename(shown.index, *shown.place(params.position), params.new_name)
            return types.WorkspaceEdit({shown.uri: translate.edits(shown.positions, found)})
        return None

    def complete(self, params: types.CompletionParams) -> list[types.CompletionItem]:
        """What may stand there; what is declared is known from the last text that could be read."""
        shown = self._document(params.text_document.uri)
        if shown.index.mentions:
            self._indexes[shown.uri] = shown.index
        known = self._indexes.get(shown.uri, shown.index)
        found = completion.completions(shown.source, known, *shown.place(params.position))
        return [translate.completion(each, rank) for rank, each in enumerate(found)]

    def symbols(self, params: types.DocumentSymbolParams) -> list[types.DocumentSymbol]:
        """The outline."""
        shown = self._document(params.text_document.uri)
        return [translate.symbol(shown.positions, each) for each in outline.outline(shown.source)]

    def actions(self, params: types.CodeActionParams) -> list[types.CodeAction]:
        """Changes that mend what is wrong on some lines, each of which was tried."""
        shown = self._document(params.text_document.uri)
        first, last = params.range.start.line + 1, params.range.end.line + 1
        answer = self._answers.get(shown.uri)
        found = list(checking.fixes(shown.source, first, last))
        if answer is not None and any(first <= each.span.line <= last for each in answer.failures):
            found += answer.repairs
        return [translate.action(shown.positions, each, shown.uri) for each in found]

    def format(self, params: types.DocumentFormattingParams) -> list[types.TextEdit] | None:
        """The layout; None where there are mistakes in the syntax."""
        shown = self._document(params.text_document.uri)
        try:
            text = format.format_text(shown.source)
        except UserError:
            return None
        changed = [Edit(whole(shown.source), text)] if text != shown.source.text else []
        return translate.edits(shown.positions, changed)

    def hints(self, params: types.InlayHintParams) -> list[types.InlayHint]:
        """Counts, once there is an answer."""
        shown = self._document(params.text_document.uri)
        answer = self._answers.get(shown.uri)
        found = answer.hints if answer is not None else ()
        first, last = params.range.start.line + 1, params.range.end.line + 1
        return [translate.hint(shown.positions, each) for each in found if first <= each.line <= last]

    # What is told to the editor.

    @contextlib.contextmanager
    def _told(self) -> Iterator[None]:
        """Tell the user why something cannot be renamed."""
        try:
            yield
        except renaming.CannotRenameError as error:
            said = f"This cannot be renamed: {error}."
            self._server.window_show_message(types.ShowMessageParams(types.MessageType.Warning, said))

    def _refresh(self) -> None:
        """Have the editor ask for hints again, if it can be told."""
        workspace = self._server.client_capabilities.workspace
        hints = workspace.inlay_hint if workspace is not None else None
        if hints is not None and hints.refresh_support:
            self._server.workspace_inlay_hint_refresh(None)

    @contextlib.asynccontextmanager
    async def _progress(self, title: str) -> AsyncIterator[None]:
        """Show that work goes on, where the editor can; who cancels it there cancels the task that is in here."""
        window = self._server.client_capabilities.window
        task = asyncio.current_task()
        if window is None or not window.work_done_progress or task is None:
            yield
            return
        token, work = str(uuid4()), self._server.work_done_progress
        await work.create_async(token)
        work.begin(token, types.WorkDoneProgressBegin(title, cancellable=True))
        work.tokens[token].add_done_callback(lambda done: task.cancel() if done.cancelled() else None)
        try:
            yield
        finally:
            work.end(token, types.WorkDoneProgressEnd())
