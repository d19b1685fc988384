"""Why there is no policy (`explain`), for a person: which parts the report has, in which order."""

from __future__ import annotations

from collections.abc import Iterator

from msgspec import Struct

from tumato_symbolic.diagnostics import Diagnostic, Source
from tumato_symbolic.explain.explanation import STAGES, Explanation, Found, NothingToExplain, Unexplained
from tumato_symbolic.report.blame import group_lines, near_pieces, reason_pieces
from tumato_symbolic.report.layout import Paint, count
from tumato_symbolic.report.objections import Place
from tumato_symbolic.report.possible_changes import left_out_lines, part_lines, repair_pieces
from tumato_symbolic.report.proof import ORDERINGS
from tumato_symbolic.report.restorable import restorable_lines
from tumato_symbolic.semantics import count_states
from tumato_symbolic.spec import Spec


class Explained(Struct, frozen=True):
    """What `explain` found by now, with everything that its report needs. `written` is the file with the assumption."""

    source: Source
    spec: Spec
    found: Found
    warnings: tuple[Diagnostic, ...]
    written: str | None
    every_cube: bool

    @property
    def place(self) -> Place:
        """The specification and its file."""
        return Place(self.spec, self.source.name)


def as_text(done: Explained, colour: bool) -> str:
    """The report for a person."""
    return "\n".join(pieces(done, colour))


def pieces(done: Explained, colour: bool) -> list[str]:
    """The report in pieces, each of whole lines; as more is found, there are more of them, and none changes."""
    paint, name = Paint(colour), done.source.name
    size = f"{name}: {count(count_states(done.spec), 'state')}, {count(len(done.spec.cases), 'action')}"
    match done.found:
        case NothingToExplain():
            return [
                size,
                f"{name} is {paint.good('realizable')}: there is nothing to explain.\n"
                "`tumato-sym synth` writes its policy, and `tumato-sym why` explains the decisions.",
            ]
        case Unexplained(limit, statistics):
            valid = "" if statistics is None else f"\n  {count(statistics.valid, 'valid state')}"
            return [size] if limit is None else [size, f"{name}: {paint.doubt('undecided')}: {limit}.{valid}"]
        case Explanation() as found:
            return [size, *_explanation(done, found, paint)]


def _explanation(done: Explained, found: Explanation, paint: Paint) -> Iterator[str]:
    """The pieces behind the first line; those that begin a paragraph start with an empty line."""
    yield _verdict(done, found, paint)
    if found.is_over("states"):
        for group in found.groups:
            yield "\n".join(["", *group_lines(done.place, group, done.every_cube)])
        if found.restorability is not None:
            yield "\n".join(["", *restorable_lines(done.place, found.restorability)])
    if found.is_over("part") and "part" not in [each.stage for each in found.left_out]:
        yield "\n".join(["", *part_lines(done.spec, found.part, done.written)])
    yield from reason_pieces(done.place, found, done.every_cube)
    if found.is_over("near"):
        yield from near_pieces(done.place, found)
    yield from repair_pieces(done.place, found)
    if found.left_out and all(found.is_over(stage) for stage in STAGES):
        yield "\n".join(["", *left_out_lines(found)])


def _verdict(done: Explained, found: Explanation, paint: Paint) -> str:
    numbers = found.statistics
    verdict = f"{done.source.name} is {paint.bad('not realizable')}: "
    if found.failing_states:
        fail = "fails" if found.failing_states == 1 else "fail"
        asked = count(numbers.valid, "valid state") if numbers.part is None else count(numbers.part.starts, "start")
        verdict += f"{found.failing_states:,} of {asked} {fail}."
    else:
        verdict += "each state alone has a plan, but no policy works for all of them."
    return verdict if numbers.ordering == "any" else f"{verdict}\n  effects: {ORDERINGS[numbers.ordering]}"
