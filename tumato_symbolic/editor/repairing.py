"""Repairs as edits of the text that a user has before them: which are offered, and where lines are added."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from tumato_symbolic.diagnostics import CopySpan, Source, Span
from tumato_symbolic.editor.checking import Fix
from tumato_symbolic.explain.additions import Addition, NewAction, NoGoalWhile, Setting
from tumato_symbolic.explain.elements import span_of
from tumato_symbolic.explain.explanation import Change, Repair
from tumato_symbolic.report.element_roles import declared
from tumato_symbolic.report.possible_changes import added_lines, controlled
from tumato_symbolic.spec import Spec
from tumato_symbolic.syntax import ast, parse
from tumato_symbolic.syntax.edits import Edit
from tumato_symbolic.syntax.leaving_out import is_after, places_of, without_entry, without_line, without_member
from tumato_symbolic.syntax.parser import read_terminals

NEW_ACTION = "new_action"
"""The name of an action that is added."""

_FOR_YOU = "whether it is safe is for you to judge"


def repair_edits(source: Source, spec: Spec, repair: Repair) -> Fix | None:
    """A repair as a fix; None where it is about copies, or about what cannot be said in a small edit."""
    edits = list[Edit]()
    titles = list[str]()
    for addition in repair.additions:
        edit = _added(source, spec, addition)
        if edit is None:
            return None
        edits.append(edit)
        capable = ", if the robot can do it" if isinstance(addition, NewAction) else ""
        titles.append(f"add `{'; '.join(line.strip() for line in edit.text.strip().splitlines())}`{capable}")
    for change in repair.changes:
        edit = _changed(source, spec, change)
        if edit is None:
            return None
        edits.append(edit)
        old = declared(spec, change.element)
        new = "" if change.text is None else declared(spec, change.element, change.text)
        titles.append(f"change `{old}` to `{new}`" if new else f"drop `{old}`")
    taken = ", ".join(spec.variables[variable].name for variable in sorted(controlled(spec, repair)))
    remark = f"no action controls {taken}; {_FOR_YOU}" if taken else _FOR_YOU
    return Fix(f"Repair: {', '.join(titles)} ({remark})", tuple(edits)) if edits else None


def _changed(source: Source, spec: Spec, change: Change) -> Edit | None:
    """The edit for one line."""
    element, span = change.element, span_of(spec, change.element)
    if span is None or isinstance(span, CopySpan):
        return None
    if element.kind == "plan-bound":
        return (
            Edit(span, declared(spec, element, change.text))
            if change.text is not None
            else without_line(source.text.split("\n"), span)
        )
    if element.kind == "resource":
        return None
    if change.text is not None:
        return Edit(span, change.text)
    _, tokens, _ = read_terminals(source)
    first = places_of(tokens).get((span.line, span.column))
    if first is None:
        return None
    if element.kind == "precondition":
        return without_member(tokens, first, span)
    if element.kind == "alternative":
        return _without_alternative(source, span)
    return without_entry(source.text.split("\n"), tokens, first, span)


def _without_alternative(source: Source, span: Span) -> Edit | None:
    for field in _fields(parse(source).tree):
        inside = (field.span.line, field.span.column) <= (span.line, span.column) and (
            (span.end_line, span.end_column) <= (field.span.end_line, field.span.end_column)
        )
        if inside:
            return None if field.clauses else without_line(source.text.split("\n"), field.span)
    return None


def _fields(tree: ast.Specification | None) -> Iterator[ast.AlternativeEffects]:
    """The alternative effects of all actions that are not copied."""
    for block in tree.blocks if tree is not None else ():
        for action in block.actions if isinstance(block, ast.Actions) else ():
            if isinstance(action, ast.ActionDeclaration):
                yield from (each for each in action.fields if isinstance(each, ast.AlternativeEffects))


def _added(source: Source, spec: Spec, addition: Addition) -> Edit | None:
    """The edit that adds lines: at the end of their block, or in a new block; goals come first in their list."""
    lines = [line.replace("action NAME", f"action {NEW_ACTION}") for line in added_lines(spec, addition)]
    tree = parse(source).tree
    blocks = tree.blocks if tree is not None else ()
    if isinstance(addition, NoGoalWhile):
        return (
            _before_goals(source, blocks, lines) if spec.goals is not None and spec.goals.kind == "priority" else None
        )
    if isinstance(addition, NewAction):
        lines = [lines[0], *(f"  {line}" for line in lines[1:])]
    kind, title = (ast.Config, "CONFIG") if isinstance(addition, Setting) else (ast.Actions, "ACTIONS")
    block = next((each for each in blocks if isinstance(each, kind)), None)
    if block is None:
        end = source.text.split("\n")
        text = "\n".join(["", f"BEGIN {title}", *lines, f"END {title}", ""])
        return Edit(Span(len(end), len(end[-1]) + 1, len(end), len(end[-1]) + 1), text if not end[-1] else f"\n{text}")
    if isinstance(addition, Setting) and any(isinstance(each, ast.Restoration) for each in block.settings):  # type: ignore[union-attr]
        return None
    _, tokens, _ = read_terminals(source)
    closing = max(place for place, each in enumerate(tokens) if each.text == "END" and not is_after(each, block.span))
    return _inserted(tokens[closing].span, lines)


def _before_goals(source: Source, blocks: Sequence[ast.Block], lines: list[str]) -> Edit | None:
    block = next((each for each in blocks if isinstance(each, ast.Goals)), None)
    _, tokens, _ = read_terminals(source)
    if block is None:
        return None
    kind = next(
        place
        for place, each in enumerate(tokens)
        if each.text == "priority" and (each.line, each.column) > (block.span.line, block.span.column)
    )
    return _inserted(tokens[kind + 1].span, lines)


def _inserted(before: Span, lines: Sequence[str]) -> Edit:
    """Lines of their own before something that begins a line."""
    return Edit(Span(before.line, before.column, before.line, before.column), "".join(f"{line}\n" for line in lines))
