"""Faults that can be planted in a module: every small change of its syntax tree, by a name that outlives line numbers.

What is left alone: types, decorators, texts, what is raised (only that it is raised counts), constants in capitals,
which are limits of time and memory, and `strict=True`, which only asserts.
"""

from __future__ import annotations

import ast
import copy
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

from msgspec import Struct

COMPARISONS: dict[type[ast.cmpop], tuple[type[ast.cmpop], ...]] = {
    ast.Lt: (ast.LtE, ast.GtE),
    ast.LtE: (ast.Lt, ast.Gt),
    ast.Gt: (ast.GtE, ast.LtE),
    ast.GtE: (ast.Gt, ast.Lt),
    ast.Eq: (ast.NotEq,),
    ast.NotEq: (ast.Eq,),
    ast.In: (ast.NotIn,),
    ast.NotIn: (ast.In,),
    ast.Is: (ast.IsNot,),
    ast.IsNot: (ast.Is,),
}
OPERATORS: dict[type[ast.operator], type[ast.operator]] = {
    ast.Add: ast.Sub,
    ast.Sub: ast.Add,
    ast.Mult: ast.Add,
    ast.FloorDiv: ast.Mult,
    ast.Mod: ast.FloorDiv,
    ast.BitAnd: ast.BitOr,
    ast.BitOr: ast.BitAnd,
    ast.LShift: ast.RShift,
    ast.RShift: ast.LShift,
}
OPPOSITES = [
    ("any", "all"),
    ("min", "max"),
    ("conjunction", "disjunction"),
    ("all_of", "any_of"),
    ("intersection", "union"),
    ("ULE", "ULT"),
    ("UGE", "UGT"),
]
OPPOSITE = {one: other for pair in OPPOSITES for one, other in (pair, pair[::-1])}
NEGATIONS = {"negation", "Not"}
COLLECTING = {"conjunction", "disjunction", "all_of", "any_of", "intersection", "union", "And", "Or"}
"""Functions of several terms, given as one tuple or list: one of them may be forgotten."""
EITHER_WAY = {"min", "max", "gcd", "same", "isinstance", "suppress"}
"""Functions whose arguments are not exchanged: it would change nothing, or fail wherever it is met."""
ASKING = {"add", "ask", "define", "scope", "find", "first_model", "some_state", "some_step"}
"""Functions of several terms, given as arguments."""
WORDS = {
    "proved": "refuted",
    "refuted": "proved",
    "undecided": "proved",
    "unsat": "sat",
    "sat": "unsat",
    "unknown": "unsat",
    "any": "first",
    "first": "any",
}


class Site(Struct, frozen=True):
    """One fault: `name` says where and what, `line` is where it stands today, `number` its place in the module."""

    name: str
    line: int
    number: int


class _Change(Struct, frozen=True):
    """Another node in the place of one: `field` of `parent`, at `index` where the field is a list."""

    parent: ast.AST
    field: str
    index: int | None
    before: ast.AST
    after: ast.AST
    owner: str

    @property
    def name(self) -> str:
        return f"{self.owner}: {_text(self.before)} -> {_text(self.after)}"


def sites(path: Path, module: str) -> list[Site]:
    """Every fault of a module, in the order of its text."""
    return [site for site, _ in _named(ast.parse(path.read_text(encoding="utf-8")), module)]


def planted(path: Path, module: str, number: int) -> ast.Module:
    """The syntax tree of a module with one fault."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    change = next(change for site, change in _named(tree, module) if site.number == number)
    if change.index is None:
        setattr(change.parent, change.field, change.after)
    else:
        getattr(change.parent, change.field)[change.index] = change.after
    return ast.fix_missing_locations(tree)


def _named(tree: ast.Module, module: str) -> Iterator[tuple[Site, _Change]]:
    met: Counter[str] = Counter()
    for number, change in enumerate(_changes(tree, module)):
        met[change.name] += 1
        again = f" #{met[change.name]}" if met[change.name] > 1 else ""
        yield Site(change.name + again, getattr(change.before, "lineno", 0), number), change


def _text(node: ast.AST) -> str:
    return " ".join(ast.unparse(node).split())


def _changes(node: ast.AST, owner: str) -> Iterator[_Change]:
    for field, value in ast.iter_fields(node):
        if _is_left_alone(node, field):
            continue
        children = value if isinstance(value, list) else [value]
        for index, child in enumerate(children):
            if not isinstance(child, ast.AST) or _is_text(child):
                continue
            inner = owner
            if isinstance(child, (ast.FunctionDef, ast.ClassDef)):
                inner = f"{owner}.{child.name}" if ":" in owner else f"{owner}:{child.name}"
            place = index if isinstance(value, list) else None
            for after in (*_instead(child), *_as_condition(node, field, child)):
                yield _Change(node, field, place, child, ast.copy_location(after, child), inner)
            yield from _changes(child, inner)


def _is_left_alone(node: ast.AST, field: str) -> bool:
    if field in ("annotation", "returns", "decorator_list", "bases", "type_params", "pattern"):
        return True
    if isinstance(node, ast.Module):
        return False
    if isinstance(node, (ast.Raise, ast.JoinedStr, ast.Import, ast.ImportFrom)):
        return True
    if isinstance(node, ast.keyword) and node.arg == "strict":
        return True
    targets = node.targets if isinstance(node, ast.Assign) else [node.target] if isinstance(node, ast.AnnAssign) else []
    names = [target.id for target in targets if isinstance(target, ast.Name)]
    return any(name.isupper() or name == "__all__" or (name[:1].isupper() and field == "value") for name in names)


def _is_text(node: ast.AST) -> bool:
    return (isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)) or (
        isinstance(node, ast.If) and isinstance(node.test, ast.Name) and node.test.id == "TYPE_CHECKING"
    )


def _instead(node: ast.AST) -> Iterator[ast.AST]:
    """What may stand in the place of `node`."""
    match node:
        case ast.Compare():
            for place, operator in enumerate(node.ops):
                for other in COMPARISONS[type(operator)]:
                    yield _with(node, ops=[*node.ops[:place], other(), *node.ops[place + 1 :]])
        case ast.Constant(value=bool(value)):
            yield ast.Constant(not value)
        case ast.Constant(value=int(value)):
            yield ast.Constant(value + 1)
            yield ast.Constant(value - 1)
        case ast.Constant(value=str(value)) if value in WORDS:
            yield ast.Constant(WORDS[value])
        case ast.BinOp(op=operator):
            if type(operator) in OPERATORS:
                yield _with(node, op=OPERATORS[type(operator)]())
            yield node.left
            if not isinstance(operator, (ast.Sub, ast.FloorDiv, ast.Mod, ast.LShift, ast.RShift)):
                yield node.right
        case ast.AugAssign(op=operator):
            if type(operator) in OPERATORS:
                yield _with(node, op=OPERATORS[type(operator)]())
            yield ast.Pass()
        case ast.BoolOp():
            yield _with(node, op=ast.Or() if isinstance(node.op, ast.And) else ast.And())
            for place in range(len(node.values)):
                rest = [*node.values[:place], *node.values[place + 1 :]]
                yield rest[0] if len(rest) == 1 else _with(node, values=rest)
        case ast.UnaryOp(op=ast.Not() | ast.USub() | ast.Invert()):
            yield node.operand
        case ast.IfExp():
            yield _with(node, body=node.orelse, orelse=node.body)
        case ast.Call():
            yield from _other_calls(node)
        case ast.Expr(value=ast.Call()) | ast.Raise():
            yield ast.Pass()
        case ast.Break():
            yield ast.Continue()
            yield ast.Pass()
        case ast.Continue():
            yield ast.Break()
            yield ast.Pass()
        case ast.Slice():
            if node.lower is not None:
                yield _with(node, lower=None)
            if node.upper is not None:
                yield _with(node, upper=None)


def _as_condition(parent: ast.AST, field: str, node: ast.AST) -> Iterator[ast.AST]:
    """What may stand in the place of a condition, beside what its operators allow."""
    is_test = field == "test" and isinstance(parent, (ast.If, ast.IfExp))
    if is_test and isinstance(node, (ast.Name, ast.Call, ast.Attribute, ast.BinOp)):
        yield ast.UnaryOp(ast.Not(), node)
    if isinstance(parent, ast.comprehension) and field == "ifs":
        yield ast.Constant(True)
    if isinstance(parent, ast.Return) and isinstance(node, (ast.Compare, ast.BoolOp)):
        yield ast.Constant(True)
        yield ast.Constant(False)


def _other_calls(node: ast.Call) -> Iterator[ast.AST]:
    name = node.func.id if isinstance(node.func, ast.Name) else getattr(node.func, "attr", "")
    if name in OPPOSITE:
        other = OPPOSITE[name]
        function = ast.Name(other, ast.Load()) if isinstance(node.func, ast.Name) else _with(node.func, attr=other)
        yield _with(node, func=function)
    if name in NEGATIONS and len(node.args) == 1:
        yield node.args[0]
    if name == "range" and len(node.args) == 1:
        yield _with(node, args=[ast.BinOp(node.args[0], ast.Sub(), ast.Constant(1))])
    starred = any(isinstance(argument, ast.Starred) for argument in node.args)
    if len(node.args) >= 2 and not starred and name not in ASKING | EITHER_WAY:
        *rest, last, swapped = node.args
        yield _with(node, args=[*rest, swapped, last])
    if name in ASKING and len(node.args) >= 2:
        for left_out in range(len(node.args)):
            yield _with(node, args=[*node.args[:left_out], *node.args[left_out + 1 :]])
    if name in COLLECTING:
        for place, argument in enumerate(node.args):
            if isinstance(argument, (ast.Tuple, ast.List)) and len(argument.elts) >= 2:
                for left_out in range(len(argument.elts)):
                    rest = [*argument.elts[:left_out], *argument.elts[left_out + 1 :]]
                    yield _with(node, args=[*node.args[:place], _with(argument, elts=rest), *node.args[place + 1 :]])


def _with(node: ast.AST, **fields: object) -> ast.AST:
    changed = copy.copy(node)
    for field, value in fields.items():
        setattr(changed, field, value)
    return changed
