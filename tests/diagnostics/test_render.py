"""Diagnostics as text."""

from tumato_symbolic.diagnostics import Code, Diagnostic, Note, Source, Span, render
from tumato_symbolic.diagnostics.render import MAX_SHOWN, MAX_WIDTH
from tumato_symbolic.diagnostics.wording import listed, nearest, quoted

SOURCE = Source("dir/a.tum", "first line\n\tsecond \x1b[31m line\nthird")


def test_a_diagnostic_with_everything() -> None:
    """Code, message, place, the line with the span underlined, notes, and the way out, in this order."""
    diagnostic = Diagnostic(
        Code.TUM203, "declared twice", Span(3, 1, 3, 6), "remove one", (Note("first here", Span(1, 7, 1, 11)),)
    )
    assert render((diagnostic,), SOURCE) == (
        "error[TUM203]: declared twice\n"
        "  --> dir/a.tum:3:1\n"
        " 3 | third\n"
        "   | ^^^^^\n"
        "  note: first here\n"
        "  --> dir/a.tum:1:7\n"
        " 1 | first line\n"
        "   |       ----\n"
        "  help: remove one\n"
    )


def test_a_line_cannot_steer_the_terminal() -> None:
    """Tabs count as one column and control characters are replaced."""
    text = render((Diagnostic(Code.TUM105, "m", Span(2, 2, 2, 8)),), SOURCE)
    assert " 2 |  second \ufffd[31m line\n   |  ^^^^^^\n" in text


def test_spans_of_several_lines_and_of_nothing() -> None:
    """A span of several lines is marked to the end of its first line; an empty one gets one mark."""
    assert "   | ^^^^^^^^^^\n" in render((Diagnostic(Code.TUM105, "m", Span(1, 1, 3, 2)),), SOURCE)
    assert "   |      ^\n" in render((Diagnostic(Code.TUM105, "m", Span(3, 6, 3, 6)),), SOURCE)


def test_long_lines_are_cut_around_the_span() -> None:
    """The span stays in sight and underlined, wherever it is in a long line."""
    text = "x" * 5000 + "HERE" + "y" * 5000
    shown = render((Diagnostic(Code.TUM105, "m", Span(1, 5001, 1, 5005)),), Source("s", text)).splitlines()
    assert len(shown[2]) < MAX_WIDTH + 10
    assert shown[2].index("HERE") == shown[3].index("^^^^")
    assert shown[3].count("^") == 4


def test_color_is_asked_for() -> None:
    """Escape sequences come only with `color`, and say the same text."""
    diagnostic = Diagnostic(Code.TUM321, "unused", Span(1, 1, 1, 2))
    assert "\x1b" not in render((diagnostic,), SOURCE)
    assert "\x1b[33;1mwarning[TUM321]\x1b[0m" in render((diagnostic,), SOURCE, color=True)


def test_without_a_source() -> None:
    """Without a text there is the message alone; without a span, the name of the source."""
    assert render((Diagnostic(Code.TUM101, "no file"),), None) == "error[TUM101]: no file\n"
    assert "--> dir/a.tum\n" in render((Diagnostic(Code.TUM312, "no valid state"),), SOURCE)
    assert render((), SOURCE) == ""


def test_long_lists_are_capped_errors_first() -> None:
    """The rest is counted; warnings give way to errors."""
    warnings = [Diagnostic(Code.TUM321, f"w{number}", Span(1, 1, 1, 2)) for number in range(MAX_SHOWN + 5)]
    text = render((*warnings, Diagnostic(Code.TUM201, "the error", Span(3, 1, 3, 2))), SOURCE)
    assert "the error" in text
    assert text.endswith("and 6 more\n")


def test_wording() -> None:
    """Quotes clip and reveal, lists join and cut, and the nearest name is near."""
    assert quoted("a" * 100) == "`" + "a" * 59 + "…`"
    assert quoted("\x1b") == "`\\x1b`"
    assert listed(["a", "b", "c"]) == "`a`, `b` and `c`"
    assert listed([str(n) for n in range(12)]).endswith("`9` and 2 more")
    assert nearest("S_Batery", ["S_Load", "S_Battery"]) == "S_Battery"
    assert nearest("ON", ["off", "on"]) == "on"
    assert nearest("zebra", ["off", "on"]) is None


def test_codes_are_told_apart() -> None:
    """Every code has a title of its own, so that no code is an alias of another."""
    assert len(Code) == len(Code.__members__)
    assert all(code.name[3] == "3" for code in Code if code.severity == "warning" and code.name != "TUM507")
