"""What `sweep` found: a table for each kind of variants, what matters in it, and findings at their places."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence

from msgspec import Struct

from tumato_symbolic.diagnostics import Span
from tumato_symbolic.report.findings import Finding
from tumato_symbolic.report.layout import Paint, count, enumeration
from tumato_symbolic.sweep import Line, Plan

_WIDEST = 60
"""Columns for what is changed."""


class Swept(Struct, frozen=True):
    """The results that are known by now, in order; `limit` is why some are missing."""

    plan: Plan
    lines: tuple[Line, ...]
    limit: str | None = None

    @property
    def base(self) -> Line | None:
        """The specification itself."""
        return next((each for each in self.lines if each["variant"] == 0), None)

    @property
    def variants(self) -> list[Line]:
        """All others."""
        return [each for each in self.lines if each["variant"]]

    @property
    def counted(self) -> list[Line]:
        """Of mutations, those that change the meaning and are no error; of other variants, all."""
        if self.plan.kind != "mutate":
            return self.variants
        same = None if self.base is None else self.base["digest"]
        return [each for each in self.variants if each["verdict"] != "error" and each["digest"] != same]

    @property
    def idle(self) -> list[Line]:
        """Those that make no difference."""
        return [each for each in self.counted if each["differs"] is False]


def as_text(done: Swept, colour: bool) -> str:
    """One table, and what it comes to."""
    paint = Paint(colour)
    lines = [*_base(done)]
    match done.plan.kind:
        case "define":
            lines += ["", *_defined(done, paint), "", _verdicts(done)]
        case "drop":
            lines += ["", *([*_dropped(done, paint), ""] if done.variants else []), _matter(done)]
        case "mutate":
            lines += ["", *_mutated(done)]
    if done.limit is not None:
        total = len(done.plan.variants) - 1  # the first is the specification itself
        left = total - len(done.variants)
        lines += ["", f"{left:,} of {count(total, 'variant')} were not solved: {done.limit}."]
    return "\n".join(lines)


def _base(done: Swept) -> Iterator[str]:
    """What is known of the specification itself."""
    if done.base is not None:
        yield f"{done.plan.source.name}: {_verdict(done.base)}{_numbers(done.base)}."


def _numbers(line: Line) -> str:
    states = line["states"]
    if line["verdict"] != "realizable":
        return f", {_why(line)}" if _why(line) else ""
    run = "" if line["longest_run"] is None else f", runs of up to {count(line['longest_run'], 'step')}"
    return f", {count(states['decided'], 'state')} decided, {states['safe']:,} of all {states['valid']:,} safe{run}"


def _verdict(line: Line) -> str:
    """`realizable`; with what is missing in its proof."""
    unproved = line["verdict"] in ("realizable", "unrealizable") and line["proof"] == "undecided"
    return f"{line['verdict']}, unproved" if unproved else str(line["verdict"])


def _why(line: Line) -> str:
    """Why there is no policy."""
    if line["diagnostics"]:
        first = line["diagnostics"][0]
        place = "" if first["line"] is None else f" in line {first['line']}"
        return f"{first['code']}{place}: {first['message']}"
    if line["verdict"] == "undecided":
        return str(line["limit"])
    return ", ".join(f"{count(each['count'], 'state')}: {each['kind'].replace('-', ' ')}" for each in line["failures"])


def _difference(line: Line) -> str:
    """What is otherwise than in the specification itself."""
    found = line["compared"]
    if line["verdict"] != "realizable" or found is None:
        return _why(line)
    if not found["changed"]:
        return "the same decisions"
    kept = found["changed"] - found["lost"] - found["won"]
    parts = [
        *([f"{kept:,} of {count(found['compared'], 'decision')} changed"] if kept else []),
        *([f"{count(found['lost'], 'state')} lost"] if found["lost"] else []),
        *([f"{count(found['won'], 'state')} won"] if found["won"] else []),
    ]
    return ", ".join(parts)


def _table(rows: Sequence[Sequence[str]], right: frozenset[int] = frozenset()) -> list[str]:
    """Rows in columns; those in `right` end below each other."""
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return [
        "  "
        + "  ".join(
            f"{text:>{width}}" if place in right else f"{text:<{width}}"
            for place, (text, width) in enumerate(zip(row, widths, strict=True))
        ).rstrip()
        for row in rows
    ]


def _painted(table: list[str], lines: Sequence[Line], paint: Paint) -> list[str]:
    """A table below its heading, with the verdicts in colour."""
    tone = {"realizable": paint.good, "unrealizable": paint.bad, "error": paint.bad, "undecided": paint.doubt}
    below = (
        row.replace(line["verdict"], tone[line["verdict"]](line["verdict"]), 1)
        for row, line in zip(table[1:], lines, strict=True)
    )
    return [table[0], *below]


def _defined(done: Swept, paint: Paint) -> list[str]:
    lines = done.variants
    names = [str(each.name) for each in done.plan.variants[1].changes]
    rows = [["", *names, "verdict", "valid", "safe", "longest run", "compared with the specification"]]
    for line in lines:
        states = line["states"] or {}
        numbers = [states.get("valid"), states.get("safe"), line["longest_run"]]
        values = [_clipped(each["after"]) for each in line["changes"]]
        shown = ["" if each is None else f"{each:,}" for each in numbers]
        rows.append([str(line["variant"]), *values, _verdict(line), *shown, _difference(line)])
    first = len(names) + 2
    return _painted(_table(rows, frozenset({0, first, first + 1, first + 2})), lines, paint)


def _dropped(done: Swept, paint: Paint) -> list[str]:
    rows = [["line", "without", "", "verdict", "compared with the specification"]]
    for line in done.variants:
        (change,) = line["changes"]
        what = _clipped(change["before"])
        rows.append([str(change["line"]), change["what"], what, _verdict(line), _difference(line)])
    return _painted(_table(rows, frozenset({0})), done.variants, paint)


def _mutated(done: Swept) -> list[str]:
    counted, idle = done.counted, done.idle
    if not done.variants:
        return ["There is nothing to change by mistake."] if done.limit is None else []
    noticed = [each for each in counted if each["differs"]]
    unknown = len(counted) - len(noticed) - len(idle)
    said = [f"{len(noticed):,} of {count(len(counted), 'change')} are noticed by its rules and goals."]
    if len(done.plan.variants) - 1 < int(str(done.plan.options["possible"])):
        said.append(
            f"  drawn from {done.plan.options['possible']:,} possible ones by --seed {done.plan.options['seed']}"
        )
    verdicts = Counter(each["verdict"] for each in noticed)
    said += [
        f"  {number:,} make it {verdict}" if verdict != _of(done) else f"  {number:,} change decisions or states"
        for verdict, number in verdicts.items()
    ]
    left_out = Counter("are in error" if each["verdict"] == "error" else "mean the same" for each in _left_out(done))
    said += [f"  {number:,} more {why}, and are not counted" for why, number in left_out.items()]
    if unknown:
        said.append(f"  of {count(unknown, 'change')} this is not known within the limits")
    if idle:
        rows = []
        for line in idle:
            (change,) = line["changes"]
            after = "(left out)" if change["after"] is None else _clipped(change["after"])
            rows.append([str(change["line"]), change["what"], f"{_clipped(change['before'])} → {after}"])
        said += [
            "",
            "Not noticed, since the robot would do the same:",
            *_table([["line", "in", "change"], *rows], frozenset({0})),
        ]
    return said


def _of(done: Swept) -> object:
    return None if done.base is None else done.base["verdict"]


def _left_out(done: Swept) -> list[Line]:
    counted = {each["variant"] for each in done.counted}
    return [each for each in done.variants if each["variant"] not in counted]


def _clipped(text: str | None) -> str:
    text = "" if text is None else text
    return text if len(text) <= _WIDEST else f"{text[: _WIDEST - 1]}…"


def _verdicts(done: Swept) -> str:
    found = Counter(_verdict(each) for each in done.variants)
    return (
        f"{count(len(done.variants), 'variant')}: {enumeration([f'{n:,} {verdict}' for verdict, n in found.items()])}."
    )


def _matter(done: Swept) -> str:
    idle, unknown = done.idle, sum(each["differs"] is None for each in done.counted)
    known = len(done.counted) - unknown
    said = [f"Of {count(unknown, 'element')} it is not known within the limits."] if unknown else []
    if idle:
        lines = enumeration(list(dict.fromkeys(str(each["changes"][0]["line"]) for each in idle)))
        one = len(idle) == 1
        by_itself = "makes no difference" if one else "make no difference, each by itself"
        said.insert(0, f"{len(idle):,} of {count(known, 'element')} {by_itself}: {'line' if one else 'lines'} {lines}.")
    elif known:
        said.insert(
            0, f"{'The one element makes' if known == 1 else f'Each of the {known:,} elements makes'} a difference."
        )
    return " ".join(said) or "There is no rule, precondition, alternative or assumption to drop."


def findings(done: Swept) -> list[Finding]:
    """What makes no difference at its line, variants without a policy, and a notice with the summary."""
    file, found = done.plan.source.name, list[Finding]()
    if done.plan.kind == "define":
        for line in done.variants:
            if line["verdict"] != "realizable":
                values = ", ".join(f"{each['name']} = {each['after']}" for each in line["changes"])
                found.append(Finding("error", f"{values}: {_verdict(line)}, {_why(line)}", file, title=line["verdict"]))
        return [*found, Finding("notice", _verdicts(done))]
    for line in done.idle:
        (change,) = line["changes"]
        after = "left out" if change["after"] is None else f"`{change['after']}`"
        message = f"{change['what']} `{change['before']}` may as well be {after}: nothing is decided otherwise"
        place = Span(change["line"], change["column"], change["line"], change["column"] + 1)
        found.append(Finding("warning", message, file, place, title="no difference"))
    summary = _matter(done) if done.plan.kind == "drop" else _mutated(done)[0]
    return [*found, Finding("notice", summary)]
