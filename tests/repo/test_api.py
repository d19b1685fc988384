"""The public API."""

import importlib.metadata
import re

import pytest

import tumato_symbolic
from tests.repo.documents import ROOT


def test_every_public_name_is_there() -> None:
    """Each name in `__all__` can be imported, and `dir` shows no other."""
    for name in tumato_symbolic.__all__:
        assert getattr(tumato_symbolic, name) is not None
    assert dir(tumato_symbolic) == sorted(tumato_symbolic.__all__)


def test_an_unknown_name_is_an_attribute_error() -> None:
    """The lazy module behaves like any other."""
    with pytest.raises(AttributeError, match="no attribute 'solve'"):
        tumato_symbolic.solve  # noqa: B018


def test_the_version_is_that_of_the_package() -> None:
    """`__version__` agrees with the package's metadata."""
    assert tumato_symbolic.__version__ == importlib.metadata.version("tumato-symbolic")


def test_from_text_to_a_proved_policy() -> None:
    """The three functions work together: parse, synthesize, verify; and the policy decides."""
    spec = tumato_symbolic.parse((ROOT / "examples" / "amr.tum").read_text())
    outcome = tumato_symbolic.synthesize(spec)
    assert isinstance(outcome, tumato_symbolic.Realizable)
    assert tumato_symbolic.verify(outcome.policy, spec).verdict == "proved"
    state = {"S_Location": "corridor", "S_Battery": "low", "S_Load": "free", "S_Conveyor": "off"}
    assert outcome.policy.decide(state) == ("move_to_charger",)


def test_a_mistake_is_a_user_error() -> None:
    """`parse` raises every mistake at once, with codes."""
    with pytest.raises(tumato_symbolic.UserError) as caught:
        tumato_symbolic.parse(
            "BEGIN STATE VECTOR state S can be a, a END STATE VECTOR BEGIN CONFIG max_plan_length: 0 END CONFIG"
        )
    assert len(caught.value.diagnostics) >= 2


def test_every_public_name_is_documented() -> None:
    """The table of docs/api.md names each."""
    text = (ROOT / "docs" / "api.md").read_text()
    table = "\n".join(line.split(" | ")[0] for line in text.splitlines() if line.startswith("| `"))
    for name in tumato_symbolic.__all__:
        assert re.search(rf"`{name}[`(]", table), name


def test_what_documents_take_from_a_room_is_public() -> None:
    """Type checkers of others take for exported what `__all__` of a room names."""
    texts = [path.read_text() for path in (ROOT / "docs").glob("*.md") if path.name != "architecture.md"]
    imports = [found for text in texts for found in re.findall(r"from (tumato_symbolic\.\w+) import (.+)", text)]
    taken = {(room, name.strip()) for room, names in imports for name in names.split(",")}
    taken |= {found for text in texts for found in re.findall(r"`(tumato_symbolic\.\w+)\.(\w+)", text)}
    assert len(taken) > 5
    for room, name in sorted(taken):
        assert name in importlib.import_module(room).__all__, f"{room}.{name}"
