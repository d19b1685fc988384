"""`tumato-sym show`: a policy, or a part of it."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, ClassVar, Literal

from msgspec.structs import replace

from tumato_symbolic.cli import arguments
from tumato_symbolic.cli.console import note, write
from tumato_symbolic.cli.exits import UNDECIDED, YES
from tumato_symbolic.cli.numbers import whole
from tumato_symbolic.cli.options import MINUTE, CommandOptions, OutputFormat, argument
from tumato_symbolic.cli.output import show_as
from tumato_symbolic.limits import Context

if TYPE_CHECKING:
    from tumato_symbolic.policy import Policy, RuleList
    from tumato_symbolic.report.shown import Shown
    from tumato_symbolic.spec import Spec
    from tumato_symbolic.views import Selected, Tree

Format = Literal["tree", "rules", "table", "dot", "mermaid"]

ABOUT = """\
Show a policy, or what it does in some states: where variables have certain values, or where an action is executed.

tree     questions about the state, and what is done
rules    a short ordered list of rules: the first that matches decides; checked before it is printed
table    a line for all states that are decided alike, with their number
dot      the tree as a graph in which equal parts are one, for Graphviz
mermaid  the same as a flowchart in Markdown

States are never listed: a policy over 10^12 states takes seconds. With the specification, only valid states are shown,
and those that break a state rule are marked.
"""

EXAMPLES = """\
examples:
  tumato-sym show policy.json
  tumato-sym show policy.json S_EStop=pressed                          # what happens when it is pressed
  tumato-sym show policy.json forklift.tum S_Place!=dock,rack S_Person=near
  tumato-sym show policy.json --executing charge --format table        # where it is executed
  tumato-sym show policy.json --format rules
  tumato-sym show policy.json --format dot | dot -Tsvg -o policy.svg
"""

_LINES = 100
"""A tree or a table has so many lines at most, unless another number is asked for."""

_BOXES = 60
"""A graph has so many boxes at most, unless another number is asked for."""


class Options(CommandOptions, frozen=True):
    """What may be typed after `show`."""

    policy: str = arguments.policy()
    words: tuple[str, ...] = argument(
        metavar="SPEC, VAR=VALUE",
        nargs="*",
        help="the specification, and values that variables have in the states to show: VAR=VALUE, VAR=VALUE,VALUE or "
        "VAR!=VALUE",
    )
    executing: str | None = argument(
        "--executing",
        metavar="ACTION[,ACTION]",
        help="show the states where this action is executed, or all of these are",
    )
    format: Format = argument(
        "--format",
        choices=("tree", "rules", "table", "dot", "mermaid"),
        default="tree",
        help="as what it is shown (default: tree)",
    )
    limit: int | None = argument(
        "--limit",
        type=whole(1),
        metavar="N",
        help=f"show at most N lines of a tree or a table (default: {_LINES}), or N boxes of a graph (default: "
        f"{_BOXES}); what is left out is said",
    )
    timeout: float | None = arguments.timeout("60")
    memory: int | None = arguments.memory()
    output_format: OutputFormat = arguments.output_format("json")

    own_seconds: ClassVar[float | None] = MINUTE

    @property
    def specs(self) -> tuple[str, ...]:
        """The words that name a file."""
        return tuple(filter(_is_file, self.words))

    @property
    def assignments(self) -> tuple[str, ...]:
        """The other words."""
        return tuple(word for word in self.words if not _is_file(word))

    def mistake(self) -> str | None:
        """One specification; a graph is text for another program already; rules are listed whole."""
        if self.executing is not None and not self.executing.strip(" ,"):
            return "--executing names no action"
        if len(self.specs) > 1:
            return f"there is one specification, not {len(self.specs)}: {', '.join(self.specs)}"
        if self.format in ("dot", "mermaid") and self.output_format == "json":
            return f"--format {self.format} is for another program already (see tumato-sym show --help)"
        if self.format == "rules" and self.limit is not None:
            return "--limit is for trees, tables and graphs; rules are listed whole"
        return None


def _is_file(word: str) -> bool:
    from tumato_symbolic.cli.matching import SUFFIXES

    return word.endswith(SUFFIXES) or ("=" not in word and (word == "-" or os.path.isfile(word)))  # noqa: PTH113


def run(options: Options, context: Context) -> int:
    """Show it; exit with 3 where rules leave out states."""
    from tumato_symbolic.report import shown
    from tumato_symbolic.views import parse_selection, select

    policy, spec = _read(options, context)
    selection = parse_selection(policy.vocabulary, options.assignments, options.executing or "")
    context.tell("looking at the states")
    selected = select(policy, selection, spec)
    file = next(iter(options.specs), None)
    done = shown.Shown(options.policy, file, selection, selected, None, options.format == "table")
    if options.format in ("dot", "mermaid"):
        _draw(done, options, context)
        return YES
    done = replace(done, content=_content(selected, options, context))
    show_as(options, text=lambda _: shown.as_text(done), json=lambda: shown.as_json(done))
    return UNDECIDED if done.is_incomplete else YES


def _read(options: Options, context: Context) -> tuple[Policy, Spec | None]:
    """The policy, in the order of the specification where there is one. Raises `UserError` where they do not fit."""
    from tumato_symbolic.cli.inputs import read_policy
    from tumato_symbolic.policy import Policy, fitted

    if not options.specs:
        context.tell(f"reading {options.policy}")
        return Policy.load(options.policy), None
    _, spec, policy = read_policy(options, None, context, fitted)
    return policy, spec


def _content(selected: Selected, options: Options, context: Context) -> RuleList | Tree | None:
    """What is shown as text."""
    from tumato_symbolic.policy import find_rules
    from tumato_symbolic.views import Questions

    if options.format == "rules":
        return find_rules(selected.as_policy(), context)
    context.tell("looking for questions")
    questions = Questions(selected.joint(context))
    return questions.tree(options.limit or _LINES, leaves_only=options.format == "table")


def _draw(done: Shown, options: Options, context: Context) -> None:
    """Write the graph; that it is not whole is said beside it."""
    from tumato_symbolic.report import graphs
    from tumato_symbolic.report.shown import title
    from tumato_symbolic.views import Questions

    context.tell("looking for questions")
    boxes = Questions(done.selected.joint(context)).graph(options.limit or _BOXES)
    lines = graphs.dot_lines if options.format == "dot" else graphs.mermaid_lines
    write("\n".join(lines(done.selected.vocabulary, boxes, title(done))))
    folded = sum(box.is_folded for box in boxes)
    if folded:
        boxes_stand = "one box stands" if folded == 1 else f"{folded:,} boxes stand"
        note(f"tumato-sym: {boxes_stand} for different decisions; --limit N shows more, VARIABLE=VALUE a part")
