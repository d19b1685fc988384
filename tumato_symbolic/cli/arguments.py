"""The options that several commands share."""

from __future__ import annotations

from typing import Any

from tumato_symbolic.cli.numbers import seconds, whole
from tumato_symbolic.cli.options import OutputFormat, Target, argument


def policy(help_: str = "the policy, a .json file") -> Any:  # noqa: ANN401
    """`POLICY`."""
    return argument(metavar="POLICY", help=help_)


def specs(number: int | str = 1, help_: str = "the specification, a .tum file") -> Any:  # noqa: ANN401
    """`SPEC`, as many as argparse's `nargs` says."""
    return argument(metavar="SPEC", nargs=number, help=help_)


def several_specs() -> Any:  # noqa: ANN401
    """`SPEC …`, where several may be done."""
    return specs("+", "the specification, a .tum file; several, or folders of them, for a table with a line for each")


def output(writes: Target, default: str, help_: str) -> Any:  # noqa: ANN401
    """`--output`, where that is what the command is for."""
    return argument("-o", "--output", metavar="FILE", default=default, help=help_, writes=writes)


def state(number: str, help_: str = "the state: a value for every variable") -> Any:  # noqa: ANN401
    """`VAR=VALUE`, as many as argparse's `nargs` says."""
    return argument(metavar="VAR=VALUE", nargs=number, help=help_)


def effect_ordering(*, certificates: bool = False) -> Any:  # noqa: ANN401
    """`--effect-ordering`; `certificates` are judged as well, each by the ordering that it is about."""
    more = "; of a proof that there is no policy, the one that it records" if certificates else ""
    return argument(
        "--effect-ordering",
        choices=("any", "first"),
        help="how the effects of actions executed together may interleave: in any order, one after the other, or only "
        f"the first of them (default: the specification's, else any{more})",
    )


def restoration() -> Any:  # noqa: ANN401
    """`--restoration`."""
    return argument(
        "--restoration",
        choices=("one_step", "bounded", "fair"),
        help="how safety is restored: in one step; in several, within a bound whatever happens; or in several, if "
        "nominal effects happen again and again (default: the specification's, else one_step)",
    )


def no_verify(help_: str) -> Any:  # noqa: ANN401
    """`--no-verify`."""
    return argument("--no-verify", action="store_false", help=help_)


def seed(help_: str, default: int | None) -> Any:  # noqa: ANN401
    """`--seed`."""
    return argument("--seed", type=whole(0), default=default, metavar="N", help=help_)


def timeout(default: str = "no limit") -> Any:  # noqa: ANN401
    """`--timeout`; `default` is how long a command takes at most by itself."""
    return argument(
        "--timeout",
        type=seconds,
        metavar="SECONDS",
        help="how long the command may take before it ends with what it has found (exit 3 where that is no answer; "
        f"default: {default})",
    )


def memory(limit: str = "how much memory the command may use before it ends in the same way") -> Any:  # noqa: ANN401
    """`--memory`; `limit` says what it bounds."""
    help_ = f"{limit} (default: no limit)"
    return argument("--memory", type=whole(1, "megabytes"), metavar="MB", help=help_)


def prover() -> Any:  # noqa: ANN401
    """`--prover`."""
    return argument(
        "--prover",
        choices=("auto", "z3", "walk", "explicit", "both"),
        default="auto",
        help="what proves a policy: Z3 (z3); the walk, our own checker over decision diagrams, without Z3 (walk); "
        "explicit-state checking of up to 200,000 decided states (explicit); both Z3 and the walk, which must agree "
        "(both); or Z3 for what it answers soon, the walk for the rest, and explicit-state checking for what is left "
        "(auto, the default). Unrealizability is always proved by Z3 or the walk",
    )


def jobs(what: str) -> Any:  # noqa: ANN401
    """`--jobs`."""
    return argument(
        "--jobs",
        type=whole(1, "processes"),
        metavar="N",
        help=f"how many processes may work on {what}; the answer does not depend on it (default: one per processor)",
    )


def profile() -> Any:  # noqa: ANN401
    """`--profile`."""
    return argument(
        "--profile",
        action="store_true",
        help="show on the standard error stream how long each stage took, and how much memory was used",
    )


def check(help_: str) -> Any:  # noqa: ANN401
    """`--check`."""
    return argument("--check", action="store_true", help=help_)


def output_format(*formats: OutputFormat, json: str = "one JSON object") -> Any:  # noqa: ANN401
    """`--output-format`, with the formats that there are beside the text for a person."""
    readers = {
        "json": f"for a program ({json})",
        "github": "as workflow commands of GitHub",
    }
    said = ["for a person", *(readers[each] for each in formats if each in readers)]
    return argument(
        "--output-format",
        choices=("text", *formats),
        default="text",
        help=f"{', '.join(said[:-1])}, or {said[-1]} (default: text)",
    )
