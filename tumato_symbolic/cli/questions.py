"""What may be typed after `explain` and `why`, and the help that teaches it."""

from __future__ import annotations

import argparse

from tumato_symbolic.cli.numbers import whole

EXPLAIN = """\
Say why there is no policy for a specification, and what would change that.

All states that fail, in a few groups; for each group the fewest lines that suffice for it; what the nearest sets of
actions break; what could be dropped or changed, each way tried; and the largest part of the states for which there is
a policy, as an assumption.
"""

EXPLAIN_EXAMPLE = """\
examples:
  tumato-sym explain robots.tum
  tumato-sym explain robots.tum --write robots_assumed.tum       # with the assumption that makes it realizable
  tumato-sym explain robots.tum --output-format sarif > explain.sarif

"""

WHY = """\
Say why a policy decides as it does in a state: which goal is active and why, the run to the goal, which other sets of
actions are not allowed, and by which outcome, and what the allowed ones would cost.
"""

WHY_EXAMPLE = """\
examples:
  tumato-sym why policy.json amr.tum S_Location=corridor S_Battery=low S_Load=free S_Conveyor=on
  tumato-sym why policy.json amr.tum S_Location=corridor S_Battery=low S_Load=free S_Conveyor=on --not move_to_charger

"""


def add_explain(parser: argparse.ArgumentParser) -> None:
    """The arguments of `explain`, but for those that other commands share."""
    parser.add_argument("specs", metavar="SPEC", nargs=1, help="the specification, a .tum file")
    parser.add_argument(
        "--max-cubes",
        type=whole(1),
        metavar="N",
        help="list at most N groups of failing states (default: 1,000 for a program, the largest ones for a person)",
    )
    parser.add_argument(
        "--cores", type=whole(1), default=1, metavar="N", help="give up to N reasons for each group (default: 1)"
    )
    parser.add_argument(
        "--repairs", type=whole(0), default=3, metavar="N", help="look for N ways to drop lines (default: 3)"
    )
    parser.add_argument(
        "--write",
        metavar="FILE",
        help="write the specification with the assumption that makes it realizable (- for the standard output, the "
        "report then goes to the standard error stream)",
    )


def add_why(parser: argparse.ArgumentParser) -> None:
    """The arguments of `why`, but for those that other commands share."""
    parser.add_argument("policy", metavar="POLICY", help="the policy, a .json file")
    parser.add_argument("specs", metavar="SPEC", nargs=1, help="the specification, a .tum file")
    parser.add_argument("assignments", metavar="VAR=VALUE", nargs="+", help="the state: a value for every variable")
    parser.add_argument(
        "--not",
        dest="instead",
        metavar="ACTION[,ACTION]",
        help="say why not this set of actions ('' is: nothing)",
    )
    parser.add_argument(
        "--output-format",
        choices=("text", "json"),
        default="text",
        help="for a person, or for a program (one JSON object) (default: text)",
    )
