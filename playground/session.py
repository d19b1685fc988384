"""What the worker asks of the package: the mistakes in a text, what synthesis and the walk say of it, and a page.

Answers are JSON. Nothing here makes a child process, and nothing needs Z3.
"""

from __future__ import annotations

import json
import tempfile
from collections.abc import Callable, Iterable
from contextlib import redirect_stdout
from io import StringIO
from pathlib import Path
from typing import TypeAlias

from msgspec.structs import replace

from tumato_symbolic.cli.synthesizing import answer_page, prove, solve
from tumato_symbolic.diagnostics import Diagnostic, Source, UserError
from tumato_symbolic.editor.checking import findings
from tumato_symbolic.editor.positions import Positions
from tumato_symbolic.limits import Context, LimitReachedError, has_z3
from tumato_symbolic.policy import dumps
from tumato_symbolic.policy.unrealizability import dumps as certificate_text
from tumato_symbolic.report.html.page import page
from tumato_symbolic.report.layout import seconds
from tumato_symbolic.report.proof import provers, states_covered
from tumato_symbolic.report.synthesized import Synthesized
from tumato_symbolic.report.unrealizable import proof_line
from tumato_symbolic.spec import load
from tumato_symbolic.synthesis import Realizable, Undecided, Unrealizable

SPEC_NAME, POLICY_NAME, CERTIFICATE_NAME = "specification.tum", "policy.json", "policy.unrealizable.json"

NO_Z3 = (
    "the certificate was too much for the stand-alone checker, and Z3, which may take it, does not run here; "
    f"`tumato-sym verify {CERTIFICATE_NAME} SPEC` asks it"
)

Tell: TypeAlias = Callable[[str], None]
"""Is told the name of every stage."""


def check(text: str) -> str:
    """Mistakes, warnings and remarks, in the order of the text; places count lines and UTF-16 units from 0."""
    source = Source(SPEC_NAME, text)
    return json.dumps(_problems(source, text, findings(source)))


class Session:
    """Remembers the last answer, of which a page can be made."""

    def __init__(self) -> None:
        self._done: Synthesized | None = None

    def solve(self, text: str, tell: Tell) -> str:
        """Synthesize what a text means, and prove the policy by the walk; `files` are what `synth` would write."""
        self._done, source, context = None, Source(SPEC_NAME, text), Context(progress=tell)
        loaded = load(source)
        if loaded.spec is None:
            return _mistaken(source, text, loaded.diagnostics)
        done = Synthesized(
            source, loaded.spec, Undecided("", None), None, loaded.diagnostics, output=POLICY_NAME, written=False
        )
        try:
            done = solve(done, None, "auto", context)
            done = prove(done, "walk", 1, context, wanted=True)
        except UserError as error:
            return _mistaken(source, text, error.diagnostics)
        except LimitReachedError as limit:
            done = replace(done, outcome=Undecided(str(limit), None))
        proved = done.proof is not None and done.proof.verdict == "proved"
        files = _files(done, proved)
        certificate = files.get(CERTIFICATE_NAME)
        if certificate is not None and not has_z3():
            tell("checking the certificate")
            done = _checked(done, certificate)
        self._done = done = replace(done, written=proved, certificate=next(iter(files), None))
        return json.dumps({**_said(done), "problems": _problems(source, text, done.warnings), "files": files})

    def report(self, tell: Tell) -> str:
        """The page about the last answer; empty where there is none to make a page of."""
        if self._done is None:
            return ""
        of = answer_page(self._done, Context(progress=tell))
        return "" if of is None else page(of)


def _mistaken(source: Source, text: str, found: Iterable[Diagnostic]) -> str:
    problems = _problems(source, text, found)
    heading = "There are mistakes to correct first."
    return json.dumps({"verdict": "mistakes", "heading": heading, "lines": [], "problems": problems, "files": {}})


def _files(done: Synthesized, proved: bool) -> dict[str, str]:
    """What `synth` would write: the policy once it is proved, or the certificate that there is none."""
    match done.outcome:
        case Realizable(policy=policy) if proved:
            return {POLICY_NAME: dumps(policy)}
        case Unrealizable(certificate=certificate) if certificate is not None:
            return {CERTIFICATE_NAME: certificate_text(certificate)}
        case _:
            return {}


def _checked(done: Synthesized, certificate: str) -> Synthesized:
    """What the stand-alone checker says of a certificate, where Z3 would have been needed."""
    found = done.unrealizability
    if found is None or found.verdict != "undecided":
        return done
    code, said = _by_checker(done.source.text, certificate)
    if code == 0:
        found = replace(found, verdict="proved", reason=None, by_checker=True)
    elif code == 1:
        found = replace(found, verdict="refuted", reason=said, by_checker=True)
    else:
        found = replace(found, reason=NO_Z3)
    return replace(done, unrealizability=found)


def _by_checker(text: str, certificate: str) -> tuple[int, str]:
    """The exit code of `proofs/checker.py`, and what it prints."""
    from proofs import checker

    with tempfile.TemporaryDirectory() as folder, redirect_stdout(StringIO()) as said:
        spec, claim = Path(folder, SPEC_NAME), Path(folder, CERTIFICATE_NAME)
        spec.write_text(text, encoding="utf-8")
        claim.write_text(certificate, encoding="utf-8")
        return checker.main([str(claim), str(spec)]), said.getvalue().strip()


def _said(done: Synthesized) -> dict[str, object]:
    """The verdict in a word, a heading, and lines below it."""
    match done.outcome:
        case Realizable(statistics=statistics) if done.written and done.proof is not None:
            longest = statistics.longest_told
            lines = [
                f"Found in {seconds(done.solved_in)}, proved by {provers(done.proof)} in {seconds(done.proved_in)}.",
                f"The longest run to a goal takes {longest}.",
            ]
            heading = f"A policy is proved for {states_covered(done.proof)}."
            return {"verdict": "realizable", "heading": heading, "lines": lines}
        case Realizable():
            reasons = [each.reason for each in done.proof.properties if each.reason] if done.proof else []
            heading = "A policy was found, and not proved."
            return {"verdict": "undecided", "heading": heading, "lines": reasons}
        case Unrealizable():
            return {"verdict": "unrealizable", "heading": "There is no policy.", "lines": _proof_of_none(done)}
        case Undecided(limit=limit):
            return {"verdict": "undecided", "heading": "Undecided.", "lines": [limit]}


def _proof_of_none(done: Synthesized) -> list[str]:
    found, lines = done.unrealizability, [f"Found in {seconds(done.solved_in)}."]
    if found is not None and found.verdict == "proved":
        line = proof_line(done.spec, found)
        lines.append(f"{line[0].upper()}{line[1:]}.")
    elif found is not None and found.reason:
        lines.append(f"Not proved: {found.reason}.")
    return lines


def _problems(source: Source, text: str, found: Iterable[Diagnostic]) -> list[dict[str, object]]:
    positions = Positions(source, text)
    return [
        {
            "severity": each.severity,
            "code": each.code.name,
            "message": each.message,
            "help": each.help,
            "notes": [f"line {note.span.line}: {note.message}" for note in each.notes],
            "range": None if each.span is None else positions.range(each.span),
        }
        for each in found
    ]
