"""What a sweep finds, in a file that grows: whatever ends it, nothing is lost and nothing depends on the order."""

import json
from pathlib import Path

import pytest

from tests.sweep.here import COIN, KNOWN, PLAN, GoneError, run, shuffling, whole
from tumato_symbolic.diagnostics import UserError
from tumato_symbolic.sweep import Plan, Task, dropped, kept
from tumato_symbolic.sweep.tasks import Answer


def refused(path: Path, plan: Plan = PLAN, version: str = "0") -> str:
    """What is said of a file that cannot be gone on with, which stays as it is."""
    before = path.read_bytes()
    with pytest.raises(UserError) as error, kept(str(path), plan.header(version)):
        pass
    assert path.read_bytes() == before
    return str(error.value)


@pytest.mark.parametrize("seed", range(5))
def test_the_order_of_answers_does_not_matter(seed: int, tmp_path: Path) -> None:
    """In the file and on the output, the lines stand in the order of the variants."""
    assert run(tmp_path / "results.jsonl", shuffling(seed, KNOWN)) == whole()
    assert (tmp_path / "results.jsonl").read_text() == whole()
    numbers = [json.loads(line)["variant"] for line in whole().splitlines()[1:]]
    assert numbers == list(range(len(PLAN.variants)))


@pytest.mark.parametrize("most", range(12))
def test_a_sweep_that_stops_goes_on(most: int, tmp_path: Path) -> None:
    """After any number of answers; what was found is not looked for again."""
    path = tmp_path / "results.jsonl"
    with pytest.raises(GoneError):
        run(path, shuffling(most, KNOWN, most))
    there = [json.loads(line)["variant"] for line in path.read_text().splitlines()[1:]]
    assert len(there) <= most
    asked: dict[Task, Answer] = {}
    assert run(path, shuffling(7, asked)) == whole()
    assert len(asked) == len(PLAN.variants) - len(there) + (
        len(there) > 0
    )  # and the specification, with which others are compared
    assert path.read_text() == whole()


def test_a_file_cut_anywhere_is_completed(tmp_path: Path) -> None:
    """By a kill in the middle of a line, or of the header."""
    path = tmp_path / "results.jsonl"
    for length in [*range(0, 60, 7), *range(60, len(whole()), 211), len(whole()) - 1, len(whole())]:
        path.write_text(whole()[:length])
        assert run(path, shuffling(length, KNOWN)) == whole(), length
        assert path.read_text() == whole(), length


def test_a_line_cut_in_two_spoils_no_other(tmp_path: Path) -> None:
    """Also where the next run is killed too: each line of the file is one result, and none stands there twice."""
    path = tmp_path / "results.jsonl"
    path.write_text(whole()[: len(whole()) // 3])
    with pytest.raises(GoneError):
        run(path, shuffling(0, KNOWN, 5))
    numbers = [json.loads(line)["variant"] for line in path.read_text().splitlines()[1:]]
    assert len(numbers) == len(set(numbers))
    assert run(path, shuffling(1, KNOWN)) == whole()


def test_a_file_of_another_sweep_is_refused(tmp_path: Path) -> None:
    """The message says what is otherwise."""
    path = tmp_path / "results.jsonl"
    path.write_text(whole())
    other = Plan("drop", COIN, dropped(COIN), {"some": "thing"})
    assert "the options are others: some option there, thing here" in refused(path, other)
    assert "another version of tumato-symbolic" in refused(path, version="1")
    assert "it varies something else" in refused(path, Plan("mutate", COIN, dropped(COIN), PLAN.options))


@pytest.mark.parametrize("text", ["hello\n", "hello", "{}\n", "[1]\n", "\x00\x01\n", "\n\n", '{"sweep": 1}\n'])
def test_a_file_of_something_else_is_refused(text: str, tmp_path: Path) -> None:
    """And is left as it was."""
    path = tmp_path / "results.jsonl"
    path.write_text(text)
    assert "TUM120" in refused(path)


@pytest.mark.parametrize("line", ["no", "{}", "3", '{"variant": 1}', "the one that is there, as number 99"])
def test_a_line_that_is_no_result_is_named(line: str, tmp_path: Path) -> None:
    """Not guessed at, and not passed over."""
    path = tmp_path / "results.jsonl"
    header, first, second, *rest = whole().splitlines()
    line = second.replace(": 1,", ": 99,", 1) if line.endswith("99") else line
    path.write_text("\n".join([header, first, line, second, *rest, ""]))
    assert "line 3 of" in refused(path)


def test_two_sweeps_do_not_share_a_file(tmp_path: Path) -> None:
    """The second one is refused while the first one writes."""
    pytest.importorskip("fcntl", reason="there are no locks")
    path = tmp_path / "results.jsonl"
    with kept(str(path), PLAN.header("0")):
        assert "another sweep is writing" in refused(path)
