"""What synthesis says of a text on saving: counts behind the headings of blocks (inlay hints), failures, repairs."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from typing import Any, Literal, NamedTuple

from tumato_symbolic.diagnostics import Source, Span, UserError
from tumato_symbolic.diagnostics.wording import count
from tumato_symbolic.editor.checking import Fix
from tumato_symbolic.limits import Context, LimitReachedError
from tumato_symbolic.spec import Spec, load
from tumato_symbolic.syntax import ast, parse
from tumato_symbolic.syntax.edits import Edit
from tumato_symbolic.synthesis import Realizable, SynthesisResult, Unrealizable, synthesize
from tumato_symbolic.synthesis.result import Statistics

Verdict = Literal["realizable", "unrealizable", "undecided", "mistakes"]

SHARE_OF_REPAIRS = 0.5
"""The part of the time in which repairs are looked for."""


class Hint(NamedTuple):
    """A text to show after the end of a line, which is no part of the document."""

    line: int
    column: int
    text: str


class Failure(NamedTuple):
    """States for which there is no policy: the name of a code, a message, and the line of the goals."""

    code: str
    message: str
    span: Span


class Answer(NamedTuple):
    """All of it. A policy that is found here is not proved: `synth` does that."""

    verdict: Verdict
    summary: str
    hints: tuple[Hint, ...] = ()
    failures: tuple[Failure, ...] = ()
    repairs: tuple[Fix, ...] = ()


def answer(source: Source, context: Context) -> Answer:
    """Synthesize what a text means; where there is no policy, look for repairs as well."""
    spec = load(source).spec
    if spec is None:
        return Answer("mistakes", "there are mistakes to correct first")
    try:
        outcome = synthesize(spec, context=context, certify=False)
    except UserError as error:
        return Answer("mistakes", error.diagnostics[0].message)
    except LimitReachedError as limit:
        return Answer("undecided", f"undecided: {limit}")
    hints = tuple(_hints(source, spec, outcome))
    match outcome:
        case Realizable():
            longest = outcome.statistics.longest_told
            return Answer("realizable", f"realizable; the longest run to a goal takes {longest}", hints)
        case Unrealizable():
            failures = tuple(_failures(source, spec, outcome))
            return Answer("unrealizable", "no policy", hints, failures, tuple(_repairs(source, spec, context)))
        case _:
            return Answer("undecided", f"undecided: {outcome.limit}", hints)


def _hints(source: Source, spec: Spec, outcome: SynthesisResult) -> Iterator[Hint]:
    """Counts after the lines with which blocks begin."""
    statistics: Statistics | None = outcome.statistics
    if statistics is None:
        return
    texts: dict[type, str] = {
        ast.StateVector: count(statistics.total, "state"),
        ast.Assumptions: count(statistics.valid, "valid state"),
        ast.StateRules: f"{statistics.safe:,} safe, {statistics.unsafe:,} unsafe",
        ast.Actions: count(len(spec.cases), "action"),
    }
    if isinstance(outcome, Realizable):
        texts[ast.Goals] = f"realizable, in {count(statistics.longest_run or 0, 'step')} at most"
    elif isinstance(outcome, Unrealizable):
        texts[ast.Goals] = "no policy"
    lines = source.text.split("\n")
    tree = parse(source).tree
    for block in tree.blocks if tree is not None else ():
        text = texts.get(type(block))
        if text is not None:
            line = block.span.line
            yield Hint(line, len(lines[line - 1].split("//")[0].rstrip()) + 1, text)


def _failures(source: Source, spec: Spec, outcome: Unrealizable) -> Iterator[Failure]:
    """The groups of states that fail, at the beginning of the goals, or of the text."""
    from tumato_symbolic.report.failures import FAILURE_CODES, failure_line
    from tumato_symbolic.report.objections import Place

    tree = parse(source).tree
    blocks = tree.blocks if tree is not None else ()
    block = next((each for each in blocks if isinstance(each, ast.Goals)), next(iter(blocks), None))
    line = 1 if block is None else block.span.line
    span = Span(line, 1, line, len(source.text.split("\n")[line - 1]) + 1)
    for failure in outcome.failures:
        message = failure_line(Place(spec, source.name), failure).partition(": ")[2]
        yield Failure(FAILURE_CODES[failure.kind].name, message, span)


def _repairs(source: Source, spec: Spec, context: Context) -> Iterator[Fix]:
    """Repairs that keep every state rule; each text was synthesized, and has a policy."""
    from tumato_symbolic.editor.repairing import repair_edits
    from tumato_symbolic.explain.explain import explain
    from tumato_symbolic.explain.explanation import Explanation

    seconds = None if context.deadline is None else (context.seconds_left() or 0.0) * SHARE_OF_REPAIRS
    found = explain(spec, max_cubes=0, cores=1, context=context.within(seconds))
    if isinstance(found, Explanation):
        for repair in found.repairs:
            fix = None if repair.gives_up_safety else repair_edits(source, spec, repair)
            if fix is not None and _has_policy(source, fix, context):
                yield fix


def _has_policy(source: Source, fix: Fix, context: Context) -> bool:
    from tumato_symbolic.syntax.edits import edited

    spec = load(Source(source.name, edited(source, fix.edits))).spec
    return spec is not None and isinstance(synthesize(spec, context=context.within(), certify=False), Realizable)


def dumps(found: Answer) -> str:
    """As a line of JSON."""
    data = found._asdict()
    data["failures"] = [(each.code, each.message, _numbers(each.span)) for each in found.failures]
    data["repairs"] = [
        (each.title, [(_numbers(edit.span), edit.text) for edit in each.edits]) for each in found.repairs
    ]
    return json.dumps(data)


def loads(text: str) -> Answer:
    """The answer in a line of JSON."""
    data: Mapping[str, Any] = json.loads(text)
    return Answer(
        data["verdict"],
        data["summary"],
        tuple(Hint(*each) for each in data["hints"]),
        tuple(Failure(code, message, Span(*span)) for code, message, span in data["failures"]),
        tuple(Fix(title, tuple(Edit(Span(*span), new) for span, new in edits)) for title, edits in data["repairs"]),
    )


def _numbers(span: Span) -> tuple[int, int, int, int]:
    return span.line, span.column, span.end_line, span.end_column
