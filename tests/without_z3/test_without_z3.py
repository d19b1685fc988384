"""Where Z3 cannot be imported: the same policies, other provers, and a message where there is no answer."""

import re
import subprocess
import sys
from pathlib import Path
from random import Random

import pytest
from msgspec.structs import replace

from tests.generate import random_spec
from tests.profiles import ALL_PROFILES
from tests.repo.documents import ROOT
from tests.without_z3.blocking import run_module
from tumato_symbolic.game import build_problem
from tumato_symbolic.limits import Context, MissingPackageError, has_z3, need_z3
from tumato_symbolic.symbolic import available_backend
from tumato_symbolic.synthesis.restoring import CheapestByDiagram
from tumato_symbolic.synthesis.solver import CheapestSet

MISSING = "cannot be imported here; install it with `pip install z3-solver`"


def test_answers_are_the_same() -> None:
    """Policies, certificates and failing states, byte for byte, of the examples and of 50 specifications.

    Where decisions have to be repaired, there is no answer instead.
    """
    answers = [run_module("tests.without_z3.answers", "0", "50", blocked=blocked) for blocked in ((), ("z3",))]
    kinds = set()
    for with_z3, without in zip(*answers, strict=True):
        kinds.add(without[1])
        if without[1] == "Undecided":
            assert without[2] == f"Z3 is needed to repair decisions where goals interact, and {MISSING}"
        else:
            assert with_z3 == without
    assert {"Realizable", "Unrealizable"} <= kinds
    assert sum(without[1] == "Undecided" for without in answers[1]) <= 3


@pytest.fixture(scope="module")
def commands(tmp_path_factory: pytest.TempPathFactory) -> dict[str, dict[str, tuple[int, str, str]]]:
    """What every command came to, with Z3, without it, and without any package."""
    kinds: dict[str, tuple[str, ...]] = {"with": (), "without": ("z3",), "bare": ("z3", "dd", "lark")}
    return {
        kind: run_module("tests.without_z3.commands", blocked=blocked, cwd=tmp_path_factory.mktemp(kind))
        for kind, blocked in kinds.items()
    }


def test_every_command_ends_well(commands: dict[str, dict[str, tuple[int, str, str]]]) -> None:
    """No traceback; what needs Z3 says so, and exits with 3."""
    for kind in ("without", "bare"):
        for name, (code, out, err) in commands[kind].items():
            assert "Traceback" not in out + err, (kind, name, err)
            assert code != 70, (kind, name)
    without = commands["without"]
    for name in ("synth by Z3", "conflict", "z3", "both", "certificate"):
        code, out, err = without[name]
        assert code == 3, (name, out, err)
        assert MISSING in " ".join((out + err).split()), name
    code, out, _ = without["no policy"]
    assert code == 1
    assert MISSING in " ".join(out.split())


def test_every_other_command_prints_the_same(commands: dict[str, dict[str, tuple[int, str, str]]]) -> None:
    """But for times, and for who proved it."""
    same = ("check", "explain", "explain more", "why", "decide", "run", "worst", "show", "export")
    for name in (*same, "synth by the walk", "walk", "explicit"):
        with_z3, without = (_timeless(commands[kind][name]) for kind in ("with", "without"))
        assert with_z3 == without, name
    for name in ("synth", "auto", "guarantees", "folder"):
        assert commands["without"][name][0] == 0, name
    assert "Proved by explicit-state checking" in commands["without"]["synth"][1]


def test_no_package_is_needed_but_to_compute_policies(commands: dict[str, dict[str, tuple[int, str, str]]]) -> None:
    """What needs dd says so; the rest prints what it always prints."""
    bare = commands["bare"]
    for name in ("synth", "synth by the walk", "synth by Z3", "no policy", "conflict", "explain", "explain more"):
        code, out, _ = bare[name]
        assert code == 3, name
        assert "dd is needed to look for policies" in " ".join(out.split()), name
    for name in ("check", "why", "decide", "run", "worst", "show", "export", "walk", "explicit"):
        assert _timeless(bare[name]) == _timeless(commands["with"][name]), name
    for name in ("auto", "guarantees"):
        assert bare[name][0] == 0, name


def _timeless(ran: tuple[int, str, str]) -> tuple[int, str, str]:
    code, out, err = ran
    return code, re.sub(r"\d+\.\d+ s", "… s", out), err


def test_what_cannot_be_imported_is_missing(monkeypatch: pytest.MonkeyPatch) -> None:
    """Also where a package is there, and broken."""
    assert has_z3()
    need_z3("prove this")
    monkeypatch.setattr("tumato_symbolic.limits.packages.import_module", _broken)
    assert not has_z3()
    with pytest.raises(MissingPackageError, match="Z3 is needed to prove this"):
        need_z3("prove this")


def test_what_should_pass_without_it_is_told_from_what_is_about_it(tmp_path: Path) -> None:
    """By `python -m tests.without_z3`: an answer that Z3 would have given may be missed, and nothing may break."""
    (tmp_path / "test_some.py").write_text(
        "from tumato_symbolic.limits import has_z3\n"
        "def test_wrong(): assert 1 + 1 == 3\n"
        "def test_about_z3(): assert has_z3()\n"
        "def test_broken(): import z3\n"
    )
    command = [sys.executable, "-m", "tests.without_z3", str(tmp_path), "-p", "no:cacheprovider", "-rfs"]
    ran = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert ran.returncode == 1
    assert re.findall(r"FAILED \S+::(\w+)", ran.stdout) == ["test_wrong", "test_broken"], ran.stdout
    assert "it is about Z3" in ran.stdout
    assert "2 failed, 1 skipped" in ran.stdout


def _broken(_: str) -> None:
    raise RuntimeError("libz3.so: wrong architecture")


@pytest.mark.parametrize("profile", sorted(ALL_PROFILES))
def test_the_diagram_knows_the_smallest_duration(profile: str) -> None:
    """It is that of Z3, of all sets that restore safety, and of those that are left when states are decided."""
    found = 0
    for seed in range(24):
        spec, random = random_spec(seed, ALL_PROFILES[profile]), Random(seed)
        longest = 10**10 if seed % 3 == 0 else 5
        actions = tuple(replace(action, duration=random.randint(0, longest)) for action in spec.actions)
        spec = replace(spec, actions=actions)
        problem = build_problem(spec, "any", available_backend(), Context())
        relation = problem.steps.allowed & problem.steps.unsafe
        if relation == problem.false:
            continue
        searches = CheapestSet(problem.encoding, relation), CheapestByDiagram(problem.encoding, relation)
        left = problem.steps.states_of(relation)
        for _ in range(6):
            one, other = (search.minimum() for search in searches)
            assert one == other
            if one is None:
                break
            found += one > 0
            state = problem.encoding.state_cube(problem.encoding.first_state(left))
            left = left & ~state
            for search in searches:
                search.exclude(state)
    assert found > 3
