"""From the text of the grammar to the parse table: what lark does for us."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from lark import Lark, Token
from lark.grammar import Rule as LarkRule
from lark.lexer import Lexer
from lark.parsers.lalr_analysis import Shift

from tumato_symbolic.syntax.table import Rule, Table, is_list

_START = "specification"


class _NoLexer(Lexer):
    """In place of a lexer: tokens come from elsewhere, and lark need not compile their patterns."""

    def __init__(self, lexer_conf: object) -> None:
        pass

    def lex(self, lexer_state: object, parser_state: object) -> Iterator[Token]:  # noqa: ARG002 - what lark calls
        return iter(())


def compile_table(grammar: str) -> Table:
    """The table of a grammar: always the same one, although lark numbers states as it happens to meet them."""
    parser = Lark(grammar, start=_START, parser="lalr", lexer=_NoLexer, keep_all_tokens=True, maybe_placeholders=False)
    found = parser.parse_interactive().parser_state.parse_conf.parse_table
    spelling = {each.name: each.pattern.value for each in parser.terminals if each.pattern.type == "str"}
    origins = {rule.origin.name for rule in parser.rules}
    number = _numbered(found.states, found.start_states[_START])
    place = {rule: index for index, rule in enumerate(parser.rules)}

    def row(state: int, of_origins: bool) -> dict[str, int]:
        row = {
            spelling.get(symbol, str(symbol)): number[target] if action is Shift else -1 - place[target]
            for symbol, (action, target) in found.states[state].items()
            if (symbol in origins) == of_origins
        }
        return dict(sorted(row.items()))

    return Table(
        {each.name: each.pattern.value for each in parser.terminals if each.pattern.type == "re"},
        tuple(_rule(rule, spelling) for rule in parser.rules),
        tuple(row(state, of_origins=False) for state in number),
        tuple(row(state, of_origins=True) for state in number),
        number[found.end_states[_START]],
    )


def _numbered(states: Mapping[int, Mapping[str, tuple[Any, Any]]], start: int) -> dict[int, int]:
    """A number for each state, in the order in which a walk from the start meets them."""
    order = [start]
    seen = {start}
    for state in order:
        for _, (action, target) in sorted(states[state].items()):
            if action is Shift and target not in seen:
                seen.add(target)
                order.append(target)
    return {state: number for number, state in enumerate(order)}


def _rule(rule: LarkRule, spelling: Mapping[str, str]) -> Rule:
    origin, parts = str(rule.origin.name), tuple(spelling.get(each.name, str(each.name)) for each in rule.expansion)
    stands_for_its_part = rule.options.expand1 and not rule.alias and len(parts) == 1
    node = None if stands_for_its_part or is_list(origin) else str(rule.alias or origin)
    return Rule(origin, parts, node)
