"""Every declaration of a specification, found and numbered; names that are declared twice or reserved."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Final, Literal, TypeAlias, get_args

from msgspec import Struct

from tumato_symbolic.diagnostics import Code, Note, Span
from tumato_symbolic.diagnostics.wording import quoted
from tumato_symbolic.spec.collector import Findings
from tumato_symbolic.spec.specification import Variable
from tumato_symbolic.spec.values import declared_values
from tumato_symbolic.syntax import ast

MAX_VARIABLES = 1_000
"""The most state variables."""

MAX_ACTIONS = 10_000
"""The most actions."""

Kind: TypeAlias = Literal["state variable", "alias", "resource", "action", "named list"]

_RESERVED = frozenset({"true", "false", "none", "executing"})


class Declared(Struct, frozen=True):
    """What a name stands for: the how-many-th declaration of which kind, and where."""

    kind: Kind
    number: int
    span: Span


class Names(Struct, frozen=True):
    """All declarations, in order, without repetitions, and what each name stands for.

    `unsettled` are the variables whose values are in error.
    """

    variables: tuple[Variable, ...]
    values: tuple[Mapping[str, int], ...]
    aliases: tuple[ast.AliasDefinition, ...]
    resources: tuple[ast.ResourceDeclaration, ...]
    actions: tuple[ast.ActionDeclaration, ...]
    table: Mapping[str, Declared]
    unsettled: frozenset[int] = frozenset()

    def of_kind(self, kind: Kind) -> list[str]:
        """All names of one kind, in order of declaration."""
        return [name for name, declared in self.table.items() if declared.kind == kind]


def collect(tree: ast.Specification, findings: Findings) -> Names:
    """Find every declaration; report names that are declared twice, shadow another kind, or are reserved."""
    table: dict[str, Declared] = {}
    declared: dict[Kind, list[ast.Declaration]] = {kind: [] for kind in get_args(Kind)}
    for block in tree.blocks:
        for each in _declarations(block):
            kind = KINDS[type(each)]
            if _declare(table, each.name, kind, len(declared[kind]), findings):
                declared[kind].append(each)
    _limit(declared["state variable"], MAX_VARIABLES, "state variables", findings)
    _limit(declared["action"], MAX_ACTIONS, "actions", findings)
    variables = [each for each in declared["state variable"] if isinstance(each, ast.VariableDeclaration)]
    values = declared_values(variables, findings)
    return Names(
        tuple(Variable(each.name.text, own.texts, each.name.span) for each, own in zip(variables, values, strict=True)),
        tuple({value: number for number, value in enumerate(own.texts)} for own in values),
        tuple(each for each in declared["alias"] if isinstance(each, ast.AliasDefinition)),
        tuple(each for each in declared["resource"] if isinstance(each, ast.ResourceDeclaration)),
        tuple(each for each in declared["action"] if isinstance(each, ast.ActionDeclaration)),
        table,
        frozenset(number for number, each in enumerate(values) if not each.complete),
    )


KINDS: Final[Mapping[type, Kind]] = {
    ast.VariableDeclaration: "state variable",
    ast.AliasDefinition: "alias",
    ast.NamedList: "named list",
    ast.ResourceDeclaration: "resource",
    ast.ActionDeclaration: "action",
}
"""What declarations declare."""


def _declarations(block: ast.Block) -> Iterable[ast.Declaration]:
    match block:
        case ast.StateVector(variables):
            return ast.one_by_one(variables)
        case ast.Aliases(definitions):
            return ast.one_by_one(definitions)
        case ast.Resources(resources):
            return ast.one_by_one(resources)
        case ast.Actions(actions):
            return ast.one_by_one(actions)
        case _:
            return ()


def _declare(table: dict[str, Declared], name: ast.Name, kind: Kind, number: int, findings: Findings) -> bool:
    """Enter a name; False where it is taken already by the same kind."""
    first = table.get(name.text)
    if first is None:
        table[name.text] = Declared(kind, number, name.span)
        if name.text in _RESERVED:
            findings.add(
                Code.TUM205,
                f"{quoted(name.text)} is a word of the language and cannot name {article(kind)}",
                name.span,
                "choose another name",
            )
        return True
    notes = (Note(f"{quoted(name.text)} is declared first here", first.span),)
    if first.kind == kind:
        findings.add(Code.TUM203, f"the {kind} {quoted(name.text)} is declared twice", name.span, "remove one", notes)
        return False
    findings.add(
        Code.TUM204,
        f"{quoted(name.text)} names {article(first.kind)} already and cannot name {article(kind)}",
        name.span,
        "choose another name for one of them",
        notes,
    )
    return False


def _limit(declared: Sequence[ast.Declaration], limit: int, what: str, findings: Findings) -> None:
    if len(declared) > limit:
        message = f"there are more than {limit:,} {what}"
        findings.add(Code.TUM311, message, declared[limit].name.span, "split the specification")


def article(kind: str) -> str:
    """A kind with its article."""
    return f"an {kind}" if kind[0] in "ae" else f"a {kind}"
