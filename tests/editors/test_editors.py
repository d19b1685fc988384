"""What editors are given beside the server knows the words of the language, all of them and no others."""

import json
import re
import tomllib
from typing import Any

import pytest

from tests.editors.textmate import Highlighter
from tests.repo.documents import ROOT
from tumato_symbolic.diagnostics import Source
from tumato_symbolic.editor.format import format_text
from tumato_symbolic.syntax import parse
from tumato_symbolic.syntax.grammar import grammar
from tumato_symbolic.syntax.parser import read_terminals

EDITORS = ROOT / "editors"
WORDS = frozenset(each for each in grammar().keywords if each.isidentifier())
EXAMPLES = sorted((ROOT / "examples").glob("*.tum"))


def _json(path: str) -> Any:
    return json.loads((EDITORS / "vscode" / path).read_text(encoding="utf-8"))


TEXTMATE = _json("syntaxes/tumato.tmLanguage.json")
SNIPPETS = _json("snippets/tumato.json")


def _words(pattern: str) -> set[str]:
    """The words in a regular expression."""
    return set(re.findall(r"[A-Za-z_]{2,}", re.sub(r"\[[^\]]*\]|\\.", " ", pattern)))


def test_textmate_knows_the_words() -> None:
    """Every word of the grammar stands in a pattern, and nothing else."""
    assert set().union(*(_words(each.get("match", "")) for each in TEXTMATE["patterns"])) == WORDS


def test_vim_knows_the_words() -> None:
    """In its keywords and matches."""
    text = (EDITORS / "vim" / "syntax" / "tumato.vim").read_text(encoding="utf-8")
    found = set[str]()
    for line in text.splitlines():
        kind, _, rest = line.partition(" tumato")
        _, _, rest = rest.partition(" ")
        if kind == "syntax keyword":
            found |= set(rest.split())
        elif kind == "syntax match":
            found |= _words(re.sub(r"\\z[es]|@<=|contains=.*", " ", rest))
    assert found == WORDS


def test_emacs_knows_the_words() -> None:
    """In its two lists."""
    text = (EDITORS / "emacs" / "tumato-mode.el").read_text(encoding="utf-8")
    lists = re.findall(r"\(defconst tumato-(?:keywords|constants)\s+'\(([^)]*)\)", text)
    assert set(re.findall(r'"(\w+)"', " ".join(lists))) == WORDS
    assert text.count("(") == text.count(")")


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_textmate_colours_what_the_parser_reads(path: Any) -> None:
    """In every example: keywords are coloured as such, names are not, and comments are comments."""
    source = Source(path.name, path.read_text(encoding="utf-8"))
    _, tokens, terminals = read_terminals(source)
    lines = list(Highlighter(TEXTMATE).scopes(source.text))
    for token, terminal in zip(tokens, terminals, strict=True):
        scope = lines[token.line - 1].get(token.column - 1, "")
        if token.kind == "word" and terminal not in ("true", "false", "none"):
            keyword = scope.startswith(("keyword", "storage"))
            assert keyword == (terminal not in ("NAME", "NUMBER")), (token, scope)
        assert scope != "comment"


@pytest.mark.parametrize("name", SNIPPETS)
def test_snippets_are_sentences(name: str) -> None:
    """With what they propose, they are laid out, and can be read where they belong."""
    body = "\n".join(SNIPPETS[name]["body"])
    choices = re.sub(r"\$\{\d+\|(\w+),[^}]*\|\}", r"\1", body)
    text = re.sub(r"\$\{\d+:([^}]*)\}", r"\1", choices).replace("$0", "")
    blocks = {
        "state": "BEGIN STATE VECTOR\n{}\nEND STATE VECTOR\n",
        "action": "BEGIN ACTIONS\n{}\nEND ACTIONS\n",
        "rule": "BEGIN STATE RULES\n{}\nEND STATE RULES\n",
        "when": "BEGIN GOALS\ngoal type: priority\n{}\nEND GOALS\n",
        "for": "BEGIN STATE RULES\n{}\nEND STATE RULES\n",
        "allow": "BEGIN STATE RULES\n{}\nrule: true\nEND STATE RULES\n",
    }
    whole = blocks.get(SNIPPETS[name]["prefix"], "{}\n").format(text)
    source = Source(name, re.sub(r"\n\s*\n(?=end for|END)", "\n", whole))
    assert parse(source).diagnostics == ()
    assert format_text(source) == source.text


def test_the_extension_is_of_this_version() -> None:
    """Its version is that of the package, and every file that it names is there."""
    manifest = _json("package.json")
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert (manifest["version"], manifest["license"]) == (project["version"], project["license"])
    contributed = manifest["contributes"]
    paths = [manifest["main"], *(each["configuration"] for each in contributed["languages"])]
    paths += [each["path"] for kind in ("grammars", "snippets") for each in contributed[kind]]
    assert all((EDITORS / "vscode" / path).is_file() for path in paths)
    assert _json("language-configuration.json")["comments"]["lineComment"] == "//"
