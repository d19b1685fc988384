"""The file format of policies (`docs/policy.md`), and of the certificate in them (`docs/certificate.md`)."""

from __future__ import annotations

from typing import Any

from tumato_symbolic.diagnostics import Code, Source, UserError
from tumato_symbolic.diagrams import Reference
from tumato_symbolic.policy.formats import header, kinds
from tumato_symbolic.policy.formats.diagrams import DiagramPart, section
from tumato_symbolic.policy.formats.kinds import Kind, Names
from tumato_symbolic.policy.formats.rows import RowsPart
from tumato_symbolic.policy.formats.tables import Entries, Field, Place, Record, plain, text_of
from tumato_symbolic.policy.records import (
    Certificate,
    DecisionDiagram,
    Deviation,
    PolicyFields,
    RankedGoal,
    Restoring,
    Table,
    Vocabulary,
)
from tumato_symbolic.policy.text import (
    MAX_BYTES,
    as_object,
    as_text,
    as_whole,
    fault,
    member,
    parse_json,
    show,
    too_large,
    way_out,
)

UNREALIZABLE = "unrealizable"
"""The `Type` of certificates of unrealizability."""

FRAMEWORK_VERSION = "0.0.0"
"""What policies of Tumato 2.0 carry as `PolicyFrameworkVersion`."""

_FRAMEWORK = Kind[str](kinds.TEXT.read, lambda _, __: FRAMEWORK_VERSION, kinds.TEXT.schema)


def _read_roots(value: object, where: str, names: Names) -> tuple[Reference, ...]:
    named, known = as_object(value, where), names.vocabulary.actions
    for name in named:
        if name not in known:
            raise fault(Code.TUM505, f"{where} has the unknown action {show(name)}", way_out(name, known, "actions"))
    roots = []
    for name in known:
        if name not in named:
            raise fault(Code.TUM505, f"{where} has no entry for the action {show(name)}")
        roots.append(as_whole(named[name], f"the root of {show(name)}", names.counts["reference"]))
    return tuple(roots)


ROOTS = Kind[tuple[Reference, ...]](
    _read_roots,
    lambda roots, names: dict(zip(names.vocabulary.actions, roots, strict=True)),
    {"type": "object", "additionalProperties": kinds.REFERENCE.schema},
)

DIAGRAM = section(
    DecisionDiagram,
    (
        DiagramPart("diagram", kinds.TRUTH),
        Field("Roots", ROOTS, "For every action, where the diagram of the states starts in which it is executed."),
        Field("Defined", kinds.REFERENCE, "Where the diagram of the states starts that are decided."),
    ),
)

DEVIATION = Record(
    Deviation, (Field("State", kinds.STATE), Field("Better", kinds.ACTION_SET), Field("Missed", kinds.STATE))
)
_BETTER = "Better sets that are not chosen, each with a state whose run would miss its goal."
_EFFORTS = "Efforts, each a duration and a number of steps; null where there is none."
_NOMINAL = "Where the efforts along nominal runs start, for states without a largest one."

RESTORING = section(
    Restoring,
    (
        DiagramPart("efforts", kinds.EFFORTS, _EFFORTS),
        Field("Worst", kinds.REFERENCE, "Where the largest efforts start."),
        Field("Nominal", kinds.REFERENCE, _NOMINAL),
        Entries("Deviations", DEVIATION, "deviation", _BETTER, first=1),
    ),
    "Where safety may take several steps to restore: how long that takes in each unsafe state.",
)

RANKED_GOAL = Record(
    RankedGoal, (Field("Bodies", kinds.TEXTS), Field("Executed", kinds.TEXTS), Field("Root", kinds.REFERENCE))
)

CERTIFICATE = section(
    Certificate,
    (
        DiagramPart("ranks", kinds.RANKS, "Ranks; null where the goal is never reached."),
        Entries("Goals", RANKED_GOAL, "goal", first=1),
        Field("Restoring", RESTORING, default=None),
    ),
    "Ranks per residual goal: what a proof that all goals are reached needs beside the policy.",
)


class _CertificatePart(Field, frozen=True):
    """The certificate; one that cannot be read is set aside, and `certificate_problem` says why."""

    def read(self, section: dict[str, Any], place: Place, names: Names) -> dict[str, Any]:
        """See `Part`."""
        try:
            return {**super().read(section, place, names), "certificate_problem": None}
        except UserError as error:
            return {"certificate": None, "certificate_problem": error.diagnostics[0].message}


def _file(form: str, decisions: RowsPart | Field) -> Record[PolicyFields]:
    return Record(
        PolicyFields,
        (
            Field("PolicyFrameworkVersion", _FRAMEWORK, name="", default=""),
            header.type_of_file(form),
            header.version("Version of the sections that Tumato 2.0 does not have."),
            header.digest("Identifies the meaning of the specification that the policy was made for.", None),
            header.ordering("The ordering of effects under which the policy is safe.", None),
            header.restoration("How the policy restores safety; one_step where it is missing."),
            header.VocabularyPart(
                "All actions, in the order of declaration.",
                "The variables; for each, its values and their indices 0, 1, … (or, for all variables, 1, 2, …).",
            ),
            decisions,
            _CertificatePart("Certificate", CERTIFICATE, default=None),
        ),
        style=plain,
    )


FILES = {
    "policy": (_file("policy", RowsPart()), "Policy"),
    "policy-diagram": (_file("policy-diagram", Field("Diagram", DIAGRAM, name="decisions")), "Diagram"),
}
"""By `Type`: the fields of a policy, and the key of its decisions."""


def policy_fields(text: str, name: str) -> PolicyFields:
    """The policy that `text` describes; `name` is what it is called in messages.

    Raises `UserError` (TUM501 to TUM508).
    """
    try:
        return fields_of(as_object(parse_json(text, name), "the policy"))
    except UserError as error:
        raise UserError(error.diagnostics, error.source or Source(name, "")) from None


def fields_of(document: dict[str, Any]) -> PolicyFields:
    """The policy that a JSON object describes. Raises `UserError`."""
    form = as_text(member(document, "Type", "the policy"), "`Type`")
    if form == UNREALIZABLE:
        message = "this is a certificate that a specification has no policy; it decides nothing"
        raise fault(Code.TUM502, message, "check it with `tumato-sym verify`")
    if form not in FILES:
        raise fault(Code.TUM502, f"`Type` is {show(form)}", 'expected "policy" or "policy-diagram"')
    table, body = FILES[form]
    for _, other in FILES.values():
        if other != body and other in document:
            raise fault(Code.TUM502, f"a policy of type {show(form)} must not have `{other}`", f"keep `{body}` only")
    member(document, body, f"a policy of type {show(form)}")
    return table.read(document, "the policy", Names(Vocabulary((), ())))


def policy_text(policy: PolicyFields) -> str:
    """A policy as JSON text in ASCII; a table has to be one that the format can hold (`fits_table`).

    Raises `UserError` (TUM508) where the text would be larger than what is read.
    """
    table, _ = FILES["policy" if isinstance(policy.decisions, Table) else "policy-diagram"]
    text = text_of(table, policy, Names(policy.vocabulary))
    if len(text) > MAX_BYTES:
        raise too_large("policy")
    return text
