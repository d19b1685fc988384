"""A page in one file: which parts of the program it has, in which order, with style and data, made small.

It asks nothing of anybody else.
"""

from __future__ import annotations

import base64
import hashlib
import json
import re
from collections.abc import Mapping
from html import escape
from pathlib import Path
from typing import Final

from tumato_symbolic.report.html.contents import NoPolicyPage, PolicyPage, contents

_FOLDER: Final = Path(__file__).parent

_SHARED: Final = (
    "spec",
    "policy",
    "steps",
    "runs",
    "restoring",
    "judge",
    "words",
    "dom",
    "state",
    "verdict",
    "slices",
    "listing",
    "app",
)

_OF_A_POLICY: Final = (
    *("chance", "checking", "filter", "table", "rules", "graph"),
    *("decision", "execution", "compare", "policy_page"),
)

MODULES: Final = {
    PolicyPage: (*_SHARED, *_OF_A_POLICY),
    NoPolicyPage: (*_SHARED, "failing", "tried", "reasons", "no_policy_page"),
}
"""The program of each kind of page: a module stands behind what it imports. The names of all share one scope."""


def page(of: PolicyPage | NoPolicyPage) -> str:
    """The page as HTML."""
    program, style = bundle(type(of)), _style()
    allowed = (f"{what} {source}" for what, source in sources(type(of)).items())
    parts = {
        "title": escape(f"{Path(of.source.name).name} · tumato-sym"),
        "policy": "; ".join(("default-src 'none'", *allowed, "base-uri 'none'", "form-action 'none'")),
        "style": style,
        "data": data_text(contents(of)),
        "program": program,
    }
    frame = (_FOLDER / "page.html").read_text(encoding="utf-8")
    return re.sub(r"\{\{(\w+)\}\}", lambda place: parts[place[1]], frame)


def sources(kind: type[PolicyPage | NoPolicyPage]) -> dict[str, str]:
    """The only program and style of a kind of page, as its content security policy names them."""
    return {"script-src": _hash(bundle(kind)), "style-src": _hash(_style())}


def bundle(kind: type[PolicyPage | NoPolicyPage]) -> str:
    """The program of a kind of page as one module."""
    texts = ((_FOLDER / f"{name}.mjs").read_text(encoding="utf-8") for name in MODULES[kind])
    return "".join(_tight(_joined(_plain(_alone(text)))) for text in texts)


def data_text(record: Mapping[str, object]) -> str:
    """A record as JSON in ASCII that ends no element, whatever names and comments are in it."""
    text = json.dumps(record, separators=(",", ":"))
    for character in "<>&":
        text = text.replace(character, f"\\u{ord(character):04x}")
    return text


def _alone(text: str) -> str:
    """A module without what ties it to others."""
    return re.sub(r"^export ", "", re.sub(r"^import [^;]*;\n", "", text, flags=re.MULTILINE), flags=re.MULTILINE)


_DECLARATIONS: Final = re.compile(r"^(const|let) ([^\n]*);\n(\1 [^\n]*;\n)+", re.MULTILINE)


def _joined(text: str) -> str:
    """Declarations that follow each other, each on a line of its own, as one."""
    return _DECLARATIONS.sub(lambda found: re.sub(rf";\n{found[1]} ", ",\n", found[0]), text)


def _plain(text: str) -> str:
    """Without indentation, and without lines that are comments."""
    lines = (line.strip() for line in text.splitlines())
    return "".join(f"{line}\n" for line in lines if line and not line.startswith("//"))


_PIECES: Final = re.compile(r'("(?:[^"\\\n]|\\.)*"|`(?:[^`\\]|\\.)*`)')
"""Strings and templates, which stay as they are; no template stands in another, and no regular expression anywhere."""

_SHORTER: Final = (
    (re.compile(r"\n(?!\w)|(?<!\w)\n| *([-{}()\[\],;:?<>=|&!+*/]) *"), r"\1"),
    (re.compile(r"(?<!\w)\((\w+)\)=>"), r"\1=>"),
    (re.compile(r"\bconst\b"), "let"),
)
"""What only people need, and what stands for it."""


def _tight(program: str) -> str:
    """The same in fewer letters: every statement ends with `;` or `}`."""
    parts = _PIECES.split(program)
    for longer, shorter in _SHORTER:
        parts[::2] = [longer.sub(shorter, part) for part in parts[::2]]
    return "".join(parts).replace(";}", "}") + "\n"


def _style() -> str:
    return _tight_style((_FOLDER / "page.css").read_text(encoding="utf-8"))


def _tight_style(style: str) -> str:
    """The same for a style sheet."""
    return re.sub(r"\s*([{};:,])\s*", r"\1", style).replace(";}", "}")


def _hash(text: str) -> str:
    digest = hashlib.sha256(text.encode()).digest()
    return f"'sha256-{base64.b64encode(digest).decode()}'"
