"""What an editor shows about a name (hover), as Markdown."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from tumato_symbolic.diagnostics.wording import count
from tumato_symbolic.editor.mentions import Index, Mention, Symbol, Use

_MOST = 12
"""So many places of one kind are named."""


def hover(known: Index, line: int, column: int) -> str | None:
    """About the name at a line and column; None where there is none."""
    symbols = dict.fromkeys(each.symbol for each in known.at(line, column))
    if not symbols:
        return None
    if len(symbols) > _MOST:
        return f"{len(symbols)} names, one for each copy: {_listed(each.name for each in symbols)}"
    return "\n\n---\n\n".join("\n\n".join(_about(known, symbol)) for symbol in symbols)


def _about(known: Index, symbol: Symbol) -> Iterator[str]:
    """Paragraphs about one symbol."""
    mentions = known.of_symbol.get(symbol, ())
    declared = bool(known.declarations(symbol))
    match symbol.kind:
        case "state variable":
            values = _listed(known.values(symbol.name))
            yield f"state variable `{symbol.name}`, one of {values}" if declared else _unknown(symbol)
            written = _inside(mentions, "written")
            yield f"written by {written}" if written else "no action writes it: it is the environment's"
            yield from _told("read by", _inside(mentions, "read"))
        case "value":
            yield f"value `{symbol.name}` of `{symbol.of}`" if declared else _unknown(symbol)
            yield from _told("set by", _inside(mentions, "written"))
            yield from _told("asked for by", _inside(mentions, "read"))
        case "action":
            yield f"action `{symbol.name}`" if declared else _unknown(symbol)
            yield from _told("writes", _of_action(known, symbol, "written"))
            yield from _told("reads", _of_action(known, symbol, "read"))
            yield from _told("needs", _of_action(known, symbol, "needed"))
            yield from _told("`executing` stands in", _inside(mentions, "executed"))
        case "alias" | "named list":
            yield f"{symbol.kind} `{symbol.name}`" if declared else _unknown(symbol)
            yield from _told("used by", _inside(mentions, "read"))
        case "resource":
            yield f"resource `{symbol.name}`" if declared else _unknown(symbol)
            yield from _told("needed by", _inside(mentions, "needed"))
        case "parameter":
            uses = sum(each.use == "read" for each in mentions)
            yield f"parameter `{symbol.name}`, which stands in {count(uses, 'place')}"
    text = _declaration(known, symbol)
    if text:
        yield f"```tumato\n{text}\n```"


def _unknown(symbol: Symbol) -> str:
    return f"`{symbol.name}` is not declared"


def _told(head: str, listed: str) -> Iterator[str]:
    if listed:
        yield f"{head} {listed}"


def _inside(mentions: Iterable[Mention], use: Use) -> str:
    """The entries in which a symbol is mentioned in one way, each with how often if more than once."""
    counted: dict[str, int] = {}
    for each in mentions:
        if each.use == use:
            counted[each.inside] = counted.get(each.inside, 0) + 1
    unnamed = {inside: number for inside, number in counted.items() if "`" not in inside}
    named = [inside for inside in counted if inside not in unnamed]
    several = [inside if number == 1 else f"{inside} ({number} times)" for inside, number in unnamed.items()]
    return _joined([*named, *several])


def _of_action(known: Index, symbol: Symbol, use: Use) -> str:
    """The variables or resources that an action uses in one way."""
    inside = f"action `{symbol.name}`"
    names = (each.symbol.name for each in known.mentions if each.inside == inside and each.use == use)
    kinds = {name: None for name in names if Symbol("state variable", name) in known.of_symbol or use == "needed"}
    return _listed(kinds)


def _declaration(known: Index, symbol: Symbol) -> str:
    """The line of the declaration, as it is written."""
    spans = known.declarations(symbol)
    if not spans or symbol.kind == "value":
        return ""
    return known.source.text.split("\n")[spans[0].line - 1].strip()


def _listed(names: Iterable[str]) -> str:
    return _joined([f"`{name}`" for name in names])


def _joined(texts: list[str]) -> str:
    if len(texts) > _MOST:
        return f"{', '.join(texts[:_MOST])} and {len(texts) - _MOST} more"
    return ", ".join(texts)
