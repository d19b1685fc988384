"""Policies as Python modules, run by every Python from 3.8 on that is found here."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from collections.abc import Sequence
from functools import cache
from pathlib import Path

import pytest

from tests.export.mixed import FROM_STARTS, mixed
from tests.export.policies import EXAMPLES, decisions, example, exported, random_request, request, written
from tumato_symbolic.export import python
from tumato_symbolic.export.request import Request
from tumato_symbolic.export.targets import TARGETS

_ASK = """
import importlib.util, json, sys
def module(number, path):
    found = importlib.util.spec_from_file_location("policy{}".format(number), path)
    made = importlib.util.module_from_spec(found)
    found.loader.exec_module(made)
    return made
def answer(policy, state):
    try:
        return list(policy.decide(state))
    except policy.UndecidedState:
        return None
    except ValueError as error:
        return str(error)
asked = json.load(sys.stdin)
answers = [[answer(module(n, path), state) for state in states] for n, (path, states) in enumerate(asked)]
json.dump(answers, sys.stdout)
"""


@cache
def interpreters() -> tuple[str, ...]:
    """Every Python from 3.8 on, one of each version."""
    found = {(3, sys.version_info[1]): sys.executable}
    roots = Path(os.environ.get("PYENV_ROOT", Path.home() / ".pyenv")) / "versions"
    for minor in range(8, 30):
        places = [shutil.which(f"python3.{minor}"), *map(str, roots.glob(f"3.{minor}.*/bin/python"))]
        place = next((each for each in places if each is not None and _works(each)), None)
        if place is not None:
            found.setdefault((3, minor), place)
    return tuple(found.values())


def _works(python: str) -> bool:
    return subprocess.run([python, "-c", "pass"], capture_output=True, check=False).returncode == 0


def ask(interpreter: str, asked: Sequence[tuple[Request, Sequence[object]]], folder: Path) -> list[list[object]]:
    """What the modules answer about states: actions, None where undecided, or what is wrong."""
    files = []
    for number, (made, states) in enumerate(asked):
        path = folder / f"policy{number}.py"
        path.write_text(python.files(made)[0], encoding="utf-8")
        files.append((str(path), states))
    ran = subprocess.run(
        [interpreter, "-I", "-c", _ASK], input=json.dumps(files), capture_output=True, text=True, check=False
    )
    assert ran.returncode == 0, ran.stderr
    answers: list[list[object]] = json.loads(ran.stdout)
    return answers


def _compare(interpreter: str, requests: Sequence[Request], folder: Path) -> None:
    asked, expected = [], []
    for made in requests:
        said = list(decisions(made))
        variables = made.policy.vocabulary.variables
        states = [
            {name: values[value] for (name, values), value in zip(variables, state, strict=True)} for state, _ in said
        ]
        asked.append((made, states))
        expected.append([None if actions is None else list(actions) for _, actions in said])
    assert ask(interpreter, asked, folder) == expected


@pytest.mark.parametrize("interpreter", interpreters(), ids=lambda path: Path(path).resolve().name)
def test_every_python_decides_as_decide_does(interpreter: str, tmp_path: Path) -> None:
    """In every state of examples (here: of all), of policies from starts, and of random ones with undecided states."""
    names = EXAMPLES if interpreter == sys.executable else ["amr", "nested_goals"]
    requests = [example(name) for name in names] + [example(name, diagram=True) for name in names[:2]]
    requests += [exported(mixed(seed)[0]) for seed in FROM_STARTS]
    _compare(interpreter, [*requests, *(random_request(seed) for seed in range(12))], tmp_path)


def test_policies_with_a_diagram_for_each_action(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Where all decisions together would take too many questions, the answers are the same."""
    monkeypatch.setattr(python, "MOST_QUESTIONS", 0)
    requests = [*map(example, ("amr", "forklift", "lid")), *(random_request(seed) for seed in range(12))]
    assert "_EXECUTED" in python.files(requests[0])[0]
    _compare(sys.executable, requests, tmp_path)


def test_what_is_no_state_is_an_error(tmp_path: Path) -> None:
    """Unknown and missing variables, and values that are none, are errors of their own, and no undecided state."""
    spec = written({"Door": "open, closed", "Level": "0..2"}, ["wait"])
    made = request(spec, {(0, 1): frozenset((0,))})
    states: list[object] = [
        {"Door": "open", "Level": 1},
        {"Door": "open", "Level": "1"},
        {"Door": "closed", "Level": 0},
        {"Door": "open"},
        {"Door": "open", "Level": 1, "Lamp": "on"},
        {"Door": "ajar", "Level": 1},
        {"Door": "open", "Level": 3},
        {"Door": "open", "Level": True},
        {"Door": None, "Level": 1},
    ]
    for few in (False, True):
        with pytest.MonkeyPatch.context() as patched:
            if few:
                patched.setattr(python, "MOST_QUESTIONS", 0)
            (answers,) = ask(sys.executable, [(made, states)], tmp_path)
        assert answers[:3] == [["wait"], ["wait"], None]
        assert answers[3:5] == ["Level has no value", "there is no variable 'Lamp'"]
        assert all(isinstance(each, str) and " cannot be " in each for each in answers[5:]), answers


def test_the_file_says_what_is_guaranteed() -> None:
    """And what the code around it has to do, for the ordering of effects that it was made for."""
    text = " ".join(python.files(example("amr"))[0].split())
    assert "whatever effects occur, in any order" in text
    assert "see every effect before it asks again" in text
    first = Request(example("amr").policy, example("amr").spec, "first", "amr")
    assert "halt the others as soon as one of them has an effect" in " ".join(python.files(first)[0].split())
    assert TARGETS["python"].beside == ()
