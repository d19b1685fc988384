"""Files to source texts."""

import io
import os
import subprocess
import sys
from pathlib import Path

import pytest

from tumato_symbolic.diagnostics import UserError
from tumato_symbolic.syntax import read_source
from tumato_symbolic.syntax.grammar import grammar_path
from tumato_symbolic.syntax.reading import MAX_BYTES


def refused(path: object) -> str:
    """The code with which a path is refused."""
    with pytest.raises(UserError) as caught:
        read_source(str(path))
    return caught.value.diagnostics[0].code.name


def test_a_mark_and_windows_line_ends_are_taken_off(tmp_path: Path) -> None:
    """A byte-order mark is dropped, line ends become line feeds, the name is the path as given."""
    file = tmp_path / "a.tum"
    file.write_bytes(b"\xef\xbb\xbfone\r\ntwo\rthree\n")
    source = read_source(str(file))
    assert (source.name, source.text) == (str(file), "one\ntwo\nthree\n")


def test_what_is_no_file_is_refused(tmp_path: Path) -> None:
    """Missing files, directories and impossible names."""
    assert refused(tmp_path / "missing.tum") == "TUM101"
    assert refused(tmp_path) == "TUM101"
    assert refused("with\0zero") == "TUM101"
    assert refused("x" * 5000) == "TUM101"


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() == 0, reason="root reads everything")
def test_what_may_not_be_read_is_refused(tmp_path: Path) -> None:
    """A file without permission to read."""
    file = tmp_path / "a.tum"
    file.touch(mode=0o000)
    assert refused(file) == "TUM101"


def test_what_is_not_text_is_refused(tmp_path: Path) -> None:
    """Binary files, and texts in another encoding, whose place is told."""
    file = tmp_path / "a.tum"
    file.write_bytes(b"\x7fELF\0\0")
    assert refused(file) == "TUM102"
    file.write_bytes("// gr\u00f6\u00dfer".encode("latin-1"))
    with pytest.raises(UserError) as caught:
        read_source(str(file))
    span = caught.value.diagnostics[0].span
    assert caught.value.diagnostics[0].code.name == "TUM102"
    assert span is not None
    assert (span.line, span.column) == (1, 6)


def test_what_is_too_large_is_refused(tmp_path: Path) -> None:
    """One byte more than the limit, and no more than that is read."""
    file = tmp_path / "a.tum"
    file.write_bytes(b" " * MAX_BYTES)
    assert len(read_source(str(file)).text) == MAX_BYTES
    file.write_bytes(b" " * (MAX_BYTES + 1))
    assert refused(file) == "TUM103"
    assert refused("/dev/zero") == "TUM103"


def test_a_dash_is_standard_input(monkeypatch: pytest.MonkeyPatch) -> None:
    """`-` reads standard input."""
    monkeypatch.setattr("sys.stdin", io.TextIOWrapper(io.BytesIO(b"text")))
    source = read_source("-")
    assert (source.name, source.text) == ("<stdin>", "text")


def test_the_grammar_is_found_and_says_what_it_is() -> None:
    """The grammar file is read from the checkout or the installed package."""
    assert grammar_path().read_text(encoding="utf-8").startswith("// The language of tumato-symbolic")


def test_formulas_do_not_need_the_parser() -> None:
    """Importing specifications, and the reading of files, does not import lark."""
    program = "import sys, tumato_symbolic.spec, tumato_symbolic.syntax; print('lark' in sys.modules)"
    result = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert result.stdout == "False\n"
