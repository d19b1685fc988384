"""Policy files: all or nothing, and clear words about what cannot be read."""

import io
import os
import signal
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from tests.policy.strategies import amr_like
from tumato_symbolic.diagnostics import UserError
from tumato_symbolic.policy import dumps, load, loads, save
from tumato_symbolic.policy.text import strict_json


def names(folder: Path) -> list[str]:
    """What is in a folder."""
    return sorted(path.name for path in folder.iterdir())


def test_saved_is_loaded(tmp_path: Path) -> None:
    """`load` gives what `save` was given, and nothing else is left in the folder."""
    path = tmp_path / "policy.json"
    save(amr_like(), path)
    save(amr_like(diagram=True), path)
    assert load(str(path)) == amr_like(diagram=True)
    assert names(tmp_path) == ["policy.json"]


@pytest.mark.parametrize("failure", [OSError(28, "No space left on device"), KeyboardInterrupt(), MemoryError()])
@pytest.mark.parametrize("step", ["fsync", "replace"])
def test_a_failing_write_changes_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, failure: BaseException, step: str
) -> None:
    """When writing fails or is interrupted, the old file is whole and the temporary one is gone."""
    path = tmp_path / "policy.json"
    path.write_text("old")

    def fail(*_: object) -> None:
        raise failure

    monkeypatch.setattr(os, step, fail)
    with pytest.raises(UserError if isinstance(failure, OSError) else type(failure)) as raised:
        save(amr_like(), path)
    if isinstance(failure, OSError):
        assert "TUM510: the policy cannot be written: No space left on device" in str(raised.value)
    assert path.read_text() == "old"
    assert names(tmp_path) == ["policy.json"]


@pytest.mark.skipif(os.name != "posix", reason="Windows ends processes in another way")
@pytest.mark.parametrize("number", ["SIGTERM", "SIGHUP", "SIGINT"])
def test_a_process_that_is_ended_leaves_nothing(tmp_path: Path, number: str) -> None:
    """A signal that ends the process while it writes ends it, with that signal; the old file is whole and alone."""
    path = tmp_path / "policy.json"
    path.write_text("old")
    code = (
        "import os, signal, sys, time\nfrom pathlib import Path\nfrom tumato_symbolic.policy import save_text\n"
        "signal.signal(signal.SIGINT, signal.default_int_handler)\n"
        "signal.signal(signal.SIGHUP, signal.SIG_DFL)\n"
        "os.fsync = lambda _: (print('writing', flush=True), time.sleep(100))\n"
        "save_text('new', Path(sys.argv[1]), 'policy')"
    )
    with subprocess.Popen([sys.executable, "-c", code, path], stdout=-1, stderr=subprocess.DEVNULL) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == b"writing\n"
        assert len(names(tmp_path)) == 2
        process.send_signal(getattr(signal, number))
        assert process.wait(timeout=60) == -getattr(signal, number)
    assert (path.read_text(), names(tmp_path)) == ("old", ["policy.json"])


def test_saving_leaves_signals_as_they_were(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Afterwards all is as before; what somebody else does with a signal is not touched meanwhile."""
    before = signal.signal(signal.SIGTERM, signal.SIG_IGN)
    try:
        found = []
        monkeypatch.setattr(os, "fsync", lambda _: found.append(signal.getsignal(signal.SIGTERM)))
        for handler in (signal.SIG_IGN, signal.SIG_DFL):
            signal.signal(signal.SIGTERM, handler)
            save(amr_like(), tmp_path / "policy.json")
            assert signal.getsignal(signal.SIGTERM) == handler
        assert found[0] == signal.SIG_IGN
        assert found[1] not in (signal.SIG_IGN, signal.SIG_DFL)
        with ThreadPoolExecutor() as threads:
            threads.submit(save, amr_like(), tmp_path / "policy.json").result()
        assert found[2] == signal.SIG_DFL
    finally:
        signal.signal(signal.SIGTERM, before)


def test_a_folder_is_not_overwritten(tmp_path: Path) -> None:
    """A folder, or a folder that does not exist, is a coded error and leaves no file behind."""
    for path in (tmp_path, tmp_path / "missing" / "policy.json"):
        with pytest.raises(UserError, match="TUM510"):
            save(amr_like(), path)
    assert names(tmp_path) == []


def test_a_device_is_written_to(tmp_path: Path) -> None:
    """A pipe or device stays what it is; a link keeps pointing to the file that is replaced."""
    null = Path(os.devnull).stat()
    save(amr_like(), tmp_path.joinpath(os.devnull))
    assert Path(os.devnull).stat().st_ino == null.st_ino
    link, target = tmp_path / "link.json", tmp_path / "target.json"
    target.write_text("old")
    link.symlink_to(target)
    save(amr_like(), link)
    assert link.is_symlink()
    assert load(str(target)) == amr_like()


def test_standard_input_is_read(monkeypatch: pytest.MonkeyPatch) -> None:
    """`-` reads standard input as UTF-8, a byte-order mark included."""
    data = b"\xef\xbb\xbf" + dumps(amr_like()).encode()
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(data), "ascii"))
    assert load("-") == amr_like()


def test_what_cannot_be_read_is_said(tmp_path: Path) -> None:
    """A missing file, a folder, empty, binary, UTF-16, truncated, an impossible name: TUM501 with the name as typed."""
    (tmp_path / "empty").write_bytes(b"")
    (tmp_path / "binary").write_bytes(bytes(range(256)))
    (tmp_path / "utf16").write_bytes(dumps(amr_like()).encode("utf-16"))
    (tmp_path / "truncated").write_text(dumps(amr_like())[:-100])
    for name in ("missing", ".", "empty", "binary", "utf16", "truncated", "a\0b", "x" * 5000):
        path = f"{tmp_path}/{name}"
        with pytest.raises(UserError, match="TUM501") as raised:
            load(path)
        assert raised.value.source is not None
        assert raised.value.source.name == path


def test_an_endless_file_is_too_large(monkeypatch: pytest.MonkeyPatch) -> None:
    """Reading stops at the limit, and texts beyond it are neither read nor written."""
    monkeypatch.setattr(strict_json, "MAX_BYTES", 100)
    monkeypatch.setattr("tumato_symbolic.policy.text.reading.MAX_BYTES", 100)
    monkeypatch.setattr("tumato_symbolic.policy.formats.policies.MAX_BYTES", 100)
    with pytest.raises(UserError, match="TUM508"):
        load("/dev/zero")
    with pytest.raises(UserError, match="TUM508"):
        loads(" " * 101)
    with pytest.raises(UserError, match="TUM508"):
        dumps(amr_like())


def test_a_syntax_error_has_a_place() -> None:
    """Text that is no JSON is shown with line and column."""
    with pytest.raises(UserError) as raised:
        loads('{\n  "Type": policy\n}', "p.json")
    span, source = raised.value.diagnostics[0].span, raised.value.source
    assert span is not None
    assert source is not None
    assert (span.line, span.column) == (2, 11)
    assert source.text.splitlines()[1] == '  "Type": policy'
