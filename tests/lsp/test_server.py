"""Each feature of the language server, asked by a client over the standard streams."""

import sys
from collections.abc import AsyncIterator
from typing import Any

import pytest

from tests.cli.inputs import NO_PLAN

pytest_lsp = pytest.importorskip("pytest_lsp", exc_type=ImportError)
from lsprotocol import types  # noqa: E402 - skipped without it
from pytest_lsp import LanguageClient  # noqa: E402

URI = "file:///tmp/lamp.tum"
LAMP = """\
// 𝒮 a lamp
BEGIN STATE VECTOR
state S_Lamp can be on, off
END STATE VECTOR
BEGIN ACTIONS
action press
  nominal effects: S_Lamp is on
END ACTIONS
BEGIN STATE RULES
/* 𝒮 */ rule: S_Lmp is on OR S_Lamp is off
END STATE RULES
BEGIN GOALS
goal type: priority
goal: S_Lamp is on
END GOALS
"""
RIGHT = LAMP.replace("S_Lmp", "S_Lamp")
DOCUMENT = types.TextDocumentIdentifier(URI)


@pytest_lsp.fixture(  # type: ignore[untyped-decorator]
    scope="module",
    config=pytest_lsp.ClientServerConfig(server_command=[sys.executable, "-m", "tumato_symbolic", "lsp"]),
)
async def client(lsp_client: LanguageClient) -> AsyncIterator[None]:
    """A client whose server runs."""
    await lsp_client.initialize_session(types.InitializeParams(capabilities=types.ClientCapabilities()))
    yield
    await lsp_client.shutdown_session()


async def _shown(client: Any, text: str) -> list[types.Diagnostic]:
    """What is said of a text when it is opened."""
    client.text_document_did_open(types.DidOpenTextDocumentParams(types.TextDocumentItem(URI, "tumato", 1, text)))
    await client.wait_for_notification("textDocument/publishDiagnostics")
    return list(client.diagnostics[URI])


def _place(text: str, piece: str) -> types.Position:
    """Where a piece of a text begins."""
    before = text[: text.index(piece)]
    return types.Position(before.count("\n"), len(before.rpartition("\n")[2].encode("utf-16-le")) // 2)


def _cut(text: str, where: types.Range) -> str:
    """The text in a range of one line."""
    line = text.split("\n")[where.start.line].encode("utf-16-le")
    return str(line[2 * where.start.character : 2 * where.end.character].decode("utf-16-le"))


@pytest.mark.asyncio(loop_scope="module")
async def test_mistakes_as_one_types(client: Any) -> None:
    """Each is told at its place, in UTF-16, and what is corrected is no longer told; a fix is offered."""
    (found,) = await _shown(client, LAMP)
    assert (found.code, _cut(LAMP, found.range)) == ("TUM201", "S_Lmp")
    context = types.CodeActionContext([])
    (action,) = await client.text_document_code_action_async(types.CodeActionParams(DOCUMENT, found.range, context))
    (edit,) = action.edit.changes[URI]
    assert (action.title, edit.new_text, edit.range) == ("Change to `S_Lamp`", "S_Lamp", found.range)
    change = types.TextDocumentContentChangePartial(edit.range, edit.new_text)
    client.text_document_did_change(
        types.DidChangeTextDocumentParams(types.VersionedTextDocumentIdentifier(2, URI), [change])
    )
    await client.wait_for_notification("textDocument/publishDiagnostics")
    assert not [each for each in client.diagnostics[URI] if each.severity == types.DiagnosticSeverity.Error]


@pytest.mark.asyncio(loop_scope="module")
async def test_names(client: Any) -> None:
    """Hover, definition, references, rename."""
    await _shown(client, RIGHT)
    here = _place(RIGHT, "S_Lamp is off")
    hover = await client.text_document_hover_async(types.HoverParams(DOCUMENT, here))
    assert "written by action `press`" in hover.contents.value
    (declared,) = await client.text_document_definition_async(types.DefinitionParams(DOCUMENT, here))
    assert declared.range.start == _place(RIGHT, "S_Lamp can")
    context = types.ReferenceContext(include_declaration=True)
    found = await client.text_document_references_async(types.ReferenceParams(context, DOCUMENT, here))
    assert len(found) == 5
    assert {_cut(RIGHT, each.range) for each in found} == {"S_Lamp"}
    name = await client.text_document_prepare_rename_async(types.PrepareRenameParams(DOCUMENT, here))
    assert name.start == here
    edit = await client.text_document_rename_async(types.RenameParams(DOCUMENT, here, "S_Light"))
    assert len(edit.changes[URI]) == 5


@pytest.mark.asyncio(loop_scope="module")
async def test_text(client: Any) -> None:
    """Completion, outline, layout."""
    await _shown(client, RIGHT)
    here = _place(RIGHT, "off\nEND STATE RULES")
    items = await client.text_document_completion_async(types.CompletionParams(DOCUMENT, here))
    assert [item.label for item in items] == ["on", "off", "not"]
    symbols = await client.text_document_document_symbol_async(types.DocumentSymbolParams(DOCUMENT))
    assert [each.name for each in symbols] == ["STATE VECTOR", "ACTIONS", "STATE RULES", "GOALS"]
    assert [each.name for each in symbols[1].children] == ["press"]
    options = types.FormattingOptions(tab_size=2, insert_spaces=True)
    (edit,) = await client.text_document_formatting_async(types.DocumentFormattingParams(DOCUMENT, options))
    assert "off\nEND STATE VECTOR\n\nBEGIN ACTIONS\n" in edit.new_text


@pytest.mark.asyncio(loop_scope="module")
async def test_synthesis_on_save(client: Any) -> None:
    """Counts as hints, failing states as a diagnostic, repairs as actions."""
    await _shown(client, NO_PLAN)
    client.text_document_did_save(types.DidSaveTextDocumentParams(DOCUMENT))
    await client.wait_for_notification("window/logMessage")
    everywhere = types.Range(types.Position(0, 0), types.Position(99, 0))
    hints = await client.text_document_inlay_hint_async(types.InlayHintParams(DOCUMENT, everywhere))
    assert [each.label for each in hints] == ["2 states", "1 action", "no policy"]
    (failure,) = [each for each in client.diagnostics[URI] if each.code == "TUM402"]
    context = types.CodeActionContext([failure])
    found = await client.text_document_code_action_async(types.CodeActionParams(DOCUMENT, failure.range, context))
    assert any("preconditions" in each.title for each in found)
