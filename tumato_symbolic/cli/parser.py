"""The command line as data: what may be typed, and the help that teaches it."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

from tumato_symbolic.cli.console import write
from tumato_symbolic.cli.numbers import seconds, whole
from tumato_symbolic.cli.questions import EXPLAIN, EXPLAIN_EXAMPLE, WHY, WHY_EXAMPLE, add_explain, add_why

if TYPE_CHECKING:
    from _typeshed import SupportsWrite

    from tumato_symbolic.spec import Ordering
    from tumato_symbolic.verify import ProverName

OutputFormat = Literal["text", "json", "github", "sarif"]
PROPERTIES = ("total", "safe", "goals", "minimal")
WRITING = ("synth", "explain", "export-proof")
"""The commands that write files."""


@dataclass(frozen=True, slots=True)
class Options:
    """One command with its options. A field that the command does not know keeps its default."""

    command: Literal["synth", "explain", "verify", "export-proof", "decide", "rules", "why", "check"]
    specs: tuple[str, ...] = ()
    policy: str = ""
    output: str = "policy.json"
    effect_ordering: Ordering | None = None
    policy_format: Literal["auto", "table", "diagram"] = "auto"
    timeout: float | None = None
    memory: int | None = None
    prove: bool = True
    properties: tuple[str, ...] = PROPERTIES
    prover: ProverName = "auto"
    jobs: int | None = None
    profile: bool = False
    strict: bool = False
    require_all: bool = False
    spec_folders: tuple[str, ...] = ()
    assignments: tuple[str, ...] = ()
    stdin: bool = False
    max_cubes: int | None = None
    cores: int = 1
    repairs: int = 3
    write: str | None = None
    instead: str | None = None
    output_format: OutputFormat = "text"


_EXITS = """\
exit codes:
  0 yes   1 no   2 the input or the command line cannot be used   3 no verdict within the limits
  70 a bug of this program (please report it)   130 interrupted
"""

_MAIN = """\
From a declarative specification to a robot policy that is proved safe.

A specification says what the robot can be in (state variables), what it can do (actions with nominal and
alternative effects), what must never happen (rules) and what it should reach (goals). `synth` computes what to do in
every valid state, or says why there is no such policy; `verify` proves a policy for all states.
"""

_MAIN_EXAMPLE = """\
example:
  tumato-sym check amr.tum                   # any mistakes?
  tumato-sym synth amr.tum                   # writes policy.json, proved
  tumato-sym explain robots.tum              # why there is none, and what would do
  tumato-sym verify policy.json amr.tum      # proves it again, believing nobody
  tumato-sym decide policy.json S_Location=corridor S_Battery=low S_Load=free S_Conveyor=off

"""

_SYNTH = """\
Compute a policy for a specification, prove it, and write it.

The policy says for every valid state which actions to execute. It is written only after it has been proved. Where there
is none, the states that fail are named, and NAME.unrealizable.json with the proof of that is written instead.
"""

_SYNTH_EXAMPLE = """\
examples:
  tumato-sym synth amr.tum                                      # writes policy.json
  tumato-sym synth amr.tum -o - | python -m json.tool | less    # the policy on the standard output
  tumato-sym synth amr.tum --output-format json                 # the answer for a program

"""

_VERIFY = """\
Prove a policy, whoever made it, against a specification.

For all valid states at once: total (there is a decision), safe (every outcome keeps the rules, in any order of
effects), goals (the nominal run reaches the active goals), minimal (no cheaper set of actions would restore safety as
well). A property that does not hold is refuted by a state and the story of what goes wrong there.

Given a folder, every NAME.policy.json and NAME.unrealizable.json in it is verified against NAME.tum, which is looked
for in the folders given with --specs, beside it, and in ../examples; where there is no such name, against the
specification there that it was made for. The exit code is that of the worst file: 2, then 1, then 3, then 0.
"""

_VERIFY_EXAMPLE = """\
examples:
  tumato-sym verify policy.json amr.tum
  tumato-sym verify policy.json amr.tum --properties total,safe,goals
  tumato-sym verify proofs/ --specs robots/ --strict             # all policies of a repository, in its CI

"""

_EXPORT = """\
Write a policy and its specification as one Coq file: compiling it proves that the policy is sound, complete and
minimal. Nothing is judged here: the theorem of a wrong policy is written as well, and Coq refuses it. For
specifications of up to 2,000 states.
"""

_EXPORT_EXAMPLE = """\
examples:
  tumato-sym export-proof policy.json amr.tum -o amr.v
  coqc -q -R proofs/coq Tumato amr.v             # after `make -C proofs/coq`, in a checkout of tumato-symbolic

"""

_DECIDE = """\
Ask a policy what to do in a state: one action a line, nothing where nothing is to be done.

With --stdin, read one JSON object per line and answer each with one JSON list on a line of its own: null where the
policy says nothing about the state, {"error": "..."} where the line is no state. Every line is answered; the exit code
is 1 where one of them was not answered with a list.
"""

_DECIDE_EXAMPLE = """\
examples:
  tumato-sym decide policy.json S_Location=corridor S_Battery=low S_Load=free S_Conveyor=off
  echo '{"S_Location": "corridor", "S_Battery": "low", "S_Load": "free", "S_Conveyor": "off"}' \\
    | tumato-sym decide policy.json --stdin

"""

_RULES = """\
Show a policy as a short ordered list of rules: the first that matches decides.

The list says what the policy says in every state that it decides, which is checked before it is printed. It needs the
policy alone, and no list of states: a policy over 10^12 states takes seconds.
"""

_RULES_EXAMPLE = """\
examples:
  tumato-sym rules policy.json
  tumato-sym rules policy.json --output-format json

"""

_CHECK = """\
Look for mistakes in specifications without solving them: syntax, names, effects, and what is surely unmeant.

Made for editors and commit hooks: it answers at once. Warnings alone exit with 0. What shows only in the states, such
as a rule that nothing breaks, is looked for where there are few of them; `synth` looks for it everywhere.
"""

_CHECK_EXAMPLE = """\
examples:
  tumato-sym check amr.tum
  tumato-sym check specs/*.tum --output-format github

"""


def parse(arguments: Sequence[str] | None) -> Options:
    """Read a command line. Help, version and usage errors end in `SystemExit`, as argparse does.

    Raises `UserError` where help cannot be shown.
    """
    typed = sys.argv[1:] if arguments is None else arguments
    found: dict[str, Any] = vars(_parser(typed).parse_args(typed))
    if found["command"] == "decide" and found["stdin"] == bool(found["assignments"]):
        what = "not both" if found["stdin"] else "or --stdin"
        _parser().error(f"decide: give the state as VAR=VALUE …, {what} (see tumato-sym decide --help)")
    if found["command"] in ("synth", "export-proof") and not found["output"]:
        _parser().error(f"{found['command']}: -o needs a file name (or - for the standard output)")
    if found["command"] == "explain" and found["write"] == "":
        _parser().error("explain: --write needs a file name (or - for the standard output)")
    if found["command"] == "verify":
        _check_verify(found)
    _check_standard_input(found)
    settings: dict[str, Any] = {
        name: tuple(value) if isinstance(value, list) else value for name, value in found.items()
    }
    return Options(**settings)


def _check_standard_input(found: dict[str, Any]) -> None:
    """It can be read once."""
    inputs = [found.get("policy"), *found.get("specs", ()), "-" if found.get("stdin") else None]
    if inputs.count("-") > 1:
        _parser().error(f"{found['command']}: only one input can be the standard input")


def _check_verify(found: dict[str, Any]) -> None:
    """A policy needs one specification, a folder looks for its own; a certificate is judged beside a safe policy."""
    is_folder = os.path.isdir(found["policy"])  # noqa: PTH112 - Path.is_dir() fails for names that are too long
    if len(found["specs"]) > 1 or not (found["specs"] or is_folder):
        _parser().error("verify: give a policy and its specification, or a folder of policies")
    if found["specs"] and found["spec_folders"]:
        _parser().error("verify: give either the specification, or --specs DIR for a folder of policies")
    if found["specs"] and found["require_all"]:
        _parser().error("verify: --require-all is for a folder of policies")
    if found["strict"] and not {"safe", "goals"} <= set(found["properties"]):
        _parser().error("verify: --strict judges the certificate, and needs safe and goals among the properties")


class _Parser(argparse.ArgumentParser):
    """A parser whose help is lost to nobody without a word."""

    def print_help(self, file: SupportsWrite[str] | None = None) -> None:
        """Put the help on the standard output. Raises `UserError` where it cannot be."""
        if file is None:
            write(self.format_help())
        else:
            super().print_help(file)


class _Version(argparse.Action):
    """Print the version, which is looked up only now."""

    def __call__(self, parser: argparse.ArgumentParser, *_: object) -> None:
        from tumato_symbolic import __version__

        write(f"tumato-sym {__version__}")
        parser.exit()


def _properties(text: str) -> tuple[str, ...]:
    asked = tuple(dict.fromkeys(part.strip() for part in text.split(",")))
    wrong = next((name for name in asked if name not in PROPERTIES), None)
    if wrong is not None:
        raise argparse.ArgumentTypeError(f"{wrong!r} is not a property; choose from {', '.join(PROPERTIES)}")
    return asked


class _Help(argparse.RawDescriptionHelpFormatter):
    """Help as Python 3.13 formats it: earlier ones forget that commands are indented, and break their column."""

    def add_argument(self, action: argparse.Action) -> None:
        """Count the indented commands in the width of the first column."""
        super().add_argument(action)
        for command in self._iter_indented_subactions(action):
            width = len(self._format_action_invocation(command)) + self._current_indent
            self._action_max_length = max(self._action_max_length, width)


def _parser(typed: Sequence[str] = ()) -> argparse.ArgumentParser:
    """What may be typed. Only the commands that were typed know their arguments: making all takes its time."""
    parser = _Parser(
        prog="tumato-sym",
        description=_MAIN,
        epilog=_MAIN_EXAMPLE + _EXITS,
        formatter_class=_Help,
        allow_abbrev=False,
    )
    parser.add_argument(
        "--version", action=_Version, nargs=0, default=argparse.SUPPRESS, help="show the version and exit"
    )
    commands = parser.add_subparsers(dest="command", metavar="COMMAND", required=True)
    for name, purpose, about, example, add_arguments in _COMMANDS:
        command = commands.add_parser(
            name, help=purpose, description=about, epilog=example + _EXITS, formatter_class=_Help, allow_abbrev=False
        )
        if name in typed:
            add_arguments(command)
    return parser


def _synth(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("specs", metavar="SPEC", nargs=1, help="the specification, a .tum file")
    parser.add_argument(
        "-o",
        "--output",
        metavar="FILE",
        default="policy.json",
        help="where to write the policy (default: policy.json here; - for the standard output, the report then goes "
        "to the standard error stream)",
    )
    _ordering(parser, "the specification's, else any")
    parser.add_argument(
        "--policy-format",
        choices=("auto", "table", "diagram"),
        default="auto",
        help="a row for every state, or a decision diagram (default: auto, a table up to about 10,000 valid states)",
    )
    parser.add_argument(
        "--no-verify",
        dest="prove",
        action="store_false",
        help="write the policy without a proof (the report says so)",
    )
    _limits(parser)
    _prover(parser)
    _jobs(parser, "the proof of a large policy")
    _profile(parser)
    _format(parser)


def _explain(parser: argparse.ArgumentParser) -> None:
    add_explain(parser)
    _limits(parser, "60")
    _ordering(parser, "the specification's, else any")
    _format(parser, "sarif")


def _verify(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "policy", metavar="POLICY", help="the policy or the proof that there is none, a .json file, or a folder of them"
    )
    parser.add_argument("specs", metavar="SPEC", nargs="*", help="the specification, a .tum file; none for a folder")
    parser.add_argument(
        "--specs",
        dest="spec_folders",
        metavar="DIR",
        action="append",
        default=[],
        help="where the specifications of a folder of policies are looked for first; may be given several times",
    )
    _limits(parser)
    _prover(parser)
    _jobs(parser, "a large proof, or a folder")
    _profile(parser)
    parser.add_argument(
        "--strict",
        action="store_true",
        help="fail as well (exit 1) where the certificate is wrong, or stale: made for another specification",
    )
    _ordering(parser, "the one that the policy records, else the specification's, else any")
    parser.add_argument(
        "--require-all",
        action="store_true",
        help="fail as well (exit 1) where a specification has neither a policy nor a certificate in the folder: one of "
        "those in the folders given with --specs, else of those in the folder itself and in ../examples",
    )
    parser.add_argument(
        "--properties",
        type=_properties,
        default=PROPERTIES,
        metavar="LIST",
        help=f"what to prove, separated by commas (default: {','.join(PROPERTIES)})",
    )
    _format(parser)


def _export(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("policy", metavar="POLICY", help="the policy, a .json file")
    parser.add_argument("specs", metavar="SPEC", nargs=1, help="the specification, a .tum file")
    parser.add_argument(
        "-o", "--output", metavar="FILE", default="-", help="where to write the theorem (default: the standard output)"
    )
    _limits(parser)
    _ordering(parser, "any where the specification writes it, else what the policy records, else any")


def _decide(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("policy", metavar="POLICY", help="the policy, a .json file")
    parser.add_argument("assignments", metavar="VAR=VALUE", nargs="*", help="the state: a value for every variable")
    parser.add_argument(
        "--stdin", action="store_true", help="read states from the standard input, one JSON object a line"
    )


def _rules(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("policy", metavar="POLICY", help="the policy, a .json file")
    _limits(parser, "60")
    parser.add_argument(
        "--output-format",
        choices=("text", "json"),
        default="text",
        help="for a person, or for a program (one JSON object) (default: text)",
    )


def _why(parser: argparse.ArgumentParser) -> None:
    add_why(parser)
    _limits(parser)
    _ordering(parser, "the one that the policy records, else the specification's, else any")


def _check(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("specs", metavar="SPEC", nargs="+", help="specifications, .tum files")
    _limits(parser)
    _format(parser)


def _ordering(parser: argparse.ArgumentParser, default: str) -> None:
    parser.add_argument(
        "--effect-ordering",
        choices=("any", "first"),
        help="how the effects of actions executed together may strike: in any order, one after the other, or only the "
        f"first of them (default: {default})",
    )


def _limits(parser: argparse.ArgumentParser, default: str = "no limit") -> None:
    """What a command may cost; `default` is how long it takes at most by itself."""
    parser.add_argument(
        "--timeout",
        type=seconds,
        metavar="SECONDS",
        help="how long the command may take before it ends with what it has found (exit 3 where that is no answer; "
        f"default: {default})",
    )
    parser.add_argument(
        "--memory",
        type=whole(1, "megabytes"),
        metavar="MB",
        help="how much memory it may take before it ends so (default: no limit)",
    )


def _prover(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--prover",
        choices=("auto", "z3", "walk", "explicit", "both"),
        default="auto",
        help="who proves a policy: Z3; the walk, our own checker over decision diagrams, which does without Z3; "
        "explicit-state checking, which looks at every decided state, up to 200,000; both Z3 and the walk, which must "
        "agree; or Z3 for what it answers soon, the walk for the rest, and explicit-state checking for what they leave "
        "open (default: auto). That there is no policy is proved by Z3",
    )


def _jobs(parser: argparse.ArgumentParser, what: str) -> None:
    parser.add_argument(
        "--jobs",
        type=whole(1, "processes"),
        metavar="N",
        help=f"how many processes may work at {what}; the answer is the same (default: one on every processor)",
    )


def _profile(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--profile",
        action="store_true",
        help="show on the standard error stream where the time went, and how much memory was taken",
    )


def _format(parser: argparse.ArgumentParser, *more: str) -> None:
    parser.add_argument(
        "--output-format",
        choices=("text", "json", "github", *more),
        default="text",
        help="for a person, for a program (one JSON object), or as workflow commands of GitHub (default: text)",
    )


_COMMANDS: tuple[tuple[str, str, str, str, Callable[[argparse.ArgumentParser], None]], ...] = (
    ("synth", "compute, prove and write a policy", _SYNTH, _SYNTH_EXAMPLE, _synth),
    ("explain", "why there is no policy, and what would do", EXPLAIN, EXPLAIN_EXAMPLE, _explain),
    ("verify", "prove a policy, whoever made it", _VERIFY, _VERIFY_EXAMPLE, _verify),
    ("export-proof", "write a policy as a theorem for Coq", _EXPORT, _EXPORT_EXAMPLE, _export),
    ("decide", "what to do in a state", _DECIDE, _DECIDE_EXAMPLE, _decide),
    ("rules", "a policy as a short list of rules", _RULES, _RULES_EXAMPLE, _rules),
    ("why", "why a policy decides as it does in a state", WHY, WHY_EXAMPLE, _why),
    ("check", "look for mistakes in specifications", _CHECK, _CHECK_EXAMPLE, _check),
)
"""The commands: name, purpose, description, examples, and what adds the arguments."""
