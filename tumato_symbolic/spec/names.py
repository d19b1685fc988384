"""Every declaration of a specification, found and numbered."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Literal, TypeAlias

from tumato_symbolic.diagnostics import Code, Note, Span
from tumato_symbolic.diagnostics.wording import quoted
from tumato_symbolic.spec.findings import Findings
from tumato_symbolic.spec.model import Variable
from tumato_symbolic.syntax import ast

MAX_VARIABLES = 1_000
MAX_VALUES = 10_000
MAX_ACTIONS = 1_000

Kind: TypeAlias = Literal["state variable", "alias", "resource", "action"]

_RESERVED = frozenset({"true", "false", "none", "executing"})


@dataclass(frozen=True, slots=True)
class Declared:
    """What a name stands for: the how-many-th declaration of which kind, and where."""

    kind: Kind
    number: int
    span: Span


@dataclass(frozen=True, slots=True)
class Names:
    """All declarations, in order, without repetitions, and what each name stands for."""

    variables: tuple[Variable, ...]
    values: tuple[Mapping[str, int], ...]
    aliases: tuple[ast.AliasDefinition, ...]
    resources: tuple[ast.ResourceDeclaration, ...]
    actions: tuple[ast.ActionDeclaration, ...]
    table: Mapping[str, Declared]

    def of_kind(self, kind: Kind) -> list[str]:
        """All names of one kind, in order of declaration."""
        return [name for name, declared in self.table.items() if declared.kind == kind]


def collect(tree: ast.Specification, findings: Findings) -> Names:
    """Find every declaration; report names that are declared twice, shadow another kind, or are reserved."""
    table: dict[str, Declared] = {}
    variables: list[Variable] = []
    aliases: list[ast.AliasDefinition] = []
    resources: list[ast.ResourceDeclaration] = []
    actions: list[ast.ActionDeclaration] = []
    for block in tree.blocks:
        match block:
            case ast.StateVector(declarations):
                for each in declarations:
                    if _declare(table, each.name, "state variable", len(variables), findings):
                        values = tuple(_distinct_values(each, findings))
                        variables.append(Variable(each.name.text, values, each.name.span))
            case ast.Aliases(definitions):
                for definition in definitions:
                    if _declare(table, definition.name, "alias", len(aliases), findings):
                        aliases.append(definition)
            case ast.Resources(declared):
                for resource in declared:
                    if _declare(table, resource.name, "resource", len(resources), findings):
                        resources.append(resource)
            case ast.Actions(declared_actions):
                for action in declared_actions:
                    if _declare(table, action.name, "action", len(actions), findings):
                        actions.append(action)
            case _:
                pass
    if len(variables) > MAX_VARIABLES:
        _too_many("state variables", MAX_VARIABLES, variables[MAX_VARIABLES].span, findings)
    if len(actions) > MAX_ACTIONS:
        _too_many("actions", MAX_ACTIONS, actions[MAX_ACTIONS].name.span, findings)
    numbers = tuple({value: number for number, value in enumerate(each.values)} for each in variables)
    return Names(tuple(variables), numbers, tuple(aliases), tuple(resources), tuple(actions), table)


def _declare(table: dict[str, Declared], name: ast.Name, kind: Kind, number: int, findings: Findings) -> bool:
    """Enter a name; False where it is taken already by the same kind."""
    first = table.get(name.text)
    if first is None:
        table[name.text] = Declared(kind, number, name.span)
        if name.text in _RESERVED:
            findings.add(
                Code.TUM205,
                f"{quoted(name.text)} is a word of the language and cannot name {_article(kind)}",
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
        f"{quoted(name.text)} names {_article(first.kind)} already and cannot name {_article(kind)}",
        name.span,
        "choose another name for one of them",
        notes,
    )
    return False


def _distinct_values(declaration: ast.VariableDeclaration, findings: Findings) -> Iterable[str]:
    """The values in order; the first repetition of each is reported."""
    places: dict[str, Span] = {}
    reported: set[str] = set()
    for value in declaration.values:
        if value.text not in places:
            places[value.text] = value.span
        elif value.text not in reported:
            reported.add(value.text)
            findings.add(
                Code.TUM203,
                f"{quoted(declaration.name.text)} lists the value {quoted(value.text)} twice",
                value.span,
                "remove one",
                (Note("it is listed first here", places[value.text]),),
            )
    if len(places) > MAX_VALUES:
        _too_many("values of one state variable", MAX_VALUES, declaration.name.span, findings)
    return places


def _too_many(what: str, limit: int, span: Span, findings: Findings) -> None:
    findings.add(Code.TUM311, f"there are more than {limit:,} {what}", span, "split the specification")


def _article(kind: str) -> str:
    return f"an {kind}" if kind[0] in "ae" else f"a {kind}"
