"""`export`: the command line around the targets."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.cli.conftest import Cli
from tumato_symbolic.export.targets import TARGETS


def test_the_theorem_goes_where_it_is_asked_for(cli: Cli, tmp_path: Path) -> None:
    """To the standard output, or to a file, with the same text."""
    ran = cli("export", "coq", "amr.json", "amr.tum")
    assert (ran.code, ran.err) == (0, "")
    assert ran.out.endswith("Print Assumptions policy_is_right.\n")
    filed = cli("export", "coq", "amr.json", "amr.tum", "-o", "amr.v")
    assert (filed.code, filed.out) == (0, "")
    assert "amr.v is written" in filed.err
    assert (tmp_path / "amr.v").read_text(encoding="utf-8") == ran.out


def test_a_target_of_several_files(cli: Cli, tmp_path: Path) -> None:
    """They stand beside each other, and none of them is an input, the standard output, or another of them."""
    ran = cli("export", "c99", "amr.json", "amr.tum", "-o", "robot.c")
    assert (ran.code, ran.out) == (0, "")
    assert ran.err.startswith("robot.c and robot.h are written")
    assert '#include "robot.h"' in (tmp_path / "robot.c").read_text(encoding="utf-8")
    (tmp_path / "taken.h").write_text((tmp_path / "amr.tum").read_text())
    for command, complaint in (
        ("amr.json amr.tum", "name the first with -o, as in -o amr.c"),
        ("amr.json amr.tum -o robot.h", "the name of another of the files"),
        ("amr.json taken.h -o taken.c", "TUM118"),
        ("amr.json amr.tum -o /dev/null", "TUM510"),
        ('amr.json amr.tum -o a"b.c', "the files name each other"),
    ):
        ran = cli("export", "c99", *command.split())
        assert (ran.code, ran.out) == (2, "")
        assert complaint in ran.err


@pytest.mark.parametrize("target", TARGETS)
def test_a_name_without_an_ending_gets_that_of_the_target(cli: Cli, tmp_path: Path, target: str) -> None:
    """Other tools find a file by its ending; a name that has one, or that a file has, stands as it is typed."""
    ending = Path(TARGETS[target].example).suffix
    ran = cli("export", target, "amr.json", "amr.tum", "-o", "robot")
    assert (ran.code, ran.err.split()[0]) == (0, f"robot{ending}")
    assert (tmp_path / f"robot{ending}").exists()
    assert not (tmp_path / "robot").exists()
    assert cli("export", target, "amr.json", "amr.tum", "-o", "robot.txt").code == 0
    assert (tmp_path / "robot.txt").exists()
    (tmp_path / "there").touch()
    assert cli("export", target, "amr.json", "amr.tum", "-o", "there").code == 0
    assert (tmp_path / "there").read_text() != ""
    ran = cli("export", target, "amr.json", "amr.tum", "-o", ".")
    assert (ran.code, "error[TUM510]" in ran.err) == (2, True)


def test_no_ending_hides_that_a_file_is_an_input(cli: Cli, tmp_path: Path) -> None:
    """The name with its ending is the one that is looked at before the work begins."""
    (tmp_path / "robot.v").write_bytes((tmp_path / "amr.tum").read_bytes())
    ran = cli("export", "coq", "amr.json", "robot.v", "-o", "robot")
    assert (ran.code, "error[TUM118]" in ran.err) == (2, True)


def test_unknown_targets_and_checks_that_there_are_not(cli: Cli) -> None:
    """Wrong usage says which targets there are, and which have a check."""
    ran = cli("export", "java", "amr.json", "amr.tum")
    assert ran.code == 2
    assert "python" in ran.err
    assert "c99" in ran.err
    ran = cli("export", "python", "amr.json", "amr.tum", "--check")
    assert ran.code == 2
    assert "the target python has no such program" in ran.err


@pytest.mark.parametrize("target", TARGETS)
def test_every_target_is_written(cli: Cli, tmp_path: Path, target: str) -> None:
    """To the files that the table says, with a sentence on what is guaranteed; the same bytes every time."""
    found = TARGETS[target]
    command = ["export", target, "amr.json", "amr.tum", "-o", found.example, *(["--check"] if found.check else [])]
    before = {path.name for path in tmp_path.iterdir()}
    texts = []
    for _ in range(2):
        assert cli(*command).code == 0
        made = sorted(path for path in tmp_path.iterdir() if path.name not in before)
        texts.append([path.read_text(encoding="utf-8") for path in made])
    assert len(texts[0]) == 1 + len(found.beside) + (found.check is not None)
    assert texts[0] == texts[1]
    assert all(f"tumato-sym export {target}" in text for text in texts[0])


def test_the_ordering_is_that_of_the_specification(cli: Cli, tmp_path: Path) -> None:
    """The command line's, else what the specification means, whatever the policy records."""
    policy = (tmp_path / "amr.json").read_text().replace('"EffectOrdering": "any"', '"EffectOrdering": "first"')
    (tmp_path / "first.json").write_text(policy)
    spec = (tmp_path / "amr.tum").read_text()
    (tmp_path / "writes.tum").write_text(spec.replace("BEGIN CONFIG", "BEGIN CONFIG\neffect_ordering: any"))
    (tmp_path / "weaker.tum").write_text(spec.replace("BEGIN CONFIG", "BEGIN CONFIG\neffect_ordering: first"))
    for arguments, wanted in (
        (("first.json", "amr.tum", "--effect-ordering", "any"), "Any"),
        (("first.json", "writes.tum", "--effect-ordering", "first"), "First"),
        (("first.json", "weaker.tum"), "First"),
        (("amr.json", "weaker.tum"), "First"),
        (("amr.json", "amr.tum"), "Any"),
    ):
        assert f"minimal spec {wanted} " in cli("export", "coq", *arguments).out
    for meant in ("amr.tum", "writes.tum"):
        refused = cli("export", "coq", "first.json", meant)
        assert (refused.code, refused.out) == (2, "")
        assert "TUM511" in refused.err


def test_a_policy_for_a_weaker_restoration(cli: Cli, tmp_path: Path) -> None:
    """It is refused, unless the command line says by which one the theorem judges it."""
    policy = (tmp_path / "amr.json").read_text()
    weaker = policy.replace('"EffectOrdering": "any"', '"EffectOrdering": "any", "Restoration": "fair"')
    (tmp_path / "fair.json").write_text(weaker)
    refused = cli("export", "coq", "fair.json", "amr.tum")
    assert (refused.code, refused.out) == (2, "")
    assert "TUM511" in refused.err
    assert "was made for `restoration: fair`, but the specification means one_step" in refused.err
    assert cli("export", "coq", "fair.json", "amr.tum", "--restoration", "one_step").code == 0


def test_what_cannot_be_exported_is_2(cli: Cli) -> None:
    """Wrong input, another specification, a file that cannot be written."""
    for arguments in (
        ("missing.json", "amr.tum"),
        ("amr.json", "typo.tum"),
        ("amr.json", "warned.tum"),
        ("amr.json", "amr.tum", "-o", "nowhere/amr.v"),
        ("amr.json", "amr.tum", "-o", ""),
    ):
        ran = cli("export", "coq", *arguments)
        assert (ran.code, ran.out) == (2, "")
        assert "Traceback" not in ran.err
