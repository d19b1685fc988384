"""Tests of explanations that grow: what is found is handed over as it is found, and what is left out is named."""

from __future__ import annotations

from tests.cli.inputs import CONFLICT, TWO_ROBOTS
from tests.explain.variants import VARIANTS
from tumato_symbolic import parse
from tumato_symbolic.diagnostics import Source
from tumato_symbolic.explain.explain import explain, explained
from tumato_symbolic.explain.explanation import STAGES, Explanation, Found, Unexplained, Wanted, stopped
from tumato_symbolic.limits import Context, LimitReachedError, Limits
from tumato_symbolic.report.explained import Explained, pieces
from tumato_symbolic.report.explained_data import as_json, findings
from tumato_symbolic.report.findings import as_github

BROKEN = VARIANTS[3].text


class Impatient(Context):
    """A context whose time is up as soon as a certain stage begins."""

    def __init__(self, stage: str) -> None:
        super().__init__(Limits(1e6), self._told)
        self._last = stage

    def _told(self, stage: str) -> None:
        if stage.startswith(self._last):
            self.deadline = 0.0
            raise LimitReachedError("the time limit was met")


def _done(found: Found, text: str = BROKEN) -> Explained:
    return Explained(Source("x.tum", text), parse(text), found, (), None, False)


def test_the_text_only_grows() -> None:
    """Every version of the report begins with the one before, up to the last, which is that of `explain`."""
    wanted: Wanted
    for text, wanted in ((BROKEN, 3), (TWO_ROBOTS.read_text(), 0), (CONFLICT, 3)):
        before: list[str] = []
        for found in explained(parse(text), wanted_repairs=wanted):
            now = pieces(_done(found, text), False)
            assert now[: len(before)] == before
            before = now
        assert before == pieces(_done(explain(parse(text), wanted_repairs=wanted), text), False)
        assert isinstance(found, Explanation)
        assert found.finished == STAGES


def test_the_verdict_comes_first() -> None:
    """Before anything is explained it is said that there is no policy, and how many states fail."""
    first = next(explained(parse(BROKEN)))
    assert isinstance(first, Explanation)
    assert (first.failing_states, first.finished, first.reasons) == (12, (), ())


def test_what_is_left_out_is_named() -> None:
    """Wherever time is up, all later stages are named, with how far they came; what is there is right."""
    whole = explain(parse(BROKEN))
    assert isinstance(whole, Explanation)
    for number, told in enumerate(("listing", "looking for the largest", "cores: reason 1", "repairs: 2")):
        found = explain(parse(BROKEN), context=Impatient(told))
        assert isinstance(found, Explanation)
        expected = STAGES[number:] if number < 3 else ("repairs",)
        assert tuple(each.stage for each in found.left_out) == tuple(s for s in expected if s not in found.finished)
        assert found.failing_states == whole.failing_states
        assert found.repairs == whole.repairs[: len(found.repairs)]
        assert "Left out:" in "\n".join(pieces(_done(found), False))
        report = as_json(_done(found))
        assert [each["what"] for each in report["incomplete"]] == [each.stage for each in found.left_out]  # type: ignore[attr-defined]
        assert "Left out" in as_github(findings(_done(found)))


def test_work_that_is_ended_tells_what_is_there() -> None:
    """Whatever version is the last: its report names the rest, and is made of the same pieces."""
    for found in explained(parse(BROKEN)):
        ended = stopped(found, "it was interrupted")
        assert isinstance(ended, Explanation)
        assert {*ended.finished, *(each.stage for each in ended.left_out)} == set(STAGES)
        shown = pieces(_done(found), False)
        assert pieces(_done(ended), False)[: len(shown)] == shown


def test_no_verdict_in_time_is_no_explanation() -> None:
    """Where time is up before it is known whether there is a policy, nothing is claimed."""
    found = explain(parse(BROKEN), context=Impatient("finding the allowed steps"))
    assert isinstance(found, Unexplained)
    assert found.limit is not None
